# SPDX-License-Identifier: MIT
"""The MICROMASTER 3 as data: 3 + 2 words, numbers below 1000, 16-bit values, no index.

Tables and columns are those of mm420.py. Except the layout, the control word 0C7Fh and IND 0,
everything here is general knowledge, unverified: numbers, units (0.1 s, 0.1 Hz, or 0.01 Hz when
P095 is not 0), the direction bits, the fault number. A change goes into the EEPROM with P971 = 1.

    Drive(clock, wire, 2, {93: 2}, family=mm3)
"""

from boards.sim.drives.words import (
    ACTUAL,
    CURRENT,
    DC_LINK,
    EXTERNAL,
    FAULT,
    FAULTS,
    HOT,
    INHIBITED,
    LIMITED,
    NO_COMMAND,
    OVERCURRENT,
    OVERHEAT,
    OVERVOLTAGE,
    READY,
    READY_TO_RUN,
    RUNNING,
    SPEED,
    STEPS,
    STOPPING,
    TORQUE,
    UNDERVOLTAGE,
    VOLTAGE,
    WANTED,
)
from boards.sim.drives.power import restart, sources
from boards.sim.drives.operations import RESET

NAME = "MICROMASTER 3"

ROWS = (
    # number, name, type, unit, indices, minimum, maximum, default, change, level, note
    (0, "operating display", "U16", "", 1, None, None, 0, "", 0, "the actual frequency"),
    (2, "ramp-up time", "U16", "0.1 s", 1, 0, 6500, 100, "CUT", 0, ""),
    (3, "ramp-down time", "U16", "0.1 s", 1, 0, 6500, 100, "CUT", 0, ""),
    (5, "digital setpoint", "U16", "", 1, 0, 65000, 50, "CUT", 0, "of the keypad"),
    (6, "setpoint type", "U16", "", 1, 0, 2, 0, "CT", 0, ""),
    (7, "keypad control", "U16", "", 1, 0, 1, 1, "CT", 0, ""),
    (9, "access", "U16", "", 1, 0, 3, 0, "CUT", 0, "3: all"),
    (12, "minimum frequency", "U16", "", 1, 0, 65000, 0, "CUT", 3, ""),
    (13, "maximum frequency", "U16", "", 1, 0, 65000, 500, "CUT", 3, ""),
    (31, "JOG frequency right", "U16", "", 1, 0, 65000, 50, "CUT", 3, ""),
    (32, "JOG frequency left", "U16", "", 1, 0, 65000, 50, "CUT", 3, ""),
    (33, "JOG ramp-up time", "U16", "0.1 s", 1, 0, 6500, 100, "CUT", 3, ""),
    (34, "JOG ramp-down time", "U16", "0.1 s", 1, 0, 6500, 100, "CUT", 3, ""),
    (51, "function of digital input 1", "U16", "", 1, 0, 19, 1, "CT", 3, ""),
    (52, "function of digital input 2", "U16", "", 1, 0, 19, 2, "CT", 3, ""),
    (53, "function of digital input 3", "U16", "", 1, 0, 19, 6, "CT", 3, ""),
    (81, "rated motor frequency", "U16", "", 1, 0, 65000, 500, "CT", 3, ""),
    (82, "rated motor speed", "U16", "1/min", 1, 0, 9999, 1390, "CT", 3, ""),
    (83, "rated motor current", "U16", "0.1 A", 1, 1, 9999, 33, "CT", 3, ""),
    (84, "rated motor voltage", "U16", "V", 1, 0, 1000, 230, "CT", 3, ""),
    (85, "rated motor power", "U16", "0.01 kW", 1, 12, 250, 75, "CT", 3, ""),
    (91, "slave address", "U16", "", 1, 0, 30, 0, "CUT", 3, ""),
    (92, "baud rate", "U16", "", 1, 3, 7, 6, "CUT", 3, "a code, see BAUD_CODES"),
    (93, "time-out", "U16", "s", 1, 0, 240, 0, "CUT", 3, "0: not supervised"),
    (94, "nominal system setpoint", "U16", "", 1, 1, 65000, 500, "CT", 3, "4000h"),
    (95, "USS compatibility", "U16", "", 1, 0, 2, 0, "CT", 3,
     "frequencies in 0: 0.1 Hz, 1: 0.01 Hz, 2: 0.01 Hz, the setpoint as well"),
    (131, "frequency setpoint", "U16", "", 1, None, None, 0, "", 3, ""),
    (132, "motor current", "U16", "0.1 A", 1, None, None, 0, "", 3, ""),
    (133, "motor torque", "U16", "%", 1, None, None, 0, "", 3, ""),
    (134, "DC link voltage", "U16", "V", 1, None, None, 0, "", 3, ""),
    (135, "motor speed", "U16", "1/min", 1, None, None, 0, "", 3, ""),
    (137, "output voltage", "U16", "V", 1, None, None, 0, "", 3, ""),
    (140, "last fault code", "U16", "", 1, None, None, 0, "", 3, ""),
    (910, "local or remote mode", "U16", "", 1, 0, 4, 0, "CT", 3,
     "0 local, 1 remote, 2 remote setpoint, 3 remote control, 4 local, read and written remotely"),
    (922, "software version", "U16", "", 1, None, None, 318, "", 3, ""),
    (930, "most recent fault code", "U16", "", 1, None, None, 0, "", 3, ""),
    (931, "most recent warning", "U16", "", 1, None, None, 0, "", 3, ""),
    (944, "reset to factory settings", "U16", "", 1, 0, 1, 0, "CT", 3, "1 resets, returns to 0"),
    (971, "EEPROM storage", "U16", "", 1, 0, 1, 1, "CUT", 3, "1: changes outlive the power"),
)  # fmt: skip

PERMITTED = {}

BAUD_CODES = {3: 1200, 4: 2400, 5: 4800, 6: 9600, 7: 19200}

COMMISSIONED = {9: 3, 910: 1}

LINK = {
    "baud": 92,
    "address": 91,
    "pzd words": None,
    "pkw words": None,
    "layout": (3, 2),
    "off time": 93,
    "unit us": 1_000_000,
    "from process data": False,
    "fault": 8,
    "sent": None,
    "retained": 971,
    "protocol": None,
    "broadcast": False,
    "index": 0,
}

SETTINGS = (
    ("scaling", 95, 1),
    ("command_source", 910, 1),
    ("setpoint_source", 910, 1),
    ("jog_right_hz", 31, STEPS),
    ("jog_left_hz", 32, STEPS),
    ("jog_up_s", 33, 10),
    ("jog_down_s", 34, 10),
    ("minimum_hz", 12, STEPS),
    ("maximum_hz", 13, STEPS),
    ("reached_hz", 13, STEPS),
    ("up_s", 2, 10),
    ("down_s", 3, 10),
    ("reference_hz", 94, STEPS),
    ("rated_hz", 81, STEPS),
    ("rated_rpm", 82, 1),
    ("rated_a", 83, 10),
    ("rated_v", 84, 1),
    ("rated_kw", 85, 100),
)

OTHER_COMMANDS = {0: NO_COMMAND, 2: NO_COMMAND, 4: NO_COMMAND}
SOURCES = sources.FIXED
SETPOINT_SOURCES = {0: 0, 1: 5, 2: 5, 3: 0, 4: 0}

READINGS = {
    0: (ACTUAL, STEPS),
    131: (WANTED, STEPS),
    132: (CURRENT, 10),
    133: (TORQUE, 1),
    134: (DC_LINK, 1),
    135: (SPEED, 1),
    137: (VOLTAGE, 1),
    140: (FAULTS, 2),
    930: (FAULTS, 0),
}

OPERATIONS = {944: (RESET, 10)}
ONLY_ZERO = ()
KEPT = (91, 92, 971)
QUICK_COMMISSIONING = ()
TERMINALS = None

STYLE = {
    "states": {
        INHIBITED: 0xBA41,
        READY: 0xBA01,
        READY_TO_RUN: 0xBA02,
        RUNNING: 0xBA04,
        STOPPING: 0xBA04,
        FAULT: 0xBA48,
    },
    "right at zero": True,
    "signed": False,
    "two directions": True,
    "absolute": 2,
    "obeyed bits": 0xFFFF,
    "control fault": 0,
    "restarts": restart.PLAIN,
    "faults": {
        OVERCURRENT: 2,
        OVERVOLTAGE: 1,
        UNDERVOLTAGE: 9,
        OVERHEAT: 74,
        EXTERNAL: 12,
    },
    "warnings": ((LIMITED, 2), (HOT, 74)),
}

CHANNEL = {
    "tasks": (1, 2),
    "pages": False,
    "first index": 0,
    "plain index": True,
    "scalar as array": False,
    "elements": (),
    "variable elements": (),
    "neighbours": 0,
    "texts": None,
    "level": 9,
    "user list": None,
    "rights": None,
    "steps": None,
    "active": {},
    "tightened": None,
}
