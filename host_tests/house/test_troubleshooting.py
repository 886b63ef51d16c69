# SPDX-License-Identifier: MIT
"""firmware/panel/TROUBLESHOOTING.md: every text of the display that says that something is wrong
stands there, and a drive as delivered is what the catalogue says.
"""

import re

import catalogue
from page_bench import pattern, section, text
from text_bench import named, parts
from uss import families

INTERPRETERS = "host"

MANUAL = "firmware/panel/TROUBLESHOOTING.md"

# Names of texts, by module, with which nothing is wrong: states, labels, choices, what was done.
# Whoever adds a text writes it into the manual, or here.
PLAIN = {
    "panel.texts": """
        ACTUAL ACTUAL_PERCENT ADDRESS ALL_STOPPED BEGINS_ANEW FAULT_LETTER FIND_DRIVES
        FOUND_STATES FIX_OR_STOP HOLD_FOR_ALL HOLD_FOR_OFF2 HOLD_FOR_OFF3 JOGS_LEFT JOGS_RIGHT
        MENU_MARK OFF2_HOLD_FOR_ALL OFF3_HOLD_FOR_ALL PERCENT READY RUNNING SETPOINT STARTING
        STOPPING WARNING_LETTER _DO_OR_NOT _FIX_OR_START _START_OR_STOP""",
    "panel.pages.splash": "SETTING SPLASH",
    "panel.pages.parameter_words": """
        OTHER_WRITTEN PARAMETER READ_PARAMETER WRITTEN WRITTEN_EEPROM""",
    "panel.pages.digits": "HERTZ NEW_SETPOINT",
    "panel.pages.set_up": """
        ASK_SET_UP ASK_SET_UP_EEPROM ASK_UNLOCK _DO_OR_NOT _TO_BE_WRITTEN""",
    "panel.pages.writing": "ASK _DO_OR_NOT _TO_BE_WRITTEN",
    "panel.lookup.ask": "ASK _TO_BE_WRITTEN",
    "panel.lookup.words": """
        ALL_OF_THEM BY_NUMBER CAUSE FAULTS_OF FAVOURITES IS_FAVOURITE IS_NO_FAVOURITE NEW_VALUE
        NO_FAULT REMEDY TYPE_NUMBER""",
    "panel.commission.words": """
        ALL_DONE ASK IS IS_RIGHT LEAVES_DONE LEAVES_LEFT LEFT LEFT_FIRST NEEDS PROCEDURES
        RESCALES WRITES""",
    "panel.menu.words": """
        ABOUT_VERSION ACCEPTED ADDED ALL_ADDED ANSWERS ANY_ADDRESS ASKS AT_ALL_RATES
        AT_THIS_RATE CARRIED CARRYING CHECK CHECK_ENDS CHECK_MAINS CHECK_MASTERS CHECK_PARAMETER
        CHECK_PLUG CHECK_RATE CHECK_SHIELD CHECK_SWAPPED CHECK_TWINS CHECK_UNNAMED CHOICES CODE
        COMMISSION FAULT_MEMORY FOUND HEARD_OF IN_THE_LIST KEPT KEY_TEST KEY_TEST_ENDS KIND
        KIND_TITLES LICENCE LIGHT_STAYS LINKS LOCK_CODE MENU MENU_ABOUT MENU_DIAGNOSIS
        MENU_DRIVES MENU_EVENTS MENU_LOCK MENU_ORDER MENU_SETS MENU_SETTINGS MENU_TURNS NEW_CODE
        NO_EVENTS NO_LOCK PARAMETERS PRESS_A_KEY REMOVED REMOVE_DRIVE SEARCH_PERCENT SETTINGS
        SET_BEGIN SET_KEEPS SET_NEXT SHOW_DRIVE SO_MANY_FOUND STOPPED STOPPED_TWO STOPS_FOUND
        TAKE_ALL TAKE_BACK TIMES UNLOCKED WHAT_IS WHY_NO_CONTACT""",
    "panel.menu.sets.words": """
        ABSENT ALL_EQUAL ASK_DELETE ASK_WRITE CHECKING COMPARE COMPARING DELETE DIFFERENCE
        GIVE_UP INTO INTO_EEPROM INTO_RAM LEFT LEFT_DIFFER NAME NO_SET_FILE OPENS SAVE SAVED
        SAVING SETS SO_MANY WRITING WRITTEN_EQUAL YES_OR_NO""",
    "panel.menu.diagnosis.words": """
        BACK BUS BUS_COUNTERS BUS_OFF BUS_TIMES BYTES COMMANDS COUNTERS COUNTS HEAP HEARD HELD
        HIW HSW LINE_IS_FREE LONG_RANGE MIRROR NONE_YET NOT_BITTEN NO_TASK OF_A_DRIVE OF_THE_BUS
        PER_MINUTE PWE RANGE READS RESTART SENT SET_COUNTS SET_LEAVES STOPS_DRIVES STORES STW
        TELLS THE_PANEL TIMES WATCHDOG WRITES ZSW""",
    "search.words": """
        BAUD_SECONDS FIND_DRIVES_S FOUND_STOP_ENDS NOT_TAKEN RATES_SET_GO SEARCH_ENDS SET_YES
        TAKEN TAKE_DRIVES""",
}  # fmt: skip
# Parts of the other texts: which keys answer a question, and GOOD beside the findings.
BESIDE = {
    b"START=GO STOP=NO", b"SET=FIX START=GO", b"SET=DO  PARAM=NO", b"SET=DO PARAM=NO", b"GOOD",
}  # fmt: skip


def first_cells():
    """What stands in the first column of the tables."""
    rows = re.findall(r"^\| ([^|]*) \|", text(MANUAL), re.M)
    return "\n".join(rows)


def test_every_text_that_says_that_something_is_wrong_has_its_causes():
    told = first_cells() + "\n" + "\n".join(re.findall(r"^#+ (.*)$", text(MANUAL), re.M))
    plain = {module: set(names.split()) for module, names in PLAIN.items()}
    count = 0
    for module, name, value in named():
        if name in plain.get(module.__name__, ()):
            plain[module.__name__].remove(name)
            continue
        for part in parts(value):
            if part not in BESIDE:
                count += 1
                assert re.search(pattern(part), told), (module.__name__, name, part)
    assert count > 150
    assert not any(plain.values()), plain  # names that are no more


def test_every_row_says_what_to_check_or_that_nothing_is_wrong():
    rows = re.findall(r"^\| (.*) \|$", text(MANUAL), re.M)
    assert len(rows) > 80
    for row in rows:
        cells = row.split(" | ")
        assert len(cells) == 3 and cells[1].strip(), row


def test_what_a_drive_is_as_delivered():
    rows = re.findall(
        r"^\| (.*) \| (\d+) \| (\d+) \|$", section(MANUAL, "A drive as delivered"), re.M
    )
    told = {}
    for name, baud, address in rows:
        for number in re.findall(r"[A-Z]?\d+", name):
            told["MM" + number if "MASTER" in name else number] = (int(baud), int(address))
    assert set(told) == {family.upper() for family in catalogue.FAMILIES}
    for family, (baud, address) in told.items():
        data = getattr(families, family)
        defaults = [
            int(catalogue.find(family.lower(), number)[catalogue.DEFAULT].split(b",")[0])
            for number in (data.baud_number, data.address_number)
        ]
        assert (data.baud_codes[defaults[0]], defaults[1]) == (baud, address), family
        assert data.baud == baud, family
