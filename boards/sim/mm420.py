"""The MICROMASTER 420 as data: which parameters it has and how they leave the factory.

It is not a store: drive_parameters.py keeps the values, drive.py gives the readings theirs.
Numbers, names and ranges follow the manufacturer's parameter lists as far as those were at hand.
What a simulated bus cannot exercise (motor data, terminals, boosts) is left out, and so unknown to
the drive: it answers error 0 there. The other families (mm3.py, mm440.py, g110.py, v20.py,
g120.py, generic.py) have the same tables; each stands here with what its columns mean.

    Drive(clock, wire, 3, family=mm440)
"""

from boards.sim.process import (
    ACTUAL,
    CONTROL_1,
    CONTROL_2,
    COUNTERS,
    FAULT,
    FAULTS,
    INHIBITED,
    NO_COMMAND,
    READY,
    READY_TO_RUN,
    RECEIVED,
    RUNNING,
    STATUS_1,
    STATUS_2,
    STOPPING,
    WANTED,
)

NAME = "MICROMASTER 420"

# A row has the columns that drive_parameters.py names. CHANGE tells in which states the number may
# be changed, C commissioning, U running, T ready; a row without any is a reading. LEVEL is the
# least P0003 for changing it. A default that is a tuple has one value for each index.

ROWS = (
    # number, name, type, unit, indices, minimum, maximum, default, change, level, note
    (3, "user access level", "U16", "", 1, 0, 4, 1, "CUT", 1, "0 user list ... 3 expert"),
    (10, "commissioning parameter", "U16", "", 1, 0, 30, 0, "CT", 1, "the motor runs only at 0"),
    (20, "frequency setpoint before the ramp", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (21, "actual frequency", "F", "Hz", 1, None, None, 0.0, "", 2, "as delivered: PZD2"),
    (24, "actual output frequency", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (52, "status word 1", "U16", "", 1, None, None, 0, "", 2, "as delivered: PZD1"),
    (53, "status word 2", "U16", "", 1, None, None, 0, "", 2, "as delivered: PZD4"),
    (54, "control word 1", "U16", "", 1, None, None, 0, "", 3, "the one that is obeyed"),
    (55, "control word 2", "U16", "", 1, None, None, 0, "", 3, "PZD4"),
    (700, "command source", "U16", "", 1, 0, 6, 2, "CT", 1,
     "0 as delivered, 1 keypad, 2 terminals, 4 USS on BOP link, 5 USS on COM link, 6 CB"),
    (927, "parameters changeable via", "U16", "", 1, 0, 15, 15, "CUT", 2,
     "bit 0 CB, 1 keypad, 2 USS on BOP link, 3 USS on COM link"),
    (947, "last fault codes", "U16", "", 8, None, None, 0, "", 2,
     "[0] and [1] the present trip, [2] and [3] the one before, and so on"),
    (971, "transfer data from RAM to EEPROM", "U16", "", 1, 0, 1, 0, "CUT", 3,
     "1 saves and returns to 0"),
    (1000, "frequency setpoint source", "U16", "", 1, 0, 66, 2, "CT", 1,
     "units main, tens additional: 0 none, 1 motor potentiometer, 2 analog input, 3 fixed "
     "frequency, 4 USS on BOP link, 5 USS on COM link, 6 CB"),
    (1040, "setpoint of the motor potentiometer", "F", "Hz", 1, -650.0, 650.0, 5.0, "CUT", 2, ""),
    (1058, "JOG frequency right", "F", "Hz", 1, 0.0, 650.0, 5.0, "CUT", 2, ""),
    (1059, "JOG frequency left", "F", "Hz", 1, 0.0, 650.0, 5.0, "CUT", 2, ""),
    (1060, "JOG ramp-up time", "F", "s", 1, 0.0, 650.0, 10.0, "CUT", 2, "for 0...P1082"),
    (1061, "JOG ramp-down time", "F", "s", 1, 0.0, 650.0, 10.0, "CUT", 2, "for P1082...0"),
    (1080, "minimum frequency", "F", "Hz", 1, 0.0, 650.0, 0.0, "CUT", 1, ""),
    (1082, "maximum frequency", "F", "Hz", 1, 0.0, 650.0, 50.0, "CT", 1, ""),
    (1120, "ramp-up time", "F", "s", 1, 0.0, 650.0, 10.0, "CUT", 1, "for 0...P1082"),
    (1121, "ramp-down time", "F", "s", 1, 0.0, 650.0, 10.0, "CUT", 1, "for P1082...0, OFF1 too"),
    (1135, "OFF3 ramp-down time", "F", "s", 1, 0.0, 650.0, 5.0, "CUT", 2, "for P1082...0"),
    (2000, "reference frequency", "F", "Hz", 1, 1.0, 650.0, 50.0, "CT", 2, "4000h in PZD"),
    (2009, "USS denormalisation", "U16", "", 2, 0, 1, 0, "CT", 3, "1: PZD2 is 0.01 Hz"),
    (2010, "USS baud rate", "U16", "", 2, 3, 12, 6, "CUT", 2,
     "a code, see BAUD_CODES; lists say 3...9, the operating instructions time rates to 115200"),
    (2011, "USS address", "U16", "", 2, 0, 31, 0, "CUT", 2, ""),
    (2012, "USS PZD length", "U16", "words", 2, 0, 4, 2, "CUT", 3, ""),
    (2013, "USS PKW length", "U16", "words", 2, 0, 127, 127, "CUT", 3, "127: variable"),
    (2014, "USS telegram off time", "U16", "ms", 2, 0, 65535, 0, "CT", 3, "0: not supervised"),
    (2018, "PZD from COM link", "U16", "", 4, None, None, 0, "", 3, ""),
    (2019, "PZD to COM link", "U32", "", 4, 0, 0x0FA00000, (0x00340000, 0x00150000, 0, 0x00350000),
     "CT", 3, "number in the high word, index in the low one"),
    (2024, "USS error-free telegrams", "U16", "", 2, None, None, 0, "", 3, ""),
    (2025, "USS rejected telegrams", "U16", "", 2, None, None, 0, "", 3, "r2026 ... r2031"),
    (2026, "USS character frame errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2027, "USS overrun errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2028, "USS parity errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2029, "USS start not identified", "U16", "", 2, None, None, 0, "", 3, ""),
    (2030, "USS BCC errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2031, "USS length errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2036, "control word 1 from COM link", "U16", "", 1, None, None, 0, "", 3, ""),
    (2037, "control word 2 from COM link", "U16", "", 1, None, None, 0, "", 3, ""),
    (2155, "threshold frequency f_1", "F", "Hz", 1, 0.0, 650.0, 30.0, "CUT", 3, "r0053 bits 4, 5"),
    (2164, "hysteresis of the deviation", "F", "Hz", 1, 0.0, 10.0, 3.0, "CUT", 3, "r0052 bit 8"),
    (2167, "switch-off frequency f_off", "F", "Hz", 1, 0.0, 10.0, 1.0, "CUT", 3, "r0053 bit 1"),
)  # fmt: skip

# Discrete settings: anything else between the limits is refused with error 104.
PERMITTED = {
    10: (0, 1, 2, 29, 30),
    700: (0, 1, 2, 4, 5, 6),
    1000: tuple(10 * additional + main for additional in range(7) for main in range(7)),
    2013: (0, 3, 4, 127),
    # What the simulated drive can send: nothing, or one of these readings.
    2019: tuple(number << 16 for number in (0, 20, 21, 24, 52, 53, 54, 55)),
}

# A code of the baud rate to bits a second.
BAUD_CODES = {
    3: 1200, 4: 2400, 5: 4800, 6: 9600, 7: 19200, 8: 38400, 9: 57600, 10: 76800, 11: 93750,
    12: 115200,
}  # fmt: skip

# How somebody has set it up for a panel on its RS-485 terminals: index 0 of each number. Address
# and baud rate come on top.
COMMISSIONED = {3: 3, 700: 5, 1000: 5, 2012: 2, 2013: 4}

# The numbers of the link's own settings; None: the family has none, and `layout` holds, the PKW
# and the PZD words. `sent`: what the PZD words carry, None: ZSW and the actual value. `retained`:
# a number that, other than 0, has every change kept in the EEPROM. `off time` is in microseconds
# times `unit us`; it runs from the first telegram on, or from the first one with process data;
# `fault` is what it trips with. `save`: 1 saves all, `acknowledge`: 1 acknowledges a fault; both
# return to 0. `broadcast`: whether the family takes one (optional: USS specification A-3).
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
    "save": 971,
    "retained": None,
    "acknowledge": None,
    "broadcast": True,
}

# A setting that process.py goes by, the number that it comes from, and by what it is divided.
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
)

# Values of the command source with which the drive does not obey this bus, and the control word
# that it obeys then.
OTHER_COMMANDS = {0: NO_COMMAND, 1: NO_COMMAND, 2: NO_COMMAND, 4: 0, 6: 0}

# Values of the setpoint source that do not mean what its digits say: units main, tens additional.
SETPOINT_SOURCES = {}

# A reading: what it shows, and by what a frequency is multiplied, or where a list begins.
READINGS = {
    20: (WANTED, 1),
    21: (ACTUAL, 1),
    24: (ACTUAL, 1),
    52: (STATUS_1, 0),
    53: (STATUS_2, 0),
    54: (CONTROL_1, 0),
    55: (CONTROL_2, 0),
    947: (FAULTS, 0),
    2018: (RECEIVED, 0),
    2024: (COUNTERS, 0),
    2025: (COUNTERS, 1),
    2026: (COUNTERS, 2),
    2027: (COUNTERS, 3),
    2028: (COUNTERS, 4),
    2029: (COUNTERS, 5),
    2030: (COUNTERS, 6),
    2031: (COUNTERS, 7),
    2036: (RECEIVED, 0),
    2037: (RECEIVED, 3),
}

# What the process data look like. `states`: bits of ZSW, here 0 to 3 and 6, which exclude each
# other on a MICROMASTER 4, and those that never change: 9 control requested, 11 no current limit,
# 12 (1 in every capture), 13 no motor overload, 15 no inverter overload. `right at zero`: ZSW bit
# 14 of a motor that stands. `signed`: the actual value; else its size, and the direction is bit
# 14. `two directions`: a bit of STW for each, 11 and 12, in the place of one that reverses.
# `absolute`: the value of `scaling` with which setpoint and actual value are in 0.01 Hz, None:
# there is none. `obeyed bits`: of STW. `control fault`: trips when STW bit 10 drops while it runs.
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
}

# The parameter channel. `tasks`: AKs that it knows, the others are refused with error 106.
# `pages`: IND names numbers from 2000 on. `first index` of an array, as in IND. `scalar as array`:
# array tasks reach the only element of a number, with index 0 or 1 (RM420). `elements`: those of
# a description (task 4). `neighbours`: numbers told with error 0 in variable length, the next
# existing one, and the one before. `texts`: (number, field, element): text, None: no texts.
# `level`: the number of the access level. `rights`: a number and the bit of it that lets this bus
# change parameters, None: nothing forbids it.
CHANNEL = {
    "tasks": (1, 2, 3, 6, 7, 8, 9, 11, 12, 13, 14),
    "pages": True,
    "first index": 0,
    "scalar as array": True,
    "elements": (),
    "neighbours": 1,
    "texts": None,
    "level": 3,
    "rights": (927, 0x0008),
}
