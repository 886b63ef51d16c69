# SPDX-License-Identifier: MIT
"""What is wired to which pin, by the table of a board file: read, not run."""

import ast
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]

sys.path.append(str(TOP))
from boards.sim.ports.chips import CHIPS  # noqa: E402

BUS = (
    ("BUS_SEND", "bus DI"),
    ("BUS_RECEIVE", "bus RO"),
    ("DRIVER_ENABLE", "bus DE, /RE, pull-down"),
    ("BACKPACK_SDA", "SDA of a backpack"),
    ("BACKPACK_SCL", "SCL of a backpack"),
)
LCD = ("LCD RS", "LCD E", "LCD D4", "LCD D5", "LCD D6", "LCD D7")


def table(board):
    """The constants of boards/NAME/board.py."""
    found = {}
    for node in ast.parse((TOP / "boards" / board / "board.py").read_text()).body:
        if not isinstance(node, ast.Assign):
            continue
        try:
            value = ast.literal_eval(node.value)
        except ValueError:
            continue
        names = ast.unparse(node.targets[0]).strip("()").split(", ")
        found.update(zip(names, value) if len(names) > 1 else {names[0]: value})
    return found


# Why a pin is better left alone, by the name of the refusal of boards/sim/ports.
KEEP_OFF = {
    "flash": "flash: leave alone",
    "psram": "PSRAM: leave alone",
    "strapping": "boot: leave alone",
    "prompt": "prompt: leave alone",
    "led": "RGB LED: leave alone",
    "output": "input only",
    "e5": "no key here",
}


def keep_off(board):
    """{number of a pin: why it is better left alone}."""
    found = {}
    for what, numbers in CHIPS[table(board)["CHIP"]].pins:
        found.update({number: KEEP_OFF[what] for number in numbers if what in KEEP_OFF})
    return found


def wires(board):
    """{number of a pin: what is wired to it}."""
    names = table(board)
    found = {names[name]: what for name, what in BUS if names.get(name) is not None}
    if "LCD_REGISTER_SELECT" in names:
        found.update({names["LCD_REGISTER_SELECT"] + at: what for at, what in enumerate(LCD)})
    for key, number in names["KEYS"]:
        closed = ", normally closed" if key in names["NORMALLY_CLOSED"] else ""
        found[number] = f"key {key}{closed}"
    for row, number in enumerate(names.get("ROWS", ())):
        found[number] = f"keys, row {row + 1}"
    for column, number in enumerate(names.get("COLUMNS", ())):
        found[number] = f"keys, column {column + 1}"
    return found
