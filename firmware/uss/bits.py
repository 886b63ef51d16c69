# SPDX-License-Identifier: MIT
"""Every bit of the control and status words by its name, for programs that show or test them.

Tables of rows (bit, name, whether 0 is the remarkable value), for each family. To run a drive
`pzd` is enough; the panel does not use this file.

    names(0xFB34, ZSW_BITS)             # ["RUNNING", "CONTROL_REQUESTED", "BRAKE", "RUNS_RIGHT"]
    drive.zsw & bit("WARNING", ZSW_BITS)
    may_start(drive.zsw)

An unknown word is not 0, because in a 0 the bits that are active at 0 would be set. A `bus.Drive`
without contact has None instead: its only name is UNKNOWN, and `may_start` is False for it. A
`drive.Drive` has a word at any time; check its `contact`.
"""

# Bit, name, whether 0 is the remarkable value (here never: the name says what 1 does).
# Bits 0-10: specification C-5.2.1; from 11 on: MICROMASTER 4, r0054.
STW_BITS = (
    (0, "ON", False),  # 0 is OFF1: ramp down and switch off
    (1, "NO_OFF2", False),  # 0 coasts to a stop
    (2, "NO_OFF3", False),  # 0 stops as fast as the drive can
    (3, "PULSES", False),  # enables the inverter
    (4, "RAMP_OUTPUT", False),  # 0 forces the ramp's output to 0
    (5, "RAMP_RUN", False),  # 0 holds the ramp
    (6, "SETPOINT", False),  # 0 makes the setpoint 0
    (7, "ACKNOWLEDGE", False),  # its rising edge acknowledges a fault
    (8, "JOG_RIGHT", False),
    (9, "JOG_LEFT", False),
    (10, "CONTROL", False),  # these process data are valid; 0 leaves the old ones in force
    (11, "REVERSE", False),  # turn the other way
    (13, "MOP_UP", False),
    (14, "MOP_DOWN", False),
    (15, "REMOTE", False),  # local / remote, command data set bit 0
)

# Bit, name, whether 0 is the remarkable value. Bits 0-10: specification C-5.2.1; others: r0052.
ZSW_BITS = (
    (0, "READY_TO_SWITCH_ON", False),
    (1, "READY_TO_RUN", False),
    (2, "RUNNING", False),
    (3, "FAULT", False),
    (4, "OFF2", True),
    (5, "OFF3", True),
    (6, "INHIBIT", False),
    (7, "WARNING", False),
    (8, "DEVIATION", True),
    (9, "CONTROL_REQUESTED", False),
    (10, "MAXIMUM_REACHED", False),
    (11, "CURRENT_LIMIT", True),
    (12, "BRAKE", False),
    (13, "MOTOR_OVERLOAD", True),
    (14, "RUNS_RIGHT", False),
    (15, "INVERTER_OVERLOAD", True),
)

# Bits 0...10 are the specification's (C-5.2.1); each family has its own bits above them.
STW_BITS_PROFILE = STW_BITS[:11]
ZSW_BITS_PROFILE = ZSW_BITS[:11]

STW_BITS_MM3 = STW_BITS_PROFILE + (  # unverified except the first
    (11, "RUN_RIGHT", False),
    (12, "RUN_LEFT", False),
    (13, "MOP_UP", False),
    (14, "MOP_DOWN", False),
)
ZSW_BITS_MM3 = ZSW_BITS_PROFILE + ((14, "RUNS_RIGHT", False),)  # unverified

# No jog: bits 8 and 9 are reserved. PROFIdrive interface of the G120.
STW_BITS_G120 = (
    STW_BITS[:8]
    + STW_BITS[10:12]
    + (
        (13, "MOP_UP", False),
        (14, "MOP_DOWN", False),
        (15, "DATA_SET_BIT_0", False),
    )
)
ZSW_BITS_G120 = ZSW_BITS_PROFILE + (  # unverified from bit 11 on
    (11, "CURRENT_LIMIT", True),
    (12, "BRAKE_OPEN", False),
    (13, "MOTOR_OVERLOAD", True),
    (14, "RUNS_RIGHT", False),
    (15, "INVERTER_OVERLOAD", True),
)

# PZD word 4 to a MICROMASTER 4 that takes four of them: r0055. The names are unverified.
STW2_BITS = (
    (0, "FIXED_FREQUENCY_BIT_0", False),
    (1, "FIXED_FREQUENCY_BIT_1", False),
    (2, "FIXED_FREQUENCY_BIT_2", False),
    (3, "FIXED_FREQUENCY_BIT_3", False),  # MM440
    (4, "DRIVE_DATA_SET_BIT_0", False),  # MM430, MM440
    (5, "DRIVE_DATA_SET_BIT_1", False),
    (8, "PID", False),  # enables the closed-loop controller
    (9, "DC_BRAKE", False),
    (11, "DROOP", False),  # MM440
    (12, "TORQUE_CONTROL", False),  # MM440
    (13, "EXTERNAL_FAULT", True),
    (15, "COMMAND_DATA_SET_BIT_1", False),
)

# PZD word 4 from it: r0053. Unverified too; a drive that stood sent 06E0h.
ZSW2_BITS = (
    (0, "DC_BRAKE_ACTIVE", False),
    (1, "ABOVE_OFF_FREQUENCY", False),  # |f| > P2167
    (2, "ABOVE_MINIMUM_FREQUENCY", False),  # |f| > P1080
    (3, "ABOVE_THRESHOLD_CURRENT", False),  # I >= P2170
    (4, "ABOVE_THRESHOLD_FREQUENCY", False),  # f > P2155
    (5, "BELOW_THRESHOLD_FREQUENCY", False),  # f <= P2155
    (6, "SETPOINT_REACHED", False),  # f >= setpoint
    (7, "BELOW_THRESHOLD_VOLTAGE", False),  # DC link, P2172
    (8, "ABOVE_THRESHOLD_VOLTAGE", False),
    (9, "RAMP_FINISHED", False),
    (10, "PID_AT_MINIMUM", False),  # output at P2292
    (11, "PID_AT_MAXIMUM", False),  # output at P2291
    (14, "LOADS_DATA_SET_0", False),  # from the AOP
    (15, "LOADS_DATA_SET_1", False),
)

UNKNOWN = "UNKNOWN"  # no bit's name

# No fault, no inhibit, neither OFF2 nor OFF3 in force.
_START_MASK = 0x0078
_START_VALUE = 0x0030


def rows(table):
    """The rows of a table. table: the rows themselves, or the table's name here, as a family has
    it."""
    return globals()[table] if isinstance(table, str) else table


def names(word, table):
    """A list of the names of the remarkable bits of a word. table: as in `rows`. For None, which
    is no word: [UNKNOWN].
    """
    if word is None:
        return [UNKNOWN]
    return [name for place, name, at_0 in rows(table) if (word >> place & 1 == 0) == at_0]


def bit(name, table):
    """The bit of that name as a mask: 0x0008 for "FAULT". ValueError if the table has no such
    bit."""
    for place, candidate, _ in rows(table):
        if candidate == name:
            return 1 << place
    raise ValueError("no bit is called %s" % name)


def may_start(zsw):
    """Whether a status word lets ON make the drive run.

    Not after OFF2, OFF3 or a fault, until OFF1 has lifted the inhibit (USS.md 4.9, 4.10).
    """
    return zsw is not None and zsw & _START_MASK == _START_VALUE
