# SPDX-License-Identifier: MIT
"""The MICROMASTER 440 as data: an MM420 with data sets, eight PZD words and more arrays.

Tables and columns are those of mm420.py, the rows all of mm4_parameters.py. Three indices are the
data sets of commands or of the drive, see data_sets.py.

    Drive(clock, wire, 3, {2012: 4}, family=mm440)
"""

from boards.sim.drives.families import mm4_parameters, mm4_readings, mm420
from boards.sim.drives.families.mm4_parameters import MM440, rows_of

NAME = "MICROMASTER 440"

ROWS = rows_of(MM440)

PERMITTED = dict(mm4_parameters.PERMITTED)
PERMITTED[2019] = tuple(number << 16 for number in mm420.SENT + (31, 32))
# 7: the second analog input, which a MICROMASTER 420 does not have.
PERMITTED[1000] = tuple(10 * additional + main for additional in range(8) for main in range(8))

BAUD_CODES = {code: baud for code, baud in mm420.BAUD_CODES.items() if code >= 4}
COMMISSIONED = mm420.COMMISSIONED
LINK = mm420.LINK
SETTINGS = mm420.SETTINGS
OTHER_COMMANDS = mm420.OTHER_COMMANDS
SOURCES = mm420.SOURCES
SETPOINT_SOURCES = mm420.SETPOINT_SOURCES
READINGS = mm4_readings.READINGS
OPERATIONS = mm420.OPERATIONS
ONLY_ZERO = mm420.ONLY_ZERO
KEPT = mm420.KEPT
QUICK_COMMISSIONING = mm4_parameters.QUICK_COMMISSIONING
TERMINALS = mm4_parameters.TERMINALS
STYLE = mm420.STYLE
CHANNEL = mm420.CHANNEL
