# SPDX-License-Identifier: MIT
"""The texts of the menu's own lists, in memory only while the menu is open. See `panel.texts`.

What others say as well stands in `panel.texts`.
"""

from panel import texts

MENU = b"MENU"
IN_THE_MENU = b"NO: IN THE MENU"  # a key that moves a motor was pressed
STOPPED = b"A%d: STOP"
STOPPED_TWO = b"A%d A%d: STOP"
MENU_LOCK = b"LOCK"  # closes the lock
MENU_DRIVES = b"DRIVES"
ANY_ADDRESS = b"ANY ADDRESS"
IN_THE_LIST = b"IN THE LIST"
ASKS = b"..."
ANSWERS = b"ANSWERS"
NOBODY = b"NOBODY"
ADDED = b"A%d ADDED"
ALL_ADDED = b"%d ADDED"
NOT_ADDED = b"A%d NOT ADDED"  # 31 are there, or nothing of its telegrams is PZD1 and PZD2
REMOVED = b"A%d REMOVED"
NOT_REMOVED = b"A%d NOT REMOVED"  # it is the only one, or may be running
WHY_NO_CONTACT = b"WHY NO CONTACT"
MENU_SETTINGS = b"SETTINGS"
MENU_ORDER = b"ORDER"
MENU_TURNS = b"TURNS"
MENU_SETS = b"SETS"
MENU_ABOUT = b"ABOUT"
MENU_DIAGNOSIS = b"DIAGNOSIS"
PARAMETERS = b"PARAMETERS"
FAULT_MEMORY = b"FAULT MEMORY"
COMMISSION = b"COMMISSION"
MENU_EVENTS = b"EVENTS"
NO_EVENTS = b"NONE YET"
WHAT_IS = b"WHAT IS %s"  # a fault or a warning that the display shows
SHOW_DRIVE = b"SHOW IT"
REMOVE_DRIVE = b"REMOVE IT"

# Settings that are a choice or a number: name, how it reads, decimals, whether it acts at once.
# The panel begins anew with the others, for which no motor may run.
SETTINGS = (  # the rate comes first: `contact`
    ("baud", b"BAUD %s", 0, False),
    ("second_stop", b"2ND STOP %s", 0, False),
    ("reply_timeout_ms", b"REPLY %s ms", 0, False),
    ("lost_ms", b"LOST %s ms", 0, False),
    ("setpoint_centihertz", b"START %s Hz", 2, False),
    ("setpoint_step_centihertz", b"STEP %s Hz", 2, True),
    ("lowest_centihertz", b"LOW %s Hz", 2, False),
    ("highest_centihertz", b"HIGH %s Hz", 2, False),
    ("key_delay_ms", b"KEY WAIT %s ms", 0, True),
    ("key_repeat_ms", b"KEY RATE %s ms", 0, True),
    ("light_minutes", b"LIGHT %s min", 0, True),
    ("language", b"LANG. %s", 0, True),
    ("log", b"LOG %s", 0, True),
)
CHOICES = {  # values that are no numbers: how each reads. A language reads as it calls itself
    "OFF3": b"OFF3",
    "OFF2": b"OFF2",
    "none": b"none",
    "en": b"English",
    "de": b"Deutsch",
    "JSON": b"JSON",
}
LIGHT_STAYS = b"LIGHT STAYS ON"  # light_minutes is 0
SET_KEEPS = b"UP DOWN SET=KEEP"
KEPT = b"KEPT"
ACCEPTED = b"P2014=0 OK"  # drives that may run on when the panel dies
TAKE_BACK = b"A%d  SET=ASK"
NO_DRIVE = b"NO DRIVE"
KEY_TEST = b"KEY TEST"
KEY_TEST_ENDS = b"HOLD PARAM: ENDS"
PRESS_A_KEY = b"PRESS A KEY"

# What a drive is, and how that reads.
FAMILY, PKW, PZD, LINK = range(4)
KIND_TITLES = (b"FAMILY", b"PKW WORDS", b"PZD WORDS", b"LINK")
KIND = (b"FAMILY %s", b"PKW %d WORDS", b"PZD %d WORDS", b"LINK %s")
LINKS = (b"RS-485", b"BOP")  # of the terminals, of the keypad's plug

LOCK_CODE = b"LOCK CODE"
SET_NEXT = b"UP DOWN SET=NEXT"
NEW_CODE = b"NEW CODE %s"
CODE = b"CODE %s"
NO_LOCK = b"NO LOCK"
WRONG_CODE = b"WRONG CODE"
UNLOCKED = b"UNLOCKED"

CARRIED = b"A%d  UP DOWN"
CARRYING = b"SET=KEEP"  # or its number of turns is changed
TIMES = b"A%d  x%d"
SHORT = b"A%d: P2014 SHORT"  # for so long a round of the bus

# Drives that are looked for.
AT_THIS_RATE = b"AT THIS RATE"
AT_ALL_RATES = b"AT ALL RATES"
STOPS_FOUND = b"STOPS FOUND"  # whatever the search finds
SET_BEGIN = b"SET=BEGIN"
SEARCH_PERCENT = b"SEARCH %d%%"
SO_MANY_FOUND = b"%d FOUND"
FOUND = b"FOUND"
TAKE_ALL = b"TAKE ALL %d"

# No contact: what was heard, and what to check.
HEARD_OF = b"A%d HEARD"
HEARD_NOTHING = b"NOTHING"
HEARD_NOBODY = b"NO DRIVE AT ALL"  # none of the list answers
IT_ANSWERS = b"IT ANSWERS NOW"
OK_OF = b"%d OK OF %d"  # telegrams
CHECK = b"CHECK"
CHECK_PARAMETER = b"P%04d = %d"
CHECK_RATE = b"P%04d=%d %d"  # number, code, bit/s
CHECK_UNNAMED = (b"RATE %d", b"ADDRESS %d", b"PKW WORDS %d", b"PZD WORDS %d")
CHECK_TWINS = b"ONLY ONE IS A%d"
CHECK_PLUG = b"PLUG AND WIRES"
CHECK_MAINS = b"DRIVE HAS MAINS"
CHECK_SWAPPED = b"A AND B SWAPPED"
CHECK_ENDS = b"ENDS TERMINATED"
CHECK_SHIELD = b"SHIELD, GROUND"
CHECK_MASTERS = b"NO OTHER MASTER"

ABOUT_VERSION = b"VERSION %s"
LICENCE = b"LICENCE: MIT"


def of_kind(row, value):
    """An entry of what a drive is, in words."""
    return texts.of(KIND[row], value.encode() if isinstance(value, str) else value)


def reading(row, value):
    """A setting in words. row: of SETTINGS."""
    name, text, decimals, _ = row
    if name == "light_minutes" and not value:
        return texts.of(LIGHT_STAYS)
    if isinstance(value, str):
        value = texts.of(CHOICES[value])
    elif decimals:
        value = b"%d.%02d" % (value // 100, value % 100)
    else:
        value = b"%d" % value
    return texts.of(text, value)


def speed(control):
    """The actual frequency of a drive in words, with its unit."""
    actual = control.actual_centihertz()
    if actual is None:
        return texts.of(texts.UNKNOWN_VALUE)
    unit = b"%" if control.survey.is_percent() else b"Hz"
    sign = b"-" if actual < 0 else b""
    return b"%s%d.%02d %s" % (sign, abs(actual) // 100, abs(actual) % 100, unit)
