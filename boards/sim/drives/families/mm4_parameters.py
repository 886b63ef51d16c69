# SPDX-License-Identifier: MIT
"""The parameters of the MICROMASTER 4 as data: one table, from which each family takes its rows.

A row has the columns that parameters.py names. CHANGE tells in which states the number may
be changed, C commissioning, U running, T ready; a row without any is a reading. LEVEL is the least
P0003 for changing it. A default that is a tuple has one value for each index. INDICES is a pair
if an MM440 and an MM420 differ, with 0 for the one that lacks the number.

    ROWS = rows_of(MM440)       # as parameters.py needs them

Numbers, names and ranges follow the manufacturer's parameter lists as far as those were at hand.
Other ranges and defaults, which are most of them, are general knowledge, unverified.
"""

from boards.sim.drives.power.sources import SELECTIONS
from boards.sim.drives.parameters import CHANGE, DEFAULT, INDICES, in_single_precision

MM440, MM420 = 0, 1  # the place in a pair

SETS = (3, 1)  # data sets, of commands or of the drive: data_sets.py tells which is in force
SETS_440 = (3, 0)
ONE_440 = (1, 0)
INPUTS = (2, 1)
WORDS = (8, 4)

# Sources: number in the high word, index or bit in the low one.
LAST_SOURCE = 0x0FA00000
PZD_SOURCES = (0x00340000, 0x00150000, 0, 0x00350000, 0, 0, 0, 0)

ROWS = (
    # number, name, type, unit, indices, minimum, maximum, default, change, level, note
    # operation and access
    (0, "operating display", "U16", "", 1, None, None, 0, "", 1, ""),
    (2, "drive state", "U16", "", 1, None, None, 1, "", 2,
     "0 commissioning 1 ready 2 fault 3 starting 4 running 5 stopping"),
    (3, "user access level", "U16", "", 1, 0, 4, 1, "CUT", 1,
     "0 user list 1 standard 2 extended 3 expert 4 service"),
    (4, "parameter filter", "U16", "", 1, 0, 22, 0, "CUT", 1, ""),
    (5, "display selection", "U16", "", SETS, 2, 2294, 21, "CUT", 2, ""),
    (6, "display mode", "U16", "", 1, 0, 4, 2, "CUT", 3, ""),
    (7, "backlight delay", "U16", "s", 1, 0, 2000, 0, "CUT", 3, ""),
    (10, "commissioning parameter", "U16", "", 1, 0, 30, 0, "CT", 1, "the motor runs only at 0"),
    (11, "lock of the user list", "U16", "", 1, 0, 65535, 0, "CUT", 3, ""),
    (12, "key of the user list", "U16", "", 1, 0, 65535, 0, "CUT", 3,
     "the list may be changed while P0012 is P0011"),
    (13, "user list", "U16", "", 20, 0, 65535, 0, "CUT", 3, ""),
    # readings
    (18, "firmware version", "F", "", 1, None, None, 2.11, "", 1, ""),
    (19, "keypad control word", "U16", "", 1, None, None, 0, "", 3, ""),
    (20, "frequency setpoint before the ramp", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (21, "actual frequency", "F", "Hz", 1, None, None, 0.0, "", 2, "as delivered: PZD2"),
    (22, "actual speed", "F", "1/min", 1, None, None, 0.0, "", 3, ""),
    (24, "actual output frequency", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (25, "output voltage", "F", "V", 1, None, None, 0.0, "", 2, ""),
    (26, "DC link voltage", "F", "V", 1, None, None, 560.0, "", 2, ""),
    (27, "output current", "F", "A", 1, None, None, 0.0, "", 2, ""),
    (31, "torque", "F", "Nm", ONE_440, None, None, 0.0, "", 2, ""),
    (32, "power", "F", "kW", ONE_440, None, None, 0.0, "", 2, ""),
    (34, "motor utilisation", "F", "%", 1, None, None, 0.0, "", 2, ""),
    (35, "motor temperature", "F", "C", SETS_440, None, None, 20.0, "", 2, ""),
    (36, "inverter utilisation", "F", "%", 1, None, None, 0.0, "", 4, ""),
    (37, "inverter temperature", "F", "C", (5, 2), None, None, 30.0, "", 3, ""),
    (38, "power factor", "F", "", 1, None, None, 0.0, "", 3, ""),
    (39, "energy meter", "F", "kWh", 1, None, None, 0.0, "", 2, ""),
    (40, "reset energy meter", "U16", "", 1, 0, 1, 0, "CT", 2, "1: begins at 0"),
    (50, "active command data set", "U16", "", ONE_440, None, None, 0, "", 2, ""),
    (51, "drive data set", "U16", "", (2, 0), None, None, 0, "", 2, "[0] selected, [1] active"),
    (52, "status word 1", "U16", "", 1, None, None, 0, "", 2, "as delivered: PZD1"),
    (53, "status word 2", "U16", "", 1, None, None, 0, "", 2, "as delivered: PZD4"),
    (54, "control word 1", "U16", "", 1, None, None, 0, "", 3, "the one that is obeyed"),
    (55, "control word 2", "U16", "", 1, None, None, 0, "", 3, "PZD4"),
    (56, "motor control status", "U16", "", 1, None, None, 0, "", 3, ""),
    (67, "actual current limit", "F", "A", 1, None, None, 3.0, "", 3, ""),
    (70, "DC link voltage, unfiltered", "F", "V", 1, None, None, 560.0, "", 3, ""),
    (72, "output voltage, unfiltered", "F", "V", 1, None, None, 0.0, "", 3, ""),
    # inverter and motor
    (100, "Europe / North America", "U16", "", 1, 0, 2, 0, "C", 1,
     "0 kW 50 Hz, 1 hp 60 Hz, 2 kW 60 Hz"),
    (201, "power stack code", "U16", "", 1, 0, 65535, 0, "C", 3, ""),
    (206, "rated inverter power", "F", "kW", 1, None, None, 0.75, "", 2, ""),
    (207, "rated inverter current", "F", "A", 1, None, None, 3.9, "", 2, ""),
    (208, "rated inverter voltage", "U32", "V", 1, None, None, 230, "", 2, ""),
    (209, "maximum inverter current", "F", "A", 1, None, None, 5.85, "", 2, ""),
    (290, "inverter overload reaction", "U16", "", 1, 0, 3, 2, "CT", 3, ""),
    (300, "motor type", "U16", "", SETS, 1, 2, 1, "C", 2, ""),
    (304, "rated motor voltage", "U16", "V", SETS, 10, 2000, 230, "C", 1, ""),
    (305, "rated motor current", "F", "A", SETS, 0.01, 10000.0, 3.25, "C", 1, ""),
    (307, "rated motor power", "F", "kW", SETS, 0.01, 2000.0, 0.75, "C", 1, "hp where P0100 is 1"),
    (308, "rated motor cos phi", "F", "", SETS, 0.0, 1.0, 0.0, "C", 2, "of P0100 = 0 and 2"),
    (309, "rated motor efficiency", "F", "%", SETS, 0.0, 99.9, 0.0, "C", 2, "of P0100 = 1"),
    (310, "rated motor frequency", "F", "Hz", SETS, 12.0, 650.0, 50.0, "C", 1, ""),
    (311, "rated motor speed", "U16", "1/min", SETS, 0, 40000, 1395, "C", 1, ""),
    (313, "pole pairs", "U16", "", 1, None, None, 2, "", 3, ""),
    (320, "magnetising current", "F", "%", SETS, 0.0, 99.0, 0.0, "CT", 3, ""),
    (330, "rated slip", "F", "%", 1, None, None, 7.0, "", 3, ""),
    (335, "motor cooling", "U16", "", SETS, 0, 3, 0, "CT", 2, ""),
    (340, "calculate motor data", "U16", "", SETS, 0, 4, 0, "CT", 2, "returns to 0"),
    (346, "magnetisation time", "F", "s", SETS, 0.0, 20.0, 1.0, "CUT", 3, ""),
    (347, "demagnetisation time", "F", "s", SETS, 0.0, 20.0, 1.0, "CUT", 3, ""),
    (350, "stator resistance", "F", "ohm", SETS, 1e-05, 2000.0, 4.0, "CUT", 2, ""),
    (610, "motor I2t reaction", "U16", "", SETS, 0, 2, 2, "CT", 3, ""),
    (611, "motor I2t time constant", "U16", "s", SETS, 0, 16000, 100, "CT", 2, ""),
    (640, "motor overload factor", "F", "%", SETS, 10.0, 400.0, 150.0, "CUT", 2, ""),
    # terminals
    (700, "command source", "U16", "", SETS, 0, 6, 2, "CT", 1,
     "0 as delivered 1 keypad 2 terminals 4 BOP link 5 USS 6 CB"),
    (701, "function of digital input 1", "U16", "", SETS, 0, 99, 1, "CT", 2, ""),
    (702, "function of digital input 2", "U16", "", SETS, 0, 99, 12, "CT", 2, ""),
    (703, "function of digital input 3", "U16", "", SETS, 0, 99, 9, "CT", 2, ""),
    (704, "function of digital input 4", "U16", "", SETS, 0, 99, 15, "CT", 2, ""),
    (705, "function of digital input 5", "U16", "", SETS_440, 0, 99, 15, "CT", 2, ""),
    (706, "function of digital input 6", "U16", "", SETS_440, 0, 99, 15, "CT", 2, ""),
    (707, "function of digital input 7", "U16", "", SETS_440, 0, 99, 0, "CT", 2, ""),
    (708, "function of digital input 8", "U16", "", SETS_440, 0, 99, 0, "CT", 2, ""),
    (719, "command and setpoint selection", "U16", "", SETS, 0, 66, 0, "CT", 3, ""),
    (720, "number of digital inputs", "U16", "", 1, None, None, 6, "", 3, ""),
    (722, "digital inputs", "U16", "", 1, None, None, 0, "", 2, ""),
    (724, "debounce of digital inputs", "U16", "", 1, 0, 3, 3, "CT", 3, ""),
    (725, "PNP or NPN inputs", "U16", "", 1, 0, 1, 1, "CT", 3, ""),
    (731, "source of digital output 1", "U32", "", SETS, 0, LAST_SOURCE, 0x00340003, "CUT", 2,
     "52:3, a fault"),
    (732, "source of digital output 2", "U32", "", SETS_440, 0, LAST_SOURCE, 0x00340007, "CUT", 2,
     "52:7, a warning"),
    (733, "source of digital output 3", "U32", "", SETS_440, 0, LAST_SOURCE, 0, "CUT", 2, ""),
    (747, "digital outputs", "U16", "", 1, None, None, 0, "", 3, ""),
    (748, "invert digital outputs", "U16", "", 1, 0, 7, 0, "CUT", 3, ""),
    (750, "number of analog inputs", "U16", "", 1, None, None, 2, "", 3, ""),
    (752, "analog input", "F", "V", INPUTS, None, None, 0.0, "", 2, ""),
    (753, "smoothing of the analog input", "U16", "ms", INPUTS, 0, 10000, 3, "CUT", 3, ""),
    (754, "analog input after scaling", "F", "%", INPUTS, None, None, 0.0, "", 2, ""),
    (755, "analog input after scaling", "I16", "", INPUTS, None, None, 0, "", 2,
     "4000h is 100 %"),
    (756, "type of the analog input", "U16", "", INPUTS, 0, 4, 0, "CT", 2, ""),
    (757, "analog input, x1", "F", "V", INPUTS, -20.0, 20.0, 0.0, "CUT", 2, ""),
    (758, "analog input, y1", "F", "%", INPUTS, -99999.9, 99999.9, 0.0, "CUT", 2, ""),
    (759, "analog input, x2", "F", "V", INPUTS, -20.0, 20.0, 10.0, "CUT", 2, ""),
    (760, "analog input, y2", "F", "%", INPUTS, -99999.9, 99999.9, 100.0, "CUT", 2, ""),
    (761, "analog input, dead band", "F", "V", INPUTS, 0.0, 20.0, 0.0, "CUT", 2, ""),
    (771, "source of the analog output", "U32", "", INPUTS, 0, LAST_SOURCE, 0x00150000, "CUT", 2,
     "21:0, the actual frequency"),
    (773, "smoothing of the analog output", "U16", "ms", INPUTS, 0, 1000, 2, "CUT", 3, ""),
    (774, "analog output", "F", "mA", INPUTS, None, None, 0.0, "", 2, ""),
    (776, "type of the analog output", "U16", "", INPUTS, 0, 1, 0, "CT", 2, ""),
    (777, "analog output, x1", "F", "%", INPUTS, -99999.0, 99999.0, 0.0, "CUT", 2, ""),
    (778, "analog output, y1", "F", "mA", INPUTS, 0.0, 20.0, 0.0, "CUT", 2, ""),
    (779, "analog output, x2", "F", "%", INPUTS, -99999.0, 99999.0, 100.0, "CUT", 2, ""),
    (780, "analog output, y2", "F", "mA", INPUTS, 0.0, 20.0, 20.0, "CUT", 2, ""),
    (781, "analog output, dead band", "F", "", INPUTS, 0.0, 20.0, 0.0, "CUT", 2, ""),
    # commands, faults, storage
    (810, "command data set, bit 0", "U32", "", 1, 0, 0x0FFF0000, 0, "CUT", 2, ""),
    (811, "command data set, bit 1", "U32", "", ONE_440, 0, 0x0FFF0000, 0, "CUT", 2, ""),
    (820, "drive data set, bit 0", "U32", "", ONE_440, 0, 0x0FFF0000, 0, "CT", 3, ""),
    (821, "drive data set, bit 1", "U32", "", ONE_440, 0, 0x0FFF0000, 0, "CT", 3, ""),
    (840, "source of ON", "U32", "", SETS, 0, LAST_SOURCE, 0x02D20000, "CT", 3,
     "722:0; P0700 sets it"),
    (918, "CB address", "U16", "", 1, 0, 65535, 3, "CT", 2, ""),
    (927, "parameters changeable via", "U16", "", 1, 0, 15, 15, "CUT", 2,
     "bit 0 CB, 1 keypad, 2 BOP link, 3 this bus"),
    (947, "last fault codes", "U16", "", 8, None, None, 0, "", 2,
     "[0] and [1] the present trip, [2] [3] the last, ..."),
    (948, "fault times", "U16", "", 12, None, None, 0, "", 3, ""),
    (949, "fault values", "U32", "", 8, None, None, 0, "", 3, ""),
    (952, "number of faults", "U16", "", 1, 0, 8, 0, "CT", 3, "0 clears"),
    (964, "firmware data", "U16", "", 5, None, None, (42, 420, 211, 2002, 402), "", 3, ""),
    (967, "control word 1", "U16", "", 1, None, None, 0, "", 3, ""),
    (968, "status word 1", "U16", "", 1, None, None, 0, "", 3, ""),
    (970, "factory reset", "U16", "", 1, 0, 1, 0, "C", 1, "1 resets and returns to 0"),
    (971, "transfer data from RAM to EEPROM", "U16", "", 1, 0, 1, 0, "CUT", 3,
     "1 saves and returns to 0"),
    # setpoints and ramps
    (1000, "frequency setpoint source", "U16", "", SETS, 0, 77, 2, "CT", 1,
     "units main, tens additional, see PERMITTED"),
    (1001, "fixed frequency 1", "F", "Hz", SETS, -650.0, 650.0, 0.0, "CUT", 2, ""),
    (1002, "fixed frequency 2", "F", "Hz", SETS, -650.0, 650.0, 5.0, "CUT", 2, ""),
    (1003, "fixed frequency 3", "F", "Hz", SETS, -650.0, 650.0, 10.0, "CUT", 2, ""),
    (1004, "fixed frequency 4", "F", "Hz", SETS, -650.0, 650.0, 15.0, "CUT", 2, ""),
    (1005, "fixed frequency 5", "F", "Hz", SETS, -650.0, 650.0, 20.0, "CUT", 2, ""),
    (1006, "fixed frequency 6", "F", "Hz", SETS, -650.0, 650.0, 25.0, "CUT", 2, ""),
    (1007, "fixed frequency 7", "F", "Hz", SETS, -650.0, 650.0, 30.0, "CUT", 2, ""),
    (1008, "fixed frequency 8", "F", "Hz", SETS_440, -650.0, 650.0, 35.0, "CUT", 2, ""),
    (1009, "fixed frequency 9", "F", "Hz", SETS_440, -650.0, 650.0, 40.0, "CUT", 2, ""),
    (1010, "fixed frequency 10", "F", "Hz", SETS_440, -650.0, 650.0, 45.0, "CUT", 2, ""),
    (1011, "fixed frequency 11", "F", "Hz", SETS_440, -650.0, 650.0, 50.0, "CUT", 2, ""),
    (1012, "fixed frequency 12", "F", "Hz", SETS_440, -650.0, 650.0, 55.0, "CUT", 2, ""),
    (1013, "fixed frequency 13", "F", "Hz", SETS_440, -650.0, 650.0, 60.0, "CUT", 2, ""),
    (1014, "fixed frequency 14", "F", "Hz", SETS_440, -650.0, 650.0, 65.0, "CUT", 2, ""),
    (1015, "fixed frequency 15", "F", "Hz", SETS_440, -650.0, 650.0, 65.0, "CUT", 2, ""),
    (1016, "fixed frequency mode, bit 0", "U16", "", 1, 1, 3, 1, "CT", 3, ""),
    (1024, "active fixed frequency", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (1031, "memory of the motor potentiometer", "U16", "", SETS, 0, 1, 0, "CUT", 2, ""),
    (1032, "motor potentiometer not reversed", "U16", "", 1, 0, 1, 1, "CT", 2, ""),
    (1040, "setpoint of the motor potentiometer", "F", "Hz", SETS, -650.0, 650.0, 5.0, "CUT", 2,
     "moved by STW bits 13, 14"),
    (1050, "output of the motor potentiometer", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (1058, "JOG frequency right", "F", "Hz", SETS, 0.0, 650.0, 5.0, "CUT", 2, ""),
    (1059, "JOG frequency left", "F", "Hz", SETS, 0.0, 650.0, 5.0, "CUT", 2, ""),
    (1060, "JOG ramp-up time", "F", "s", SETS, 0.0, 650.0, 10.0, "CUT", 2, "for 0...P1082"),
    (1061, "JOG ramp-down time", "F", "s", SETS, 0.0, 650.0, 10.0, "CUT", 2, "for P1082...0"),
    (1070, "source of the main setpoint", "U32", "", SETS, 0, LAST_SOURCE, 0x02F30000, "CT", 3,
     "755:0; P1000 sets it"),
    (1078, "total setpoint", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (1080, "minimum frequency", "F", "Hz", SETS, 0.0, 650.0, 0.0, "CUT", 1, ""),
    (1082, "maximum frequency", "F", "Hz", SETS, 0.0, 650.0, 50.0, "CT", 1, ""),
    (1091, "skip frequency 1", "F", "Hz", SETS, 0.0, 650.0, 0.0, "CUT", 3, ""),
    (1092, "skip frequency 2", "F", "Hz", SETS, 0.0, 650.0, 0.0, "CUT", 3, ""),
    (1093, "skip frequency 3", "F", "Hz", SETS, 0.0, 650.0, 0.0, "CUT", 3, ""),
    (1094, "skip frequency 4", "F", "Hz", SETS, 0.0, 650.0, 0.0, "CUT", 3, ""),
    (1101, "skip frequency bandwidth", "F", "Hz", SETS, 0.0, 10.0, 2.0, "CUT", 3, ""),
    (1110, "inhibit negative setpoint", "U32", "", SETS, 0, LAST_SOURCE, 0, "CT", 3, ""),
    (1119, "setpoint before the ramp", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    (1120, "ramp-up time", "F", "s", SETS, 0.0, 650.0, 10.0, "CUT", 1, "for 0...P1082"),
    (1121, "ramp-down time", "F", "s", SETS, 0.0, 650.0, 10.0, "CUT", 1,
     "for P1082...0, OFF1 too"),
    (1130, "ramp-up, initial rounding", "F", "s", SETS, 0.0, 40.0, 0.0, "CUT", 2, ""),
    (1131, "ramp-up, final rounding", "F", "s", SETS, 0.0, 40.0, 0.0, "CUT", 2, ""),
    (1132, "ramp-down, initial rounding", "F", "s", SETS, 0.0, 40.0, 0.0, "CUT", 2, ""),
    (1133, "ramp-down, final rounding", "F", "s", SETS, 0.0, 40.0, 0.0, "CUT", 2, ""),
    (1134, "rounding type", "U16", "", SETS, 0, 1, 0, "CUT", 2, ""),
    (1135, "OFF3 ramp-down time", "F", "s", SETS, 0.0, 650.0, 5.0, "CUT", 2, "for P1082...0"),
    (1170, "setpoint after the ramp", "F", "Hz", 1, None, None, 0.0, "", 3, ""),
    # starting, stopping, braking
    (1200, "flying start", "U16", "", 1, 0, 6, 0, "CUT", 2, "see restart.py"),
    (1202, "flying start current", "U16", "%", SETS, 10, 200, 100, "CUT", 3, ""),
    (1210, "automatic restart", "U16", "", 1, 0, 6, 1, "CUT", 2, "see restart.py"),
    (1211, "restart attempts", "U16", "", 1, 0, 10, 3, "CUT", 3, "not counted here"),
    (1215, "holding brake", "U16", "", 1, 0, 1, 0, "T", 2, ""),
    (1216, "brake release delay", "F", "s", 1, 0.0, 20.0, 1.0, "T", 2, ""),
    (1217, "holding time after ramp-down", "F", "s", 1, 0.0, 20.0, 1.0, "T", 2, ""),
    (1232, "DC brake current", "U16", "%", SETS, 0, 250, 100, "CUT", 2, ""),
    (1233, "DC brake duration", "U16", "s", SETS, 0, 250, 0, "CUT", 2, ""),
    (1236, "compound brake current", "U16", "%", SETS, 0, 250, 0, "CUT", 2, ""),
    (1237, "dynamic braking", "U16", "", ONE_440, 0, 5, 0, "CUT", 2, ""),
    (1240, "DC link controller", "U16", "", SETS, 0, 3, 1, "CT", 3, ""),
    # control
    (1300, "control mode", "U16", "", SETS, 0, 23, 0, "CT", 2, ""),
    (1310, "continuous boost", "F", "%", SETS, 0.0, 250.0, 50.0, "CUT", 2, ""),
    (1311, "acceleration boost", "F", "%", SETS, 0.0, 250.0, 0.0, "CUT", 2, ""),
    (1312, "starting boost", "F", "%", SETS, 0.0, 250.0, 0.0, "CUT", 2, ""),
    (1316, "boost end frequency", "F", "%", SETS, 0.0, 100.0, 20.0, "CUT", 3, ""),
    (1335, "slip compensation", "F", "%", SETS, 0.0, 600.0, 0.0, "CUT", 2, ""),
    (1800, "pulse frequency", "U16", "kHz", 1, 2, 16, 4, "CUT", 2, ""),
    (1820, "reverse output phases", "U16", "", SETS, 0, 1, 0, "CT", 2, ""),
    (1910, "motor identification", "U16", "", 1, 0, 20, 0, "CT", 2, "returns to 0"),
    # serial links
    (2000, "reference frequency", "F", "Hz", SETS, 1.0, 650.0, 50.0, "CT", 2, "4000h in PZD"),
    (2001, "reference voltage", "U16", "V", SETS, 10, 2000, 1000, "CT", 3, ""),
    (2002, "reference current", "F", "A", SETS, 0.1, 10000.0, 0.1, "CT", 3, ""),
    (2003, "reference torque", "F", "Nm", SETS, 0.1, 99999.0, 0.75, "CT", 3, ""),
    (2009, "USS denormalisation", "U16", "", 2, 0, 1, 0, "CT", 3, "1: PZD2 is 0.01 Hz"),
    (2010, "USS baud rate", "U16", "", 2, 4, 12, 6, "CUT", 2, "a code, see BAUD_CODES"),
    (2011, "USS address", "U16", "", 2, 0, 31, 0, "CUT", 2, ""),
    (2012, "USS PZD length", "U16", "words", 2, 0, 8, 2, "CUT", 3, ""),
    (2013, "USS PKW length", "U16", "words", 2, 0, 127, 127, "CUT", 3, "127: variable"),
    (2014, "USS telegram off time", "U16", "ms", 2, 0, 65535, 0, "CT", 3, "0: not supervised"),
    (2015, "PZD from BOP link", "U16", "", WORDS, None, None, 0, "", 3, ""),
    (2016, "PZD to BOP link", "U32", "", WORDS, 0, LAST_SOURCE, PZD_SOURCES, "CT", 3, ""),
    (2018, "PZD from COM link", "U16", "", WORDS, None, None, 0, "", 3, ""),
    (2019, "PZD to COM link", "U32", "", WORDS, 0, LAST_SOURCE, PZD_SOURCES, "CT", 3,
     "number in the high word, index in the low one"),
    (2024, "USS error-free telegrams", "U16", "", 2, None, None, 0, "", 3, ""),
    (2025, "USS rejected telegrams", "U16", "", 2, None, None, 0, "", 3, "r2026 ... r2031"),
    (2026, "USS character frame errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2027, "USS overrun errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2028, "USS parity errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2029, "USS start not identified", "U16", "", 2, None, None, 0, "", 3, ""),
    (2030, "USS BCC errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2031, "USS length errors", "U16", "", 2, None, None, 0, "", 3, ""),
    (2032, "control word 1 from BOP link", "U16", "", 1, None, None, 0, "", 3, ""),
    (2033, "control word 2 from BOP link", "U16", "", 1, None, None, 0, "", 3, ""),
    (2036, "control word 1 from COM link", "U16", "", 1, None, None, 0, "", 3, ""),
    (2037, "control word 2 from COM link", "U16", "", 1, None, None, 0, "", 3, ""),
    (2040, "CB telegram off time", "U16", "ms", 1, 0, 65535, 20, "CT", 3, ""),
    (2050, "PZD from CB", "U16", "", WORDS, None, None, 0, "", 3, ""),
    (2051, "PZD to CB", "U32", "", WORDS, 0, LAST_SOURCE, PZD_SOURCES[:2] + (0,) * 6, "CT", 3, ""),
    (2053, "CB identification", "U16", "", 5, None, None, 0, "", 3, ""),
    (2054, "CB diagnosis", "U16", "", 7, None, None, 0, "", 3, ""),
    (2090, "control word 1 from CB", "U16", "", 1, None, None, 0, "", 3, ""),
    (2091, "control word 2 from CB", "U16", "", 1, None, None, 0, "", 3, ""),
    # warnings and thresholds
    (2100, "alarm number selection", "U16", "", 3, 0, 65535, 0, "CT", 3, ""),
    (2101, "stop reaction", "U16", "", 3, 0, 4, 0, "CT", 3, ""),
    (2103, "source of acknowledgement", "U32", "", SETS, 0, LAST_SOURCE, 0x02D20002, "CT", 3, ""),
    (2106, "source of external fault", "U32", "", SETS, 0, LAST_SOURCE, 0x00010000, "CT", 3, ""),
    (2110, "warning numbers", "U16", "", 4, None, None, 0, "", 2, ""),
    (2111, "number of warnings", "U16", "", 1, 0, 4, 0, "CT", 3, "0 clears"),
    (2114, "run time counter", "U16", "", 2, None, None, 0, "", 3, ""),
    (2155, "threshold frequency f_1", "F", "Hz", SETS, 0.0, 650.0, 30.0, "CUT", 3,
     "r0053 bits 4, 5"),
    (2164, "hysteresis of the deviation", "F", "Hz", SETS, 0.0, 10.0, 3.0, "CUT", 3,
     "r0052 bit 8"),
    (2167, "switch-off frequency f_off", "F", "Hz", SETS, 0.0, 10.0, 1.0, "CUT", 3, "r0053 bit 1"),
    (2170, "threshold current", "F", "%", SETS, 0.0, 400.0, 100.0, "CUT", 3, ""),
    (2172, "threshold DC link voltage", "U16", "V", SETS, 0, 2000, 800, "CUT", 3, ""),
    # PID controller
    (2200, "enable PID", "U32", "", SETS, 0, LAST_SOURCE, 0, "CT", 2, ""),
    (2253, "source of the PID setpoint", "U32", "", SETS, 0, LAST_SOURCE, 0, "CUT", 2, ""),
    (2264, "source of the PID feedback", "U32", "", SETS, 0, LAST_SOURCE, 0x02F30000, "CUT", 2,
     "755:0, the analog input"),
    (2266, "PID feedback filtered", "F", "%", 1, None, None, 0.0, "", 2, ""),
    (2280, "PID gain", "F", "", SETS, 0.0, 65.0, 3.0, "CUT", 2, ""),
    (2285, "PID integral time", "F", "s", SETS, 0.0, 60.0, 0.0, "CUT", 2, ""),
    (2291, "PID upper limit", "F", "%", SETS, -200.0, 200.0, 100.0, "CUT", 2, ""),
    (2292, "PID lower limit", "F", "%", SETS, -200.0, 200.0, 0.0, "CUT", 2, ""),
    (2294, "PID output", "F", "%", 1, None, None, 0.0, "", 2, ""),
    # commissioning
    (3900, "end quick commissioning", "U16", "", 1, 0, 3, 0, "C", 1,
     "1, 2, 3 end it; returns to 0"),
    (3950, "access to hidden numbers", "U16", "", 1, 0, 255, 0, "CUT", 4, ""),
    (3980, "commissioning command selection", "U16", "", 1, 0, 66, 0, "CT", 4, ""),
    (3981, "reset active fault", "U16", "", 1, 0, 1, 0, "CT", 4, "1 acknowledges"),
    (3986, "number of parameters", "U16", "", 2, None, None, 0, "", 4, ""),
)  # fmt: skip

# Discrete settings: the drive refuses any other value between the limits with error 104.
DIGITAL_INPUT = (0, 1, 2, 3, 4, 9, 10, 11, 12, 13, 14, 15, 16, 21, 25, 29, 99)
PERMITTED = {
    10: (0, 1, 2, 29, 30),
    700: (0, 1, 2, 4, 5, 6),
    719: SELECTIONS,
    2013: (0, 3, 4, 127),
}
PERMITTED.update({number: DIGITAL_INPUT for number in range(701, 709)})

# The numbers of quick commissioning: they keep their values when P3900 = 1 resets all others.
QUICK_COMMISSIONING = (
    3, 10, 100, 300, 304, 305, 307, 308, 309, 310, 311, 320, 335, 640, 700, 1000, 1080, 1082, 1120,
    1121, 1135, 1300, 1910,
)  # fmt: skip

# The terminals, which P3900 = 2 resets: from the first number to the last.
TERMINALS = (701, 781)

# Numbers that can be changed only in a certain commissioning step, and its P0010; 29, a download,
# opens all. The step of every other number that can be changed only in state C is 1.
COMMISSIONING_STEPS = {201: 2, 970: 30}

# Numbers that another parameter puts out of use: that parameter, and its values with which they
# are in use.
ACTIVE = {308: (100, (0, 2)), 309: (100, (1,))}


def rows_of(member):
    """The rows of an MM440 or of an MM420, with plain indices and defaults that fit them."""
    rows = []
    for row in ROWS:
        if isinstance(row[INDICES], tuple):
            row = _with_indices(row, row[INDICES][member])
        if row[INDICES]:
            rows.append(row)
    return in_single_precision(rows)


def _with_indices(row, indices):
    default = row[DEFAULT]
    if isinstance(default, tuple):
        default = default[:indices]
    return row[:INDICES] + (indices,) + row[INDICES + 1 : DEFAULT] + (default,) + row[CHANGE:]
