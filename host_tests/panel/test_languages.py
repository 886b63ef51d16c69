# SPDX-License-Identifier: MIT
"""The languages of the panel: every text has words in each, and they fit. An operator chooses one
while the panel runs.

If you add a text, add its row to firmware/panel/languages/words.tsv, and here, if its place is
narrower than a row, how wide that is, and if numbers belong into it, the widest of these.
"""

import gc
import json
import sys
from binascii import crc32
from io import BytesIO
from struct import pack

from micropython import heap_lock, heap_unlock

import catalogue
import on_demand
import settings_file
from boards.sim.chip.lcd import ROM
from boards.sim.script import Script
from hal.display.hd44780 import Hd44780
from panel import texts
from panel.commission import words as commission_words
from panel.languages import Language
from panel.lookup import ask
from panel.lookup import words as lookup_words
from panel.menu import words as menu_words
from panel.menu.diagnosis import words as diagnosis_words
from panel.menu.sets import words as set_words
from panel.pages import digits, parameter_words, set_up, splash, writing
from panel.screen import GLYPHS, Screen
from panel_bench import LOOP_US, panel, press, row_1, row_2, running, said, starts, unsupervised
from search import words as search_words
from text_bench import columns, named, parts, rows
from tools.live.plain import in_ascii
from uss import families
from version import VERSION

ROW, STATE, ENTRY, TITLE = 16, 12, 15, 11  # places; an entry stands behind the mark of the menu
BESIDE_ADDRESS = ROW - len("A31")
COUNTED = ROW - len(" 31")
ROW_MAX = 128  # bytes: what is read of a row of the table
ORDINARY = {
    texts: ROW, splash: ROW, parameter_words: ROW, menu_words: ENTRY, set_words: ENTRY,
    commission_words: ENTRY, diagnosis_words: ENTRY, search_words: ROW, lookup_words: ENTRY + 1,
    ask: ROW, set_up: ROW, writing: ROW, digits: ROW,
}  # fmt: skip
NARROW = {  # by module: names, place
    set_words: (
        ("NAME SAVING CHECKING COMPARING WRITING ASK_DELETE ASK_GIVE_UP HALF_WRITTEN", ROW),
        ("SETS SO_MANY MAY_CUT", TITLE),
        ("DIFFERENCE NO_SET_FILE", 2 * ROW),  # which are cut
    ),
    texts: (
        ("NO_CONTACT LINE_NOISE OTHER_LENGTH WRONG_DRIVE WRONG_CHECK DRIVER_STUCK", STATE),
        ("UART_BROKEN LINE_LOW DEFECTS CHECKING NOT_READY READY STARTING RUNNING", STATE),
        ("RUNS_FOR_EVER RUNS_LONG RUNS_FASTER STOPPING JOGS_RIGHT JOGS_LEFT INHIBITED", STATE),
        ("LOCAL RUNS_LOCALLY STATUS_UNKNOWN LINE_FAILED PANEL_HUNG ENGINE_FAILED", STATE),
        ("STOPPED_ITSELF DID_NOT_START TAKEN_AWAY DRIVE_RESET UNSUPERVISED MAY_RUN", STATE),
        ("HALF_SET", STATE),
        ("FAULT WARNING", STATE - len(" F01910")),
        ("FAULT_LETTER WARNING_LETTER ADDRESS PERCENT MENU_MARK", 1),
        ("SETPOINT", 2),
        ("ACTUAL ACTUAL_PERCENT", 3),
        ("UNKNOWN_VALUE BEYOND_VALUE UNREAD_VALUE", texts.VALUE_WIDTH),
        ("OTHER_UNCONFIRMED OTHER_LOST OTHER_RUNS OTHER_UNHEARD", BESIDE_ADDRESS),
        ("OTHER_TRIPPED", BESIDE_ADDRESS - len(" F01910")),
        ("SEVERAL_UNCONFIRMED SEVERAL_LOST SEVERAL_RUN SEVERAL_REMARKED SEVERAL_TRIPPED", COUNTED),
        ("SEVERAL_NOTED SEVERAL_UNHEARD", COUNTED),
        ("LINE_IN_USE FIND_DRIVES", ENTRY),
        ("FOUND_STATES", ROW - len("127+2  [X]")),
    ),
    parameter_words: (
        ("PARAMETER READ_PARAMETER", parameter_words.PARAMETER_WIDTH),
        ("REFUSED_VALUE", texts.VALUE_WIDTH),
        ("NO_PARAMETERS", ROW - len("A31")),
        ("NO_ANSWER NO_REPLY_TO_IT NO_RIGHTS REFUSALS OTHER_REFUSAL", ENTRY),  # a list has them
    ),
    menu_words: (
        ("MENU ANY_ADDRESS MENU_SETTINGS MENU_ORDER MENU_TURNS MENU_ABOUT ACCEPTED", TITLE),
        ("KIND_TITLES CARRYING SEARCH_PERCENT FOUND HEARD_OF CHECK", TITLE),
        ("ASKS ANSWERS NOBODY IN_THE_LIST", ENTRY - len("A31 ")),
        ("KEY_TEST_ENDS SET_KEEPS SET_NEXT STOPS_FOUND SHORT ADDED ALL_ADDED NOT_ADDED", ROW),
        ("REMOVED NOT_REMOVED KEPT NO_LOCK WRONG_CODE UNLOCKED", ROW),
    ),
    digits: (("HERTZ", 2), ("NEW_SETPOINT", 3)),
    commission_words: (("LEAVES_DONE LEAVES_LEFT STOP_IT", ROW),),
    diagnosis_words: (
        ("COUNTERS OF_THE_BUS TIMES", TITLE - len("A31 ")),
        ("BUS SENT HEARD HELD RESTART HEAP", TITLE),
        ("MIRROR MAY_TRIP BUS_OFF BACK", ROW),
    ),
    search_words: (("TAKEN NOT_TAKEN", 3),),
}  # fmt: skip
MOST = {  # the widest values that belong into a text
    b"WHAT IS %s": (b"F30001",),
    b"A%d: P%04d[%d]": (31, 2019, 7),
    b"= %s": (b"02036:000",),
    b"LIMIT: %d.%02d": (650, 0),
    b"A%d: P%04d=%d": (31, 2010, 65535),
    b"P%04d=0: IT RUNS": (2014,),
    b"P%04d=%d: IT": (2014, 65535),
    b"RUNS ON %d.%d s": (1999, 9),
    b"P1210=%d: DRIVE": (6,),
    b"USS %s IS NO": (VERSION.encode(),),
    b"%s": (b"setpoint_centihe",),
    b"NO KEY %s": (b"ADRESS_UP",),
    b"REFUSED: %d": (65535,),
    b"A%d A%d: STOP": (31, 30),
    b"FAMILY %s": (max([name.encode() for name in families.NAMES], key=len),),
    b"PKW %d WORDS": (127,),
    b"PZD %d WORDS": (8,),
    b"LINK %s": (menu_words.LINKS[0],),
    b"NEW CODE %s": (b"2099",),
    b"CODE %s": (b"***9",),
    b"A%d  x%d": (31, settings_file.REPEATS_MAX),
    b"SEARCH %d%%": (100,),
    b"%d OK OF %d": (9999, 9999),
    b"P%04d = %d": (2013, 127),
    b"P%04d=%d %d": (2010, 12, 115200),
    b"RATE %d": (187500,),
    b"PKW WORDS %d": (127,),
    b"IS %s": (b"-00000.000",),
    b"%s NEEDS %s": (b"187500", b"21"),
    b"%d LEFT": (23,),
    b"FIRST P%04d": (3900,),
    b"A%d: ALL DONE": (31,),
    b"A%d: %d LEFT": (31, 23),
    b"%s SET=YES": (b"650.00",),
    b"STOP A%d FIRST": (31,),
    b"PZD WORDS %d": (8,),
    b"VERSION %s": (VERSION.encode(),),
    b"A%d SAVE %d%%": (31, 100),
    b"A%d COMPARE %d%%": (31, 100),
    b"A%d WRITE %d%%": (31, 100),
    b"%d:%02d LEFT": (99, 59),
    b"%d:%02d %d DIFF": (9, 59, 1100),
    b"%d DIFFER": (1100,),
    b"DIFFER: %d": (1100,),
    b"SAVED: %d": (1100,),
    b"BUT %d UNTOLD": (1100,),
    b"HALF, DIFFER %d": (99,),
    b"P%04d=%d FOR IT": (9, 3),
    b"%s>%s": (b"10", b"2.5"),
    b"? %s": (b"pump.set",),
    b"IT IS OF %s": (b"MM440",),
    b"%5d %5d/min": (65535, 13620),
    b"%5d   .../min": (65535,),
    b"BUS %s": (b"FOREIGN",),
    b"%d.%d-%d.%d ms": (999, 9, 999, 9),
    b"%d-%d ms": (99999, 99999),
    b"%d CHARACTERS": (256,),
    b"READ P%04d[%d]": (2024, 255),
    b"WRITE P%04d[%d]": (2024, 99),
    b"STORE P%04d[%d]": (2024, 99),
    b"IS P%04d[%d]": (2024, 255),
    b"PWE %04X %04X": (0xFFFF, 0xFFFF),
    b"STW %04X %s": (0x047E, b"TIPPEN"),
    b"HSW %04X %d%%": (0xFFFF, -200),
    b"ZSW %04X %s": (0xFFFF, b"SPERRE"),
    b"HIW %04X %d%%": (0xFFFF, -200),
    b"%d BYTES": (999999,),
    b"ERROR %d": (65535,),
    b"FIND DRIVES %3ds": (999,),
    b"%d RATES SET=GO": (15,),
    b"%d BAUD %ds": (187500, 999),
}
SAME = (  # in every language
    b"WARN", b"P2014=0", b"P2014=0 OK", b"Hz", b"RS-485", b"BOP", b"BAUD %s", b"START %s Hz",
    b"CODE %s", b"VERSION %s", b"%d BAUD %ds", b"A%d: STOP", b"A%d A%d: STOP", b"A%d  UP DOWN",
    b"%5d %5d/min", b"%5d   .../min", b"%d-%d ms", b"%d.%d-%d.%d ms", b"BUS %s", b"START",
    b"BCC", b"LOG %s", b"WATCHDOG",
    b"PWE %04X %04X", b"STW %04X %s", b"HSW %04X %d%%", b"ZSW %04X %s", b"HIW %04X %d%%",
    b"English", b"Deutsch", b"JSON", b"A%d: P%04d=%d", b"A%d  x%d",
)  # fmt: skip
ADDRESS_OR_COUNT = 31  # where a text has one %d only and no row above
KINDS_OF_VALUES = "sdxuX%"


def directives(words):
    """The % of a text, with what belongs to them."""
    found, at = [], words.find(b"%")
    while at >= 0:
        end = at + 1
        while end < len(words) and chr(words[end]) not in KINDS_OF_VALUES:
            end += 1
        found.append(words[at : end + 1] if end < len(words) else b"%")
        at = words.find(b"%", end + 1)
    return found


def without_directives(words):
    for one in directives(words):
        words = words.replace(one, b"", 1)
    return words


def most(text):
    """The widest values of a text."""
    wanted = [one for one in directives(text) if one not in (b"%%", b"%")]
    if text in MOST:
        return MOST[text]
    if wanted == [b"%d"]:
        return (ADDRESS_OR_COUNT,)
    assert not wanted, "%r: say in MOST how wide its values are" % text
    return ()


def setting_values(row):
    """Values of a setting as they read: the widest are among them."""
    for name, _, choices, _ in settings_file.CHOICES:
        if name == row[0]:
            return choices
    lowest, highest = [one[2:4] for one in settings_file.NUMBERS if one[0] == row[0]][0]
    return lowest, highest


def place_of(module, name):
    for names, width in NARROW.get(module, ()):
        if name in names.split():
            return width
    return ORDINARY[module]


def test_every_text_has_its_row_and_every_row_is_a_text():
    wanted = {part for _, _, value in named() for part in parts(value)}
    # Names of settings and fields of tables, which nobody sees.
    wanted -= {row[0].encode() for row in menu_words.SETTINGS}
    found = [row[0] for row in rows()[1]]
    assert len(found) > 200
    assert not wanted.difference(found), ("no row in the table", wanted.difference(found))
    assert not set(found).difference(wanted), ("no such text", set(found).difference(wanted))
    assert len(found) == len(set(found)), "a text has two rows"


def test_every_language_has_every_text():
    """A row may leave out its words where they are none of English: they stand in SAME."""
    languages, found = rows()
    for row in found:
        for place, language in enumerate(languages, 1):
            missing = len(row) <= place or not row[place]
            letters = [one for one in without_directives(row[0]) if chr(one).isalpha()]
            if missing and len(letters) > 1:
                assert row[0] in SAME, (language, "has no words for", row[0])


def test_a_text_takes_the_same_values_in_every_language():
    for spoken in columns().values():
        for text, words in spoken.items():
            if text != b"%":
                assert directives(text) == directives(words), (text, words)
            assert (text[:1] == b" ") == (words[:1] == b" "), (text, words)


def test_every_text_fits_its_place_in_every_language():
    seen = 0
    for language, spoken in columns().items():
        for module, name, value in named():
            if name == "SETTINGS":
                continue
            width = place_of(module, name)
            for text in parts(value):
                words = spoken[text]
                values = most(text)
                shown = words % values if values else words
                assert 0 < len(shown) <= width, (language, name, shown, width)
                if name in ("PARAMETER", "READ_PARAMETER"):
                    assert len(shown) == width, "the number is written into it"
                seen += 1
    assert seen > 400, seen


def test_every_setting_fits_with_its_widest_value():
    for language in columns():
        texts.speak(language)
        for row in menu_words.SETTINGS:
            for value in setting_values(row):
                assert len(menu_words.reading(row, value)) <= ENTRY, (language, row, value)
    texts.speak("en")


def test_the_parameters_of_every_family_fit_into_a_text_about_them():
    """`wording` puts the numbers of a family into it; all have four digits."""
    for spoken in columns().values():
        for text, words in spoken.items():
            for number in (b"P0700", b"P2014", b"P1080", b"P2019"):
                assert (number in text) == (number in words), (text, words)


def test_no_words_are_another_text():
    """Who is handed words in place of a text shows them as they are."""
    for language, spoken in columns().items():
        for text, words in spoken.items():
            assert spoken.get(words, words) == words, (language, text, words)


def test_the_display_has_every_letter():
    screen = Screen()
    for language, spoken in columns().items():
        for words in spoken.values():
            screen.put(0, 0, ROW, words[:ROW])
            letters = "".join([chr(letter) for letter in words[:ROW]])
            assert screen.rows()[0].startswith(letters), (language, words)
            for code, letter in zip(screen.picture, words):
                if letter < 0x80:
                    assert 0x20 <= code == letter < 0x7E and letter != 0x5C, (language, words)
                else:
                    assert code in ROM or code < len(GLYPHS) // 8, (language, words)


def test_the_settings_offer_the_columns_of_the_table():
    offered = [row[2] for row in settings_file.CHOICES if row[0] == "language"][0]
    assert ["en"] + rows()[0] == list(offered)
    for language in offered:
        assert language in menu_words.CHOICES


def test_a_row_is_read_as_a_whole():
    with open("firmware/panel/languages/words.tsv", "rb") as table:
        for line in table:
            assert len(line) <= ROW_MAX, line


# --- how words are found -------------------------------------------------------------------------


def test_the_table_is_read_as_it_stands_there():
    for name, spoken in columns().items():
        if name != "en":
            language = Language(name)
            for text, words in spoken.items():
                assert language.get(text, text) == words, text


def test_what_has_no_words_is_in_english():
    german = Language("de")
    assert german.get(b"NO SUCH TEXT", b"") == b"NO SUCH TEXT"
    assert german.get(b"UNNIN", b"") == b"UNNIN"  # in the middle of another one
    assert german.get(b"", b"") == b""
    assert Language("fr").get(b"RUNNING", b"") == b"RUNNING"


def test_without_the_table_all_is_in_english():
    module = on_demand.load("panel.languages")

    def missing(path, mode):
        raise OSError(2)

    def damaged(path, mode):
        return BytesIO(b"en\tde\nRUNNING\tL\xc3\xc3UFT\n")

    for module.open in (missing, damaged):
        assert module.Language("de").get(b"RUNNING", b"") == b"RUNNING"
    del module.open
    assert module.Language("de").get(b"RUNNING", b"") == b"L\xc4UFT"


class Packed:
    """A language as a firmware file has it: twice the check sum of `B` stands astride those of two
    texts before its own, behind which the words are found."""

    _astride = b"x" + pack("<I", crc32(b"B")) + b"xxx"
    KEYS = _astride + pack("<I", crc32(b"A")) + _astride + pack("<I", crc32(b"B"))
    PLACES = pack("<HHHHHHH", 0, 1, 2, 6, 7, 8, 13)
    WORDS = b"xyan Axyfor B"


def test_a_language_is_read_from_a_module_where_there_is_no_table():
    module = on_demand.load("panel.languages")

    def missing(path, mode):
        raise OSError(2)

    sys.modules["panel.languages.words_xx"] = Packed
    module.open = missing
    try:
        language = module.Language("xx")
        assert language.get(b"A", b"") == b"an A", language.get(b"A", b"")
        assert language.get(b"B", b"") == b"for B", language.get(b"B", b"")
        assert language.get(b"C", b"") == b"C"
    finally:
        del module.open
        on_demand.drop("panel.languages.words_xx")
        on_demand.flush()


def test_what_was_found_is_kept_and_takes_no_memory():
    german = Language("de")
    german.get(b"RUNNING", b"")
    heap_lock()
    try:
        assert german.get(b"RUNNING", b"") == b"L\xc4UFT"
        unread = german.get(b"READY", b"")
    finally:
        heap_unlock()
    assert unread == b"READY"  # no memory: in English, and in German as soon as there is some
    assert german.get(b"READY", b"") == b"BEREIT"


def test_the_last_twenty_four_words_are_kept_and_need_no_table():
    module = on_demand.load("panel.languages")
    german, spoken = module.Language("de"), columns()["de"]
    found = [text for text in spoken if spoken[text] != text][:24]
    for text in found:
        german.get(text, text)

    def missing(path, mode):
        raise OSError(2)

    module.open = missing
    try:
        for text in found:
            assert german.get(text, text) == spoken[text], text
        del module.open
        german.get(b"RUNNING 25", b"")  # one more: what was kept makes room for it
        module.open = missing
        assert german.get(found[0], b"") == found[0]
        assert german.get(b"RUNNING 25", b"") == b"RUNNING 25"
    finally:
        del module.open


def test_of_hundreds_of_words_that_were_shown_a_few_are_kept():
    """A chip has no room for all: the ones that were shown last take their place."""
    german, found = Language("de"), list(columns()["de"])
    assert len(found) > 200
    taken = []
    for some in (found[:60], found[60:]):
        for text in some:
            german.get(text, text)
        gc.collect()
        taken.append(gc.mem_alloc())
    assert taken[1] - taken[0] < 2_000, taken


# --- at the panel --------------------------------------------------------------------------------


def german(**options):
    """A German panel that knows its drive."""
    options["settings"] = dict(options.get("settings", {}), language="de")
    world = panel(**options)
    for _ in range(1000):
        if row_2(world).startswith("BEREIT"):
            return world
        world.run(20)
    raise AssertionError(world.lcd())


def menu(world):
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(300)


def walk_to(world, entry):
    seen = []
    while not row_2(world).startswith(">" + entry):
        assert row_2(world) not in seen, seen
        seen.append(row_2(world))
        press(world, "DOWN")


def choose_language(world, settings, language):
    """Open the settings, which have this name, and the language in them."""
    menu(world)
    walk_to(world, settings)
    press(world, "SET", "UP", "UP", "UP")
    walk_to(world, language)
    press(world, "SET")


def test_the_language_is_chosen_while_a_motor_runs_and_is_kept():
    world = running()
    choose_language(world, "SETTINGS", "LANG. English")
    press(world, "UP")
    assert row_2(world) == ">LANG. Deutsch", world.lcd()
    press(world, "SET")
    assert row_2(world) == "ÜBERNOMMEN", world.lcd()
    press(world, "PARAM", "PARAM")
    world.run(300)
    assert world.lcd() == ("S: 10.0 F: 10.00", "LÄUFT        A1 ")
    assert world.drives[1].state == "running" and abs(world.drives[1].hz() - 10) < 0.01
    assert starts(world) == 1, "it has not been told anything else since"
    press(world, "STOP")
    assert row_2(world) == "HÄLT AN      A1", world.lcd()
    world.run(6000)
    assert json.loads(world.flash.files["settings.json"].decode())["language"] == "de"
    world.reset()
    world.run(400)
    assert world.lcd()[1] == "NOT-HALT        ", world.lcd()
    world.run(2000)
    assert row_2(world) == "BEREIT       A1", world.lcd()
    choose_language(world, "EINSTELL.", "SPRACHE Deutsch")
    press(world, "DOWN", "SET")
    assert row_2(world) == "KEPT", world.lcd()
    press(world, "PARAM", "PARAM")
    world.run(300)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_what_was_noted_before_is_in_the_new_language_too():
    world = running(**unsupervised())
    world.drives[1].unplug()
    world.run(4000)
    world.drives[1].plug()
    world.run(12000)
    assert row_2(world) == "LINE FAILED  A1", world.lcd()
    world.app.panel.settings.change("language", "de")
    world.app.panel.heed_settings()
    world.run(200)
    assert row_2(world) == "LEITUNG WEG  A1", world.lcd()
    world.press("STOP")
    world.run(1000)
    assert row_2(world) == "BEREIT       A1", world.lcd()


def test_a_fault_a_warning_and_the_parameter_page():
    world = german()
    press(world, "PARAM", "UP")
    assert row_2(world) == "ZUERST EDIT", world.lcd()
    world.run(4000)
    press(world, "PARAM")
    world.drives[1].warn(501)
    assert "WARN A0501   A1" in said(world, 8000)
    world.drives[1].fault(1)
    world.run(3000)
    assert row_2(world) == "STÖR. F0001  A1", world.lcd()
    press(world, "START")
    assert "NEIN: STÖRUNG" in said(world, 2000)


def test_a_question_is_asked_in_german():
    world = german(parameters={2014: 0})
    press(world, "START")
    world.run(1500)
    rows_seen = {}
    for _ in range(100):
        world.run(50)
        rows_seen[row_1(world).strip()] = row_2(world)
    assert rows_seen.get("P2014=0: LÄUFT") == "SET=KORR START=J", rows_seen
    assert rows_seen.get("FORT OHNE PANEL") == "SET=KORR START=J", rows_seen
    press(world, "SET")
    assert "GESCHR. (RAM)" in said(world, 2000)


def test_refusals_carry_the_numbers_of_the_family():
    world = panel(parameters={700: 1}, settings={"language": "de"})
    world.run(3000)
    press(world, "START")
    seen = said(world, 3000)
    assert "P0700 NICHT USS" in seen, seen
    rows_seen = set()
    for _ in range(160):
        world.run(50)
        rows_seen.add(row_1(world).strip())
    assert {"A1: P0700=5", "IN SEIN EEPROM:", "PANEL STEUERT", "DANN DEN FU"} <= rows_seen


def test_drives_that_are_not_shown_are_announced_in_german():
    world = german(addresses=(1, 2, 3))
    press(world, "START")
    world.run(3000)
    press(world, "ADDRESS_UP")
    world.run(3000)
    assert "A1 LÄUFT,HALTEN" in said(world, 8000)
    world.drives[3].fault(1)
    assert "A3 STÖR. F0001" in said(world, 12_000)
    world.down("STOP")
    world.run(800)
    assert row_2(world) == "STOP HALTEN:AUS3", world.lcd()
    world.up("STOP")


def test_the_menu_in_german():
    world = german(addresses=(1, 2))
    menu(world)
    assert world.lcd() == ("MENÜ        1/13", ">ANTRIEBE       ")
    press(world, "START")
    assert row_2(world) == ">NEIN: IM MENÜ", world.lcd()
    press(world, "DOWN", "UP")
    seen = []
    while row_2(world) not in seen:
        seen.append(row_2(world))
        press(world, "DOWN")
    assert seen == [
        ">ANTRIEBE", ">ADRESSEN", ">FU SUCHEN", ">EINSTELL.", ">SÄTZE", ">ABFOLGE", ">HÄUFIGKEIT",
        ">DIAGNOSE", ">PARAMETER", ">INBETRIEBN.", ">STÖRSPEICHER", ">EREIGNISSE", ">INFO",
    ], seen  # fmt: skip
    walk_to(world, "EINSTELL.")
    press(world, "SET")
    seen = []
    while row_2(world) not in seen:
        seen.append(row_2(world))
        press(world, "DOWN")
    assert ">2. STOP AUS3" in seen and ">STUFE 0.10 Hz" in seen and ">LICHT BLEIBT AN" in seen
    walk_to(world, "TASTENTEST")
    press(world, "SET")
    assert world.lcd() == ("PARAM HALTEN=AUS", ">TASTE DRÜCKEN  ")


def test_the_search_in_german():
    world = german(addresses=(1,))
    menu(world)
    walk_to(world, "FU SUCHEN")
    press(world, "SET")
    walk_to(world, "ALLE BAUDRATEN")
    press(world, "SET")
    assert row_2(world) == "SET=J    PARAM=N", world.lcd()
    press(world, "SET")
    world.run(500)
    assert row_1(world).startswith("FU SUCHEN ") and row_2(world) == "3 RATEN SET=LOS", world.lcd()
    press(world, "SET")
    for _ in range(2000):
        world.run(50)
        if "[X]" in row_2(world):
            break
    assert world.lcd() == ("A1 19200 MM420  ", "4+2   BEREIT [X]")
    press(world, "PARAM")
    assert world.lcd() == ("1 FU NEHMEN?    ", "SET=J    PARAM=N")
    press(world, "SET")
    world.run(4000)
    assert row_2(world) == "STÖR. F0072  A1", world.lcd()  # it has heard nothing for so long


def test_the_home_page_takes_no_memory_in_german_either():
    world = german()
    world.press("START")
    world.run(4000)
    clock = world.clock
    advance_to = clock.advance_to

    def unlocked(at_us):
        heap_unlock()
        try:
            advance_to(at_us)
        finally:
            heap_lock()

    until_us = clock.now_us + 60_000_000
    clock.advance_to = unlocked
    try:
        while clock.now_us < until_us:
            heap_lock()
            try:
                world.app.step()
            finally:
                heap_unlock()
    finally:
        clock.advance_to = advance_to
    assert row_2(world) == "LÄUFT        A1", world.lcd()


def test_english_loads_nothing_of_that():
    world = german()
    assert "panel.languages" in sys.modules
    world = panel(loop_us=LOOP_US)
    assert row_2(world) == "READY        A1", world.lcd()
    assert "panel.languages" not in sys.modules


# --- letters on the display ----------------------------------------------------------------------


def test_a_text_of_the_catalogue_is_shown_with_the_same_letters():
    """Both are in ISO 8859-1."""
    row = catalogue.find("mm440", 1121)
    name = row[catalogue.NAME + catalogue.DE]
    assert name == b"R\xfccklaufzeit"
    world = german()
    screen = world.app.panel.screen
    screen.put(0, 0, 16, name)
    assert screen.rows()[0] == "Rücklaufzeit    "
    world.app.step_panel = lambda *_: True  # nothing else is drawn
    world.run(200)
    assert row_1(world) == "Rücklaufzeit    ", world.lcd()


def test_every_umlaut_is_on_a_display_with_either_rom():
    letters = "ÄÖÜäöüß°µ"
    for rom in ("A00", "A02"):
        Hd44780.rom = rom  # as a board file says of its display
        world = panel()
        del Hd44780.rom
        world.lcd_chip.rom = rom
        world.app.panel.screen.put(0, 0, ROW, bytes([ord(letter) for letter in letters]))
        world.app.step_panel = lambda *_: True  # nothing else is drawn
        world.run(200)
        assert row_1(world).rstrip() == letters, (rom, world.lcd())
        assert world.app.panel.screen.rows()[0].rstrip() == letters


def test_a_script_reads_umlauts_and_prints_them():
    world = german()
    press(world, "START")
    world.run(4000)
    shown = []
    script = Script(world, "script", shown.append)
    script.run(["expect LÄUFT", "lcd"])
    assert shown[1] == "|LÄUFT        A1 |", shown
    assert in_ascii(world.lcd()[1]) == "LAUFT        A1 "
