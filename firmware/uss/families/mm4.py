# SPDX-License-Identifier: MIT
"""MICROMASTER 410, 420, 430 and 440, on their RS-485 terminals; `bop` has the other link.

Parameter numbers and meanings: MICROMASTER parameter lists; set up for USS with P0700 = P1000 = 5.
"""

from micropython import const

from uss import pzd
from uss.families import rows
from uss.families.generic import CUTS_OFF, GENERIC, RESCALES, codes
from uss.families.rows import source

# Of `rows`, for the compiler: a row of constants takes no memory where it is frozen.
_WORD = const(0)
_CENTIHERTZ = const(1)
_SOURCE = const(4)
_COUNT = const(5)
_BY_COMMAND_SET = const(-1)
_BY_DRIVE_SET = const(-2)


class MM420(GENERIC):
    """MICROMASTER 420, on its RS-485 terminals, the COM link."""

    name = "MICROMASTER 420"
    pzd_choices = range(0, 5)  # (?)
    takes_broadcast = True  # (?) the manuals ask for the specification's PKW area, nobody saw one
    first_index = 0
    has_array_tasks = False  # it has them, and takes an index with the others (MM420 manual)
    baud_codes = codes(3, 9)  # (?) the ends of the range
    baud = 9600
    has_bop_link = True  # (?) of an MM410
    baud_number = 2010
    address_number = 2011
    pzd_words_number = 2012
    pkw_words_number = 2013
    off_time_number = 2014
    off_time_fault = 72  # (?) older lists say 70
    fault_number = 947  # index 0
    warning_number = 2110
    fault_format = "F%04d"
    motor = (310, 311)
    access = (3, 3)
    save = (971, 1)
    shown = ((700, 6), (1000, 77), (2011, 31), (2024, None), (2025, None))
    survey = (
        (700, _BY_COMMAND_SET, _WORD, None),  # where ON comes from
        (1000, _BY_COMMAND_SET, _WORD, None),  # where the setpoint comes from; tens: a second one
        (2000, _BY_DRIVE_SET, _CENTIHERTZ, None),  # reference frequency: 4000h
        (2009, 0, _WORD, None),  # 1: PZD2 is in 0.01 Hz
        (1080, _BY_DRIVE_SET, _CENTIHERTZ, None),  # minimum frequency
        (1082, _BY_DRIVE_SET, _CENTIHERTZ, None),  # maximum frequency
        (2014, 0, _WORD, 0),  # ms without a telegram after which it trips; 0: it runs on for ever
        (1210, 0, _WORD, 0),  # automatic restart
        (2024, 0, _COUNT, 0),  # telegrams without an error since the drive was powered up
        (50, 0, _WORD, 0),  # active command data set; an MM420 has one
        (51, 1, _WORD, 0),  # active drive data set
        (2019, 0, _SOURCE, None),  # what is sent as PZD1
        (2019, 1, _SOURCE, None),  # what is sent as PZD2
        (719, _BY_COMMAND_SET, _WORD, 0),  # tens: where ON comes from, units: the setpoint
        (840, _BY_COMMAND_SET, _SOURCE, 2036 << 16),  # where ON comes from; P0700 sets it
        (1070, _BY_COMMAND_SET, _SOURCE, 2018 << 16 | 1),  # the main setpoint; P1000 sets it
        (2200, _BY_COMMAND_SET, _SOURCE, 0),  # what turns the PID controller on
    )
    # P0719 goes before P0700 and P1000, digit by digit; where that is not 0, they and the
    # connectors that they set do not count. 5 is USS on the RS-485 terminals.
    meaning = (
        (rows.COMMAND, rows.SELECTION, 10, (0, 5), None),
        (rows.COMMAND, rows.COMMAND_SOURCE, rows.ALL_DIGITS, (5,), 10),
        (rows.COMMAND, rows.ON_SOURCE, rows.ALL_DIGITS, (source(2036, 0),), 10),
        (rows.SETPOINT, rows.SELECTION, 1, (0, 5), None),
        (rows.SETPOINT, rows.SETPOINT_SOURCE, rows.ALL_DIGITS, (5,), 1),
        (rows.SETPOINT, rows.MAIN_SOURCE, rows.ALL_DIGITS, (source(2018, 1),), 1),
        (rows.SETPOINT, rows.SETPOINT_SOURCE, 10, (0,), None),  # nothing is added to it
        (rows.SETPOINT, rows.PID, rows.ALL_DIGITS, (0,), None),
        (rows.STATUS, rows.STATUS_SENT, rows.ALL_DIGITS, (source(52),), None),
        (rows.ACTUAL, rows.ACTUAL_SENT, rows.ALL_DIGITS, (source(21),), None),
    )
    absolute_value = 1
    on_reverse = pzd.ON_REVERSE
    jog_right = pzd.JOG_RIGHT
    jog_left = pzd.JOG_LEFT
    is_cumulative = False  # captured of MM4 and G110; (?) of a V20
    stw_bits = "STW_BITS"
    zsw_bits = "ZSW_BITS"
    stw2_bits = "STW2_BITS"
    zsw2_bits = "ZSW2_BITS"
    integer_doubles = "MM4"
    ask_first = {
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
        1910: CUTS_OFF,  # motor identification: the drive answers nothing while it lasts
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
    permanent = (2010, 2011, 2012, 2013)


class MM410(MM420):
    """MICROMASTER 410."""

    name = "MICROMASTER 410"
    baud_codes = codes(3, 7)  # (?)


class MM440(MM420):
    """MICROMASTER 440."""

    name = "MICROMASTER 440"
    pzd_choices = range(0, 9)
    baud_codes = codes(4, 12)


class MM430(MM440):
    """MICROMASTER 430, for pumps and fans."""

    name = "MICROMASTER 430"


MM4 = MM420  # of an MM4 that is not known closer: what each of them can
