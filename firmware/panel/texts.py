# SPDX-License-Identifier: MIT
"""Every text an operator can see, by row. Nothing is wider than the place it is shown in.

In use:

    notice = texts.LINE_FAILED          # whoever keeps a text keeps its row
    screen.put(1, 0, 12, texts.of(notice))          # and looks its words up when it shows them
    texts.of(texts.NO_KEY, b"FASTER")   # with what belongs into it

So the language may change at any time. A further language is one more name in LANGUAGES and one
more column of the rows: `READY = _row(b"READY", b"BEREIT")`; what has no word in it is said in the
first one. Words are bytes, because a display takes character codes and indexing bytes allocates
nothing.
"""

from version import VERSION

LANGUAGES = ("English",)
COLUMNS = [[] for _ in LANGUAGES]  # of each language the words, by row

_spoken = COLUMNS[0]


def of(row, *values):
    """The words of a row in the language that is spoken, with these values in it."""
    return _spoken[row] % values if values else _spoken[row]


def filled(rows, *values):
    """The words of several rows, with these values in them one after the other."""
    return (b"\n".join([_spoken[row] for row in rows]) % values).split(b"\n")


def speak(language):
    """From now on every text is in this language, a place in LANGUAGES."""
    global _spoken
    _spoken = COLUMNS[language]


def _row(*words):
    """A new row: its words in each of LANGUAGES."""
    for language in range(len(LANGUAGES)):
        COLUMNS[language].append(words[language] if language < len(words) else words[0])
    return len(COLUMNS[0]) - 1


NOTHING = _row(b"")  # the only row that counts as false

STATE_WIDTH = 12  # row 2, in front of the address
ROW_WIDTH = 16

# State of the drive that is shown: at most STATE_WIDTH.
NO_CONTACT = _row(b"NO CONTACT")  # silence, and what comes instead of a valid reply:
LINE_NOISE = _row(b"LINE NOISE")
OTHER_LENGTH = _row(b"OTHER LENGTH")  # its telegrams are longer or shorter: P2013, P2012
WRONG_DRIVE = _row(b"WRONG DRIVE")  # another address answers
WRONG_CHECK = _row(b"WRONG CHECK")  # the BCC
CHECKING = _row(b"CHECKING")  # its settings are being read
NOT_READY = _row(b"NOT READY")
READY = _row(b"READY")
STARTING = _row(b"STARTING")
RUNNING = _row(b"RUNNING")
RUNS_FOR_EVER = _row(b"RUN, P2014=0")  # since it was started somebody has set it so
RUNS_LONG = _row(b"P2014 LONG")  # likewise
RUNS_FASTER = _row(b"BELOW P1080")  # the setpoint is: the drive turns at P1080
STOPPING = _row(b"STOPPING")
JOGS_RIGHT = _row(b"JOG RIGHT")
JOGS_LEFT = _row(b"JOG LEFT")
FAULT = _row(b"FAULT")  # with FAULT_LETTER and four digits behind it, once they are known
FAULT_LETTER = _row(b"F")
WARNING = _row(b"WARN")  # in turn with the state; with WARNING_LETTER and four digits behind it
WARNING_LETTER = _row(b"A")
INHIBITED = _row(b"INHIBITED")
LOCAL = _row(b"LOCAL")  # commands do not come from this bus
RUNS_LOCALLY = _row(b"RUNS LOCALLY")
STATUS_UNKNOWN = _row(b"P2019[0] ???")  # what the drive sends as its status word is none

# Why a drive is not on any more; stays until START or STOP of that drive. At most STATE_WIDTH.
LINE_FAILED = _row(b"LINE FAILED")
PANEL_HUNG = _row(b"PANEL HUNG")
ENGINE_FAILED = _row(b"BUS ERROR")
STOPPED_ITSELF = _row(b"STOPPED SELF")
DID_NOT_START = _row(b"NOT STARTED")
TAKEN_AWAY = _row(b"TAKEN AWAY")  # P0700, P1000 or the like hands it to somebody else
DRIVE_RESET = _row(b"DRIVE RESET")  # its mains were away for a moment, r2024
UNSUPERVISED = _row(b"P2014=0")  # somebody has set it so while it was jogged; RUNS_LONG likewise

# In front of setpoint, actual frequency and address, and in place of the actual frequency: 6 wide.
SETPOINT = _row(b"S:")
ACTUAL = _row(b" F:")
ADDRESS = _row(b"A")
UNKNOWN_VALUE = _row(b" -----")
BEYOND_VALUE = _row(b" >>>>>")  # more than the word of a telegram can say

# Whole rows.
NO_CONTACT_ROW = _row(b"NO CONTACT,")  # with MAY_RUN below it
MAY_RUN = _row(b"MAY RUN")
STOP_UNCONFIRMED = _row(b"STOP UNCONFIRMED")
ALL_STOPPED = _row(b"ALL DRIVES: STOP")
LINE_IN_USE = _row(b"LINE IN USE")  # another master talks; nothing is sent
SETTINGS_DAMAGED = _row(b"SETTINGS DAMAGED")  # defaults are used for what is wrong
# What is wrong, said after it: the name of a setting, as far as it fits, or this of the file.
SETTINGS_SUSPECTS = {
    "unreadable": _row(b"FILE UNREADABLE"),
    "too big": _row(b"FILE TOO BIG"),
    "no JSON": _row(b"FILE IS NO JSON"),
}
SETTING = _row(b"%s")
KEY_UNKNOWN = _row(b"NO KEY %s")  # the board file names one that there is not
NOT_SAVED = _row(b"SETTINGS UNSAVED")  # the flash is full or broken
WATCHDOG_RESTART = _row(b"WATCHDOG RESTART")  # after the splash: the panel hung, and was restarted
FAREWELL = (_row(b"PANEL STOPPED"), _row(b"NO CONTROL"))  # left behind by a panel that was ended

# What a STOP that is held does next, or has done.
HOLD_FOR_OFF3 = _row(b"STOP, HOLD: OFF3")
HOLD_FOR_OFF2 = _row(b"STOP, HOLD: OFF2")
HOLD_FOR_ALL = _row(b"STOP, HOLD: ALL")
OFF3_HOLD_FOR_ALL = _row(b"OFF3, HOLD: ALL")
OFF2_HOLD_FOR_ALL = _row(b"OFF2, HOLD: ALL")
STOP_IS_DOWN = _row(b"STOP IS DOWN")  # and was at power-on: it is jammed, or its wire is broken

# Why a key was not obeyed, shown for a while: at most ROW_WIDTH.
REFUSED_SILENT = _row(b"NO: NO CONTACT")
REFUSED_CHECKING = _row(b"NO: STILL CHECKS")
REFUSED_FAULT = _row(b"NO: FAULT")
REFUSED_INHIBITED = _row(b"NO: INHIBITED")
REFUSED_NOT_READY = _row(b"NO: NOT READY")
REFUSED_COMMAND = _row(b"NO:P0700 NOT USS")
REFUSED_SETPOINT = _row(b"NO:P1000 NOT USS")
REFUSED_SELECTION = _row(b"NO:P0719 NOT USS")
REFUSED_ON_SOURCE = _row(b"NO:P0840 NOT USS")
REFUSED_MAIN_SOURCE = _row(b"NO:P1070 NOT USS")
REFUSED_PID = _row(b"NO: P2200, PID")  # the setpoint is none of the frequency
REFUSED_STATUS = _row(b"NO: P2019[0] ???")
REFUSED_SCALING = _row(b"NO: SCALING ???")
REFUSED_MINIMUM = _row(b"NO: P1080 > 200%")  # the drive would run faster than a telegram can say
REFUSED_STOP = _row(b"NO: STOP IS DOWN")
REFUSED_EARLY = _row(b"NO: PRESS AGAIN")  # nobody had seen yet what would start
REFUSED_STOPPING = _row(b"NO: QUICK STOP")  # OFF2 or OFF3 is still in force
REFUSED_JOG = _row(b"NO: JOG IS DOWN")
REFUSED_RUNS = _row(b"NO JOG: IT RUNS")
REFUSED_UNSAVED = _row(b"NO: UNSAVED")  # its new address is not in the settings yet
REFUSED_UNSUPERVISED = _row(b"NO JOG: P2014=0")
REFUSED_LONG = _row(b"NO: P2014 LONG")

# --- parameter mode ------------------------------------------------------------------------------

# In front of a value, PARAMETER_WIDTH wide, and in place of one, VALUE_WIDTH wide.
PARAMETER_WIDTH = 6
VALUE_WIDTH = 6
UNREAD_VALUE = _row(b"     ?")
REFUSED_VALUE = _row(b" -----")  # the drive does not tell it

EDIT_FIRST = _row(b"PRESS EDIT FIRST")
READ_ONLY = _row(b"READ ONLY")
NOT_READ_YET = _row(b"NOT READ YET")
STOP_FIRST = _row(b"STOP ALL FIRST")  # no address changes while a drive runs
ADDRESS_TAKEN = _row(b"ADDRESS IS TAKEN")  # by another drive of this panel
WRITER_BUSY = _row(b"STILL WRITING")
WRITTEN = _row(b"WRITTEN (RAM)")
WRITTEN_EEPROM = _row(b"WRITTEN (EEPROM)")
NO_ANSWER = _row(b"NO ANSWER")
NO_REPLY_TO_THIS = _row(b"NO REPLY TO THIS")  # the drive answers, but falls silent on this task
NOT_WRITTEN = _row(b"NOT WRITTEN")

# What became of a write to a drive that is not shown any more.
OTHER_WRITTEN = _row(b"A%d: WRITTEN")
OTHER_NOT_WRITTEN = _row(b"A%d: NOT WRITTEN")

# Why a drive refused a parameter task, by the error number of its reply (specification table 4.9,
# and what drives add to it). NO_RIGHTS is reply 8, which carries no number.
NO_RIGHTS = _row(b"NO CHANGE RIGHTS")
REFUSALS = {
    0: _row(b"NO SUCH PARAM."),
    1: _row(b"READ ONLY"),
    2: _row(b"BEYOND LIMITS"),
    3: _row(b"NO SUCH INDEX"),
    4: _row(b"NOT AN ARRAY"),
    5: _row(b"WRONG DATA TYPE"),
    6: _row(b"MAY ONLY BE 0"),
    7: _row(b"NOT CHANGEABLE"),
    11: NO_RIGHTS,
    12: _row(b"KEY WORD MISSING"),
    17: _row(b"NOT IN THIS MODE"),  # most often: not while it runs
    18: _row(b"DRIVE SAYS ERROR"),
    20: _row(b"ILLEGAL VALUE"),
    101: _row(b"INACTIVE NOW"),
    102: _row(b"REPLY TOO LONG"),
    103: _row(b"WRONG PKW LENGTH"),
    104: _row(b"NOT THIS VALUE"),
    105: _row(b"IS AN ARRAY"),
    106: _row(b"TASK UNKNOWN"),
    107: _row(b"TEXT IS FIXED"),
    200: _row(b"BELOW LIMIT NOW"),
    201: _row(b"ABOVE LIMIT NOW"),
    204: _row(b"P0003 TOO LOW"),
}
OTHER_REFUSAL = _row(b"REFUSED: %d")

# --- questions: what takes row 1 in turn, and the choice in row 2 --------------------------------

_DO_OR_NOT = _row(b"SET=DO  PARAM=NO")
_START_OR_STOP = _row(b"START=GO STOP=NO")
_FIX_OR_START = _row(b"SET=FIX START=GO")  # SET writes P2014, START takes the risk
_TO_BE_WRITTEN = _row(b"A%d: P%04d=%d")

ASK_CUTS_OFF = ((_TO_BE_WRITTEN, _row(b"PANEL MAY LOSE"), _row(b"THE DRIVE BY IT")), _DO_OR_NOT)
ASK_RESCALES = ((_TO_BE_WRITTEN, _row(b"SETPOINTS MAY"), _row(b"CHANGE THEIR HZ")), _DO_OR_NOT)
ASK_UNSUPERVISED = ((_row(b"P2014=0: IT RUNS"), _row(b"ON IF PANEL DIES")), _FIX_OR_START)
ASK_LONG = (  # ms, s
    (_row(b"P2014=%d: IT"), _row(b"RUNS ON %d.%d s"), _row(b"IF PANEL DIES")),
    _FIX_OR_START,
)
ASK_LATE = (
    (_row(b"A%d: P2014 SHORT"), _row(b"FOR THIS BUS"), _row(b"IT MAY TRIP")),
    _START_OR_STOP,
)
ASK_RESTART = (
    (_row(b"P1210=%d: DRIVE"), _row(b"STARTS BY ITSELF"))
    + (_row(b"THE PANEL WILL"), _row(b"STOP IT THEN")),
    _START_OR_STOP,
)

# --- announcements -------------------------------------------------------------------------------

# What has to be said of a drive; follows "A" and its address, ROW_WIDTH with two digits. A notice,
# such as LINE_FAILED, stands there as well, and of a drive that runs RUNS_FOR_EVER and RUNS_LONG.
OTHER_UNCONFIRMED = _row(b" NOT STOPPED")
OTHER_LOST = _row(b" LOST,MAY RUN")
OTHER_RUNS = _row(b" RUN,HOLD=ALL")
OTHER_TRIPPED = _row(b" FAULT")  # with FAULT_LETTER and four digits behind it, once they are known
OTHER_UNHEARD = _row(b" MAY RUN")  # not heard since the panel started

# The same of several drives at once; their number follows.
SEVERAL_UNCONFIRMED = _row(b"NOT STOPPED:")
SEVERAL_LOST = _row(b"LOST,MAY RUN:")
SEVERAL_RUN = _row(b"RUN,HOLD=ALL:")
SEVERAL_REMARKED = _row(b"RUN, P2014 ?:")
SEVERAL_TRIPPED = _row(b"DRIVES FAULT:")
SEVERAL_NOTED = _row(b"DRIVES OFF:")
SEVERAL_UNHEARD = _row(b"MAY RUN:")

# Shown after power-on, both rows: the panel's STOP goes over a wire and through two processors.
SPLASH = (_row(b"USS %s IS NO" % VERSION.encode()), _row(b"EMERGENCY STOP"))
