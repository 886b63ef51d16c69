"""The MICROMASTER 440 as data: an MM420 with data sets, eight PZD words and more arrays.

Tables and columns are those of mm420.py. Three indices are the data sets of commands or of the
drive; the simulated one obeys the first. Numbers and ranges: MM440 parameter list and operating
instructions; what they do not say is general knowledge.

    Drive(clock, wire, 3, {2012: 4}, family=mm440)
"""

from boards.sim import mm420
from boards.sim.drive_parameters import INDICES, NUMBER, rows_like

NAME = "MICROMASTER 440"

# Numbers that have three data sets here and one value on an MM420.
DATA_SETS = (
    700, 1000, 1040, 1058, 1059, 1060, 1061, 1080, 1082, 1120, 1121, 1135, 2000, 2155, 2164, 2167,
)  # fmt: skip

ROWS = rows_like(
    mm420.ROWS,
    [row[:INDICES] + (3,) + row[INDICES + 1 :] for row in mm420.ROWS if row[NUMBER] in DATA_SETS]
    + [
        # number, name, type, unit, indices, minimum, maximum, default, change, level, note
        (304, "rated motor voltage", "U16", "V", 3, 10, 2000, 230, "C", 1, ""),
        (310, "rated motor frequency", "F", "Hz", 3, 12.0, 650.0, 50.0, "C", 1, ""),
        (311, "rated motor speed", "U16", "1/min", 3, 0, 40000, 1395, "C", 1, ""),
        (731, "source of digital output 1", "U32", "", 3, 0, 0x0FA0FFFF, 0x00340003, "CUT", 2, ""),
        (755, "ADC after scaling", "I16", "", 2, None, None, -1, "", 2, "4000h is 100 %"),
        (1001, "fixed frequency 1", "F", "Hz", 3, -650.0, 650.0, 0.0, "CUT", 2, ""),
        (2010, "USS baud rate", "U16", "", 2, 4, 12, 6, "CUT", 2, "a code, see BAUD_CODES"),
        (2012, "USS PZD length", "U16", "words", 2, 0, 8, 2, "CUT", 3, ""),
        (2018, "PZD from COM link", "U16", "", 8, None, None, 0, "", 3, ""),
        (2019, "PZD to COM link", "U32", "", 8, 0, 0x0FA00000,
         (0x00340000, 0x00150000, 0, 0x00350000, 0, 0, 0, 0), "CT", 3, ""),
        (3981, "reset active fault", "U16", "", 1, 0, 1, 0, "CT", 4, "1 acknowledges"),
    ],
)  # fmt: skip

PERMITTED = dict(mm420.PERMITTED)
# 7: the second analog input, which a MICROMASTER 420 does not have.
PERMITTED[1000] = tuple(10 * additional + main for additional in range(8) for main in range(8))

BAUD_CODES = {code: baud for code, baud in mm420.BAUD_CODES.items() if code >= 4}
COMMISSIONED = mm420.COMMISSIONED
LINK = dict(mm420.LINK)
LINK["acknowledge"] = 3981
SETTINGS = mm420.SETTINGS
OTHER_COMMANDS = mm420.OTHER_COMMANDS
SETPOINT_SOURCES = mm420.SETPOINT_SOURCES
READINGS = mm420.READINGS
STYLE = mm420.STYLE
CHANNEL = dict(mm420.CHANNEL)
CHANNEL["tasks"] = (1, 2, 3, 4, 6, 7, 8, 9, 11, 12, 13, 14)
CHANNEL["elements"] = (1, 2, 7, 8)  # "limited"; which ones is a choice
