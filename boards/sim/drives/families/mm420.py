# SPDX-License-Identifier: MIT
"""The MICROMASTER 420 as data: which parameters it has and how they leave the factory.

parameters.py keeps the values, readings.py supplies those of the readings. The rows are those of
mm4_parameters.py that an MM420 has. The other families (mm3.py, mm440.py, g110.py, v20.py,
g120.py, generic.py) have the same tables; this file explains each table and its columns.

    Drive(clock, wire, 3, family=mm440)
"""

from boards.sim.drives.words import (
    BOTH_JOGS,
    EXTERNAL,
    FAULT,
    HELD_DOWN,
    HOT,
    INHIBITED,
    LIMITED,
    LOW_SUPPLY,
    NO_COMMAND,
    OVERCURRENT,
    OVERHEAT,
    OVERVOLTAGE,
    READY,
    READY_TO_RUN,
    RUNNING,
    STOPPING,
    STRAINED,
    UNDERVOLTAGE,
)
from boards.sim.drives.power import restart, sources
from boards.sim.drives.parameters import only, rows_like
from boards.sim.drives.operations import (
    ACKNOWLEDGE,
    CALCULATE,
    CLEAR_ENERGY,
    CLEAR_FAULTS,
    CLEAR_WARNINGS,
    END_COMMISSIONING,
    RESET,
    SAVE,
)
from boards.sim.drives.families.mm4_parameters import MM420, rows_of
from boards.sim.drives.families import mm4_parameters, mm4_readings

NAME = "MICROMASTER 420"

# A row has the columns that parameters.py names; mm4_parameters.py tells what they mean.
ROWS = rows_like(
    rows_of(MM420),
    (
        # number, name, type, unit, indices, minimum, maximum, default, change, level, note
        (335, "motor cooling", "U16", "", 1, 0, 1, 0, "CT", 2, ""),
        (340, "calculate motor data", "U16", "", 1, 0, 1, 0, "CT", 2, "returns to 0"),
        (704, "function of digital input 4", "U16", "", 1, 0, 99, 0, "CT", 2, ""),
        (720, "number of digital inputs", "U16", "", 1, None, None, 3, "", 3, ""),
        (750, "number of analog inputs", "U16", "", 1, None, None, 1, "", 3, ""),
        (756, "type of the analog input", "U16", "", 1, 0, 1, 0, "CT", 2, ""),
        (776, "type of the analog output", "U16", "", 1, 0, 0, 0, "CT", 2, "0...20 mA"),
        (1000, "frequency setpoint source", "U16", "", 1, 0, 66, 2, "CT", 1,
         "units main, tens additional: 0 none, 1 motor potentiometer, 2 analog input, 3 fixed "
         "frequency, 4 USS on BOP link, 5 USS on COM link, 6 CB"),
        (1300, "control mode", "U16", "", 1, 0, 3, 0, "CT", 2, ""),
        (2010, "USS baud rate", "U16", "", 2, 3, 12, 6, "CUT", 2,
         "lists say 3...9, the operating instructions time rates to 115200"),
        (2012, "USS PZD length", "U16", "words", 2, 0, 4, 2, "CUT", 3, ""),
    ),
)  # fmt: skip

# Discrete settings: the drive refuses any other value between the limits with error 104.
PERMITTED = only(mm4_parameters.PERMITTED, ROWS)
PERMITTED[1000] = tuple(10 * additional + main for additional in range(7) for main in range(7))
# What the simulated drive can send: nothing, or one of these readings.
SENT = (0, 20, 21, 22, 24, 25, 26, 27, 36, 52, 53, 54, 55, 67)
PERMITTED[2019] = tuple(number << 16 for number in SENT)

# A code of the baud rate to bits a second.
BAUD_CODES = {
    3: 1200, 4: 2400, 5: 4800, 6: 9600, 7: 19200, 8: 38400, 9: 57600, 10: 76800, 11: 93750,
    12: 115200,
}  # fmt: skip

# The settings for a panel on its RS-485 terminals: index 0 of each number. Address and baud rate
# are set in addition.
COMMISSIONED = {3: 3, 700: 5, 1000: 5, 2012: 2, 2013: 4}

# The numbers of the link's own settings; None: the family has none, and `layout` holds, the PKW
# and the PZD words. `sent`: what the PZD words carry, None: ZSW and the actual value. `retained`:
# a number that, other than 0, has every change kept in the EEPROM. `protocol`: a number that is 1
# where the connector speaks USS, from the next power-up on. `off time` is in microseconds
# times `unit us`; it runs from the first telegram on, or from the first one with process data;
# `fault` is what it trips with. `broadcast`: whether the family takes one (optional: USS
# specification A-3). `index`: of the link among the family's, where its numbers have one.
LINK = {
    "baud": 2010,
    "address": 2011,
    "pzd words": 2012,
    "pkw words": 2013,
    "layout": None,
    "off time": 2014,
    "unit us": 1_000,
    "from process data": False,
    "fault": 72,
    "sent": 2019,
    "retained": None,
    "protocol": None,
    "broadcast": True,
    "index": 0,
}

# The settings that process.py uses: name, the number of the parameter, the divisor.
SETTINGS = (
    ("commissioning", 10, 1),
    ("command_source", 700, 1),
    ("setpoint_source", 1000, 1),
    ("scaling", 2009, 1),
    ("potentiometer_hz", 1040, 1),
    ("jog_right_hz", 1058, 1),
    ("jog_left_hz", 1059, 1),
    ("jog_up_s", 1060, 1),
    ("jog_down_s", 1061, 1),
    ("minimum_hz", 1080, 1),
    ("maximum_hz", 1082, 1),
    ("reached_hz", 1082, 1),
    ("up_s", 1120, 1),
    ("down_s", 1121, 1),
    ("off3_s", 1135, 1),
    ("reference_hz", 2000, 1),
    ("threshold_hz", 2155, 1),
    ("tolerance_hz", 2164, 1),
    ("slow_hz", 2167, 1),
    ("rated_v", 304, 1),
    ("rated_a", 305, 1),
    ("rated_kw", 307, 1),
    ("rated_hz", 310, 1),
    ("rated_rpm", 311, 1),
    ("magnetising_percent", 320, 1),
    ("heat_s", 611, 1),
    ("overload_percent", 640, 1),
    ("fixed_1_hz", 1001, 1),
    ("fixed_2_hz", 1002, 1),
    ("fixed_3_hz", 1003, 1),
    ("fixed_4_hz", 1004, 1),
    ("potentiometer_kept", 1031, 1),
    ("potentiometer_right", 1032, 1),
    ("skip_1_hz", 1091, 1),
    ("skip_2_hz", 1092, 1),
    ("skip_3_hz", 1093, 1),
    ("skip_4_hz", 1094, 1),
    ("skip_band_hz", 1101, 1),
    ("no_reverse", 1110, 1),
    ("flying_start", 1200, 1),
    ("auto_restart", 1210, 1),
    ("selection", 719, 1),
    ("on_source", 840, 1),
    ("main_source", 1070, 1),
    ("controller", 2200, 1),
    ("controller_source", 2253, 1),
    ("gain", 2280, 1),
    ("highest_percent", 2291, 1),
    ("lowest_percent", 2292, 1),
    ("brake", 1215, 1),
    ("vdc_controller", 1240, 1),
    ("reference_v", 2001, 1),
    ("reference_a", 2002, 1),
    ("reference_nm", 2003, 1),
    ("external_fault", 2106, 1),
    ("threshold_percent", 2170, 1),
    ("threshold_v", 2172, 1),
)

# Values of the command source with which the drive does not obey this bus, and the control word
# that it obeys then.
OTHER_COMMANDS = {0: NO_COMMAND, 1: NO_COMMAND, 2: NO_COMMAND, 4: 0, 6: 0}

# What P0700 and P1000 connect: sources.py tells the columns.
SOURCES = sources.MM4

# Values of the setpoint source whose digits (units main, tens additional) do not tell the meaning.
SETPOINT_SOURCES = {}

READINGS = only(mm4_readings.READINGS, ROWS)

# A number that makes the drive do something: what, and for how many seconds it is silent then (a
# guess, see operations.py; for P0971 0, because most masters do not expect any).
OPERATIONS = {
    40: (CLEAR_ENERGY, 0),
    340: (CALCULATE, 5),
    952: (CLEAR_FAULTS, 0),
    970: (RESET, 10),
    971: (SAVE, 0),
    1910: (CALCULATE, 30),
    2111: (CLEAR_WARNINGS, 0),
    3900: (END_COMMISSIONING, 10),
    3981: (ACKNOWLEDGE, 0),
}

# Of these the numbers that can be set to 0 alone (error 6); all others begin with another value.
ONLY_ZERO = (952, 2111)

# What a factory reset leaves alone (general knowledge), what quick commissioning has asked for,
# the first and the last number of the terminals: P3900 resets one or the other, or neither.
KEPT = (100, 918, 2010, 2011)
QUICK_COMMISSIONING = mm4_parameters.QUICK_COMMISSIONING
TERMINALS = mm4_parameters.TERMINALS

# What the process data look like. `states`: bits of ZSW, here 0 to 3 and 6, which exclude each
# other on a MICROMASTER 4, and those that never change: 9 control requested, 11 no current limit,
# 12 (1 in every capture), 13 no motor overload, 15 no inverter overload. `right at zero`: ZSW bit
# 14 of a motor that stands. `signed`: the actual value; else its size, and the direction is bit
# 14. `two directions`: a bit of STW for each, 11 and 12, in the place of one that reverses.
# `absolute`: the value of `scaling` with which setpoint and actual value are in 0.01 Hz, None:
# there is none. `obeyed bits`: of STW. `control fault`: trips when STW bit 10 drops while it runs.
# `restarts`: what it does when its mains are back, a table of restart.py.
# `faults` and `warnings`: its numbers for what it trips with and warns of by itself.
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
    "signed": True,
    "two directions": False,
    "absolute": 1,
    "obeyed bits": 0xFFFF,
    "control fault": 0,
    "restarts": restart.MM4,
    "faults": {
        OVERCURRENT: 1,
        OVERVOLTAGE: 2,
        UNDERVOLTAGE: 3,
        OVERHEAT: 11,
        EXTERNAL: 85,
    },
    "warnings": (
        (LIMITED, 501),
        (LOW_SUPPLY, 503),
        (STRAINED, 505),
        (HOT, 511),
        (HELD_DOWN, 911),
        (BOTH_JOGS, 923),
    ),
}

# The parameter channel. `tasks`: AKs that it knows, the others are refused with error 106.
# `pages`: IND names numbers from 2000 on. `first index` of an array, as in IND. `scalar as array`:
# array tasks reach the only element of a number, with index 0 or 1 (RM420). `elements`: those of
# a description (task 4), and those that it has in variable length besides; which ones is a choice.
# `neighbours`: numbers told with error 0 in variable length, the next existing one, and the one
# before. `texts`: (number, field, element): text, None: no texts. `level`: the number of the
# access level. `user list`: the numbers of the list that level 0 opens, of its lock and of its
# key. `rights`: a number and the bit of it that lets this bus change parameters, None: nothing
# forbids it. `steps`: the number of the commissioning step, and for numbers that can be changed in
# C alone the step that they need, where it is not 1. `active`: a number, another one that puts it
# out of use, and the values of that with which it counts. `tightened`: two numbers, a lower and an
# upper limit of something, which keep their order while it runs.
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
    "user list": (13, 11, 12),
    "rights": (927, 0x0008),
    "steps": (10, mm4_parameters.COMMISSIONING_STEPS),
    "active": mm4_parameters.ACTIVE,
    "tightened": (1080, 1082),
}
