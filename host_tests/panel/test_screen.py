# SPDX-License-Identifier: MIT
"""The picture of 2 x 16 characters. The texts that stand in it: test_languages.py."""

from panel import texts
from panel.announcer import NOTHING, RUNS
from panel.screen import BUSY, COLUMNS, EDITS, GLYPHS, ROWS, Screen
from panel.view import View
from uss import families


def shown(width, hundredths, decimals):
    """What stands in a field that was full of something else, as nothing beside it changes."""
    screen = Screen()
    for row in range(ROWS):
        screen.put(row, 0, COLUMNS, b"x" * COLUMNS)
    screen.number(1, 3, width, hundredths, decimals)
    other, row = screen.rows()
    assert other == "x" * 16 and row[:3] == "xxx" and row[3 + width :] == "x" * (13 - width)
    return row[3 : 3 + width]


def test_numbers_stand_at_the_right_of_their_field():
    """Width, hundredths, decimals: what is shown."""
    for width, hundredths, decimals, text in (
        (5, 1000, 1, " 10.0"),
        (6, 998, 2, "  9.98"),
        (6, 0, 2, "  0.00"),
        (6, 5, 2, "  0.05"),
        (6, -5, 2, " -0.05"),
        (6, -1, 2, " -0.01"),
        (6, -1000, 2, "-10.00"),
        (6, 65000, 2, "650.00"),
        (5, 65000, 1, "650.0"),
        (2, 3100, 0, "31"),
        (5, 1005, 1, " 10.1"),  # rounded, half away from zero
        (5, -1005, 1, "-10.1"),
        (5, 1004, 1, " 10.0"),
    ):
        assert shown(width, hundredths, decimals) == text, (width, hundredths, decimals)


def test_a_value_that_needs_more_room_gives_up_decimals():
    assert shown(6, -65000, 2) == "-650.0"
    assert shown(5, -10000, 1) == " -100"
    assert shown(5, -65000, 1) == " -650"
    assert shown(3, 65000, 2) == "650"
    assert shown(3, 5, 2) == "0.1" and shown(2, 50, 1) == " 1"  # no point without a digit


def test_a_value_that_never_fits_is_not_shown_as_a_small_one():
    assert shown(2, 65000, 1) == "99"
    assert shown(3, -65000, 1) == "999"


def test_a_zero_has_no_sign():
    assert shown(5, -4, 1) == "  0.0"


def test_every_frequency_of_a_drive_fits_its_field():
    for centihertz in range(-65000, 65001, 127):
        for width, decimals in ((5, 1), (6, 2)):
            text = shown(width, centihertz, decimals)
            places = len(text.split(".")[1]) if "." in text else 0
            assert abs(float(text) * 100 - centihertz) <= (0.5, 5, 50)[2 - places] + 0.01, text


def test_a_number_with_all_its_digits_begins_with_zeros():
    """A parameter number of one that is being typed; of more digits there are the last ones."""
    screen = Screen()
    for number, text in ((0, "0000"), (7, "0007"), (1089, "1089"), (9, "0009"), (12345, "2345")):
        for row in range(ROWS):
            screen.put(row, 0, COLUMNS, b"x" * COLUMNS)
        screen.digits(1, 3, 4, number)
        assert screen.rows() == ("x" * 16, "xxx" + text + "x" * 9), number


def test_fn_of_a_compact_keypad_stands_over_the_first_places():
    screen = Screen()
    screen.put(0, 0, COLUMNS, b"x" * COLUMNS)
    screen.mark(2)
    assert screen.rows() == ("^^" + "x" * 14, " " * 16)


def test_text_is_cut_or_filled_to_its_field():
    screen = Screen()
    screen.put(0, 2, 4, b"RUNNING")
    screen.put(1, 0, 16, b"READY")
    assert screen.rows() == ("  RUNN          ", "READY           ")
    screen.put(0, 2, 4, b"A")
    assert screen.rows()[0] == "  A             "


def test_the_picture_has_the_size_of_the_display():
    assert len(Screen().picture) == ROWS * COLUMNS == 32


def test_letters_are_those_of_iso_8859_1():
    """Capital umlauts are pictures of the panel's own; other letters may lose their accent."""
    screen = Screen()
    screen.put(0, 0, 16, b"\xc4\xd6\xdc\xe4\xf6\xfc\xdf \xb0\xb5 \xe9\xc7\xa7")
    assert bytes(screen.picture[:14]) == b"\x02\x03\x04\xe1\xef\xf5\xe2 \xdf\xe4 eC?"
    assert screen.rows()[0] == "ÄÖÜäöüß °µ eC?  "
    screen = Screen("A02")
    screen.put(0, 0, 16, b"\xc4\xd6\xdc\xe4\xf6\xfc\xdf \xe9\xc7")
    assert bytes(screen.picture[:10]) == b"\xc4\xd6\xdc\xe4\xf6\xfc\xdf \xe9\xc7"


PICTURES = """
#####   ..#..   .#.#.   .#.#.   .#.#.
#...#   .###.   .....   .....   .....
.#.#.   #.#.#   .###.   .###.   #...#
..#..   ..#..   #...#   #...#   #...#
.#.#.   ..#..   #####   #...#   #...#
#...#   #.#.#   #...#   #...#   #...#
#####   .###.   #...#   .###.   .###.
.....   ..#..   .....   .....   .....
"""


def test_the_pictures_of_our_own_are_an_hourglass_an_arrow_and_three_letters():
    """Of codes 0 to 4, as the display is given their dots: five in a row, eight rows."""
    assert (BUSY, EDITS) == (0, 1) and len(GLYPHS) == 5 * 8
    for row, line in enumerate(PICTURES.strip().split("\n")):
        for code, dots in enumerate(line.split()):
            bits = int(dots.replace("#", "1").replace(".", "0"), 2)
            assert GLYPHS[8 * code + row] == bits, (code, row)


def test_parameter_numbers_fit_their_field():
    for family in families.FAMILIES:
        assert all(0 < number <= 9999 for number, _ in family.shown)


# --- what stands in it: the view by itself -------------------------------------------------------


class Told:
    """What a view asks of its panel, the drive shown, the announcer, the keys, and the page."""

    kind = NOTHING
    text = shift = 0
    message = values = draw_row_2 = None
    is_in_use = unconfirmed = lost_running = reversed = percent = beyond = whole = False
    tells_state = True
    centihertz, actual, address = 1_000, 998, 1

    def __init__(self, **told):
        self.selected = self.announcer = self.stop_key = self.stop_watch = self.setpoint = self
        self.survey = self.drive = self
        for name in told:
            setattr(self, name, told[name])

    def line_in_use(self):
        return self.is_in_use

    def needs_attention(self):
        return self.unconfirmed or self.lost_running

    def is_percent(self):
        return self.percent

    def actual_centihertz(self):
        return self.actual

    def actual_is_beyond(self):
        return self.beyond

    def draw(self, screen, what):
        """As the announcer, in this row; as the page: what is later than any row."""
        if what < ROWS:
            screen.put(what, 0, COLUMNS, b"A3 RUN,HOLD=ALL")
        elif self.whole:
            screen.put(0, 0, COLUMNS, b"PAGE 1")
            screen.put(1, 0, COLUMNS, b"PAGE 2")
        else:
            screen.put(1, 0, 13, b"READY")


class Values:
    def __init__(self, draws):
        self.draws = draws

    def draw(self, screen):
        screen.put(0, 7, 9, b" I:  1.25" if self.draws else b"")
        return self.draws


def below(screen, now_ms):
    screen.put(1, 0, COLUMNS, b">BELOW")


def viewed(**told):
    """Both rows of a picture over one that was full of something else; how many steps it took."""
    panel, screen = Told(**told), Screen()
    for row in range(ROWS):
        screen.put(row, 0, COLUMNS, b"x" * COLUMNS)
    view = View(panel, screen, panel)
    assert view.is_done()
    view.begin(panel)
    steps = 0
    while not view.is_done() and steps < 9:
        view.step(5_000)
        steps += 1
    before = screen.rows()
    view.step(5_000)  # there is nothing left to draw
    assert screen.rows() == before and view.is_done()
    return before[0].rstrip(), before[1].rstrip(), steps


FREQUENCIES = "S: 10.0 F:  9.98"
SAID = "A3 RUN,HOLD=ALL"
UNCONFIRMED, LOST = "STOP UNCONFIRMED", "NO CONTACT,"


def test_the_frequencies_stand_in_row_1_and_the_page_in_row_2():
    for told, rows in (
        ({}, (FREQUENCIES, "READY        A1")),
        ({"address": 9}, (FREQUENCIES, "READY        A9")),
        ({"address": 10}, (FREQUENCIES, "READY        A10")),
        ({"reversed": True}, ("S:-10.0 F:  9.98", "READY        A1")),
        ({"reversed": True, "centihertz": 0}, ("S: -0.0 F:  9.98", "READY        A1")),
        ({"centihertz": 0}, ("S:  0.0 F:  9.98", "READY        A1")),
        ({"actual": -65_000}, ("S: 10.0 F:-650.0", "READY        A1")),
        ({"actual": None}, ("S: 10.0 F: -----", "READY        A1")),
        ({"actual": None, "beyond": True}, ("S: 10.0 F: -----", "READY        A1")),
        ({"shift": 2}, ("^^ 10.0 F:  9.98", "READY        A1")),
        ({"values": Values(True)}, ("S: 10.0 I:  1.25", "READY        A1")),
        ({"values": Values(False)}, (FREQUENCIES, "READY        A1")),
    ):
        assert viewed(**told) == rows + (4,), (told, viewed(**told))
    assert viewed(beyond=True)[0] == "S: 10.0 F: >>>>>"
    assert viewed(percent=True)[0] == "S: 10.0%F:  9.98"


def test_what_must_be_said_has_its_row():
    """A held STOP before a message, that before another master; an alarm before these two."""
    held, in_use = "STOP, HOLD: OFF3", "LINE IN USE"
    message, lost = {"message": b"KEPT"}, {"lost_running": True}
    announced = {"kind": RUNS}
    for told, row_1, row_2 in (
        (message, FREQUENCIES, "KEPT"),
        ({"is_in_use": True}, FREQUENCIES, in_use),
        (dict(message, is_in_use=True), FREQUENCIES, "KEPT"),
        (announced, FREQUENCIES, SAID),
        (dict(message, **announced), SAID, "KEPT"),
        ({"unconfirmed": True}, FREQUENCIES, UNCONFIRMED),
        (dict(announced, unconfirmed=True), UNCONFIRMED, SAID),
        (dict(message, unconfirmed=True), FREQUENCIES, UNCONFIRMED),
        (lost, LOST, "MAY RUN      A1"),
        (dict(lost, **announced), LOST, SAID),
        (dict(lost, unconfirmed=True), LOST, UNCONFIRMED),
        (dict(lost, unconfirmed=True, **announced), UNCONFIRMED, SAID),
        (dict(lost, **message), LOST, "MAY RUN      A1"),
    ):
        assert viewed(**told)[:2] == (row_1, row_2), (told, viewed(**told))
    for told, row_1 in (
        ({}, FREQUENCIES), (announced, SAID), ({"unconfirmed": True}, UNCONFIRMED), (lost, LOST)
    ):  # fmt: skip
        rows = viewed(text=texts.HOLD_FOR_OFF3, message=b"KEPT", is_in_use=True, **told)
        assert rows[:2] == (row_1, held), (told, rows)


def test_a_page_with_both_rows_leaves_them_to_what_must_be_said():
    message, announced = {"message": b"KEPT"}, {"kind": RUNS}
    for told, rows in (
        ({}, ("PAGE 1", "PAGE 2")),
        (message, ("PAGE 1", "KEPT")),
        (announced, (SAID, "PAGE 2")),
        (dict(message, **announced), (SAID, "KEPT")),
        ({"lost_running": True}, ("PAGE 1", "PAGE 2")),
        ({"shift": 1}, ("^AGE 1", "PAGE 2")),
    ):
        assert viewed(whole=True, **told) == rows + (1,), (told, viewed(whole=True, **told))
        later = viewed(whole=True, draw_row_2=below, **told)
        row_2 = ">BELOW" if rows[1] == "PAGE 2" else rows[1]
        assert later == (rows[0], row_2, 2), (told, later)


def test_a_picture_tells_the_state_unless_something_is_said_in_its_place():
    for told, tells in (
        ({}, True), ({"tells_state": False}, False), ({"message": b"KEPT"}, False),
        ({"is_in_use": True}, False), ({"message": b"KEPT", "unconfirmed": True}, True),
        ({"text": texts.LINE_IN_USE, "unconfirmed": True}, False),
    ):  # fmt: skip
        panel = Told(**told)
        assert View(panel, Screen(), panel).tells_state(panel) == tells, told
