# SPDX-License-Identifier: MIT
"""What the panel must know of a drive, a MICROMASTER 4 on its RS-485 terminals: data, not code.

MM410, MM420, MM430 and MM440 on the COM link. Parameter numbers and meanings: MICROMASTER
parameter lists; set up for USS with P0700 = P1000 = 5. All else that a program may want to know of
them, and the other families, is in `families`, which the panel does not import.
"""

from micropython import const

# How a parameter that is surveyed is kept.
WORD = const(0)  # as it is
CENTIHERTZ = const(1)  # a floating-point frequency, in 0.01 Hz

# What must be known of a drive before it may be started: index of the row, then the row.
COMMAND_SOURCE, SETPOINT_SOURCE, REFERENCE, ABSOLUTE, LOWEST, HIGHEST, SUPERVISION = range(7)
SURVEY = (  # number, index, kind
    (700, 0, WORD),  # where ON comes from
    (1000, 0, WORD),  # where the setpoint comes from; the tens digit adds a second one
    (2000, 0, CENTIHERTZ),  # reference frequency: 4000h
    (2009, 0, WORD),  # 1: PZD2 is in 0.01 Hz
    (1080, 0, CENTIHERTZ),  # minimum frequency
    (1082, 0, CENTIHERTZ),  # maximum frequency
    (2014, 0, WORD),  # ms without a telegram after which it trips; 0: it runs on for ever
)

USS_ON_COM_LINK = const(5)  # value of P0700 and P1000 that hands the drive to this bus
COM_LINK = const(0)  # index of the terminals among the links of P2009...P2014
FAULT_NUMBER = const(947)  # r0947[0]: the number of the present fault
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
