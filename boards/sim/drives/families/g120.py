# SPDX-License-Identifier: MIT
"""The SINAMICS G120, second generation (CU230-2, CU240-2, G120C), as data: a PROFIdrive.

Tables and columns are those of mm420.py. Bits 0 to 2 of its ZSW add up (idle EB31, running EF37),
there is no jog and no broadcast, and it trips when STW bit 10 drops while it runs. Frequencies are
speeds, in 1/min of a motor with two pole pairs. Link and words: G120 manuals; the selection of
numbers, their ranges and defaults are general knowledge.

    Drive(clock, wire, 4, family=g120)      # p0015 = 21: USS has the drive
"""

from boards.sim.drives.words import (
    ACTUAL,
    CONTROL_1,
    CURRENT,
    DC_LINK,
    EXTERNAL,
    FAULT,
    FAULT_COUNT,
    FAULT_TIMES,
    FAULT_VALUES,
    FAULTS,
    HELD_DOWN,
    HOT,
    INHIBITED,
    MOTOR_TEMPERATURE,
    NO_COMMAND,
    OVERCURRENT,
    OVERHEAT,
    OVERVOLTAGE,
    POWER,
    READY,
    READY_TO_RUN,
    RECEIVED,
    RUNNING,
    STATUS_1,
    STOPPING,
    STRAINED,
    TORQUE,
    UNDERVOLTAGE,
    VOLTAGE,
    WANTED,
    WARNINGS,
)
from boards.sim.drives.power import restart, sources
from boards.sim.drives.parameters import in_single_precision
from boards.sim.drives.operations import CLEAR_FAULTS, RESET, SAVE

NAME = "SINAMICS G120"

RPM_PER_HZ = 30

ROWS = in_single_precision((
    # number, name, type, unit, indices, minimum, maximum, default, change, level, note
    (3, "access level", "U16", "", 1, 0, 4, 3, "CUT", 1, ""),
    (10, "commissioning", "U16", "", 1, 0, 49, 0, "CT", 1, "the motor runs only at 0"),
    (15, "macro drive unit", "U16", "", 1, 0, 21, 12, "CT", 1, "21: USS"),
    (18, "firmware version", "U32", "", 1, None, None, 4700000, "", 3, ""),
    (20, "speed setpoint", "F", "1/min", 1, None, None, 0.0, "", 2, ""),
    (21, "actual speed", "F", "1/min", 1, None, None, 0.0, "", 2, ""),
    (22, "actual speed, 1/min", "F", "1/min", 1, None, None, 0.0, "", 3, ""),
    (24, "output frequency", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (25, "output voltage", "F", "V", 1, None, None, 0.0, "", 2, ""),
    (26, "DC link voltage", "F", "V", 1, None, None, 0.0, "", 2, ""),
    (27, "output current", "F", "A", 1, None, None, 0.0, "", 2, ""),
    (31, "torque", "F", "Nm", 1, None, None, 0.0, "", 2, ""),
    (32, "power", "F", "kW", 1, None, None, 0.0, "", 2, ""),
    (35, "motor temperature", "F", "C", 1, None, None, 20.0, "", 2, ""),
    (52, "status word 1", "U16", "", 1, None, None, 0, "", 2, ""),
    (54, "control word 1", "U16", "", 1, None, None, 0, "", 2, ""),
    (63, "actual speed, smoothed", "F", "1/min", 1, None, None, 0.0, "", 3, "p2051[1]"),
    (304, "rated motor voltage", "U16", "V", 1, 1, 20000, 400, "C", 1, ""),
    (305, "rated motor current", "F", "A", 1, 0.01, 10000.0, 2.0, "C", 1, ""),
    (307, "rated motor power", "F", "kW", 1, 0.01, 100000.0, 0.75, "C", 1, ""),
    (310, "rated motor frequency", "F", "Hz", 1, 1.0, 650.0, 50.0, "C", 1, ""),
    (311, "rated motor speed", "F", "1/min", 1, 1.0, 210000.0, 1395.0, "C", 1, ""),
    (722, "digital inputs", "U32", "", 1, None, None, 0, "", 2, ""),
    (840, "ON, source", "U32", "", 1, 0, 0x0FFF0000, 0x02D20000, "CT", 3, "p0015 sets it"),
    (945, "fault code", "U16", "", 8, None, None, 0, "", 3, ""),
    (947, "fault number", "U16", "", 8, None, None, 0, "", 3, ""),
    (948, "fault times", "U32", "ms", 8, None, None, 0, "", 3, ""),
    (949, "fault values", "U32", "", 8, None, None, 0, "", 3, ""),
    (952, "number of faults", "U16", "", 1, 0, 8, 0, "CT", 3, "0 clears"),
    (970, "reset drive parameters", "U16", "", 1, 0, 1, 0, "C", 1, "1 resets and returns to 0"),
    (971, "save parameters", "U16", "", 1, 0, 1, 0, "CUT", 3, "1 saves and returns to 0"),
    (1070, "main setpoint, source", "U32", "", 1, 0, 0x0FFF0000, 0x02F30000, "CT", 3,
     "p0015 sets it"),
    (1080, "minimum speed", "F", "1/min", 1, 0.0, 210000.0, 0.0, "CT", 1, ""),
    (1082, "maximum speed", "F", "1/min", 1, 0.0, 210000.0, 1500.0, "CT", 1, ""),
    (1120, "ramp-up time", "F", "s", 1, 0.0, 999999.0, 10.0, "CUT", 1, "for 0...p1082"),
    (1121, "ramp-down time", "F", "s", 1, 0.0, 999999.0, 10.0, "CUT", 1, "for p1082...0"),
    (1135, "OFF3 ramp-down time", "F", "s", 1, 0.0, 600.0, 3.0, "CUT", 2, "for p1082...0"),
    (1200, "flying start", "U16", "", 1, 0, 4, 0, "CUT", 3, "see restart.py"),
    (1210, "automatic restart", "U16", "", 1, 0, 6, 0, "CUT", 3, "see restart.py"),
    (2000, "reference speed", "F", "1/min", 1, 6.0, 210000.0, 1500.0, "CT", 2, "4000h in PZD"),
    (2020, "baud rate", "U16", "", 1, 4, 13, 8, "CUT", 2, "a code, see BAUD_CODES"),
    (2021, "address", "U16", "", 1, 0, 31, 0, "CUT", 2, ""),
    (2022, "USS PZD length", "U16", "words", 1, 0, 8, 2, "CUT", 2, ""),
    (2023, "USS PKW length", "U16", "words", 1, 0, 127, 127, "CUT", 2, "127: variable"),
    (2030, "fieldbus protocol", "U16", "", 1, 0, 10, 1, "T", 1, "1 USS; from power-up on"),
    (2040, "fieldbus monitoring time", "U16", "ms", 1, 0, 65535, 100, "CUT", 3, "0: none"),
    (2050, "PZD received", "U16", "", 8, None, None, 0, "", 3, ""),
    (2051, "PZD sent", "U32", "", 8, 0, 0x7FFFFFFF, (0x08290000, 0x003F0000, 0, 0, 0, 0, 0, 0),
     "CT", 3, "number in the high word, index in the low one"),
    (2089, "status word 1 to be sent", "U16", "", 1, None, None, 0, "", 3, "p2051[0]"),
    (2122, "warning codes", "U16", "", 8, None, None, 0, "", 3, ""),
    (2141, "speed threshold 1", "F", "1/min", 1, 0.0, 210000.0, 5.0, "CUT", 3, "ZSW bit 10"),
))  # fmt: skip

PERMITTED = {
    15: (12, 17, 18, 19, 20, 21),
    1200: (0, 1, 4),
    1210: (0, 1, 4, 6),
    2023: (0, 3, 4, 127),
    # What the simulated drive can send: nothing, or one of these readings.
    2051: tuple(number << 16 for number in (0, 20, 21, 52, 54, 63, 2089)),
}

BAUD_CODES = {
    4: 2400, 5: 4800, 6: 9600, 7: 19200, 8: 38400, 9: 57600, 10: 76800, 11: 93750, 12: 115200,
    13: 187500,
}  # fmt: skip

COMMISSIONED = {15: 21, 2022: 2, 2023: 127, 2040: 0}

LINK = {
    "baud": 2020,
    "address": 2021,
    "pzd words": 2022,
    "pkw words": 2023,
    "layout": None,
    "off time": 2040,
    "unit us": 1_000,
    "from process data": False,
    "fault": 1910,
    "sent": 2051,
    "retained": None,
    "protocol": 2030,
    "broadcast": False,
    "index": 0,
}

SETTINGS = (
    ("commissioning", 10, 1),
    ("command_source", 15, 1),
    ("setpoint_source", 15, 1),
    ("minimum_hz", 1080, RPM_PER_HZ),
    ("maximum_hz", 1082, RPM_PER_HZ),
    ("reached_hz", 2141, RPM_PER_HZ),
    ("up_s", 1120, 1),
    ("down_s", 1121, 1),
    ("off3_s", 1135, 1),
    ("reference_hz", 2000, RPM_PER_HZ),
    ("on_source", 840, 1),
    ("main_source", 1070, 1),
    ("flying_start", 1200, 1),
    ("auto_restart", 1210, 1),
)

# The macros without USS.
OTHER_COMMANDS = {macro: NO_COMMAND for macro in (12, 17, 18, 19, 20)}
SOURCES = sources.G120
SETPOINT_SOURCES = {12: 0, 17: 0, 18: 0, 19: 0, 20: 0, 21: 5}

READINGS = {
    20: (WANTED, RPM_PER_HZ),
    21: (ACTUAL, RPM_PER_HZ),
    22: (ACTUAL, RPM_PER_HZ),
    24: (ACTUAL, 1),
    25: (VOLTAGE, 0),
    26: (DC_LINK, 0),
    27: (CURRENT, 0),
    31: (TORQUE, 0),
    32: (POWER, 0),
    35: (MOTOR_TEMPERATURE, 0),
    52: (STATUS_1, 0),
    54: (CONTROL_1, 0),
    63: (ACTUAL, RPM_PER_HZ),
    945: (FAULTS, 0),
    947: (FAULTS, 0),
    948: (FAULT_TIMES, 0),
    949: (FAULT_VALUES, 0),
    952: (FAULT_COUNT, 0),
    2050: (RECEIVED, 0),
    2089: (STATUS_1, 0),
    2122: (WARNINGS, 0),
}

OPERATIONS = {952: (CLEAR_FAULTS, 0), 970: (RESET, 10), 971: (SAVE, 0)}
ONLY_ZERO = (952,)
KEPT = (2020, 2021, 2030)
QUICK_COMMISSIONING = ()
TERMINALS = None

STYLE = {
    # The states add up; bits 9, 11, 13 and 15 never change here.
    "states": {
        INHIBITED: 0xAA40,
        READY: 0xAA01,
        READY_TO_RUN: 0xAA03,
        RUNNING: 0xAA07,
        STOPPING: 0xAA07,
        FAULT: 0xAA48,
    },
    "right at zero": True,
    "signed": True,
    "two directions": False,
    "absolute": None,
    "obeyed bits": 0xFCFF,  # 8 and 9 are reserved
    "control fault": 7220,
    "restarts": restart.G120,
    "faults": {
        OVERCURRENT: 30001,
        OVERVOLTAGE: 30002,
        UNDERVOLTAGE: 30003,
        OVERHEAT: 7011,
        EXTERNAL: 7860,
    },
    "warnings": ((STRAINED, 7805), (HOT, 7012), (HELD_DOWN, 7400)),
}

CHANNEL = {
    "tasks": (1, 2, 3, 4, 6, 7, 8, 9, 11, 12, 13, 14),
    "pages": True,
    "first index": 0,
    "plain index": True,
    "scalar as array": True,
    "elements": (1, 2, 7, 8, 9),
    "variable elements": (3, 4, 6, 255),
    "neighbours": 1,
    "texts": None,
    "level": 3,
    "user list": None,
    "rights": None,
    "steps": (10, {970: 30}),
    "active": {},
    "tightened": None,
}
