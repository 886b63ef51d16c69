# SPDX-License-Identifier: MIT
"""The live panel's window, by Textual's pilot: what a stroke does, what is text, what is shown.

The terminal around it is in test_terminal.py.
"""

from tools.terminal.strokes import ESCAPE
from window_bench import in_window

INTERPRETERS = "host"


@in_window()
async def test_s_starts_and_space_stops(desk):
    await desk.type("s")
    await desk.wait(4000)
    assert desk.shows("\u2502RUNNING      A1 \u2502") and desk.shows("10.00 Hz right")
    await desk.type("space")
    await desk.wait(500)
    assert desk.state() == "stopping"


@in_window()
async def test_arrows_move_the_setpoint(desk):
    await desk.type("up", "up", "down", "up")
    await desk.wait(1500)
    assert desk.talk.lcd()[0].startswith("S: 10.2")


@in_window()
async def test_a_capital_holds_until_another_key_or_esc(desk):
    await desk.type("T")
    await desk.wait(100)
    assert desk.shows("t STOP         HELD") and desk.talk.down() == ["STOP"]
    await desk.type("escape")
    await desk.wait(200)
    assert not desk.shows("HELD") and desk.talk.down() == []
    await desk.type("U")
    await desk.wait(100)
    assert desk.shows("u UP           HELD")
    await desk.type("n")
    await desk.wait(100)
    assert not desk.shows("HELD")


@in_window()
async def test_a_jog_ends_when_the_keyboard_does_not_repeat_it(desk):
    await desk.type("L")
    await desk.pilot.pause(1.0)
    sent = [one for one in desk.panel.sent if one[1].get("key")]
    assert sent == [("down", {"key": "JOG_RIGHT"}), ("up", {"key": "JOG_RIGHT"})]


@in_window()
async def test_a_key_that_means_nothing_gets_a_hint_and_does_nothing(desk):
    for key in ("k", "exclamation_mark", "g", "OTHER"):
        before = len(desk.panel.sent)
        await desk.type(key)
        assert desk.shows("does nothing here"), key
        assert {kind for kind, _ in desk.panel.sent[before:]} <= {"alive"}
    await desk.type("u")
    assert not desk.shows("does nothing here")


@in_window()
async def test_a_command_line_stays_open_so_that_no_word_is_taken_for_keys(desk):
    """`speed` after a command would tap START, ADDRESS_DOWN and others."""
    await desk.type("colon")
    for command in ("load 1 50", "jump", "speeed", "param 1 P1082[0]", "wait 10"):
        await desk.type(*(one if one.isalnum() else name(one) for one in command), "enter")
        await desk.wait(300)
        assert desk.talk.down() == [] and desk.app.query_one("#line").kind == ":"
    assert desk.state() == "ready" and desk.starts() == 0
    await desk.type("space", "space")
    assert desk.talk.down() == ["STOP"]  # and no word after it is keys either
    await desk.wait(500)
    await desk.type(*"speed", "enter")
    await desk.wait(3000)
    assert desk.starts() == 0
    await desk.type("enter", "s")
    await desk.wait(3000)
    assert desk.starts() == 1


def name(character):
    names = {" ": "space", "[": "left_square_bracket", "]": "right_square_bracket"}
    return names.get(character, character)


@in_window()
async def test_strokes_are_taken_in_the_order_in_which_they_were_typed(desk):
    """However fast they come: what stands behind a colon is text, and behind Esc a key."""
    for key in ("colon", "s", "s", "escape", "u", "colon", "s"):
        desk.app.post_message(key_event(key))
    await desk.pilot.pause(0.3)
    pressed = [fields["key"] for kind, fields in desk.panel.sent if kind == "down"]
    assert pressed == ["UP"] and desk.app.query_one("#line").value == "s"


def key_event(key):
    from textual import events

    return events.Key(key, {"colon": ":", "escape": None}.get(key, key))


@in_window()
async def test_an_earlier_command_comes_back_with_an_arrow(desk):
    await desk.type("colon", *"lcd", "enter", *"mend", "enter", "up", "up")
    assert desk.app.query_one("#line").value == "lcd"
    await desk.type("down")
    assert desk.app.query_one("#line").value == "mend"
    assert desk.talk.lcd()[0].startswith("S: 10.0")


# --- what comes all at once ---------------------------------------------------------------------


async def together(desk, text, brackets=False):
    from tools.terminal.driver import Together

    desk.app.post_message(Together(list(text), brackets))
    await desk.pilot.pause(0.15)


@in_window()
async def test_a_paste_is_no_keys_and_stop_in_it_is_stop(desk):
    await together(desk, "uses: all is well, says log\r\n".replace(" ", ""))
    assert desk.shows("that came all at once, as a paste does: it was left out")
    await desk.wait(3000)
    assert desk.starts() == 0 and desk.talk.lcd()[0].startswith("S: 10.0")
    for text, brackets in (
        ("no words", True),
        ("u ", False),
        (ESCAPE + " ", False),
        ("ut", False),
    ):
        await desk.type("s")
        await desk.wait(4000)
        assert desk.state() == "running", text
        await together(desk, text, brackets)
        await desk.wait(400)
        assert desk.state() == "stopping" and desk.shows(", but for STOP"), text
        await desk.wait(8000)


@in_window()
async def test_a_command_line_takes_a_paste_as_text_and_never_its_enter(desk):
    await desk.type("colon")
    await together(desk, "press START\r")
    await desk.wait(1000)
    assert desk.app.query_one("#line").value == "press START" and desk.starts() == 0
    await together(desk, "unplug 1", True)
    assert desk.app.query_one("#line").value == "press START"
    await desk.wait(1000)  # the blank in it was a STOP
    await desk.type("enter")
    await desk.wait(3000)
    assert desk.starts() == 1


@in_window()
async def test_textuals_own_paste_is_left_out(desk):
    from textual import events

    await desk.type("colon")
    desk.app.post_message(events.Paste("unplug 1\n"))
    await desk.pilot.pause(0.2)
    assert desk.app.query_one("#line").value == ""


# --- START and JOG ------------------------------------------------------------------------------


@in_window(size=(18, 24))
async def test_start_and_jog_want_the_display_in_sight(desk):
    for key in "sSlLjJ":
        await desk.type(key)
        await desk.wait(500)
    await desk.command("press START")
    await desk.command("down JOG_LEFT")
    await desk.wait(1500)
    assert desk.starts() == 0
    assert {kind for kind, _ in desk.panel.sent} <= {"alive", "release", "hello", "up"}
    await desk.pilot.resize_terminal(19, 6)
    await desk.type("s")
    await desk.wait(2000)
    assert desk.starts() == 1
    await desk.pilot.resize_terminal(10, 3)
    await desk.type("space")
    await desk.wait(500)
    assert desk.state() == "stopping"


@in_window(is_real=True)
async def test_on_a_real_line_start_and_jog_are_two_keys(desk):
    assert desk.lines()[0].startswith(" REAL DRIVES ")
    assert desk.shows("gs START") and desk.shows("gl JOG_RIGHT") and desk.shows("t STOP")
    for key in "sSlLjJ":
        await desk.type(key)
        assert desk.shows("two keys within 2 s"), key
        await desk.type("g", "u", key)
        assert desk.shows("two keys within 2 s"), key
    await desk.type("g")
    assert desk.shows("now the letter of START")
    desk.app.armed_s = 0.1
    await desk.pilot.pause(0.2)
    await desk.type("s")
    assert ("down", {"key": "START"}) not in desk.panel.sent
    desk.app.armed_s = 60
    await desk.wait(1500)  # the taps of UP are over
    await desk.type("g", "s")
    assert ("down", {"key": "START"}) in desk.panel.sent and ("arm", {}) in desk.panel.sent


@in_window(is_real=True)
async def test_the_mouse_needs_two_keys_as_well(desk):
    await desk.hold("START", True)
    assert desk.shows("two keys within 2 s")
    await desk.hold("START", False)
    await desk.type("g")
    await desk.hold("JOG_LEFT", True)
    assert ("down", {"key": "JOG_LEFT"}) in desk.panel.sent


@in_window(is_real=True)
async def test_on_a_real_line_every_key_but_stop_has_to_be_repeated(desk):
    await desk.type("U")
    await desk.pilot.pause(0.9)
    assert ("up", {"key": "UP"}) in desk.panel.sent
    await desk.type("T")
    await desk.pilot.pause(0.9)
    assert ("up", {"key": "STOP"}) not in desk.panel.sent


@in_window()
async def test_a_panel_that_does_not_answer_is_not_started(desk):
    """What is sent to a panel that stands still is done when it goes on, whenever that is."""
    desk.app.heard_s = 0.1
    await desk.pilot.pause(0.3)
    await desk.pilot.press("s")
    await desk.pilot.pause(0.1)
    assert desk.shows("no START while the panel does not answer")
    assert ("down", {"key": "START"}) not in desk.panel.sent
    await desk.type("space")
    assert ("down", {"key": "STOP"}) in desk.panel.sent


@in_window()
async def test_a_window_that_loses_the_keyboard_lets_go(desk):
    from textual import events

    await desk.type("T")
    desk.app.post_message(events.AppBlur())
    await desk.pilot.pause(0.2)
    assert ("release", {}) in desk.panel.sent


# --- the mouse ----------------------------------------------------------------------------------


@in_window()
async def test_the_mouse_holds_a_key(desk):
    await desk.wait(100)
    await desk.hold("UP", True)
    await desk.wait(900)
    assert desk.shows("u UP           HELD") and desk.talk.down() == ["UP"]
    await desk.hold("UP", False)
    await desk.wait(200)
    assert desk.talk.down() == [] and not desk.shows("HELD")
    assert desk.talk.lcd()[0][3:7] > "10.3"


# --- commands -----------------------------------------------------------------------------------


@in_window()
async def test_what_is_wrong_with_a_command_is_said(desk):
    for command, said in (
        ("jump", "unknown command jump"),
        ("press FIRE", "no key FIRE"),
        ("unplug 7", "no drive at address 7"),
        ("expect RUNNING", "expected RUNNING"),
        ("speed 101", "speed 0...100"),
        ("speed", "use: speed N"),
    ):
        await desk.type("colon", *map(name, command), "enter")
        await desk.wait(100)
        assert any(said in line for line in desk.lines()) or said == "speed 0...100", command
        await desk.type("escape")


@in_window()
async def test_a_command_that_lets_time_pass_says_how_long_still_and_stop_ends_it(desk):
    await desk.type("s")
    await desk.wait(4000)
    await desk.type("colon", *map(name, "wait 12000"), "enter")
    await desk.wait(100)
    assert desk.shows("waiting, 12 s left (space: STOP, Esc: no further): wait 12000")
    await desk.wait(2000)
    assert desk.shows("waiting, 10 s left")
    await desk.type("space")
    await desk.wait(400)
    assert desk.shows("ended early: wait 12000") and desk.state() == "stopping"


@in_window()
async def test_a_setpoint_is_typed(desk):
    await desk.type("equals_sign", *"12.x5")
    assert desk.app.query_one("#line").value == "12.5"
    await desk.type("enter")
    await desk.wait(4000)
    assert desk.talk.lcd()[0].startswith("S: 12.5")
    await desk.type("equals_sign", *"1-2", "enter")
    assert desk.shows("1-2 is no setpoint, such as 12.5 or -30")


@in_window(size=(100, 40))
async def test_help_shows_what_the_manual_says(desk):
    await desk.type("question_mark")
    assert desk.shows("taps the key beside the letter") and desk.shows("q, :quit, Ctrl-C")
    await desk.type("question_mark")
    assert desk.shows("telegrams:") and not desk.shows("q, :quit, Ctrl-C")
    await desk.command("help")
    await desk.type("colon", *map(name, "help"), "enter")
    for usage in desk.app.told.hello["commands"].values():
        assert usage.split()[0] in " ".join(desk.lines()), usage


@in_window()
async def test_leaving_is_told_apart(desk):
    await desk.type("q")
    assert desk.app.way_out == "quit"


@in_window()
async def test_ctrl_c_leaves_from_a_command_line_too(desk):
    await desk.type("colon", "p", "ctrl+c")
    assert desk.app.way_out == "interrupt"


# --- what is shown ------------------------------------------------------------------------------


@in_window(addresses=tuple(range(1, 13)))
async def test_of_many_drives_those_that_run_and_the_selected_one_come_first(desk):
    await desk.type("z", "z")
    await desk.wait(4000)
    await desk.type("s")  # the one before the last runs,
    await desk.wait(4000)
    await desk.type("a")  # the last is shown
    await desk.wait(500)
    first = [line for line in desk.lines() if " Hz " in line][:2]
    assert first[0].startswith(" A11 ") and first[1].startswith("*A12 "), first
    assert desk.shows("12 drives")


@in_window()
async def test_counters_tell_silence(desk):
    await desk.command("unplug 1")
    await desk.wait(3000)
    assert desk.shows("exchanges: good") and desk.shows("silent") and desk.shows("(by A1)")
    assert desk.shows("unplugged")


@in_window(size=(120, 40))
async def test_repeats_of_a_telegram_are_counted(desk):
    await desk.wait(5000)
    rows = [line for line in desk.lines() if line[13:14] in ("<", ">") and line[13:14]]
    assert 4 < len(rows) < 60 and any("x " in row[15:19] for row in rows), rows
    assert len({row[22:] for row in rows}) == len(rows)


@in_window(keys="compact")
async def test_a_panel_of_eight_keys_has_eight_letters(desk):
    legend = " ".join(desk.lines()[:8])
    for cell in ("s START", "t STOP", "r REVERSE", "j JOG", "u UP", "d DOWN", "p P", "f FN"):
        assert cell in legend, legend
    assert "PARAM" not in legend and "EDIT" not in legend
    await desk.type("f", "f", "p")
    await desk.wait(1000)
    assert desk.talk.lcd()[1].startswith("NEW"), desk.talk.lcd()
    await desk.type("right")
    assert desk.shows("does nothing here")
