# SPDX-License-Identifier: MIT
"""./tools/panel in a terminal: a person types, looks at the screen, leaves; nothing stays behind.

The terminal is a real one (a pty); what is written to it is shown on a screen of 24 x 80, so that
the tests read what a person would. They wait for what they expect, and give up after a while.
"""

import os
import signal
import sys
import time

import pytest

from terminal_bench import PANEL, PATIENCE_S, Screen, Terminal, terminals
from tiers import TOP

INTERPRETERS = "host"

MICROPYTHON = os.path.join(TOP, "build", "unix64", "micropython")

PYTHON = os.path.join(TOP, "build", "textual", "bin", "python")
WINDOW = os.path.join(TOP, "tools", "terminal")

# With its supervision set, START does not ask first.
SUPERVISED = "param 1 P2014[0] 1000"

terminal = pytest.fixture(terminals)


def test_s_starts_the_drive_and_space_stops_it(terminal):
    panel = terminal("--speed", "5")
    panel.shows("READY        A1")
    assert panel.screen.second and not panel.screen.cursor
    panel.commands(SUPERVISED)
    panel.shows("P2014[0]=1000")
    panel.back_to_the_keys()
    panel.type("s")
    panel.shows("RUNNING      A1")
    panel.shows("10.00 Hz right")
    panel.shows("A  running")
    panel.type(" ")
    panel.shows("A  ready")
    panel.type("q")
    assert panel.ends() == 0 and panel.is_as_before()
    assert "USS panel: ended after 0:00:" in panel.screen.text()


def test_the_display_has_a_frame(terminal):
    panel = terminal()
    panel.shows("\u2502READY        A1 \u2502")
    lines = panel.screen.lines()
    assert lines[1].startswith(" \u250c" + 16 * "\u2500" + "\u2510")
    assert lines[4].startswith(" \u2514" + 16 * "\u2500" + "\u2518")


def test_without_utf_8_all_is_ascii(terminal):
    panel = terminal(LC_ALL="C")
    panel.shows("|READY        A1 |")
    assert panel.screen.text().isascii() and "+----------------+" in panel.screen.text()


def test_a_capital_holds_a_jog_and_lets_go_of_it(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.type("J")
    panel.shows("j JOG_LEFT     HELD")
    panel.shows_no_more("HELD")


@pytest.mark.parametrize("pieces", [("\x1b ",), ("\x1b", " "), ("\x1b[", " ")])
def test_space_right_after_esc_stops_the_drive(terminal, pieces):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("s")
    panel.shows("RUNNING      A1")
    for piece in pieces:
        panel.type(piece)
    panel.shows("READY        A1")


def test_stop_and_ctrl_c_do_not_wait_for_a_command(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("s")
    panel.shows("RUNNING      A1")
    panel.commands("wait 600000")
    panel.shows("waiting, 59")
    panel.type(" ")
    panel.shows("ended early: wait 600000")
    panel.shows("READY        A1")
    panel.commands("hang 600000")
    panel.shows("waiting, 5")
    panel.type("\x03")
    assert panel.ends() == 130 and panel.is_as_before()


def test_help_and_quit_may_be_typed_after_a_colon(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.commands("help")
    panel.shows("fault A F0001 [lasting]")
    panel.commands("quit")
    assert panel.ends() == 0 and panel.is_as_before()


@pytest.mark.parametrize("discipline", ["0", "5"])
@pytest.mark.parametrize("ending", ["q", "\x03", signal.SIGKILL])
def test_the_line_discipline_stays_as_it_was(terminal, discipline, ending):
    panel = terminal(discipline=discipline)
    panel.shows("READY")
    assert "line = %s;" % discipline in panel.before[0]
    if ending == signal.SIGKILL:
        os.kill(panel.program(), ending)
    else:
        panel.type(ending)
    panel.ends()
    assert panel.is_as_before()


def test_a_held_key_is_let_go_by_esc(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.type("T")
    panel.shows("t STOP         HELD")
    panel.type("\x1b")
    panel.shows_no_more("HELD")


def test_arrows_move_the_setpoint(terminal):
    panel = terminal("--speed", "5")
    panel.shows("READY")
    panel.type("\x1b[A\x1b[A")
    panel.shows("S: 10.2")
    panel.type("\x1bOB")
    panel.shows("S: 10.1")


def test_commands_of_the_script_language_work_after_a_colon(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.commands("unplug 1")
    panel.shows("done: unplug 1")
    panel.shows("NO CONTACT")
    panel.commands("jump")
    panel.shows("unknown command jump")
    panel.commands("plug 1", "off 1")
    panel.shows("A  off")
    panel.commands("on 1", "switch 1 boot_ms")
    panel.shows("boot_ms=300")
    panel.shows("READY        A1")


@pytest.mark.parametrize("text", ["\x1b[200~test results\x1b[201~", "speed, and a lot of it\n"])
def test_words_that_are_pasted_or_typed_after_a_command_start_no_motor(terminal, text):
    panel = terminal()
    panel.shows("READY        A1")
    panel.commands(SUPERVISED, "jump")
    panel.shows("unknown command jump")
    for letter in "speed":
        panel.type(letter)
        time.sleep(0.05)
    panel.shows(" :speed")
    panel.type("\x1b")
    panel.shows_no_more(" :speed")
    panel.type(text)
    panel.shows("as a paste does")
    time.sleep(0.2)  # what comes right behind a paste is a part of it
    panel.commands("wait 500", "drive 1")
    panel.shows("state=ready")
    panel.shows("starts=0")


def test_what_is_still_written_for_the_larger_terminal_is_cut_off():
    screen = Screen(24, 18, before=Screen(24, 80))
    screen.write(b"\x1b[?1049h\x1b[5;20Hx\x1b[5;18Hy")
    assert screen.lines()[4] == 17 * " " + "y"


def test_start_in_a_terminal_that_hides_the_display_is_refused(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.resize(24, 18)
    panel.type("s")
    panel.shows("no START while")
    panel.resize(24, 80)
    panel.shows("READY        A1")
    panel.commands("drive 1")
    panel.shows("starts=0")


def test_speed_lets_time_pass_faster(terminal):
    panel = terminal("--speed", "10")
    began = time.monotonic()
    panel.shows("time 0:00:3")
    assert time.monotonic() - began < 25
    panel.waits(lambda: speed_shown(panel) > 1.5, "a speed of more than 1.5")


def speed_shown(panel):
    return float(panel.screen.lines()[0].split("speed x")[1])


def test_ctrl_c_leaves_the_terminal_as_it_was(terminal):
    panel = terminal()
    panel.shows("READY")
    assert panel.settings() != panel.before
    panel.type("\x03")
    assert panel.ends() == 130 and panel.is_as_before()
    assert "ended by Ctrl-C" in panel.screen.text()
    assert "Traceback" not in panel.screen.text()


def test_an_interrupt_from_outside_does_so_too(terminal):
    panel = terminal()
    panel.shows("READY")
    os.killpg(panel.process.pid, signal.SIGINT)
    assert panel.ends() == 130 and panel.is_as_before()
    assert "Traceback" not in panel.screen.text()


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_a_program_that_is_killed_leaves_the_terminal_as_it_was(terminal, how):
    panel = terminal()
    panel.shows("READY")
    os.kill(panel.program(), how)
    assert panel.ends() == 128 + how and panel.is_as_before()
    assert "panel: ended by signal %d" % how in panel.screen.text()


def test_who_is_asked_to_end_ends_its_program(terminal):
    panel = terminal()
    panel.shows("READY")
    program = panel.program()
    panel.process.terminate()
    assert panel.ends() == 128 + signal.SIGTERM and panel.is_as_before()
    assert not os.path.exists("/proc/%d" % program)


@pytest.mark.parametrize("has_frozen", [False, True])
def test_a_terminal_that_is_closed_ends_it(has_frozen):
    panel = Terminal()
    panel.shows("READY")
    program = panel.program()
    if has_frozen:  # it takes nothing any more, and what is still to be written waits
        panel.freeze()
    os.close(panel.slave)
    os.close(panel.master)
    panel.process.wait(PATIENCE_S)
    assert not os.path.exists("/proc/%d" % program)


# The panel with a firmware that fails: nothing that a person can type does that.
FAILING = """
import main
from boards.sim.world import World
from tools.live.lines import speak

world = World(main.start)
world.run(1000)
step = world.app.step
down = world.down

def fail():
    step()
    raise RuntimeError("on purpose")

def press(key):
    down(key)
    world.app.step = fail

world.down = press
speak(world, 1)
"""


def test_an_exception_is_shown_on_a_terminal_as_it_was(terminal):
    panel = terminal()  # which fetches what a picture needs
    panel.shows("READY")
    panel.type("q")
    assert panel.ends() == 0
    panel = terminal(
        program=[PYTHON, "-B", WINDOW, MICROPYTHON, "-X", "heapsize=16M", "-c", FAILING],
        MICROPYPATH="%s:%s/firmware:.frozen" % (TOP, TOP),
    )
    panel.shows("READY")
    panel.type("s")
    assert panel.ends() == 1 and panel.is_as_before()
    assert "RuntimeError: on purpose" in panel.screen.text()


def test_a_wrong_command_line_is_said_in_a_terminal_too(terminal):
    panel = terminal("--speed", "0")
    assert panel.ends() == 2 and panel.is_as_before()
    assert "--speed 0: time passes 1...100 times as fast" in panel.screen.text()


def test_a_script_works_in_a_terminal_too(terminal, tmp_path):
    script = tmp_path / "ready.txt"
    script.write_text("wait 1000\nexpect READY\nlcd\n")
    panel = terminal("--script", str(script))
    assert panel.ends() == 0 and panel.is_as_before()
    assert "|READY        A1 |" in panel.screen.text()


def test_a_small_terminal_shows_what_fits_and_says_so(terminal):
    panel = terminal(rows=12, columns=60)
    panel.shows("q quits. 60 x 12 is too small: the panel needs 79 x 24")
    panel.shows("READY        A1")
    panel.resize(24, 80)
    panel.shows("telegrams:")
    panel.shows("READY        A1")
    panel.shows_no_more("too small")


def test_a_terminal_that_was_smaller_for_a_moment_is_drawn_again(terminal):
    panel = terminal()
    panel.shows("time 0:00:02")  # what a start draws more than once has been drawn
    panel.resize(24, 18)
    panel.resize(24, 80)  # at once: the panel may see nothing of the other size
    panel.shows("space: STOP")
    panel.shows("READY        A1")


# As `perf record` starts its program.
DEAF = """
import os, signal, sys
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGWINCH])
os.execv(sys.argv[1], sys.argv[1:])
"""


def test_a_new_size_is_heard_of_though_its_signal_was_blocked(terminal):
    panel = terminal(rows=12, columns=60, program=[sys.executable, "-c", DEAF, PANEL])
    panel.shows("READY        A1")
    panel.resize(24, 80)
    panel.shows("space: STOP")


@pytest.mark.parametrize("columns", [79, 80, 200])
def test_no_column_is_lost(terminal, columns):
    whole = " small: tap  CAPITAL: hold  Esc: let go  space: STOP  :command  ? help  q: quit"
    panel = terminal(columns=columns)
    panel.shows("telegrams:")
    panel.waits(lambda: panel.screen.lines()[6] == whole, whole)


def test_a_large_terminal_is_used_to_its_last_row(terminal):
    panel = terminal(rows=60, columns=132)
    panel.shows("telegrams:")
    panel.waits(lambda: sum(" > " in line for line in panel.screen.lines()) > 18, "36 telegrams")


def test_settings_that_name_other_drives_are_pointed_out(terminal, tmp_path):
    kept = tmp_path / "settings.json"
    kept.write_text('{"drives": [5, 6]}')
    panel = terminal("--settings", str(kept), "--drives", "1,2")
    panel.says("the panel looks for drives 5,6; there are 1,2")
    panel.shows("NO CONTACT   A5")
    panel.type("q")
    assert panel.ends() == 0 and panel.is_as_before()


def test_many_drives_fit_the_screen(terminal):
    panel = terminal("--drives", ",".join(str(address) for address in range(31)))
    panel.shows("31 drives")
    panel.shows("*A0 ")
    last = "\n A30 "  # in the list; a telegram's row begins with its time
    assert last not in panel.screen.text()
    row, column = panel.screen.place(" A1 ")
    for _ in range(12):
        panel.type("\x1b[<65;%d;%dM" % (column, row))
    panel.shows(last)
    panel.type("q")
    assert panel.ends() == 0 and panel.is_as_before()


# --- the mouse ----------------------------------------------------------------------------------


def test_the_mouse_holds_a_jog_as_long_as_its_button_is_down(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    place = panel.screen.place("j JOG_LEFT")
    panel.mouse(place, True)
    panel.shows("j JOG_LEFT     HELD")
    panel.shows("JOG LEFT     A1")
    panel.waits(lambda: "5.00 Hz left" in panel.screen.text(), "the jog frequency")
    time.sleep(1)  # much longer than a keyboard may be silent
    panel.mouse((20, 70), False)  # wherever it comes up
    panel.shows_no_more("HELD")
    panel.shows("READY        A1")


def test_a_jog_under_the_mouse_ends_when_the_terminal_answers_no_more(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.mouse(panel.screen.place("l JOG_RIGHT"), True)
    panel.shows("JOG RIGHT    A1")
    panel.is_dead = True
    panel.shows_no_more("JOG RIGHT")
    panel.shows("READY        A1")


def test_a_motor_stops_when_the_terminal_answers_no_more(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("s")
    panel.shows("RUNNING      A1")
    panel.is_dead = True
    panel.says("nobody was heard at the panel for 2 s: every drive was sent OFF1")
    panel.is_dead = False
    panel.shows("READY        A1")
    panel.commands("drive 1")
    panel.shows("starts=1")


def test_a_terminal_that_takes_no_more_output_holds_no_key(terminal):
    """Its connection has frozen: nothing is read, nothing is answered."""
    panel = terminal("--drives", "1,2,3")
    panel.shows("READY        A1")
    panel.mouse(panel.screen.place("l JOG_RIGHT"), True)
    panel.shows("JOG RIGHT    A1")
    time.sleep(6)  # nobody reads: the picture is stuck, and so is the program behind it
    panel.commands("drive 1")
    panel.shows("hz=0.00")


# --- more than keys -----------------------------------------------------------------------------


def test_a_setpoint_is_typed_and_takes_effect(terminal):
    panel = terminal("--speed", "5")
    panel.shows("READY        A1")
    for letter in "=-17.5x":  # no letter is part of it
        panel.type(letter)
        time.sleep(0.1)
    panel.shows(" =-17.5")
    panel.type("\r")
    panel.shows("S:-17.5")
    panel.type("s")
    panel.shows("17.50 Hz left")


def test_space_is_stop_while_a_setpoint_is_typed(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("s")
    panel.shows("RUNNING      A1")
    panel.type("=")
    time.sleep(0.1)
    panel.type(" ")
    panel.shows("READY        A1")


def test_help_is_there_and_the_display_stays_in_sight(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("?")
    panel.shows("taps the key beside the letter")
    panel.type("s")
    panel.shows("RUNNING      A1")
    panel.type("\x1b")
    panel.shows("telegrams:")
    for word, meaning in (
        ("help unplug", "pull and push its RS-485 connector"),
        ("help REVERSE", "changes the direction; left is negative on the display"),
        ("help NOT STARTED", "it did not run within 5 s after START"),
        ("help xyzzy", "nothing is called xyzzy"),
    ):
        panel.commands(word)
        panel.says(meaning)


def test_telegrams_stand_still_while_they_are_paused(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("v")
    panel.shows("PAUSED, v goes on")
    before = telegrams_of(panel)
    panel.type("s")
    panel.shows("RUNNING      A1")
    assert telegrams_of(panel) == before
    panel.type("v")
    panel.waits(lambda: any("047F" in line for line in telegrams_of(panel)), "the ON")
    panel.type("x")
    panel.waits(lambda: any(" 02 0E 01 " in line for line in telegrams_of(panel)), "hex")


def telegrams_of(panel):
    return [line for line in panel.screen.lines() if line[13:14] in ("<", ">") and line[13:14]]


def test_standard_error_may_go_elsewhere(terminal, tmp_path):
    said = tmp_path / "said"
    panel = terminal(program=["bash", "-c", 'exec "$0" 2>"$1"', PANEL, str(said)])
    panel.shows("READY        A1")
    panel.type("\x03")
    assert panel.ends() == 130 and panel.is_as_before()
    assert said.read_text() == "panel: ended by Ctrl-C\n"


def test_ctrl_z_does_nothing(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("\x1a")
    os.kill(panel.process.pid, signal.SIGTSTP)
    time.sleep(0.2)
    panel.type("s")
    panel.shows("RUNNING      A1")
