# SPDX-License-Identifier: MIT
"""Loads a board file on the machine of a port, as MicroPython does on the chip.

port = Port(CHIPS["ESP32S3"], chip)
board = load("boards/esp32s3/board.py", port)
board.make_link(19200)              # the table on top of the file as well: board.KEYS
"""

import sys

from boards.sim.ports import modules

BOARDS = "boards"  # where `chips` is, from the top of the tree


class Board:
    """The attributes of a board file."""


def load(path, port):
    """What the file defines. Raises what it raises."""
    with open(path) as file:
        source = file.read()
    before = modules.install(port)
    sys.path.insert(0, BOARDS)
    names = {"__name__": "board"}
    try:
        exec(compile(source, path, "exec"), names)
    finally:
        sys.path.pop(0)
        modules.restore(before)
        modules.forget()
    board = Board()
    for name, value in names.items():
        setattr(board, name, value)
    return board


def chip_of(path):
    """The chip that a board file says it is for, None if it says nothing."""
    with open(path) as file:
        for line in file:
            if line.startswith("name, CHIP = "):
                return eval(line[len("name, CHIP = ") :])[1]
    return None
