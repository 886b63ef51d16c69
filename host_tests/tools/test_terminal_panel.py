# SPDX-License-Identifier: MIT
"""The live panel without its terminal: what is typed, how the hand presses it, what is shown.

The terminal itself is in test_terminal.py.
"""

import main
from boards.sim.script import ORDER
from boards.sim.world import World
from tools.live.hand import FIRST_REPEAT_MS, REPEAT_MS, WAITING_MAX, Hand
from tools.live.pace import WORK_MS, Pace, RealPace
from tools.live.picture import (
    COLUMNS,
    ROWS,
    SAID_ROWS,
    SHAFT,
    Picture,
    fitted,
    folded,
    seen,
    shows_display,
    telegram_line,
)
from tools.live.terminal import ESCAPE, OTHER, Strokes
from tools.live.terminal_panel import (
    Session,
    farewell,
    shows_boxes,
    turning,
)

FRAME_MS = 20


class Time:
    """Real time that passes when the test says so."""

    def __init__(self):
        self.us = 0x3FFF0000  # soon it wraps

    def ticks_us(self):
        return self.us & 0x3FFFFFFF

    def ticks_diff(self, later, earlier):
        return (later - earlier) & 0x3FFFFFFF


class Seat:
    """A person before the live panel of a world."""

    def __init__(self, speed=1, boxes=True, **options):
        self.world = World(main.start, **options)
        for drive in self.world.drives.values():
            drive.write(2014, 0, 1000)  # supervised: START does not ask
        self.session = Session(self.world, boxes)
        self.time = Time()
        self.pace = Pace(self.world.clock, self.session, speed, self.time)
        self.wait(1000)

    def wait(self, ms):
        """Let so much of the world's time pass, frame by frame."""
        until_us = self.world.clock.now_us + ms * 1000
        while self.world.clock.now_us < until_us:
            self.frame()

    def frame(self):
        self.time.us += FRAME_MS * 1000
        self.pace.follow()

    def type(self, *strokes):
        for stroke in strokes:
            self.session.take(stroke, self.pace.now_ms)

    def command(self, text):
        """Typed after `:`, and back to the keys."""
        self.type(":", *text)
        self.type("\r")
        if not self.session.errand:
            said = self.session.said
            self.type(ESCAPE)
            self.session.said = said

    def screen(self):
        return [seen(line) for line in self.session.lines(self.pace.now_ms, self.pace.speed)]

    def shows(self, text):
        return any(text in line for line in self.screen())

    def state(self, address=1):
        return self.world.drives[address].state


class Clock:
    now_us = 0


class Keys:
    """A world of nothing but keys: what was done to them is a list."""

    port = None

    def __init__(self):
        self.clock = Clock()
        self.done = []
        self.hand = Hand(self)

    def down(self, key):
        self.done.append("%s down" % key)

    def up(self, key):
        self.done.append("%s up" % key)

    def run(self, ms, now_ms=0):
        for _ in range(ms):
            self.clock.now_us += 1000
            self.hand.step(now_ms)


# --- what a terminal sends ----------------------------------------------------------------------


def strokes(*pieces):
    """The strokes of bytes that come in pieces, 20 ms apart; an empty piece is a silent frame."""
    decoder = Strokes()
    found = []
    for index, piece in enumerate(pieces):
        found += decoder.take(piece, 20 * index)
    return found


def test_letters_are_themselves_and_arrows_have_names():
    assert strokes(b"sT \x03") == ["s", "T", " ", "\x03"]
    assert strokes(b"\x1b[A\x1b[B\x1b[C\x1b[D") == ["UP", "DOWN", "RIGHT", "LEFT"]
    assert strokes(b"\x1bOA\x1bOD") == ["UP", "LEFT"]


def test_an_arrow_that_comes_in_pieces_is_an_arrow():
    assert strokes(b"\x1b", b"[", b"A", b"s") == ["UP", "s"]


def test_esc_is_known_by_the_silence_after_it():
    assert strokes(b"\x1b", b"", b"") == []
    assert strokes(b"\x1b", b"", b"", b"") == [ESCAPE]
    assert strokes(b"\x1b\x1b[A") == [ESCAPE, "UP"]


def test_no_other_key_is_taken_for_a_letter():
    for sequence in (b"\x1b[[A", b"\x1b[5~", b"\x1b[15;2~", b"\x1bOP", b"\x1b[1;5A"):
        assert strokes(sequence) == [OTHER], sequence
    assert strokes("ä€".encode()) == [OTHER, OTHER]
    assert strokes(b"\x1b[" + b"1" * 40)[0] == OTHER


def test_stop_and_ctrl_c_are_heard_right_after_esc_and_inside_any_sequence():
    for stroke in (" ", "\x03", "\r", "\x7f"):
        typed = stroke.encode()
        assert strokes(b"\x1b" + typed) == [ESCAPE, stroke]
        assert strokes(b"\x1b", typed) == [ESCAPE, stroke]
        for begun in (b"\x1b[", b"\x1bO", b"\x1b[1", b"\x1b[1;5", b"\x1b[["):
            assert strokes(begun + typed) == [OTHER, stroke], begun
            assert strokes(begun, typed, b"\x1b[A") == [OTHER, stroke, "UP"], begun


def test_a_letter_right_after_esc_is_a_stroke_of_its_own():
    assert strokes(b"\x1bs") == [ESCAPE, "s"]
    assert strokes(b"\x1bq") == [ESCAPE, "q"]
    assert strokes("\x1bä".encode()) == [ESCAPE, OTHER]
    assert strokes(b"\x1b[\x1b[B") == [OTHER, "DOWN"]


# --- the hand -----------------------------------------------------------------------------------


def test_a_tap_is_down_for_100_ms_and_up_for_40_before_the_next_one():
    keys = Keys()
    keys.hand.tap("UP")
    keys.hand.tap("DOWN")
    keys.run(1)
    assert keys.done == ["UP down"]
    keys.run(100)
    assert keys.done == ["UP down", "UP up"]
    keys.run(38)
    assert len(keys.done) == 2
    keys.run(2)
    assert keys.done[2:] == ["DOWN down"]


def test_taps_that_are_typed_too_fast_are_left_out():
    keys = Keys()
    assert all(keys.hand.tap("UP") for _ in range(WAITING_MAX))
    assert not keys.hand.tap("UP")
    keys.run(5000)
    assert keys.done.count("UP down") == keys.done.count("UP up") == WAITING_MAX


def test_stop_goes_ahead_of_everything_and_empties_the_queue():
    keys = Keys()
    for key in ("START", "UP", "UP"):
        keys.hand.tap(key)
    keys.run(10)
    keys.hand.tap("STOP")
    assert keys.done == ["START down", "STOP down", "START up"]
    keys.run(1000)
    assert keys.done[3:] == ["STOP up"]


def test_stop_is_pressed_at_once_while_another_key_is_held():
    keys = Keys()
    keys.hand.hold("JOG_RIGHT", 0)
    keys.run(10)
    keys.hand.tap("STOP")
    assert keys.done == ["JOG_RIGHT down", "STOP down", "JOG_RIGHT up"]
    assert keys.hand.key == "STOP" and not keys.hand.held


def test_each_stop_is_a_press_of_its_own():
    keys = Keys()
    keys.hand.hold("STOP", 0)
    keys.run(5000)
    assert keys.done == ["STOP down"] and keys.hand.held
    keys.hand.tap("STOP")
    keys.run(200)
    assert keys.done == ["STOP down", "STOP up", "STOP down", "STOP up"]


def test_a_stop_that_a_command_put_down_does_not_swallow_the_next_one():
    keys = Keys()
    keys.hand.hold("UP", 0)
    keys.run(10)
    keys.down("STOP")
    keys.hand.fix("STOP", True)
    keys.hand.tap("STOP")
    assert keys.done == ["UP down", "STOP down", "UP up", "STOP up"]
    keys.run(200)
    assert keys.done[4:] == ["STOP down", "STOP up"] and not keys.hand.fixed


def test_a_capital_holds_until_another_key():
    keys = Keys()
    keys.hand.hold("UP", 0)
    keys.run(3000, now_ms=60_000)
    assert keys.done == ["UP down"] and keys.hand.held
    keys.hand.hold("UP", 0)  # again: nothing new
    keys.hand.tap("NEXT")
    keys.run(500)
    assert keys.done == ["UP down", "UP up", "NEXT down", "NEXT up"]


def test_a_hold_that_waits_does_not_outlast_the_tap_after_it():
    keys = Keys()
    for key in ("UP", "DOWN"):
        keys.hand.hold(key, 0)
    keys.hand.tap("NEXT")
    keys.run(1000)
    assert keys.done[-2:] == ["NEXT down", "NEXT up"]
    for key in ("UP", "DOWN"):
        assert keys.done.count(key + " down") == keys.done.count(key + " up")


def test_a_jog_lets_go_when_the_keyboard_does_not_repeat_it():
    for key in ("JOG_RIGHT", "JOG_LEFT"):
        keys = Keys()
        keys.hand.hold(key, 0)
        keys.run(10, FIRST_REPEAT_MS - 1)  # it waits before it repeats
        for now_ms in range(FIRST_REPEAT_MS, 3000, 250):
            keys.hand.hold(key, now_ms)
            keys.run(10, now_ms)
        keys.run(10, now_ms + REPEAT_MS - 1)
        assert keys.done == [key + " down"]
        keys.run(1, now_ms + REPEAT_MS)
        assert keys.done == [key + " down", key + " up"]
        keys = Keys()
        keys.hand.hold(key, 0)
        keys.run(10, FIRST_REPEAT_MS)
        assert keys.done == [key + " down", key + " up"]


def test_on_a_real_line_every_key_but_stop_has_to_be_repeated():
    held = ((None, "UP", True), ("a port", "UP", False), ("a port", "STOP", True))
    for port, key, stays in held:
        keys = Keys()
        keys.port = port
        keys.hand.hold(key, 0)
        keys.run(10, FIRST_REPEAT_MS - 1)
        assert keys.done == [key + " down"]
        keys.run(10, 60_000)
        assert (keys.done == [key + " down"]) == stays, (port, key)


def test_esc_lets_go():
    keys = Keys()
    keys.hand.hold("STOP", 0)
    keys.hand.let_go()
    assert keys.done == ["STOP down", "STOP up"] and keys.hand.key is None


# --- time ---------------------------------------------------------------------------------------


def test_a_tap_is_seen_at_every_speed():
    for speed in (1, 10, 100):
        seat = Seat(speed)
        seat.type("s")
        seat.wait(2000)
        assert seat.state() == "running", speed
        seat.type(" ")
        seat.wait(8000)
        assert seat.state() == "ready", speed


class Machine(Keys):
    """A world of keys on a machine that takes so much real time for a millisecond of it."""

    def __init__(self, time, ms_us):
        super().__init__()
        self.clock = Clock()
        self.time = time
        self.ms_us = ms_us

    def run(self, ms):
        self.clock.now_us += ms * 1000
        self.time.us += ms * self.ms_us


def test_the_world_follows_real_time():
    for speed in (1, 7, 100):
        time = Time()
        world = Machine(time, 5)
        pace = Pace(world.clock, world, speed, time)
        for _ in range(150):
            time.us += FRAME_MS * 1000
            pace.follow()
        passed_us = time.us - Time().us
        assert abs(world.clock.now_us - passed_us * speed) <= 40_000 * speed, speed
        assert abs(pace.speed - speed) < 0.05 * speed and not pace.late
        assert 0 <= passed_us - pace.now_ms * 1000 < 30_000


def test_a_machine_that_is_too_slow_falls_behind_and_says_so():
    time = Time()
    world = Machine(time, 5_000)
    pace = Pace(world.clock, world, 1, time)
    for _ in range(100):
        before_us = time.us
        pace.follow()
        assert time.us - before_us <= 2 * WORK_MS * 1000  # the keys are looked at again
        time.us += 1000
    assert pace.late and 0.1 < pace.speed < 0.25


# --- a person at the panel ----------------------------------------------------------------------


def test_s_starts_and_space_stops():
    seat = Seat()
    seat.type("s")
    seat.wait(4000)
    assert seat.shows("|RUNNING      A1 |".replace("|", "\u2502"))
    assert seat.shows(" 10.00 Hz right  running")
    seat.type(" ")
    seat.wait(500)
    assert seat.state() == "stopping"


def test_arrows_move_the_setpoint():
    seat = Seat()
    seat.type("UP", "UP", "DOWN", "UP")
    seat.wait(1000)
    assert seat.world.lcd()[0].startswith("S: 10.2")


def test_the_legend_marks_the_key_that_is_down():
    seat = Seat()
    assert seat.shows("u UP") and not seat.shows("HELD")
    seat.type("u")
    seat.wait(50)
    assert seat.shows("u UP           down")
    seat.wait(500)
    seat.type("T")
    seat.wait(500)
    assert seat.shows("t STOP         HELD") and not seat.shows("down")


def test_a_key_that_means_nothing_gets_a_hint_and_does_nothing():
    seat = Seat()
    seat.type("T")
    seat.wait(100)
    for stroke in ("x", "!", OTHER, "\x01"):
        seat.type(stroke)
        assert seat.shows("does nothing here"), stroke
    assert seat.shows("HELD")
    seat.type("u")
    assert not seat.shows("does nothing here")


def test_q_leaves_and_so_does_the_end_of_input():
    for stroke in ("q", "\x04"):
        seat = Seat()
        assert not seat.session.left
        seat.type(stroke)
        assert seat.session.left


def test_ctrl_c_interrupts_in_the_middle_of_a_command_too():
    seat = Seat()
    for typed in ("", ":press"):
        seat.type(*typed)
        try:
            seat.type("\x03")
        except KeyboardInterrupt:
            continue
        raise AssertionError(typed)


def test_a_command_is_typed_after_a_colon():
    seat = Seat()
    seat.type(*":unplux")
    assert seat.shows(":unplux_")
    seat.type("\x7f", *"g 1")
    assert seat.shows(":unplug 1_") and seat.world.drives[1].plugged
    seat.type("\r")
    assert seat.shows("done: unplug 1") and seat.shows("unplugged")
    seat.type(ESCAPE)
    seat.command("fault 1 F0001")
    assert seat.shows("F0001") and seat.shows("fault")
    seat.command("param 1 P2014[0]")
    assert seat.shows("P2014[0]=1000")


def test_esc_or_an_empty_line_closes_the_command():
    for stroke in (ESCAPE, "\r"):
        seat = Seat()
        seat.type(":", stroke)
        assert seat.session.command is None and not seat.session.said


def test_a_command_line_stays_open_so_that_no_word_is_taken_for_keys():
    """`speed` after a command would tap START, ADDRESS_DOWN and others."""
    seat = Seat()
    for command in (":load 1 50", "jump", "speed", "param 1 P1082[0]", "wait 10"):
        seat.type(*command)
        seat.type("\r")
        seat.wait(300)
        assert seat.session.command == "" and seat.session.hand.key is None, command
    seat.type(*"speed")
    assert seat.shows(":speed_")
    seat.wait(3000)
    assert seat.state() == "ready" and seat.world.drives[1].starts == 0
    seat.type(" ", " ")
    assert seat.session.hand.key == "STOP"  # and no word after it is keys either
    seat.wait(500)
    seat.type(*"speed\r")
    seat.wait(3000)
    assert seat.world.drives[1].starts == 0
    seat.type("\r", "s")
    seat.wait(3000)
    assert seat.world.drives[1].starts == 1


def test_of_two_spaces_in_a_command_the_second_is_stop():
    seat = Seat()
    for typed in (":wait", ""):
        seat.type(*typed)
        seat.type(" ")
        if typed:
            assert seat.session.command == "wait " and seat.session.hand.key is None
            seat.type(" ")
        assert seat.session.command == "" and seat.session.hand.key == "STOP"
        seat.wait(200)


def pasted(seat, *pieces):
    """What the panel takes when these bytes come, 20 ms apart."""
    decoder = Strokes()
    for piece in pieces:
        taken = decoder.take(piece, seat.pace.now_ms)
        if decoder.pasted:
            seat.session.take_paste(taken, decoder.brackets, seat.pace.now_ms)
        else:
            seat.type(*taken)
        seat.frame()


def test_a_paste_is_no_keys():
    text = b"test results: all is well, says the log\r\n"
    for pieces in (
        (b"\x1b[200~" + text + b"\x1b[201~",),
        (b"\x1b[20", b"0~s", b"", b"s", b"l", b"s\x1b[201~"),
        (b"\x1b[200~s",) + 60 * (b"",) + (b"\x1b[200~l\x1b[201~",),
        (text,),
        (b"sd", b"s", b"s"),  # the rest of it comes later
        (b"Sr", b"L", b"", b"J"),
        (b"s\x1b[A",),
        (b"\x1b[As",),
    ):
        seat = Seat()
        pasted(seat, *pieces)
        assert seat.shows("as a paste does"), pieces
        seat.wait(3000)
        assert seat.world.drives[1].starts == 0 and seat.world.lcd()[0][2:7] == " 10.0", pieces
        pasted(seat, b"s")
        seat.wait(3000)
        assert seat.world.drives[1].starts == 1, pieces


def test_stop_in_a_paste_is_stop():
    for piece in (b"\x1b[200~no words\x1b[201~", b"no words", b"u ", b"\x1b ", b"ut"):
        seat = running()
        pasted(seat, piece)
        seat.wait(400)
        assert seat.state() == "stopping", piece
        seat = running()
        seat.type(*":wait 60000\r")
        pasted(seat, piece)
        seat.wait(400)
        assert seat.state() == "stopping" and not seat.session.errand, piece


def test_a_command_line_takes_a_paste_as_text_and_never_its_enter():
    seat = Seat()
    pasted(seat, b":", b"press START\r")
    seat.wait(2000)
    assert seat.shows(":press START_") and seat.world.drives[1].starts == 0
    pasted(seat, b"", b"\r")
    seat.wait(2000)
    assert seat.world.drives[1].starts == 1
    pasted(seat, b"\x1b[200~unplug 1\x1b[201~", b"", b"", b"", b"", b"", b"", b"", b"", b"\r")
    assert seat.world.drives[1].plugged and seat.session.command is None


def test_a_key_that_the_keyboard_repeats_is_no_paste():
    seat = Seat()
    pasted(seat, b"uuu", b"uu")
    seat.wait(1000)
    assert seat.world.lcd()[0].startswith("S: 10.5")


def test_start_and_jog_want_the_display_in_sight():
    for rows, columns, whole in ((24, 79, True), (5, 19, True), (4, 19, False), (24, 18, False)):
        assert shows_display(rows, columns) == whole, (rows, columns)
        lines = fitted(Seat().session.lines(0, 1), rows, columns)
        assert (seen("".join(lines[2:4])).count("\u2502") == 4) == whole  # both sides of both rows
    for typed in ("s", "S", "l", "L", "j", "J", ":press START\r", ":hold JOG_LEFT 900\r",
                  ":down JOG_RIGHT\r"):  # fmt: skip
        seat = Seat()
        seat.session.in_sight = False
        seat.type(*typed)
        assert seat.shows("make the terminal larger"), typed
        seat.wait(1500)
        assert seat.world.drives[1].starts == 0, typed
    seat = running()
    seat.session.in_sight = False
    seat.type(" ")
    seat.wait(400)
    assert seat.state() == "stopping"


class OnPort(Seat):
    """The same in front of what counts as a real line."""

    def __init__(self):
        Seat.__init__(self)
        self.world.port = "a port"


def test_on_a_real_line_start_and_jog_are_two_keys():
    for letter in "sSlLjJ":
        seat = OnPort()
        seat.type(letter)
        assert seat.shows("two keys within 2 s"), letter
        seat.type("g")
        seat.wait(2100)
        seat.type(letter)
        seat.type("g", "u", letter)
        seat.wait(1500)
        assert seat.world.drives[1].starts == 0, letter
        seat.type("g", letter)
        seat.wait(1000)
        assert seat.world.drives[1].starts == 1, letter
    seat = OnPort()
    assert seat.shows("gs START") and seat.shows("gl JOG_RIGHT") and seat.shows("t STOP")
    seat.command("press START")  # two words and Enter
    seat.wait(2000)
    assert seat.world.drives[1].starts == 1
    seat.type(" ")
    seat.wait(300)
    assert seat.state() == "stopping"


def test_one_arming_is_one_start():
    seat = OnPort()
    seat.type("g", "s")
    seat.wait(1000)
    seat.type(" ")
    seat.wait(200)
    seat.type("s")
    seat.wait(4000)
    assert seat.world.drives[1].starts == 1 and seat.state() == "ready"


def test_a_jog_that_is_held_is_armed_once():
    seat = OnPort()
    seat.type("g", "L")
    for _ in range(10):
        seat.wait(200)
        seat.type("L")
    assert seat.state() == "running" and not seat.shows("two keys")
    seat.wait(700)
    assert seat.state() != "running"
    seat.type("L")
    seat.wait(700)
    assert seat.world.drives[1].starts == 1 and seat.state() != "running"


def test_a_program_that_stood_still_has_let_go_of_all_keys():
    class Stalling(Keys):
        def run(self, ms):
            self.clock.now_us += ms * 1000

    keys = Stalling()
    keys.hand.hold("JOG_RIGHT", 0)
    keys.down("UP")
    keys.hand.fix("UP", True)
    keys.run(150)
    pace = RealPace(keys.clock, keys)
    pace.follow()
    assert keys.done == ["UP down", "JOG_RIGHT down"]
    keys.clock.now_us += 310_000
    pace.follow()
    assert keys.done[2:] == ["JOG_RIGHT up", "UP up"] and not keys.hand.fixed


def test_what_is_wrong_with_a_command_is_said():
    seat = Seat()
    for command, said in (
        ("jump", "unknown command jump"),
        ("press FIRE", "no key FIRE"),
        ("unplug 7", "no drive at address 7"),
        ("expect RUNNING", "expected RUNNING"),
    ):
        seat.command(command)
        assert seat.shows(said), command
    assert not seat.session.left


def test_a_key_that_a_command_put_down_is_marked():
    seat = Seat()
    seat.command("down UP")
    assert seat.shows("u UP           down")
    seat.command("up UP")
    assert not seat.shows("u UP           down")
    seat.type("T")
    seat.command("press STOP")
    assert not seat.shows("HELD") and seat.shows("t STOP         down")
    seat.wait(200)
    assert not seat.shows("t STOP         down")


def test_a_failed_expectation_shows_both_rows():
    seat = Seat()
    seat.command("expect RUNNING")
    assert seat.shows("expected RUNNING, the display shows")
    assert seat.shows("|S: 10.0 F:  0.00| |READY        A1 |")
    seat.command("expect " + 60 * "X")
    assert seat.shows("|S: 10.0 F:  0.00| |READY        A1 |")


def test_help_lists_the_commands_and_quit_leaves():
    seat = Seat()
    seat.command("help")
    for name in ORDER + ("help", "quit"):
        assert seat.shows(name), name
    assert len(seat.session.said) == SAID_ROWS
    assert all(len(line) <= COLUMNS for line in seat.session.said)
    for command in ("quit", "q", " quit # enough"):
        seat = Seat()
        seat.type(":", *command.strip())
        seat.type("\r")
        assert seat.session.left, command


def test_a_line_that_is_too_long_is_broken_between_words():
    assert folded("the panel looks for drives 5,6; there are 1,2", 20) == [
        "the panel looks for", "drives 5,6; there", "are 1,2",
    ]  # fmt: skip
    assert folded("by /a/path/that/has/no/blank it", 10) == [
        "by", "/a/path/th", "at/has/no/", "blank it",
    ]  # fmt: skip
    assert folded("exactly 10", 10) == ["exactly 10"] and folded("", 10) == [""]


def test_what_the_person_should_know_first_is_said_until_a_stroke():
    session = Session(World(main.start), True, ["the panel looks for drives 5,6"])
    assert session.said == ["the panel looks for drives 5,6"]
    session.take("u", 0)
    assert session.said == []


# --- commands that let time pass ----------------------------------------------------------------


def test_a_command_lets_time_pass_frame_by_frame_and_says_how_long_still():
    seat = Seat()
    before_us = seat.world.clock.now_us
    seat.command("wait 12000")
    assert seat.world.clock.now_us == before_us
    assert seat.shows("waiting, 12 s left") and seat.shows("wait 12000")
    seat.wait(2100)
    assert seat.shows("waiting, 10 s left")
    assert [line for line in seat.screen() if " 0:00:03" in line], "the picture stands"
    seat.wait(9800)
    assert seat.shows("waiting, 1 s left")
    seat.wait(200)
    assert seat.shows("done: wait 12000") and not seat.shows("waiting")


def test_a_command_takes_as_long_as_in_a_script():
    for command, ms in (("press UP", 140), ("hold UP 850", 890), ("wait 333", 333), ("wait 0", 0)):
        seat = Seat()
        began_us = seat.world.clock.now_us
        seat.command(command)
        while seat.session.errand:
            seat.session.run(10)
        passed_us = seat.world.clock.now_us - began_us
        assert ms * 1000 <= passed_us < ms * 1000 + 6_000, (command, passed_us)
        seat.wait(100)
        assert seat.world.lcd()[0].startswith(
            {"press UP": "S: 10.1", "hold UP 850": "S: 10.5"}.get(command, "S: 10.0")
        ), command


def running():
    """A seat before a drive that runs."""
    seat = Seat()
    seat.type("s")
    seat.wait(4000)
    assert seat.state() == "running"
    return seat


def test_stop_ends_every_command_at_once_and_stops():
    for command in ("wait 60000", "hang 60000", "hold UP 60000", "press UP"):
        for stroke in " tT":
            seat = running()
            seat.command(command)
            seat.wait(60)
            assert seat.state() == "running"
            seat.type(stroke)
            assert not seat.shows("waiting")
            seat.wait(400)
            assert seat.state() == "stopping", (command, stroke)
            assert not seat.session.hand.fixed


def test_stop_while_a_command_holds_stop_is_another_stop():
    seat = running()
    seat.command("hold STOP 1000")
    seat.wait(200)
    assert seat.state() == "stopping" and seat.shows("t STOP         down")
    presses = []
    down = seat.world.down
    seat.world.down = lambda key: (presses.append(key), down(key))
    seat.type(" ")
    seat.wait(400)
    assert presses == ["STOP"] and seat.shows("ended early: hold STOP 1000")


def test_esc_ends_a_command_and_lets_go_of_its_key():
    seat = Seat()
    seat.command("hold STOP 60000")
    assert seat.shows("t STOP         down")
    seat.type(ESCAPE)
    assert seat.shows("ended early: hold STOP 60000") and not seat.shows("STOP         down")
    assert seat.session.errand is None and seat.session.command == ""  # another Esc: keys


def test_ctrl_c_and_q_leave_while_a_command_lasts():
    seat = Seat()
    seat.command("wait 60000")
    seat.type("q")
    assert seat.session.left
    try:
        seat.type("\x03")
    except KeyboardInterrupt:
        return
    raise AssertionError("it goes on")


def test_other_keys_have_to_wait_for_the_end_of_a_command():
    seat = Seat()
    seat.command("wait 3000")
    for stroke in ("s", "UP", ":", "x", OTHER):
        seat.type(stroke)
        assert seat.shows("has to wait") and seat.shows("waiting, 3 s left"), stroke
    seat.wait(1000)
    assert seat.state() == "ready" and seat.session.command == ""
    assert seat.world.lcd()[0].startswith("S: 10.0")
    seat.wait(2500)
    seat.type(ESCAPE, "s")
    seat.wait(4000)
    assert seat.state() == "running"


def test_a_panel_that_hangs_for_long_is_restarted_and_works_on_as_in_a_script():
    seat = running()
    seat.command("hang 4000")
    seat.wait(1000)
    assert seat.world.resets == 0
    seat.wait(3000)
    assert seat.world.resets == 1
    seat.wait(3000)
    assert seat.world.resets == 1 and seat.shows("done: hang 4000")


def test_what_the_firmware_raises_during_a_command_goes_through():
    seat = Seat()

    def fail():
        raise KeyError("of the firmware")

    seat.world.app.step = fail
    seat.command("wait 1000")
    try:
        seat.wait(100)
    except KeyError as error:
        assert error.args == ("of the firmware",)
        return
    raise AssertionError("swallowed")


def test_a_broken_rule_of_the_line_is_shown_and_ends_nothing():
    class Noise:
        name = "noise"

        def hear(self, burst):
            pass

    seat = Seat()
    noise = Noise()
    seat.world.wire.attach(noise)
    while not seat.world.wire.violation_count():
        seat.world.wire.talk(noise, b"\x55", 1)
        seat.wait(20)
    seat.wait(1000)
    assert seat.shows("BROKEN: seed 0: at ")
    seat.type("s")
    seat.wait(1000)
    assert len(seat.screen()) == ROWS


def test_the_farewell_names_the_motors_that_turned():
    seat = Seat()
    assert farewell(seat.world, turning(seat.world)).endswith("no motor was turning.")
    seat.type("s")
    seat.wait(4000)
    assert "A1 at 10.00 Hz" in farewell(seat.world, turning(seat.world))


# --- the picture --------------------------------------------------------------------------------


def test_everything_fits_24_rows_of_79_columns():
    for addresses in ((1,), tuple(range(6)), tuple(range(31))):
        seat = Seat(addresses=addresses)
        seat.type(*":" + "x" * 200)
        seat.session.broken = "y" * 300
        lines = seat.screen()
        assert len(lines) == ROWS
        assert max(len(line) for line in lines) <= COLUMNS
        assert sum(" > " in line or " < " in line for line in lines) >= 4
    assert any("+ 26 more" in line for line in lines)


def test_of_many_drives_those_that_run_and_the_selected_one_are_shown():
    seat = Seat(addresses=tuple(range(1, 13)))
    seat.type("z", "z")
    seat.wait(4000)
    seat.type("s")  # the one before the last runs,
    seat.wait(4000)
    seat.type("a")  # the last is shown
    seat.wait(500)
    assert seat.state(11) == "running", seat.world.lcd()
    lines = seat.screen()
    first = [line for line in lines if " Hz " in line][:2]
    assert first[0].startswith(" A11 ") and first[1].startswith("*A12 "), first
    assert any("+ 7 more" in line for line in lines)


def test_a_long_telegram_is_cut():
    line = telegram_line(123_456_789, True, bytes(range(256)))
    assert len(line) <= COLUMNS and line.startswith(" 123456789 > 00 01 ")
    assert line.endswith(" ...")
    assert telegram_line(5, False, b"\x02\x0e") == "         5 < 02 0E"


def test_a_terminal_without_utf_8_gets_ascii():
    class Display:
        """Stands for a world whose display shows its own characters."""

        def __init__(self, world):
            self.world = world

        def __getattr__(self, name):
            return getattr(self.world, name)

        def lcd(self):
            return "\u29d7\u2195\u2192\u2592            ", "READY           "

    seat = Seat(boxes=False)
    picture = Picture(Display(seat.world), seat.session.hand, False)
    lines = [seen(line) for line in picture.lines([], [])]
    assert all(ord(character) < 0x80 for line in lines for character in line)
    assert any(line.startswith(" |X^>?            |") for line in lines), lines
    picture = Picture(Display(seat.world), seat.session.hand, True)
    assert any("\u29d7\u2195" in line for line in picture.lines([], []))


def test_the_environment_tells_what_the_terminal_understands():
    for environment, boxes in (
        ({"LANG": "en_US.UTF-8"}, True),
        ({"LANG": "C.utf8"}, True),
        ({"LANG": "C"}, False),
        ({}, False),
        ({"LC_ALL": "C", "LANG": "en_US.UTF-8"}, False),
        ({"LC_ALL": "", "LC_CTYPE": "de_DE.UTF-8", "LANG": "C"}, True),
    ):
        assert shows_boxes(environment.get) is boxes, environment


def positions(hz, frame_us, frames):
    """The positions of a shaft that turns at this frequency, one for each frame."""

    class OneDrive:
        pass

    OneDrive.hz = lambda: hz
    OneDrive.drives = {1: OneDrive}
    picture = Picture(OneDrive, None, True)
    found = []
    for _ in range(frames):
        picture.turn(frame_us)
        found.append(picture.positions[1])
    return found


def test_the_direction_of_a_shaft_can_be_seen_at_every_frequency_and_speed():
    assert SHAFT == "|/-\\"
    for hz, frame_us in ((0.5, 50_000), (10, 50_000), (50, 50_000), (650, 5_000_000)):
        for direction in (1, -1):
            found = positions(hz * direction, frame_us, 400)
            steps = {after - before for before, after in zip(found, found[1:])}
            assert direction in steps and steps <= {0, direction}, (hz, direction, steps)
    assert set(positions(0, 50_000, 100)) == {0}


def test_a_shaft_turns_as_fast_as_its_motor():
    slow = positions(5, 50_000, 400)[-1]
    assert slow == positions(5, 25_000, 800)[-1]
    assert abs(positions(15, 50_000, 400)[-1] - 3 * slow) <= 3


def test_a_small_terminal_shows_display_and_keys_first_and_says_that_it_is_small():
    seat = Seat()
    lines = seat.screen()
    assert fitted(lines, ROWS, COLUMNS) == lines == fitted(lines, 60, 200)
    for rows, columns in ((10, 80), (24, 40), (3, 20), (1, 1)):
        shown = fitted(lines, rows, columns)
        assert len(shown) <= rows and all(len(line) <= columns for line in shown)
    assert fitted(lines, 10, 80)[:9] == lines[:9]
    assert fitted(lines, 10, 80)[9] == "q quits. 80 x 10 is too small: the panel needs 79 x 24"
    assert all(fitted(lines, rows, 8)[-1].startswith("q quits") for rows in (1, 10, 24))
    seat.type(*":wait")
    assert fitted(seat.screen(), 10, 80)[6].startswith(" :wait_")


# --- eight keys ----------------------------------------------------------------------------------


def test_a_panel_of_eight_keys_has_eight_letters():
    seat = Seat(keys="compact")
    legend = " ".join(seat.screen())
    for cell in ("s START", "t STOP", "r REVERSE", "j JOG", "u UP", "d DOWN", "p P", "f FN"):
        assert cell in legend, legend
    assert "PARAM" not in legend and "EDIT" not in legend
    seat.type("f", "p")
    seat.wait(500)
    assert seat.world.lcd()[0].startswith("S:")  # SET does nothing on the home page
    seat.type("f", "f", "p")
    seat.wait(700)
    assert seat.world.lcd()[1].startswith("NEW"), seat.world.lcd()
    seat.type(" ")
    seat.wait(300)
    assert seat.world.lcd()[1].startswith("READY"), seat.world.lcd()
    seat.type("RIGHT")
    assert "does nothing here" in seat.session.said[0]


def test_its_jog_ends_when_the_keyboard_does_not_repeat_it():
    seat = Seat(keys="compact")
    seat.wait(1500)
    seat.type("J")
    seat.wait(600)
    assert seat.world.drives[1].hz() > 0
    seat.wait(3000)
    assert seat.world.drives[1].hz() == 0
    seat.type("r")
    seat.wait(300)
    seat.type("J")
    seat.wait(600)
    assert seat.world.drives[1].hz() < 0
