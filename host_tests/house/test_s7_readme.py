# SPDX-License-Identifier: MIT
"""What firmware/uss/s7/README.md tells PLC programmers: its tables miss nothing, every name in
them is one of the library, and its example runs."""

import re

from boards.sim.board import HardTimer
from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.drives.drive import Drive as SimulatedDrive
from boards.sim.line.wire import Transceiver, Wire
from hal import pacer
from hal.link.rs485 import Rs485Link
from plc_bench import NEVER, SCAN_US
from uss import (
    bits,
    drive,
    families,
    layout,
    master,
    outside,
    pkw,
    pzd,
    receiver,
    s7,
    scaling,
    telegram,
    timing,
)
from uss.bus import pkw_errors
from uss.s7 import codes

MANUAL = "firmware/uss/s7/README.md"

S7_200_PINS = {
    "USS_INIT": "EN MODE BAUD ACTIVE DONE ERROR",
    "USS_CTRL": "EN RUN OFF2 OFF3 F_ACK DIR DRIVE TYPE SPEED_SP RESP_R ERROR STATUS SPEED RUN_EN"
    " D_DIR INHIBIT FAULT",
    "USS_RPM_W/D/R": "EN XMT_REQ DRIVE PARAM INDEX DB_PTR DONE ERROR VALUE",
    "USS_WPM_W/D/R": "EN XMT_REQ EEPROM DRIVE PARAM INDEX DB_PTR VALUE DONE ERROR",
}
S7_1200_PINS = {
    "USS_Port_Scan (USS_PORT)": "PORT BAUD USS_DB ERROR STATUS",
    "USS_Drive_Control (USS_DRV)": "RUN OFF2 OFF3 F_ACK DIR DRIVE PZD_LEN SPEED_SP CTRL3 CTRL8"
    " NDR ERROR STATUS RUN_EN D_DIR INHIBIT FAULT SPEED STATUS1 STATUS3 STATUS8",
    "USS_Read_Param (USS_RPM)": "REQ DRIVE PARAM INDEX USS_DB DONE ERROR STATUS VALUE",
    "USS_Write_Param (USS_WPM)": "REQ DRIVE PARAM INDEX EEPROM VALUE USS_DB DONE ERROR STATUS",
}


class NoLink:
    interrupts = True
    resolution_us = 0


def roots():
    """What the first part of a name in the tables stands for."""
    clock = Clock()
    port = s7.Port(None, clock)
    modules = (
        codes, drive, families, layout, master, pkw, pkw_errors, pzd, receiver, s7, scaling,
        outside, telegram, timing, bits,
    )  # fmt: skip
    found = {module.__name__.split(".")[-1]: module for module in modules}
    found["Drive"] = drive.Drive(1, clock.ticks_mask)
    found["Job"] = pkw.read(700)
    found["Layout"] = layout.Layout()
    found["Master"] = master.Master(NoLink, timing.Timing(19200), clock.ticks_mask)
    found["Pacer"] = pacer.Pacer(found["Master"], NoLink, clock, None)
    found["Scale"] = scaling.Scale(50.0)
    found["Timing"] = timing.Timing(19200)
    found["s7.Port"] = port
    for name in (
        "USS_INIT", "USS_CTRL", "USS_RPM_W", "USS_RPM_D", "USS_RPM_R", "USS_WPM_W", "USS_WPM_D",
        "USS_WPM_R",
    ):  # fmt: skip
        found["s7." + name] = getattr(s7, name)(port)
    return found


def manual():
    with open(MANUAL, encoding="utf-8") as file:
        return file.read()


def part(title):
    """The lines below a heading."""
    text = manual()
    begin = text.index("\n## " + title)
    end = text.find("\n## ", begin + 1)
    return text[begin : end if end >= 0 else len(text)].split("\n")


def rows(title):
    """The tables below a heading: the cells of each row, heads and rulers left out."""
    lines = part(title)
    for number, line in enumerate(lines):
        if not line.startswith("|") or line.startswith("|---"):
            continue
        if number + 1 < len(lines) and lines[number + 1].startswith("|---"):
            continue
        yield [cell.strip() for cell in line[1:-1].split("|")]


def code_numbers(cell):
    return [int(text) for text in cell.split(", ") if text.isdigit()]


def test_every_name_in_the_tables_exists():
    known = roots()
    text = manual()
    names = set()
    for quoted in text.split("`")[1::2]:
        if "\n" not in quoted and "." in quoted and re.match("^[A-Za-z_0-9.]+$", quoted):
            names.add(quoted)
    names = {name for name in names if name not in ("uss.s7", "uss.br", "uss.bus", "hal.pacer")}
    assert len(names) > 60
    for name in names:
        parts = name.split(".")
        thing = known.get(".".join(parts[:2]))
        rest = parts[2:]
        if thing is None:
            assert parts[0] in known, name
            thing = known[parts[0]]
            rest = parts[1:]
        for attribute in rest:
            assert hasattr(thing, attribute), name
            thing = getattr(thing, attribute)


def test_every_code_of_the_s7_200_has_a_row_that_agrees_with_the_code():
    found = list(rows("Codes 0...22"))
    assert [int(cells[0]) for cells in found] == list(range(23))
    for code, cells in enumerate(found):
        there = cells[1].split(", ") if cells[1] else []
        word = codes.word(code)
        assert (there[:1] == ["%04X" % word]) if word is not None else not there, cells
        assert cells[3].startswith("never") == (code in NEVER), cells


def test_every_word_of_the_s7_1200_has_a_row():
    found = {}
    for cells in rows("The S7-1200's blocks"):
        if len(cells[0]) == 4:
            found[int(cells[0], 16)] = code_numbers(cells[1])
    assert sorted(found) == sorted(codes.WORDS)
    for word, numbers in found.items():
        for code in numbers:
            assert codes.word(code) == word or word in (
                codes.ACCESS_REFUSED, codes.WRONG_VALUE_TYPE,
            )  # fmt: skip
        assert numbers or word == 0x8188


def check_pins(title, pins):
    told = {}
    block = None
    for cells in rows(title):
        block = cells[0] or block
        told[block] = told.get(block, "") + " " + cells[1].replace(",", " ").replace("...", " ")
    for block, names in pins.items():
        for name in names.split():
            assert name in told[block].split(), (block, name)


def test_every_pin_of_both_siemens_libraries_has_a_row():
    check_pins("USS_INIT, USS_CTRL", S7_200_PINS)
    check_pins("The S7-1200's blocks", S7_1200_PINS)


def test_the_pins_of_the_s7_200_are_those_of_the_blocks():
    port = s7.Port(None, Clock())
    s7.USS_INIT(port)(EN=False, MODE=1, BAUD=9600, ACTIVE=0)
    s7.USS_CTRL(port)(
        EN=False, RUN=False, OFF2=False, OFF3=False, F_ACK=False, DIR=False, DRIVE=0, TYPE=1,
        SPEED_SP=0.0,
    )  # fmt: skip
    for kind in (s7.USS_RPM_W, s7.USS_RPM_D, s7.USS_RPM_R):
        kind(port)(EN=False, XMT_REQ=False, DRIVE=0, PARAM=0, INDEX=0)
    for kind in (s7.USS_WPM_W, s7.USS_WPM_D, s7.USS_WPM_R):
        kind(port)(EN=False, XMT_REQ=False, EEPROM=False, DRIVE=0, PARAM=0, INDEX=0, VALUE=0)


class Board:
    """What the example needs of a board."""

    def __init__(self):
        self.clock = Clock()
        self.wire = Wire(self.clock, 19200)
        self.chip = Chip(self.clock, self.wire)

    def make_link(self, baud):
        driver_enable = Pin(self.chip)
        uart = UART(self.chip, baud)
        Transceiver(self.wire, uart, driver_enable)
        timer = HardTimer(self.chip)
        return Rs485Link(uart, driver_enable, timer, self.clock, baud, interrupts=False)

    def idle(self):
        self.clock.advance(SCAN_US)


def play(switch, board):
    """Run the example until it ends; answer its names."""
    names = {"board": board, "switch": switch}
    exec(manual().split("```python\n")[1].split("```")[0], names)
    return names


def test_the_example_works_and_its_end_stops_the_motor():
    board = Board()
    simulated = SimulatedDrive(board.clock, board.wire, 1, {1120: 1.0})

    def switch(name):
        if name == "end":
            if board.clock.now_us > 4_000_000:
                assert simulated.state == "running" and abs(simulated.hz() - 25.0) < 0.01
                return True
            return False
        return board.clock.now_us > 2_000_000

    names = play(switch, board)
    assert simulated.state == "stopping"
    assert names["motor"].RUN_EN and names["frequency"].DONE and names["frequency"].ERROR == 0
    assert not board.wire.violations()


def test_an_exception_in_the_example_stops_the_motor():
    board = Board()
    simulated = SimulatedDrive(board.clock, board.wire, 1, {1120: 1.0})

    def switch(name):
        if board.clock.now_us > 4_000_000:
            assert simulated.state == "running"
            raise KeyError("a contact is missing")
        return name == "run" and board.clock.now_us > 2_000_000

    try:
        play(switch, board)
        raise AssertionError("it went on")
    except KeyError:
        pass
    assert simulated.state == "stopping"
