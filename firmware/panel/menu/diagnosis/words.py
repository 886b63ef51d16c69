# SPDX-License-Identifier: MIT
"""The texts of the diagnosis, in memory only while it is open. See `panel.texts`."""

BUS_COUNTERS = b"BUS COUNTERS"
BUS_TIMES = b"BUS TIMES"
BUS_OFF = b"BUS OFF"
THE_PANEL = b"THE PANEL"
OF_A_DRIVE = (b"COUNTERS", b"TIMES", b"TELEGRAMS", b"MIRROR TEST")

# At most 7, behind the address: see `uss.drive.COUNTERS`, in whose order they stand.
COUNTERS = (b"GOOD", b"START", b"LENGTH", b"BCC", b"ADDRESS", b"NOREPLY", b"RESIDUE")
OF_THE_BUS = (b"SENT", b"FOREIGN", b"FAILED", b"HUNG")
PER_MINUTE = b"%5d %5d/min"
COUNTS = b"%5d   .../min"  # not long enough yet
BUS = b"BUS %s"

TIMES = (b"CYCLE", b"START", b"REPLY")  # the cycle, start delays, response delays
RANGE = b"%d.%d-%d.%d ms"
LONG_RANGE = b"%d-%d ms"
NONE_YET = b"NONE YET"

SENT = b"A%d SENT"
HEARD = b"A%d HEARD"
HELD = b"A%d HELD"  # the telegrams stay as they are
FINDINGS = (  # of the receiver
    b"GOOD",
    b"NO STX",
    b"%d CHARACTERS",
    b"WRONG BCC",
    b"OTHER ADDRESS",
    b"NO REPLY",
    b"CUT OFF",
    b"NO TELEGRAM",
)
NO_TASK = b"NO TASK"
READS = b"READ P%04d[%d]"
WRITES = b"WRITE P%04d[%d]"
STORES = b"STORE P%04d[%d]"  # into the EEPROM
TELLS = b"IS P%04d[%d]"
REFUSES = b"ERROR %d"
NO_RIGHTS = b"NO RIGHTS"
PWE = b"PWE %04X %04X"
STW = b"STW %04X %s"
# What a control word commands, in the order of `telegrams`.
COMMANDS = (b"OFF1", b"OFF2", b"OFF3", b"ON", b"ON", b"JOG", b"JOG")
HSW = b"HSW %04X %d%%"
ZSW = b"ZSW %04X %s"
HIW = b"HIW %04X %d%%"

MIRROR = b"A%d MIRROR TEST"

RESTART = b"RESTART"
NOT_BITTEN = b"POWER OR RESET"
WATCHDOG = b"WATCHDOG"
HEAP = b"HEAP FREE"
SET_COUNTS = b"SET=COUNT"
BYTES = b"%d BYTES"

MAY_TRIP = b"P2014 MAY TRIP"  # drives, once nobody talks to them
SET_LEAVES = b"SET=LEAVE LINE"
STOPS_DRIVES = b"STOPS DRIVES"
LINE_IS_FREE = b"LINE IS FREE"
BACK = b"PARAM=BACK"
