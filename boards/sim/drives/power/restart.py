# SPDX-License-Identifier: MIT
"""What a simulated drive does by itself when its mains are back: P1210, and P1200 for its motor.

Tables only; inverter.py asks them.

    action(MM4, 6, BLACKOUT, UNDERVOLTED)       # RESTART
    catches(1, "fault", -10.0, 25.0)            # True: a motor that turns is caught

P1210 is that of the MM420 and MM440 operating instructions (3.15, 3.16: figure "automatic
restart", for an ON that is present) and of the G120 list manual. The instructions want that ON
from a terminal; they do not tell whether an ON of the bus counts (switch `bus_restart`). Not
simulated: P1211, so attempts are not counted; and the drive acknowledges no faults without a
failure of the mains.
"""

# The cases: how long the mains were off, and the fault that is present.
BROWNOUT, BLACKOUT = "brownout", "blackout"
UNDERVOLTED, OTHER_FAULT, NO_FAULT = "undervoltage", "another fault", "no fault"

# What the drive does: nothing; acknowledge the fault; acknowledge it and run if ON is present.
NOTHING, ACKNOWLEDGE, RESTART = 0, 1, 2

CASES = (
    (BLACKOUT, UNDERVOLTED),
    (BROWNOUT, UNDERVOLTED),
    (BLACKOUT, OTHER_FAULT),
    (BROWNOUT, OTHER_FAULT),
    (BLACKOUT, NO_FAULT),
)

# P1210: what it does, in the order of CASES.
MM4 = {
    0: (NOTHING, NOTHING, NOTHING, NOTHING, NOTHING),
    1: (ACKNOWLEDGE, NOTHING, ACKNOWLEDGE, NOTHING, NOTHING),
    2: (RESTART, NOTHING, NOTHING, NOTHING, RESTART),
    3: (RESTART, RESTART, RESTART, RESTART, NOTHING),
    4: (RESTART, RESTART, NOTHING, NOTHING, NOTHING),
    5: (RESTART, NOTHING, RESTART, NOTHING, RESTART),
    6: (RESTART, RESTART, RESTART, RESTART, RESTART),
}
# p1210 of a G120, which forgets a fault without a cause when its electronics restart. 4 and 6
# restart after a failure of the mains, 6 after other faults as well.
G120 = {
    0: (ACKNOWLEDGE, NOTHING, ACKNOWLEDGE, NOTHING, NOTHING),
    1: (ACKNOWLEDGE, ACKNOWLEDGE, ACKNOWLEDGE, ACKNOWLEDGE, NOTHING),
    4: (RESTART, RESTART, ACKNOWLEDGE, NOTHING, RESTART),
    6: (RESTART, RESTART, RESTART, RESTART, RESTART),
}
# A family without that parameter: a power cycle acknowledges any fault.
PLAIN = {None: (ACKNOWLEDGE, NOTHING, ACKNOWLEDGE, NOTHING, NOTHING)}

# What switched the motor's pulses off.
POWER, FAULT, OFF2, OTHER = "power", "fault", "OFF2", "other"

# P1200: after what a turning motor is caught, and whether only in the direction of the setpoint
# (general knowledge).
ALL = (POWER, FAULT, OFF2, OTHER)
FLYING_STARTS = {
    0: ((), False),
    1: (ALL, False),
    2: ((POWER, FAULT, OFF2), False),
    3: ((FAULT, OFF2), False),
    4: (ALL, True),
    5: ((POWER, FAULT, OFF2), True),
    6: ((FAULT, OFF2), True),
}


def action(table, setting, away, fault):
    """NOTHING, ACKNOWLEDGE or RESTART. table: MM4, G120 or PLAIN. setting: of P1210."""
    case = (away, fault)
    return table[setting][CASES.index(case)] if case in CASES else NOTHING


def catches(setting, freed_by, hz, setpoint_hz):
    """Whether P1200 catches a motor that turns at `hz`; if not, it has to begin at 0 Hz."""
    reasons, one_direction = FLYING_STARTS[setting]
    return freed_by in reasons and not (one_direction and hz * setpoint_hz < 0)
