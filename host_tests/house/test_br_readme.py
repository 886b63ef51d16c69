# SPDX-License-Identifier: MIT
"""What firmware/uss/br/README.md tells B&R programmers: its tables miss nothing, its meanings are
those of the code, every name in them is one of the library, and its example runs."""

import re

from test_s7_readme import Board

from boards.sim.drives.drive import Drive as SimulatedDrive
from boards.sim.drives.families import g110
from uss import br, drive, layout, master, timing
from uss.br import codes, structures

MANUAL = "firmware/uss/br/README.md"

# Every member of the structures and blocks of the source's figures 5.3...5.6.
MEMBERS = (
    "Run FaultAcknowledge JOGRight JOGLeft Reverse RefFreq Freq PKW_lengh PZD_lengh"
    " ControllSequence ADDR DriveReady DriveReadyToRun DriveRunning DriveFault OFF2 OFF3 ONInhibit"
    " DriveWarning DeviationSetpoint PZDControl FreqOverMax Warning MotorHoldingBreake"
    " MotorOverload MotorRunsRight InverterOverload HEX Percent Receive Start Stop"
    " ErrorAcknowledge Create Reset Open_Send Open_Receive Open Close Ready Busy Done Error"
    " ErrorID StepNo TON_Delay_min TON_Delay_max STX LGE BCC ADR PKW PZD ControlWord MainSetpoint"
    " StatusWord ActualValue"
)


def manual():
    with open(MANUAL, encoding="utf-8") as file:
        return file.read()


def rows(title):
    """The table below a heading: the cells of each row, head and ruler left out."""
    lines = manual().split("\n## " + title)[1].split("\n## ")[0].split("\n")
    table = [line for line in lines if line.startswith("|")][2:]
    return [[cell.strip() for cell in line[1:-1].split("|")] for line in table]


def test_every_code_has_a_row_with_the_meaning_that_the_code_has():
    told = []
    for cells in rows("Codes 100...600"):
        numbers = [int(text) for text in cells[0].split(", ")]
        for number in numbers:
            told.append(number)
            if number not in (504, 507) and number < 1000 and number != 60 and number // 100 != 5:
                assert codes.text(number) == cells[1], number
    meant = [code for _, block in codes.BLOCKS for code, _ in block]
    assert sorted(told) == sorted(meant + [504])


def test_every_member_of_the_source_has_a_row():
    members = set()
    for cells in rows("Members"):
        for separator in ",.[]":
            cells = [cell.replace(separator, " ") for cell in cells]
        members.update((cells[0] + " " + cells[1]).split())
    for name in MEMBERS.split():
        assert name in members, name


def test_every_name_in_the_tables_exists():
    known = {
        "Drive": drive.Drive(1, 1023),
        "Layout": layout.Layout(),
        "Master": master.Master,
        "Timing": timing.Timing(19200),
        "DriveController": br.DriveController(None, None),
        "br": br,
        "codes": codes,
        "structures": structures,
    }
    quoted = manual().split("`")[1::2]
    names = {text for text in quoted if re.match(r"^[A-Za-z]+\.[A-Za-z_.]+$", text)}
    names -= {"uss.s7", "uss.br", "hal.pacer", "Master.phase", "Master.turns.arrange"}
    assert len(names) > 10
    for name in names:
        parts = name.split(".")
        thing = known[parts[0]]
        for attribute in parts[1:]:
            assert hasattr(thing, attribute), name
            thing = getattr(thing, attribute)


def test_the_example_works_and_its_end_stops_the_motor():
    board = Board()
    simulated = SimulatedDrive(board.clock, board.wire, 1, {1120: 1.0}, family=g110)

    def switch(name):
        if name == "end":
            return board.clock.now_us > 4_000_000
        return board.clock.now_us > 2_000_000

    names = {"board": board, "switch": switch}
    exec(manual().split("```python\n")[1].split("```")[0], names)
    assert simulated.state == "stopping"
    assert names["told"].StatusWord.DriveRunning and abs(names["told"].ActualValue.Freq - 25) < 0.1
    assert not board.wire.violations()
