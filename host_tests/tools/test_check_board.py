# SPDX-License-Identifier: MIT
"""tools/check-board: what it finds in a board file before anything is flashed.

Each mistake is made in a copy of a board of the tree.
"""

import subprocess

import pytest

from tiers import TOP

INTERPRETERS = "host"

COMMAND = TOP / "tools" / "check-board"
BOARDS = ("pico", "pico2", "esp32", "esp32s3")

# Board, what is changed, into what, what it says.
MISTAKES = (
    ("pico", '("UP", 18)', '("UP", 13)', "key START and key UP are both at pin 13"),
    ("pico", '("UP", 18)', '("UP", 8)', "LCD E and key UP are both at pin 8"),
    ("pico", '("UP", 18)', '("UP", 15)', "GP15 loses its pull-up while USB starts (key UP)"),
    ("pico", '("UP", 18)', '("UP", 23)', "GP23 is not led out on a Pico"),
    ("pico", '("UP", 18)', '("UP", 40)', "invalid pin: GP40 (key UP)"),
    ("pico", "BUS_RECEIVE = 4, 5", "BUS_RECEIVE = 4, 10", "bad pin GP10 for the UART"),
    ("pico", "BACKPACK_SCL = 0, 1", "BACKPACK_SCL = 0, 11", "bad pin GP11 for the I2C"),
    ("pico", "LCD_ENABLE = 7, 8", "LCD_ENABLE = 7, 13", "LCD_ENABLE is not the pin after"),
    ("pico", '    ("SET", 2),\n', "", "no key SET"),
    ("pico", '("SET", 2)', '("SETT", 2)', "the panel knows no key SETT"),
    ("pico", 'CLOSED = ("STOP",)', "CLOSED = ()", "STOP is not normally closed"),
    ("pico", "watchdog = rp2.Watchdog()\n", "", "no watchdog: see firmware/hal"),
    ("pico", "keypad = rp2.make", "keys = rp2.make", "no keypad: see firmware/hal"),
    ("pico", "watchdog = rp2.Watchdog()", "watchdog = clock", "watchdog has no feed"),
    ("pico", "idle = rp2.idle", "idle = 5", "idle is no function: see firmware/hal"),
    ("pico", "timer = rp2.make_timer()", "timer = None", "timer has no init: see firmware/hal"),
    ("pico", '("UP", 18)', '("UP", "18")', "'18' is no number of a pin"),
    ("pico", '("UP", 18),', '("UP", 18', "SyntaxError('invalid syntax',) (line "),
    ("pico", "SCL = 0, 1", "SCL = 0", "TypeError(\"'int' object isn't iterable\",) (line "),
    ("pico", '"RASPBERRY PICO"', '"RASPBERRY PICO OF MINE"', "name has more than 16"),
    ("pico", "rp2.low(DRIVER_ENABLE)", "None", "DRIVER_ENABLE is no output that is low"),
    ("pico", 'CHIP = "RASPBERRY PICO", "RP2040"', 'CHIP = "X", "Z80"', "no line `name, CHIP"),
    ("pico", '"RP2040"', '"ESP32"', "this firmware knows RP2040 and RP2350, no ESP32"),
    (
        "pico2",
        "rp2.expect(CHIP)",
        'rp2.expect("RP2040")',
        "is for the RP2040, and here is a RP2350",
    ),
    ("pico", "rp2.Watchdog()", "rp2.Watchdogg()", "it cannot be loaded: AttributeError"),
    ("pico", "driver_enable, clock, baud)", "driver_enable, clock)", "make_link(19200) fails"),
    ("pico", '"""', '"""' + "\n" * 60, "a board is a table of less than 60"),
    ("esp32s3", '("UP", 4)', '("UP", 27)', "GPIO27 belongs to the flash (key UP)"),
    ("esp32s3", '("UP", 4)', '("UP", 35)', "GPIO35 belongs to the octal PSRAM"),
    ("esp32s3", '("UP", 4)', '("UP", 0)', "GPIO0 decides how the chip boots (key UP)"),
    ("esp32s3", '("UP", 4)', '("UP", 20)', "GPIO20 belongs to MicroPython's prompt"),
    ("esp32s3", '("UP", 4)', '("UP", 48)', "GPIO48 has the board's RGB LED"),
    ("esp32s3", '("UP", 4)', '("UP", 22)', "invalid pin: GPIO22 (key UP)"),
    ("esp32s3", "DRIVER_ENABLE = 16", "DRIVER_ENABLE = 45", "GPIO45 decides how the chip boots"),
    ("esp32s3", "must_supervise = True", "must_supervise = False", "must_supervise is not True"),
    ("esp32", "must_supervise = True", "", "must_supervise is not True"),
    ("esp32", '("START", 13)', '("START", 34)', "GPIO34 has no pull-up (key START)"),
    ("esp32", "ROWS = (25, 26, 27)", "ROWS = (25, 26, 39)", "GPIO39 can only be input (ROWS[2])"),
    ("esp32", "COLUMNS = (18,", "COLUMNS = (27,", "ROWS[2] and COLUMNS[0] are both at pin 27"),
    (
        "esp32",
        "DRIVER_ENABLE = None",
        "DRIVER_ENABLE = 17",
        "a timer switches the driver off too late",
    ),
)


def check(word):
    run = subprocess.run([COMMAND, word], capture_output=True, text=True, timeout=60)
    return run.returncode, run.stdout + run.stderr


@pytest.mark.parametrize("board", BOARDS)
def test_the_boards_of_the_tree_are_right(board):
    status, said = check(board)
    assert status == 0, said
    assert said.startswith(f"{board}: nothing is wrong with it")


def test_these_are_all_the_boards():
    files = {path.parent.name for path in TOP.glob("boards/*/board.py")}
    assert files - {"sim"} == {*BOARDS}


@pytest.mark.parametrize("row", MISTAKES, ids=[row[3] for row in MISTAKES])
def test_a_mistake_is_found(row, tmp_path):
    board, old, new, says = row
    text = (TOP / "boards" / board / "board.py").read_text()
    assert text.count(old) >= 1, old
    file = tmp_path / "board.py"
    file.write_text(text.replace(old, new, 1))
    status, said = check(file)
    assert status == 1 and says in said, said


def test_a_file_that_is_no_text_is_told_as_one(tmp_path):
    file = tmp_path / "board.py"
    file.write_bytes(b"\xff\xfe\x00")
    status, said = check(file)
    assert status == 1 and said == f"{file}: it cannot be read: UnicodeError()\n"


def test_a_compact_keypad_is_whole_with_eight_keys(tmp_path):
    lines = (TOP / "boards/pico/board.py").read_text().splitlines(keepends=True)
    begin = next(at for at, line in enumerate(lines) if line.startswith("KEYS = ("))
    end = lines.index(")\n", begin)
    names = ("START", "STOP", "REVERSE", "JOG", "UP", "DOWN", "P", "FN")
    keys = [
        f'    ("{name}", {13 + at * (at != 2) - 10 * (at == 2)}),\n'
        for at, name in enumerate(names)
    ]
    file = tmp_path / "board.py"
    file.write_text("".join(lines[: begin + 1] + keys + lines[end:]))
    assert check(file)[0] == 0, check(file)[1]
    file.write_text("".join(lines[: begin + 1] + keys[:-1] + lines[end:]))
    assert "no key FN" in check(file)[1]


def test_pico_and_pico_2_are_wired_alike():
    """One picture and one manual serve both."""
    tables = []
    for board in ("pico", "pico2"):
        lines = (TOP / "boards" / board / "board.py").read_text().splitlines()
        code = [line.split("  #")[0] for line in lines[lines.index("# GPIO numbers") :]]
        tables.append(code)
    assert tables[0] == tables[1]


def test_it_says_how_it_is_called():
    status, said = check("--help")
    assert status == 0 and said.startswith("usage: tools/check-board")
    for word, told in (
        ("nix", "there is no board nix"),
        ("boards", "there is no board boards"),
        ("--wrong", "say which: a folder of boards/, or a board.py of your own"),
        ("/nix/board.py", "there is no board /nix/board.py"),
    ):
        assert check(word) == (2, f"tools/check-board: {told}\n")
