# SPDX-License-Identifier: MIT
"""What a terminal sends, cut into strokes; the hand that presses keys; telegrams that repeat."""

from tools.terminal.hand import FIRST_REPEAT_MS, LOST_MS, REPEAT_MS, WAITING_MAX, Hand
from tools.terminal.shafts import SHAFT, Shafts
from tools.terminal.strokes import ESCAPE, OTHER, Strokes
from tools.terminal.told import Telegrams

INTERPRETERS = "host"

ARROW = "\x1b[%s"


def strokes(*pieces):
    """The strokes of bytes that come in pieces, 20 ms apart; an empty piece is a silent frame."""
    decoder = Strokes()
    found = []
    for index, piece in enumerate(pieces):
        found += decoder.take(piece, 20 * index)
    return found


def test_letters_are_themselves_and_a_key_is_its_sequence():
    assert strokes(b"sT \x03") == ["s", "T", " ", "\x03"]
    assert strokes(b"\x1b[A\x1b[B\x1b[C\x1b[D") == [ARROW % one for one in "ABCD"]
    assert strokes(b"\x1bOA\x1bOD\x1b[5~") == ["\x1bOA", "\x1bOD", "\x1b[5~"]
    assert strokes("ä€".encode()) == ["ä", "€"]
    assert strokes("ä".encode()[:1], "ä".encode()[1:]) == ["ä"]


def test_an_arrow_that_comes_in_pieces_is_an_arrow():
    assert strokes(b"\x1b", b"[", b"A", b"s") == [ARROW % "A", "s"]


def test_esc_is_known_by_the_silence_after_it():
    assert strokes(b"\x1b", b"", b"") == []
    assert strokes(b"\x1b", b"", b"", b"") == [ESCAPE]
    assert strokes(b"\x1b\x1b[A") == [ESCAPE, ARROW % "A"]


def test_no_other_key_is_taken_for_a_letter():
    for sequence in ("\x1b[[A", "\x1b[15;2~", "\x1bOP", "\x1b[1;5A", "\x1b[1;9L"):
        assert strokes(sequence.encode()) == [sequence]
    assert strokes(b"\x1b[" + b"1" * 40)[0] == OTHER


def test_stop_and_ctrl_c_are_heard_right_after_esc_and_inside_any_sequence():
    for stroke in (" ", "\x03", "\r", "\x7f"):
        typed = stroke.encode()
        assert strokes(b"\x1b" + typed) == [ESCAPE, stroke]
        assert strokes(b"\x1b", typed) == [ESCAPE, stroke]
        for begun in (b"\x1b[", b"\x1bO", b"\x1b[1", b"\x1b[1;5", b"\x1b[[", b"\x1b[<0;1"):
            assert strokes(begun + typed) == [OTHER, stroke], begun
            assert strokes(begun, typed, b"\x1b[A") == [OTHER, stroke, ARROW % "A"], begun


def test_a_letter_right_after_esc_is_a_stroke_of_its_own():
    assert strokes(b"\x1bs") == [ESCAPE, "s"]
    assert strokes("\x1bä".encode()) == [ESCAPE, "ä"]
    assert strokes(b"\x1b[\x1b[B") == [OTHER, ARROW % "B"]


def test_what_the_terminal_says_of_its_own_accord_is_no_stroke():
    decoder = Strokes()
    reports = ("\x1b[<0;25;5M", "\x1b[<35;125;50m", "\x1b[12;40R", "\x1b[?2026;2$y", "\x1b[I")
    assert decoder.take("".join(reports).encode() + b"s", 0) == ["s"]
    assert decoder.reports == list(reports) and not decoder.pasted


def test_what_comes_all_at_once_is_a_paste():
    text = b"test results: all is well, says the log\r\n"
    for pieces, brackets in (
        ((b"\x1b[200~" + text + b"\x1b[201~",), True),
        ((b"\x1b[20", b"0~s", b"", b"s", b"l", b"s\x1b[201~"), True),
        ((b"\x1b[200~s",) + 60 * (b"",) + (b"\x1b[200~l\x1b[201~",), True),
        ((text,), False),
        ((b"sd", b"s", b"s"), False),  # the rest of it comes later
        ((b"Sr", b"L", b"", b"J"), False),
        ((b"s\x1b[A",), False),
        ((b"\x1b s",), False),
    ):
        decoder = Strokes()
        for at, piece in enumerate(pieces):
            if decoder.take(piece, 20 * at):
                assert decoder.pasted and decoder.brackets == brackets, pieces
        at += 60
        assert decoder.take(b"s", 20 * at) == ["s"] and not decoder.pasted


def test_a_key_that_the_keyboard_repeats_is_no_paste():
    decoder = Strokes()
    assert decoder.take(b"uuu", 0) == ["u", "u", "u"] and not decoder.pasted


# --- the hand -----------------------------------------------------------------------------------


class Seat:
    """A hand at a panel whose keys are seen to go down and up."""

    def __init__(self, is_real=False):
        self.sent = []
        self.hand = Hand(self.send, is_real)

    def send(self, kind, key=""):
        self.sent.append((kind + " " + key).strip())

    def sees(self, key, now_ms):
        """The panel does a tap."""
        self.hand.see([key], now_ms)
        self.hand.see([], now_ms + 1)


def test_taps_are_done_one_after_the_other():
    seat = Seat()
    for key in ("FN", "FN", "P"):
        assert seat.hand.tap(key, 0)
    assert seat.sent == ["down FN", "up FN"]
    seat.hand.see([], 20)  # it has not begun
    assert len(seat.sent) == 2
    seat.sees("FN", 100)
    seat.sees("FN", 200)
    assert seat.sent == 2 * ["down FN", "up FN"] + ["down P", "up P"]


def test_a_tap_that_is_never_seen_holds_up_nothing():
    seat = Seat()
    seat.hand.tap("UP", 0)
    seat.hand.tap("DOWN", 0)
    seat.hand.see([], LOST_MS)
    assert seat.sent[2:] == ["down DOWN", "up DOWN"]


def test_taps_that_are_typed_too_fast_are_left_out():
    seat = Seat()
    assert all(seat.hand.tap("UP", 0) for _ in range(1 + WAITING_MAX))
    assert not seat.hand.tap("UP", 0)


def test_stop_goes_ahead_of_everything_and_empties_the_queue():
    seat = Seat()
    for key in ("START", "UP", "UP", "STOP"):
        seat.hand.tap(key, 0)
    assert seat.sent == ["down START", "up START", "down STOP", "up STOP"]
    seat.sees("STOP", 100)
    seat.hand.see([], 5000)
    assert len(seat.sent) == 4


def test_stop_is_pressed_while_another_key_is_held():
    seat = Seat()
    seat.hand.hold("JOG_RIGHT", 0)
    seat.hand.tap("STOP", 10)
    assert seat.sent == ["down JOG_RIGHT", "up JOG_RIGHT", "down STOP", "up STOP"]
    assert seat.hand.held is None


def test_a_capital_holds_until_another_key_and_another_capital_only_renews_it():
    seat = Seat()
    seat.hand.hold("UP", 0)
    seat.hand.hold("UP", 40)
    seat.hand.step(60_000)
    assert seat.sent == ["down UP"] and seat.hand.held == "UP"
    seat.hand.tap("NEXT", 60_000)
    assert seat.sent == ["down UP", "up UP", "down NEXT", "up NEXT"]


def test_a_jog_lets_go_when_the_keyboard_does_not_repeat_it():
    for key in ("JOG_RIGHT", "JOG_LEFT", "JOG"):
        seat = Seat()
        seat.hand.hold(key, 0)
        seat.hand.step(FIRST_REPEAT_MS - 1)  # it waits before it repeats
        seat.hand.hold(key, FIRST_REPEAT_MS - 1)
        seat.hand.step(FIRST_REPEAT_MS + REPEAT_MS - 2)
        assert seat.sent == ["down " + key]
        seat.hand.step(FIRST_REPEAT_MS + REPEAT_MS - 1)
        assert seat.sent == ["down " + key, "up " + key]
        seat = Seat()
        seat.hand.hold(key, 0)
        seat.hand.step(FIRST_REPEAT_MS)
        assert seat.sent == ["down " + key, "up " + key]


def test_on_a_real_line_every_key_but_stop_has_to_be_repeated():
    for is_real, key, stays in ((False, "UP", True), (True, "UP", False), (True, "STOP", True)):
        seat = Seat(is_real)
        seat.hand.hold(key, 0)
        seat.hand.step(60_000)
        assert (seat.hand.held == key) == stays, (is_real, key)


def test_a_key_under_the_mouse_is_down_until_its_button_comes_up():
    seat = Seat(True)
    seat.hand.press("JOG_LEFT", 0)
    seat.hand.step(60_000)
    assert seat.sent == ["down JOG_LEFT"]
    seat.hand.lift()
    seat.hand.lift()
    assert seat.sent == ["down JOG_LEFT", "up JOG_LEFT"]


def test_what_the_panel_has_let_go_of_is_held_no_more():
    seat = Seat()
    seat.hand.hold("UP", 0)
    seat.hand.see(["UP"], LOST_MS)
    assert seat.hand.held == "UP"
    seat.hand.see([], LOST_MS + 20)
    assert seat.hand.held is None


def test_esc_lets_go_of_all_and_forgets_what_waits():
    seat = Seat()
    seat.hand.tap("UP", 0)
    seat.hand.tap("UP", 0)
    seat.hand.hold("STOP", 0)
    seat.hand.let_go()
    seat.hand.see([], 5000)
    assert seat.sent[-1] == "release" and seat.hand.held is None


# --- telegrams, shafts --------------------------------------------------------------------------


def message(us, text, whence="panel"):
    return {"us": us, "from": whence, "text": text, "hex": "02", "wrong": 0}


def test_repeats_of_a_telegram_are_counted_and_a_pause_loses_none():
    telegrams = Telegrams()
    for us in range(0, 1000, 100):
        telegrams.take(message(us, "A1 OFF1"))
        telegrams.take(message(us + 50, "A1 OFF1", "drive"))
    assert [(row.count, row.first_us) for row in telegrams.rows] == [(10, 0), (10, 50)]
    telegrams.pause(True)
    telegrams.take(message(2000, "A1 ON"))
    assert len(telegrams.rows) == 2
    telegrams.pause(False)
    assert [row.message["text"] for row in telegrams.rows][-1] == "A1 ON"
    telegrams.take(message(60_000_000, "A1 OFF1"))  # much later it is news
    assert len(telegrams.rows) == 4


def test_there_is_an_end_to_what_is_kept():
    telegrams = Telegrams()
    for number in range(5000):
        telegrams.take(message(number, "A1 %d" % number))
    assert len(telegrams.rows) <= 1000 and telegrams.rows[-1].message["text"] == "A1 4999"


def positions(hz, frame_us, frames):
    """The positions of a shaft that turns at this frequency, one for each frame."""
    shafts, found = Shafts(), []
    for frame in range(frames + 1):
        shafts.turn([{"a": 1, "hz": hz}], frame * frame_us)
        found.append(shafts.positions[1])
    return found[1:]


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
