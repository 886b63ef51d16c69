# SPDX-License-Identifier: MIT
"""What the panel must know of a drive, a MICROMASTER 4 on its RS-485 terminals: data, not code.

MM410, MM420, MM430 and MM440 on the COM link. Parameter numbers and meanings: MICROMASTER
parameter lists; set up for USS with P0700 = P1000 = 5. All else that a program may want to know of
them, and the other families, is in `families`, which the panel does not import.
"""

from micropython import const

# How a parameter that is surveyed is kept; 2 and 3 are in `families`.
WORD = const(0)  # as it is
CENTIHERTZ = const(1)  # a floating-point frequency, in 0.01 Hz
SOURCE = const(4)  # a connector, as `source` makes it
COUNT = const(5)  # a counter of 16 bits that wraps

# In place of an index: that of the command data set, or of the drive data set, that is active.
BY_COMMAND_SET = const(-1)
BY_DRIVE_SET = const(-2)


def source(number, index=0):
    """The value of a connector, P0840 = 2036:0 for one: what it is connected with."""
    return number << 16 | index


# What must be known of a drive before it may be started: index of the row, then the row.
COMMAND_SOURCE, SETPOINT_SOURCE, REFERENCE, ABSOLUTE, LOWEST, HIGHEST, SUPERVISION = range(7)
RESTART, COUNTER, COMMAND_SET, DRIVE_SET = range(7, 11)
STATUS_SENT, ACTUAL_SENT, SELECTION, ON_SOURCE, MAIN_SOURCE, PID = range(11, 17)
ROWS = (  # number, index, kind, what it is where the drive has no such parameter; None: it must be
    (700, BY_COMMAND_SET, WORD, None),  # where ON comes from
    (1000, BY_COMMAND_SET, WORD, None),  # where the setpoint comes from; tens: a second one
    (2000, BY_DRIVE_SET, CENTIHERTZ, None),  # reference frequency: 4000h
    (2009, 0, WORD, None),  # 1: PZD2 is in 0.01 Hz
    (1080, BY_DRIVE_SET, CENTIHERTZ, None),  # minimum frequency
    (1082, BY_DRIVE_SET, CENTIHERTZ, None),  # maximum frequency
    (2014, 0, WORD, 0),  # ms without a telegram after which it trips; 0: it runs on for ever
    (1210, 0, WORD, 0),  # automatic restart
    (2024, 0, COUNT, 0),  # telegrams without an error since the drive was powered up
    (50, 0, WORD, 0),  # active command data set; an MM420 has one
    (51, 1, WORD, 0),  # active drive data set
    (2019, 0, SOURCE, None),  # what is sent as PZD1
    (2019, 1, SOURCE, None),  # what is sent as PZD2
    (719, BY_COMMAND_SET, WORD, 0),  # tens: where ON comes from, units: the setpoint
    (840, BY_COMMAND_SET, SOURCE, source(2036, 0)),  # where ON comes from; P0700 sets it
    (1070, BY_COMMAND_SET, SOURCE, source(2018, 1)),  # the main setpoint; P1000 sets it
    (2200, BY_COMMAND_SET, SOURCE, 0),  # what turns the PID controller on
)
FIRST = COMMAND_SET  # of a round: with it the indices of others are known
LATER = (RESTART, COUNTER)  # START alone needs them, and reads them
WATCHED = (COUNTER, LOWEST, HIGHEST)  # read more often than the others while it runs

# The first seven for a program that asks for index 0 of each.
SURVEY = tuple((number, max(index, 0), kind) for number, index, kind, _ in ROWS[: SUPERVISION + 1])

# What gives STW, HSW, ZSW and HIW their meaning: every row of a subject must have one of the
# values. P0719 goes before P0700 and P1000, digit by digit; where that is not 0, they and the
# connectors that they set do not count.
COMMAND, SETPOINT, STATUS, ACTUAL = range(4)
SUBJECTS = const(4)
ALL_DIGITS = const(0)
MEANING = (  # subject, row, place of the digit that counts, values, digit of P0719 that must be 0
    (COMMAND, SELECTION, 10, (0, 5), None),
    (COMMAND, COMMAND_SOURCE, ALL_DIGITS, (5,), 10),
    (COMMAND, ON_SOURCE, ALL_DIGITS, (source(2036, 0),), 10),
    (SETPOINT, SELECTION, 1, (0, 5), None),
    (SETPOINT, SETPOINT_SOURCE, ALL_DIGITS, (5,), 1),
    (SETPOINT, MAIN_SOURCE, ALL_DIGITS, (source(2018, 1),), 1),
    (SETPOINT, SETPOINT_SOURCE, 10, (0,), None),  # nothing is added to it
    (SETPOINT, PID, ALL_DIGITS, (0,), None),
    (STATUS, STATUS_SENT, ALL_DIGITS, (source(52),), None),
    (ACTUAL, ACTUAL_SENT, ALL_DIGITS, (source(21),), None),
)

USS_ON_COM_LINK = const(5)  # value of P0700 and P1000 that hands the drive to this bus
COM_LINK = const(0)  # index of the terminals among the links of P2009...P2014
FAULT_NUMBER = const(947)  # r0947[0]: the number of the present fault
WARNING_NUMBER = const(2110)  # r2110[0]: the number of the present warning
USS_ADDRESS = const(2011)
TELEGRAM_OFF_TIME = const(2014)

# Parameters that are written into the EEPROM as well, always: with its next power-up the drive
# would be where nobody looks for it.
PERMANENT = (2010, 2011, 2012, 2013)

# Parameters that must not be written without asking: the panel may lose the drive by them, or a
# setpoint may mean something else afterwards.
CUTS_OFF, RESCALES = range(2)
ASK_FIRST = {
    3: CUTS_OFF,  # access level
    10: CUTS_OFF,  # commissioning: the motor does not run
    700: CUTS_OFF,
    719: CUTS_OFF,  # command and setpoint source in one
    840: CUTS_OFF,  # source of ON
    918: CUTS_OFF,  # address of the communication board
    927: CUTS_OFF,  # who may change parameters
    970: CUTS_OFF,  # factory reset
    1000: CUTS_OFF,
    1070: CUTS_OFF,  # source of the setpoint
    2000: RESCALES,
    2009: RESCALES,
    2010: CUTS_OFF,  # baud rate
    2011: CUTS_OFF,  # address
    2012: CUTS_OFF,  # words of PZD
    2013: CUTS_OFF,  # words of PKW
    2014: CUTS_OFF,  # telegram-off time
    2016: RESCALES,  # what the drive sends, BOP link
    2019: RESCALES,  # what the drive sends, COM link
    2023: CUTS_OFF,  # protocol
    3900: CUTS_OFF,  # end of commissioning
}
