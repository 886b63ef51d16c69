"""The MICROMASTER 420 as data: which parameters it has and how they leave the factory.

It is not a store: drive_parameters.py keeps the values, drive.py gives the readings theirs.
Numbers, names and ranges follow the manufacturer's parameter lists as far as those were at hand.
What a simulated bus cannot exercise (motor data, terminals, boosts) is left out, and so unknown to
the drive: it answers error 0 there.

A row has the columns that drive_parameters.py names. CHANGE tells in which states the number may
be changed, C commissioning, U running, T ready; a row without any is a reading. LEVEL is the least
P0003 for changing it. A default that is a tuple has one value for each index.
"""

NAME = "MICROMASTER 420"

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
    # What the simulated drive can send: nothing, r0020, r0021, r0024, r0052, r0053, r0054.
    2019: tuple(number << 16 for number in (0, 20, 21, 24, 52, 53, 54)),
}

# P2010 to bits a second.
BAUD_CODES = {
    3: 1200, 4: 2400, 5: 4800, 6: 9600, 7: 19200, 8: 38400, 9: 57600, 10: 76800, 11: 93750,
    12: 115200,
}  # fmt: skip

# How somebody has set it up for a panel on its RS-485 terminals: index 0 of each number. Address
# and baud rate come on top.
COMMISSIONED = {3: 3, 700: 5, 1000: 5, 2012: 2, 2013: 4}
