# SPDX-License-Identifier: MIT
"""The names that the parts of a simulated drive share: bits, states, readings.

Bits of control word 1 are those of the USS specification (C-5.2.1), 11 to 14 those of the
MICROMASTER 4 and 3. A reading's name is the second column of a family's READINGS, and what
`Process.quantity` is asked for.

    stw & ON and not stw & JOG
"""

# Control word 1. OFF2 and OFF3 are low-active commands.
ON = 0x0001
NO_OFF2 = 0x0002
NO_OFF3 = 0x0004
PULSES = 0x0008
RAMP_OUTPUT = 0x0010
RAMP_RUN = 0x0020
SETPOINT = 0x0040
ACKNOWLEDGE = 0x0080
JOG_RIGHT = 0x0100
JOG_LEFT = 0x0200
JOG = JOG_RIGHT | JOG_LEFT
BY_PLC = 0x0400
REVERSE = 0x0800
RIGHT, LEFT = 0x0800, 0x1000  # of a family with a bit for each direction
UP, DOWN = 0x2000, 0x4000  # the motor potentiometer

# The control word from an obeyed source that is not this bus: open terminals and an untouched
# keypad give OFF1 and nothing worse; a link that never had a telegram gives 0000.
NO_COMMAND = NO_OFF2 | NO_OFF3 | PULSES | RAMP_OUTPUT | RAMP_RUN | SETPOINT

# States, named as in a report.
INHIBITED = "inhibited"
READY = "ready"
READY_TO_RUN = "ready to run"
RUNNING = "running"
STOPPING = "stopping"
FAULT = "fault"
OFF = "off"

# Sources of the setpoint that the simulation knows, digits of P1000. That of this bus is 5, even
# where the drive's own digit for it is another one.
MOP, FIXED_FREQUENCY, THIS_BUS = 1, 3, 5

# A binary source that is always 1: 1:0.
ALWAYS = 0x00010000

# Places of process data words that have a meaning of their own.
CONTROL_WORD_2 = 3

# Readings.
NOTHING = "nothing"
STATUS_1, STATUS_2 = "status word 1", "status word 2"
CONTROL_1, CONTROL_2 = "control word 1", "control word 2"
RECEIVED = "word received"
COUNTERS = "telegram counters"
DRIVE_STATE = "drive state"
COMMAND_SET, DATA_SETS = "command data set", "drive data sets"
# Hz, 1/min
WANTED, ACTUAL, AFTER_RAMP = "frequency wanted", "actual frequency", "ramp output"
POTENTIOMETER, FIXED, TOTAL = "motor potentiometer", "fixed frequency", "total setpoint"
SPEED = "speed"
# A, V, Nm, kW, kWh, 1
CURRENT, CURRENT_LIMIT = "current", "current limit"
VOLTAGE, DC_LINK = "voltage", "DC link voltage"
TORQUE, POWER, ENERGY, POWER_FACTOR = "torque", "power", "energy", "power factor"
# %, degrees Celsius
MOTOR_LOAD, MOTOR_TEMPERATURE = "motor load", "motor temperature"
INVERTER_LOAD, INVERTER_TEMPERATURE = "inverter load", "inverter temperature"
# Lists and counts
FAULTS, FAULT_VALUES, FAULT_TIMES = "fault numbers", "fault values", "fault times"
FAULT_COUNT = "number of faults"
WARNINGS, WARNING_COUNT = "warnings", "number of warnings"
RUN_TIME = "run time"

STEPS = 0  # in the place of a divisor: a frequency in 0.1 Hz, or in 0.01 Hz as `scaling` says

# What makes a drive trip by itself; a family's own number for it is in its STYLE.
OVERCURRENT, OVERVOLTAGE, UNDERVOLTAGE = "overcurrent", "overvoltage", "undervoltage"
OVERHEAT, EXTERNAL = "motor overtemperature", "external fault"

# What it warns of by itself. A warning that has a bit of ZSW is that bit, which is low while the
# warning is present.
LIMITED, HOT, STRAINED = 0x0800, 0x2000, 0x8000  # current limit, motor, inverter
LOW_SUPPLY, HELD_DOWN, BOTH_JOGS = 0x10000, 0x20000, 0x40000
