"""The SINAMICS V20 as data: an MM440 with other defaults, as its macro Cn010 sets it up for USS.

Tables and columns are those of mm420.py. It supervises the line as delivered, P2014, but only once
it has had process data. That it has no P2009 is general knowledge, and so is the default of P2014.

    Drive(clock, wire, 1, family=v20)
"""

from boards.sim import mm440
from boards.sim.drive_parameters import rows_like

NAME = "SINAMICS V20"

ROWS = rows_like(
    mm440.ROWS,
    (
        # number, name, type, unit, indices, minimum, maximum, default, change, level, note
        (700, "command source", "U16", "", 3, 0, 5, 1, "CT", 1, "0, 1 keypad, 2 terminals, 5 USS"),
        (927, "parameters changeable via", "U16", "", 1, 0, 31, 31, "CUT", 2, "bit 3 this bus"),
        (2000, "reference frequency", "F", "Hz", 3, 1.0, 599.0, 50.0, "CT", 2, "4000h in PZD"),
        (2010, "USS baud rate", "U16", "", 2, 6, 12, 8, "CUT", 2, "a code, see BAUD_CODES"),
        (2011, "USS address", "U16", "", 2, 0, 31, 1, "CUT", 2, ""),
        (2014, "USS telegram off time", "U16", "ms", 2, 0, 65535, 2000, "CT", 3, "0: none"),
        (2021, "Modbus address", "U16", "", 1, 1, 247, 1, "T", 2, ""),
        (2023, "RS485 protocol", "U16", "", 1, 0, 3, 1, "T", 1, "1 USS; no effect here"),
    ),
    without=(2009, 3981),
)  # fmt: skip

PERMITTED = dict(mm440.PERMITTED)
PERMITTED[700] = (0, 1, 2, 5)

BAUD_CODES = {code: baud for code, baud in mm440.BAUD_CODES.items() if code >= 6}
COMMISSIONED = {3: 3, 700: 5, 1000: 5, 2012: 2, 2013: 127}
LINK = dict(mm440.LINK)
LINK["acknowledge"] = None
LINK["from process data"] = True
SETTINGS = tuple(row for row in mm440.SETTINGS if row[0] != "scaling")
OTHER_COMMANDS = mm440.OTHER_COMMANDS
SETPOINT_SOURCES = mm440.SETPOINT_SOURCES
READINGS = mm440.READINGS
STYLE = dict(mm440.STYLE)
STYLE["absolute"] = None
CHANNEL = mm440.CHANNEL
