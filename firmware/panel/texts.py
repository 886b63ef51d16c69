# SPDX-License-Identifier: MIT
"""The texts of the home page and of what may come over any page. Pages and lists have their own.

Nothing is wider than the place it is shown in.

In use:

    notice = texts.LINE_FAILED          # whoever keeps a text keeps it in English
    screen.put(1, 0, 12, texts.of(notice))          # and asks for its words when it shows them
    texts.of(digits.SET_TO_LIMIT, 50, 0)            # with what belongs into it

So the language may change at any time. `languages/words.tsv` has a column for each; who adds a
text adds its row there. What has none is said in English. Words are bytes, one for each character,
in ISO 8859-1 (`screen` knows the display), because indexing bytes allocates nothing.
"""

import on_demand

_ENGLISH = {}

_language = "en"
_spoken = _ENGLISH  # has the words of a text: get(text, text)


def of(text, *values):
    """The words of a text in the language that is spoken, with these values in it."""
    words = _spoken.get(text, text)
    return words % values if values else words


def filled(parts, *values):
    """The words of several texts, with these values in them one after the other."""
    return (b"\n".join([of(text) for text in parts]) % values).split(b"\n")


def speak(language):
    """From now on every text is in this language, as the settings name it: "en", "de"."""
    global _language, _spoken
    if language == _language:
        return
    _language, _spoken = "en", _ENGLISH
    on_demand.drop("panel.languages")
    if language != "en":
        try:
            _spoken = on_demand.load("panel.languages").Language(language)
            _language = language
        except (ImportError, MemoryError):
            pass  # better in English than not at all


def language():
    """That which is spoken."""
    return _language


NOTHING = b""

STATE_WIDTH = 12  # row 2, in front of the address
ROW_WIDTH = 16

# State of the drive that is shown: at most STATE_WIDTH.
NO_CONTACT = b"NO CONTACT"  # silence, and what comes instead of a valid reply:
LINE_NOISE = b"LINE NOISE"
OTHER_LENGTH = b"OTHER LENGTH"  # its telegrams are longer or shorter: P2013, P2012
WRONG_DRIVE = b"WRONG DRIVE"  # another address answers
WRONG_CHECK = b"WRONG CHECK"  # the BCC
DRIVER_STUCK = b"DE STUCK ON"  # what the board found wrong with its bus before the first telegram:
UART_BROKEN = b"UART BROKEN"  # then nothing is started either
LINE_LOW = b"LINE IS LOW"  # until a drive answers
CHECKING = b"CHECKING"  # its settings are being read
DEFECTS = {"driver": DRIVER_STUCK, "uart": UART_BROKEN, "line": LINE_LOW}  # of `hal`
NOT_READY = b"NOT READY"
READY = b"READY"
STARTING = b"STARTING"
RUNNING = b"RUNNING"
RUNS_FOR_EVER = b"RUN, P2014=0"  # since it was started somebody has set it so
RUNS_LONG = b"P2014 LONG"  # likewise
RUNS_FASTER = b"BELOW P1080"  # the setpoint is: the drive turns at P1080
STOPPING = b"STOPPING"
JOGS_RIGHT = b"JOG RIGHT"
JOGS_LEFT = b"JOG LEFT"
FAULT = b"FAULT"  # with FAULT_LETTER and four digits behind it, once they are known
FAULT_LETTER = b"F"
WARNING = b"WARN"  # in turn with the state; with WARNING_LETTER and four digits behind it
WARNING_LETTER = b"A"
INHIBITED = b"INHIBITED"
HALF_SET = b"HALF A SET"  # of parameters is on it: see `sets`
LOCAL = b"LOCAL"  # commands do not come from this bus
RUNS_LOCALLY = b"RUNS LOCALLY"
STATUS_UNKNOWN = b"P2019[0] ???"  # what the drive sends as its status word is none

# Why a drive is not on any more; stays until START or STOP of that drive. At most STATE_WIDTH.
LINE_FAILED = b"LINE FAILED"
PANEL_HUNG = b"PANEL HUNG"
ENGINE_FAILED = b"BUS ERROR"
STOPPED_ITSELF = b"STOPPED SELF"
STOP_KEY = b"STOP KEY"  # what stopped it: in the list of events alone
DID_NOT_START = b"NOT STARTED"
TAKEN_AWAY = b"TAKEN AWAY"  # P0700, P1000 or the like hands it to somebody else
DRIVE_RESET = b"DRIVE RESET"  # its mains were away for a moment, r2024
UNSUPERVISED = b"P2014=0"  # somebody has set it so while it was jogged; RUNS_LONG likewise

# In front of setpoint, actual frequency and address, and in place of the actual frequency: 6 wide.
SETPOINT = b"S:"
ACTUAL = b" F:"
ACTUAL_PERCENT = b"%F:"  # both are in percent: the drive does not tell what 100 % is in Hz
ADDRESS = b"A"
UNKNOWN_VALUE = b" -----"
BEYOND_VALUE = b" >>>>>"  # more than the word of a telegram can say

# Whole rows.
NO_CONTACT_ROW = b"NO CONTACT,"  # with MAY_RUN below it
MAY_RUN = b"MAY RUN"
STOP_UNCONFIRMED = b"STOP UNCONFIRMED"
ALL_STOPPED = b"ALL DRIVES: STOP"
LINE_IN_USE = b"LINE IN USE"  # another master talks; nothing is sent
NO_MEMORY = b"NO MEMORY LEFT"  # for a page
NOT_SAVED = b"SETTINGS UNSAVED"  # the flash is full or broken
WATCHDOG_RESTART = b"WATCHDOG RESTART"  # after the splash: the panel hung, and was restarted
FAREWELL = (b"PANEL STOPPED", b"NO CONTROL")  # left behind by a panel that was ended
BEGINS_ANEW = (b"THE PANEL", b"BEGINS ANEW")  # with other settings

# What a STOP that is held does next, or has done.
HOLD_FOR_OFF3 = b"STOP, HOLD: OFF3"
HOLD_FOR_OFF2 = b"STOP, HOLD: OFF2"
HOLD_FOR_ALL = b"STOP, HOLD: ALL"
OFF3_HOLD_FOR_ALL = b"OFF3, HOLD: ALL"
OFF2_HOLD_FOR_ALL = b"OFF2, HOLD: ALL"
STOP_IS_DOWN = b"STOP IS DOWN"  # and was at power-on: it is jammed, or its wire is broken

# Why a key was not obeyed, shown for a while: at most ROW_WIDTH.
REFUSED_SILENT = b"NO: NO CONTACT"
REFUSED_CHECKING = b"NO: STILL CHECKS"
REFUSED_FAULT = b"NO: FAULT"
REFUSED_INHIBITED = b"NO: INHIBITED"
REFUSED_NOT_READY = b"NO: NOT READY"
REFUSED_COMMAND = b"NO:P0700 NOT USS"
REFUSED_SETPOINT = b"NO:P1000 NOT USS"
REFUSED_SELECTION = b"NO:P0719 NOT USS"
REFUSED_ON_SOURCE = b"NO:P0840 NOT USS"
REFUSED_MAIN_SOURCE = b"NO:P1070 NOT USS"
REFUSED_PID = b"NO: P2200, PID"  # the setpoint is none of the frequency
REFUSED_STATUS = b"NO: P2019[0] ???"
REFUSED_SCALING = b"NO: SCALING ???"
REFUSED_MINIMUM = b"NO: P1080 > 200%"  # the drive would run faster than a telegram can say
REFUSED_STOP = b"NO: STOP IS DOWN"
REFUSED_EARLY = b"NO: PRESS AGAIN"  # nobody had seen yet what would start
REFUSED_STOPPING = b"NO: QUICK STOP"  # OFF2 or OFF3 is still in force
REFUSED_JOG = b"NO: JOG IS DOWN"
REFUSED_RUNS = b"NO JOG: IT RUNS"
REFUSED_UNSAVED = b"NO: UNSAVED"  # its new address is not in the settings yet
REFUSED_HALF_SET = b"NO: HALF A SET"  # complete it, or give it up
REFUSED_NO_JOG = b"NO: HAS NO JOG"
REFUSED_UNSUPERVISED = b"NO JOG: P2014=0"
REFUSED_LONG = b"NO: P2014 LONG"
REFUSED_FN = b"NO: FN IS ON"  # this key of a compact keypad does nothing behind FN
REFUSED_UNWATCHED = b"NO: SET P2014"  # on a board that cannot do without

PERCENT = b"%"  # a unit in row 1 or 2

# --- parameters; `pages.parameter_words` has more ------------------------------------------------

VALUE_WIDTH = 6
UNREAD_VALUE = b"     ?"  # in place of a value, VALUE_WIDTH wide
STOP_FIRST = b"STOP ALL FIRST"  # no address changes while a drive runs
WRITER_BUSY = b"STILL WRITING"
ACCESS_TOO_LOW = b"P0003 TOO LOW"  # a refusal of the drive: see `pages.set_up`

# --- questions: what takes row 1 in turn, and the choice in row 2 --------------------------------

_DO_OR_NOT = b"SET=DO  PARAM=NO"
_START_OR_STOP = b"START=GO STOP=NO"
_FIX_OR_START = b"SET=FIX START=GO"  # SET writes P2014, START takes the risk
FIX_OR_STOP, CANNOT_START = b"SET=FIX STOP=NO", b"IT CANNOT START"  # no START=GO there

ASK_UNSUPERVISED = ((b"P%04d=0: IT RUNS", b"ON IF PANEL DIES"), _FIX_OR_START)
ASK_UNTOLD = ((b"IT MAY RUN ON", b"IF PANEL DIES"), _START_OR_STOP)  # nobody can read its P2014
ASK_LONG = (  # number, value, s
    (b"P%04d=%d: IT", b"RUNS ON %d.%d s", b"IF PANEL DIES"),
    _FIX_OR_START,
)
ASK_LATE = (
    (b"A%d: P2014 SHORT", b"FOR THIS BUS", b"IT MAY TRIP"),
    _START_OR_STOP,
)
ASK_RESTART = (
    (b"P1210=%d: DRIVE", b"STARTS BY ITSELF") + (b"THE PANEL WILL", b"STOP IT THEN"),
    _START_OR_STOP,
)

ASK_SEARCH = (
    (b"LEAVE THE LINE &", b"FIND DRIVES?", b"THOSE WITH P2014", b"MAY TRIP: F0072"),
    _DO_OR_NOT,
)

# --- the menu, see `menu`; `menu.words` has more -------------------------------------------------

MENU_MARK = b">"
LOCKED = b"LOCK: HOLD PARAM"  # until its code is given


# --- the search for drives; `search.words` has more ----------------------------------------------

FIND_DRIVES = b"FIND DRIVES"
FOUND_STATES = (b"WAITS", b"READY", b"RUNS", b"FAULT", b"INHIB")  # as `pzd` numbers them

# --- announcements -------------------------------------------------------------------------------

# What has to be said of a drive; follows "A" and its address, ROW_WIDTH with two digits. A notice,
# such as LINE_FAILED, stands there as well, and of a drive that runs RUNS_FOR_EVER and RUNS_LONG.
OTHER_UNCONFIRMED = b" NOT STOPPED"
OTHER_LOST = b" LOST,MAY RUN"
OTHER_RUNS = b" RUN,HOLD=ALL"
OTHER_TRIPPED = b" FAULT"  # with FAULT_LETTER and four digits behind it, once they are known
OTHER_UNHEARD = b" MAY RUN"  # not heard since the panel started

# The same of several drives at once; their number follows.
SEVERAL_UNCONFIRMED = b"NOT STOPPED:"
SEVERAL_LOST = b"LOST,MAY RUN:"
SEVERAL_RUN = b"RUN,HOLD=ALL:"
SEVERAL_REMARKED = b"RUN, P2014 ?:"
SEVERAL_TRIPPED = b"DRIVES FAULT:"
SEVERAL_NOTED = b"DRIVES OFF:"
SEVERAL_UNHEARD = b"MAY RUN:"
