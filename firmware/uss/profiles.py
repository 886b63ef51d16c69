"""What differs between drive families: data, not code.

MICROMASTER 4 (MM410, MM420, MM430, MM440) on its RS-485 terminals, the COM link. Parameter numbers
and meanings: MICROMASTER parameter lists; set up for USS with P0700 = P1000 = 5.
"""

from micropython import const

# How a parameter that is surveyed is kept.
WORD = const(0)  # as it is
CENTIHERTZ = const(1)  # a floating-point frequency, in 0.01 Hz

# What must be known of a drive before it may be started: index of the row, then the row.
COMMAND_SOURCE, SETPOINT_SOURCE, REFERENCE, ABSOLUTE, LOWEST, HIGHEST = range(6)
SURVEY = (  # number, index, kind
    (700, 0, WORD),  # where ON comes from
    (1000, 0, WORD),  # where the setpoint comes from; the tens digit adds a second one
    (2000, 0, CENTIHERTZ),  # reference frequency: 4000h
    (2009, 0, WORD),  # 1: PZD2 is in 0.01 Hz
    (1080, 0, CENTIHERTZ),  # minimum frequency
    (1082, 0, CENTIHERTZ),  # maximum frequency
)

USS_ON_COM_LINK = const(5)  # value of P0700 and P1000 that hands the drive to this bus
