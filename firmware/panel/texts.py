"""Every text an operator can see. Nothing is wider than the place it is shown in.

Bytes, because a display takes character codes and indexing bytes allocates nothing.
"""

STATE_WIDTH = 12  # row 2, in front of the address
ROW_WIDTH = 16

# State of the drive that is shown: at most STATE_WIDTH.
NO_CONTACT = b"NO CONTACT"
CHECKING = b"CHECKING"  # its settings are being read
NOT_READY = b"NOT READY"
READY = b"READY"
STARTING = b"STARTING"
RUNNING = b"RUNNING"
RUNNING_WARNING = b"RUNNING WARN"
STOPPING = b"STOPPING"
FAULT = b"FAULT"
INHIBITED = b"INHIBITED"
LOCAL = b"LOCAL"  # commands do not come from this bus
RUNS_LOCALLY = b"RUNS LOCALLY"

# Why a drive is not on any more; stays until START or STOP of that drive. At most STATE_WIDTH.
LINE_FAILED = b"LINE FAILED"
PANEL_HUNG = b"PANEL HUNG"
ENGINE_FAILED = b"BUS ERROR"
STOPPED_ITSELF = b"STOPPED SELF"
DID_NOT_START = b"NOT STARTED"
TAKEN_AWAY = b"TAKEN AWAY"  # P0700 or P1000 hands it to somebody else

# In place of the actual frequency: 6 wide.
UNKNOWN_VALUE = b" -----"
BEYOND_VALUE = b" >>>>>"  # more than the word of a telegram can say

# Whole rows.
NO_CONTACT_ROW = b"NO CONTACT,"  # with MAY_RUN below it
MAY_RUN = b"MAY RUN"
STOP_UNCONFIRMED = b"STOP UNCONFIRMED"
ALL_STOPPED = b"ALL DRIVES: STOP"
LINE_IN_USE = b"LINE IN USE"  # another master talks; nothing is sent
SETTINGS_DAMAGED = b"SETTINGS DAMAGED"  # defaults are used for what is wrong

# Why START was refused, shown for a while: at most ROW_WIDTH.
REFUSED_SILENT = b"NO: NO CONTACT"
REFUSED_CHECKING = b"NO: STILL CHECKS"
REFUSED_FAULT = b"NO: FAULT"
REFUSED_INHIBITED = b"NO: INHIBITED"
REFUSED_NOT_READY = b"NO: NOT READY"
REFUSED_COMMAND = b"NO:P0700 NOT USS"
REFUSED_SETPOINT = b"NO:P1000 NOT USS"
REFUSED_SCALING = b"NO: SCALING ???"
REFUSED_MINIMUM = b"NO: P1080 > 200%"  # the drive would run faster than a telegram can say
REFUSED_STOP = b"NO: STOP IS DOWN"

# What another drive does; follows "A" and its address. At most ROW_WIDTH with a two-digit address.
OTHER_RUNS = b" RUN,HOLD=ALL"
OTHER_LOST = b" LOST,MAY RUN"
OTHER_UNCONFIRMED = b" NOT STOPPED"

# Shown after power-on, both rows: the panel's STOP goes over a wire and through two processors.
SPLASH = (b"USS PANEL IS NO", b"EMERGENCY STOP")
