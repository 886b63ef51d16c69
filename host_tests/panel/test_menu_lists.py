# SPDX-License-Identifier: MIT
"""The lists of the menu by themselves: what their entries say, and what SET does there."""

import sys

from menu_bench import Machine, PostingBus, Told
from panel import texts
from panel.menu import BACK
from panel.menu import accepted as accepted_list
from panel.menu import address as address_list
from panel.menu import code as code_page
from panel.menu import drive as drive_list
from panel.menu import find as find_list
from panel.menu import kind as kind_list
from panel.menu import main as main_list
from panel.menu import order as order_list
from panel.menu import settings as setting_list
from panel.menu import turns as turns_list
from panel.menu import words as menu_words
from uss import families, pkw
from uss.families import MM440, V20
from uss.families.bop import on_bop
from uss.finding.mirror import Mirror
from uss.layout import Layout


class Drive(Machine):
    """One that has told all, and what a list makes of it."""

    contact = complete = True
    off_ms, family, actual, in_percent = 0, MM440, None, False

    def __init__(self, address):
        Machine.__init__(self, address)
        self.survey = self

    def off_time_ms(self):
        return self.off_ms

    def actual_centihertz(self):
        return self.actual

    def is_percent(self):
        return self.in_percent


class Whole(PostingBus, Told):
    """A panel with its settings and its bus, on which an exchange takes 10 ms."""

    runs = is_full = False
    lock_code = 2_046

    def __init__(self, *addresses):
        Told.__init__(self)
        self.settings = self.bus = self.turns = self.deadlines = self.guard = self
        self.drives = addresses
        self.controls = self.list = [Drive(address) for address in addresses]
        self.selected = self.controls[0]
        self.repeats, self.unsupervised = {}, addresses

    def say(self, now_ms, text, *values):
        self.did.append(texts.of(text, *values))

    def any_runs(self):
        return self.runs

    def change(self, name, value):
        setattr(self, name, value)
        self.did.append(name)

    def begin_anew(self):
        self.did.append("anew")

    def heed_settings(self):
        self.did.append("heed")

    def unlock(self):
        self.did.append("unlock")

    def longest_cycle_us(self, entries):
        return 10_000 * len(entries) - 1

    def at(self, address):
        return ([drive for drive in self.controls if drive.address == address] or [None])[0]

    def note(self, telegram):
        self.telegram = telegram
        self.did.append((telegram.node, telegram.size - 4))

    def add(self, address, kind):
        if self.is_full:
            raise ValueError
        self.did.append((address, kind))

    def close_menu(self):
        self.did.append("closed")


def test_a_drive_that_is_carried_goes_round_in_both_directions_and_is_kept_when_that_is_left():
    panel = Whole(3, 12, 7)
    shown = order_list.List(panel, None)
    assert not shown.change(0, -1)  # nothing is carried
    assert [shown.words(at) for at in range(shown.count())] == [b"A3", b"A12", b"A7"]
    assert shown.heading(0) == b"ORDER" and shown.control_at(1) is panel.controls[1]
    shown.choose(0, 0)
    for at, steps, order_of in (
        (0, -1, (12, 3, 7)), (1, -1, (12, 7, 3)), (2, -1, (3, 12, 7)), (0, 1, (12, 7, 3)),
        (2, 1, (12, 3, 7)), (1, 1, (3, 12, 7)), (0, -100, (12, 3, 7)),
    ):  # fmt: skip
        assert not shown.change(at, steps)  # the menu walks with it
        assert shown.words(0) == b"A3  UP DOWN" and shown.heading(0) == b"SET=KEEP"
        assert tuple([shown.control_at(place).address for place in range(3)]) == order_of
    shown.choose(1, 0)
    assert [shown.words(at) for at in range(3)] == [b"A12", b"A3", b"A7"] and panel.did == []
    shown.leave(0)
    assert panel.did == ["drives", "anew"] and panel.drives == (12, 3, 7)
    shown.leave(0)
    assert panel.did == ["drives", "anew"]  # it is that already
    panel.runs = True
    shown.choose(0, 0)
    assert panel.did[2:] == [texts.STOP_FIRST] and shown.heading(0) == b"ORDER"
    panel.drives = (3, 12, 7)
    shown.leave(0)
    assert panel.did[2:] == [texts.STOP_FIRST] * 2 and panel.drives == (3, 12, 7)


def test_the_turns_of_a_drive_are_kept_where_three_rounds_fit_into_each_telegram_off_time():
    """A round of six turns is taken for 60 ms here."""
    for off_ms, changes, told in (
        (0, {}, None), (1, {}, b"A12: P2014 SHORT"), (179, {}, b"A12: P2014 SHORT"),
        (180, {}, None), (180, {"complete": False}, texts.REFUSED_CHECKING),
        (180, {"complete": False, "contact": False}, None),
    ):  # fmt: skip
        panel = Whole(3, 12, 7)
        second = panel.controls[1]
        second.off_ms = off_ms
        for name in changes:
            setattr(second, name, changes[name])
        shown = turns_list.List(panel, None)
        assert not shown.change(0, 1) and shown.words(0) == b"A3  x1"
        shown.choose(0, 0)
        assert shown.heading(0) == b"SET=KEEP"
        for steps, times in ((1, 2), (1, 3), (100, 4), (1, 4), (-1, 3), (-9, 2), (-1, 1), (-1, 1)):
            assert shown.change(0, steps) and shown.words(0) == b"A3  x%d" % times
        for _ in range(3):
            shown.change(0, 1)
        shown.choose(0, 0)
        assert shown.heading(0) == b"TURNS"
        kept_ones = {} if told else {"3": 4}
        assert panel.did == ([told] if told else ["repeats", "anew"]), (off_ms, panel.did)
        assert panel.repeats == kept_ones and shown.words(0) == (b"A3  x1" if told else b"A3  x4")
    panel.did, panel.list = [], [None] * 6
    second.off_ms, second.contact = 1, True
    taken = ["repeats", "anew"]
    for key_steps, kept_ones, did in (
        (0, {"3": 4}, []), (-1, {"3": 3}, taken), (-9, {"3": 2}, taken), (-1, {}, taken),
        (0, {}, []),
    ):  # fmt: skip
        panel.did = []
        shown.choose(0, 0)
        if key_steps:
            shown.change(0, key_steps)
        shown.choose(0, 0)  # a shorter round is never worse
        assert (panel.repeats, panel.did) == (kept_ones, did), key_steps
    panel.runs, panel.did = True, []
    for _ in range(2):
        shown.choose(1, 0)
        shown.change(1, 1)
    assert panel.did == [texts.STOP_FIRST] and panel.repeats == {}


def typed(shown, digits):
    """Type a code: what is read before each SET, and where that leads to."""
    rows, leads = [], []
    for digit in digits:
        for _ in range(int(digit)):
            assert shown.change(0, 100)  # by one, however long the key is held
        rows.append(shown.words(0).decode())
        leads.append(shown.choose(0, 77))
    return rows, leads


def test_a_code_is_typed_digit_by_digit_and_read_only_where_it_is_new():
    panel = Whole(3)
    shown = code_page.List(panel, False)
    for steps, digit in ((-1, 9), (1, 0), (-9, 9), (1, 0)):
        assert shown.change(0, steps) and shown.words(0) == b"CODE %d___" % digit
    rows, leads = typed(shown, "2047")
    assert rows == ["CODE 2___", "CODE *0__", "CODE **4_", "CODE ***7"]
    assert leads == [None] * 4 and panel.did == [b"WRONG CODE"]
    rows, leads = typed(shown, "2046")  # it begins with the first digit again
    assert rows[0] == "CODE 2___" and leads == [None] * 3 + [BACK]
    assert panel.did[1:] == ["unlock", b"UNLOCKED"]
    for digits, lock_code, said_then in (("0310", 310, b"KEPT"), ("0000", 0, b"NO LOCK")):
        panel.did = []
        rows, leads = typed(code_page.List(panel, True), digits)
        assert rows == [("NEW CODE " + digits[:at] + "___")[:13] for at in range(1, 5)]
        assert leads == [None] * 3 + [BACK] and panel.lock_code == lock_code
        assert panel.did == ["lock_code", "heed", said_then]


def test_each_drive_that_was_accepted_is_taken_back_by_itself():
    panel = Whole(3, 12, 7)
    shown = accepted_list.List(panel, None)
    for place, left in ((1, (3, 7)), (1, (3,)), (0, ()), (0, ())):
        rows = [shown.words(at) for at in range(shown.count())]
        was = panel.unsupervised
        assert rows == ([b"A%d  SET=ASK" % one for one in was] or [b"NO DRIVE"])
        panel.did = []
        assert shown.choose(place, 0) is None
        assert panel.unsupervised == left
        assert panel.did == (["unsupervised", b"KEPT"] if was else [])


def test_a_speed_has_two_decimals_its_sign_and_its_unit():
    for actual, in_percent, row in (
        (None, False, texts.UNKNOWN_VALUE), (0, False, b"0.00 Hz"), (-5, False, b"-0.05 Hz"),
        (-1, True, b"-0.01 %"), (1_284, False, b"12.84 Hz"), (-10_099, True, b"-100.99 %"),
        (100, False, b"1.00 Hz"), (-99, False, b"-0.99 Hz"),
    ):  # fmt: skip
        drive = Drive(3)
        drive.actual, drive.in_percent = actual, in_percent
        assert menu_words.speed(drive) == row, (actual, row)


class Enquirer:
    """Asks a drive that answers what it is, in two telegrams."""

    made = None

    def __init__(self, *node):
        Enquirer.made = node
        self.node = self
        self.family, self.layout = MM440, MM440.layout
        self.taken = 0

    def question(self):
        return Mirror(7, bytes(26))

    def take(self, telegram):
        self.taken += 1
        return self.taken > 1


class EnquiryModule:
    """Where that stands."""

    Enquirer = Enquirer


LENGTHS = [10, 12, 4, 16, 14, 8, 6, 18, 20, 22, 24]  # net characters that are tried


def test_an_address_is_asked_in_all_lengths_round_and_round_until_somebody_answers():
    panel = Whole(3, 12)
    shown = address_list.List(panel, None)
    assert (shown.first(), shown.count()) == (3, 32)
    shown.step(3, 0)
    shown.step(3, 0)
    assert panel.did == [] and shown.words(3) == b"A3  IN THE LIST"
    assert shown.control_at(12) is panel.controls[1] and shown.control_at(13) is None
    for name, value in (("wait_us", 1), ("has_other", True)):  # first what must not wait
        setattr(panel, name, value)
        shown.step(7, 0)
        assert panel.did == []
        setattr(panel, name, getattr(Whole, name))
    for asked_so_far in range(1, 15):
        shown.step(7, 0)
        assert len(panel.did) == asked_so_far
        shown.step(7, 0)  # it is under way
        assert len(panel.did) == asked_so_far
        row = b"A7  NOBODY" if asked_so_far > 11 else b"A7  ..."
        assert shown.words(7) == row, asked_so_far
        shown.choose(7, 0)  # nobody is there to be taken
        assert shown.words(8) == b"A8  ..."
        panel.telegram.state = pkw.TIMED_OUT
    shown.step(7, 0)
    assert panel.did == [(7, length) for length in (LENGTHS + LENGTHS)[:15]]
    panel.telegram.state = pkw.DONE
    for _ in range(3):  # who answers is not asked any more
        shown.step(7, 0)
        assert len(panel.did) == 15 and shown.words(7) == b"A7  ANSWERS"
    shown.step(8, 0)  # another one begins with the first
    assert panel.did[15:] == [(8, 10)]
    assert shown.words(8) == b"A8  ..." and shown.words(7) == b"A7  ..."
    panel.telegram.state = pkw.TIMED_OUT
    shown.step(12, 0)
    assert len(panel.did) == 16 and shown.words(12) == b"A12 IN THE LIST"


def test_who_answers_is_asked_what_it_is_when_set_wants_it_and_taken_as_that():
    """It takes one length only if it is silent twice on another."""
    for silences, is_answered, is_full in (
        (0, True, False), (1, True, False), (2, False, False), (2, False, True)
    ):  # fmt: skip
        panel = Whole(3)
        panel.is_full = is_full
        shown = address_list.List(panel, None)
        shown.step(7, 0)
        panel.telegram.state = pkw.TIMED_OUT
        shown.step(7, 0)
        panel.telegram.state = pkw.DONE
        shown.step(7, 0)
        shown.choose(8, 0)  # nobody was found there
        shown.step(7, 0)
        assert panel.did == [(7, 10), (7, 12)] and shown.words(7) == b"A7  ANSWERS"
        shown.choose(7, 0)
        assert shown.words(7) == b"A7  ..."
        sys.modules["uss.finding.enquiry"] = EnquiryModule
        shown.step(7, 0)
        for is_last in [False] * (silences - 1 if silences == 2 else silences) + [True]:
            assert panel.did[-1] == (7, 14)  # a word more
            panel.telegram.state = pkw.DONE if is_last and is_answered else pkw.TIMED_OUT
            shown.step(7, 0)
        sys.modules.pop("uss.finding.enquiry", None)
        assert Enquirer.made == (7, 12, is_answered), (silences, Enquirer.made)
        for _ in range(2):
            assert panel.did[-1] == (7, 26)
            panel.telegram.state = pkw.DONE
            asked_so_far = len(panel.did)
            shown.step(7, 0)
        added = [b"A7 NOT ADDED"] if is_full else [(7, "mm440"), b"A7 ADDED"]
        assert panel.did[asked_so_far:] == ["closed"] + added


class Kinds(Whole):
    """A panel whose drive 3 is of a kind."""

    def __init__(self, family, layout, contact=True):
        Whole.__init__(self, 3, 12)
        drive = self.controls[0]
        drive.family, drive.layout, drive.contact = family, layout, contact

    def set_kind(self, address, kind):
        self.did.append((address, kind))

    def show(self, control):
        self.selected = control

    def remove(self):
        if self.runs:
            raise ValueError
        self.controls.remove(self.selected)


FAMILY, PKW, PZD, LINK = range(4)


def test_each_part_of_what_a_drive_is_can_be_chosen_as_its_family_has_it():
    bop = on_bop(MM440)
    for family, layout, row, first, count in (
        (MM440, Layout(4, 2), FAMILY, "FAMILY MM440", len(families.NAMES)),
        (bop, Layout(4, 2), FAMILY, "FAMILY MM440", len(families.NAMES)),
        (MM440, Layout(127, 2), PKW, "PKW 127 WORDS", len(MM440.pkw_choices)),
        (MM440, Layout(4, 3), PZD, "PZD 3 WORDS", len(MM440.pzd_choices) - 2),  # not 0, not 1
        (MM440, Layout(4, 2), LINK, "LINK RS-485", 2), (bop, Layout(4, 2), LINK, "LINK BOP", 2),
        (V20, Layout(4, 2), LINK, "LINK RS-485", 1),
    ):  # fmt: skip
        panel = Kinds(family, layout)
        drive = panel.controls[0]
        shown = kind_list.List(panel, (drive, row))
        assert shown.words(shown.first()).decode() == first and shown.count() == count, first
        assert shown.control_at(0) is drive
        assert texts.of(shown.title) == menu_words.KIND_TITLES[row]
        assert shown.choose(shown.first(), 0) is BACK and panel.did == []  # it is that
    panel = Kinds(MM440, Layout(4, 16))
    wrong = kind_list.List(panel, (panel.selected, PZD))
    assert wrong.first() == 0 and wrong.words(0) == b"PZD 2 WORDS"


def test_what_is_chosen_keeps_the_rest_as_far_as_that_can_be():
    bop, short = on_bop(MM440), Layout(127, 3, short=True)
    for family, layout, contact, row, wanted, kind in (
        (MM440, Layout(4, 2), True, PKW, "PKW 127 WORDS", "mm440/127"),
        (MM440, short, True, PKW, "PKW 3 WORDS", "mm440/3+3"),
        (MM440, short, True, PZD, "PZD 4 WORDS", "mm440/127s+4"),
        (bop, Layout(127, 2), True, PKW, "PKW 4 WORDS", "mm440-bop"),
        (MM440, Layout(127, 3), True, LINK, "LINK BOP", "mm440-bop/127+3"),
        (bop, Layout(127, 3), True, LINK, "LINK RS-485", "mm440/127+3"),
        (bop, Layout(127, 3), True, FAMILY, "FAMILY MM420", "mm420-bop/127+3"),
        (bop, Layout(127, 3), False, FAMILY, "FAMILY MM420", "mm420-bop"),
        (bop, Layout(127, 3), True, FAMILY, "FAMILY V20", "v20/127+3"),
        (MM440, Layout(4, 2), True, FAMILY, "FAMILY MM3", "mm3"),
    ):
        panel = Kinds(family, layout, contact)
        shown = kind_list.List(panel, (panel.selected, row))
        rows = [shown.words(place).decode() for place in range(shown.count())]
        panel.runs = True
        assert shown.choose(rows.index(wanted), 0) is None and panel.did == [texts.STOP_FIRST]
        panel.runs = False
        assert shown.choose(rows.index(wanted), 0) is None
        assert panel.did[1:] == [(3, kind), "anew"], (kind, panel.did)


def test_a_drive_of_the_list_is_shown_removed_or_told_what_it_is():
    panel = Kinds(MM440, Layout(127, 3))
    third, twelfth = panel.controls
    twelfth.actual = -5
    shown = drive_list.List(panel, third)
    rows = [shown.words(place).decode() for place in range(shown.count())]
    assert rows[:6] == ["SHOW IT", "REMOVE IT", "FAMILY MM440", "PKW 127 WORDS", "PZD 3 WORDS",
                        "LINK RS-485"] and len(rows) == 7  # fmt: skip
    assert shown.title == b"A3" and shown.control_at(5) is third
    leads = [shown.choose(place, 0) for place in range(2, 7)]
    assert leads == [("kind", (third, row)) for row in range(4)] + [None] and panel.did == []
    panel.selected = twelfth
    assert shown.choose(0, 0) is None and panel.selected is third and panel.did == ["closed"]
    panel.selected, panel.did, panel.runs = twelfth, [], True
    shown.choose(1, 0)
    assert panel.did == ["closed", b"A3 NOT REMOVED"] and panel.controls == [third, twelfth]
    panel.selected, panel.did, panel.runs = twelfth, [], False
    shown.choose(1, 0)
    assert panel.did == ["closed", b"A3 REMOVED"] and panel.selected is twelfth
    panel.did = []
    for place in (0, 1):  # it has gone already
        assert shown.choose(place, 0) is None and panel.did == []
    assert drive_list.List(panel, twelfth).words(6) == b"-0.05 Hz"


def test_drives_are_looked_for_at_all_rates_first_where_none_answers():
    panel = Whole(3, 12)
    panel.line_in_use = lambda: panel.has_other
    panel.offer_search = panel.did.append
    shown = find_list.List(panel, None)
    assert [shown.words(place) for place in range(shown.count())] == [
        b"AT THIS RATE", b"AT ALL RATES"
    ]  # fmt: skip
    for contacts, first in (((True, False), 0), ((False, True), 0), ((False, False), 1)):
        for drive, contact in zip(panel.controls, contacts):
            drive.contact = contact
        assert shown.first() == first, contacts
    assert shown.choose(0, 5) == ("beside", None) and panel.did == []
    assert shown.choose(1, 6) is None and panel.did == [6]
    panel.has_other = True  # another master talks: nobody is looked for beside it
    assert shown.choose(0, 7) is None and panel.did == [6, 7]


class Begun:
    """A panel with one drive, as the first list of the menu asks for it."""

    contact, pkw_words, family = True, 4, MM440
    lock_code = 0

    def __init__(self, **told):
        self.selected = self.drive = self.layout = self.survey = self.settings = self
        self.controls = [self]
        self.fault, self.warning = Alarm(), Alarm()
        self.locked_ms = []
        for name in told:
            setattr(self, name, told[name])

    def lock(self, now_ms):
        self.locked_ms.append(now_ms)


class Alarm:
    """A fault or a warning with this number; 0: nobody knows it yet."""

    def __init__(self, number=None, digits=4):
        self.active, self.number, self.digits = number is not None, number or 0, digits


def test_the_first_list_has_what_the_panel_and_its_drive_have_what_is_urgent_first():
    drives = ("DRIVES", "ANY ADDRESS", "FIND DRIVES", "SETTINGS", "SETS")
    several, diagnosis = ("ORDER", "TURNS"), ("DIAGNOSIS",)
    parameters, last = ("PARAMETERS", "COMMISSION", "FAULT MEMORY"), ("EVENTS", "ABOUT")
    usual = drives + diagnosis + parameters + last
    for told, wanted in (
        ({}, usual),
        ({"controls": [None] * 2}, drives + several + diagnosis + parameters + last),
        ({"pkw_words": 0}, drives + diagnosis + last),
        ({"contact": False}, ("WHY NO CONTACT",) + usual),
        ({"lock_code": 1}, usual + ("LOCK",)),
        ({"fault": Alarm(2)}, ("WHAT IS F0002",) + usual),
        ({"fault": Alarm(2), "family": families.MM3}, ("WHAT IS F002",) + usual),
        ({"fault": Alarm(0)}, usual),
        ({"warning": Alarm(501)}, ("WHAT IS A0501",) + usual),
        ({"warning": Alarm(5, 3)}, ("WHAT IS A005",) + usual),
        ({"warning": Alarm(0)}, usual),
        ({"fault": Alarm(2), "warning": Alarm(501)}, ("WHAT IS F0002",) + usual),
        ({"fault": Alarm(0), "warning": Alarm(501)}, ("WHAT IS A0501",) + usual),
        (
            {"fault": Alarm(1), "contact": False, "lock_code": 9_999},
            ("WHY NO CONTACT", "WHAT IS F0001") + usual + ("LOCK",),
        ),
    ):
        shown = main_list.List(Begun(**told), None)
        found = tuple([shown.words(row).decode() for row in range(shown.count())])
        assert found == wanted, (told, found)
        assert shown.heading(0) == b"MENU"


def test_set_in_the_first_list_leads_to_the_list_of_its_entry_or_locks():
    panel = Begun(controls=[None] * 2, contact=False, lock_code=7, fault=Alarm(12))
    shown = main_list.List(panel, None)
    leads = [shown.choose(row, 500) for row in range(shown.count() - 1)]
    names = (
        "drives", "address", "find", "settings", "sets.overview", "order", "turns",
        "diagnosis.overview", "lookup.groups", "commission.overview", "lookup.memory", "events",
        "about",
    )  # fmt: skip
    what = ("lookup.what", ("F", 12, b"F0012"))
    assert leads == [("contact", None), what] + [(name, None) for name in names], leads
    assert panel.locked_ms == []
    assert shown.choose(shown.count() - 1, 500) is None and panel.locked_ms == [500]
    shown = main_list.List(Begun(warning=Alarm(501)), None)
    assert shown.choose(0, 0) == ("lookup.what", ("A", 501, b"A0501"))


def test_the_settings_are_those_that_the_board_has_use_for_each_with_its_value():
    """A light that can be switched, and a plug for the log."""

    class Board:
        name = "SIMULATED"

    values = {
        "baud": 38_400, "second_stop": "none", "reply_timeout_ms": 20, "lost_ms": 1_000,
        "setpoint_centihertz": 1_005, "setpoint_step_centihertz": 10, "lowest_centihertz": 0,
        "highest_centihertz": 65_000, "key_delay_ms": 400, "key_repeat_ms": 120,
        "light_minutes": 1, "language": "de", "log": "JSON",
    }  # fmt: skip
    told = [
        "BAUD 38400", "2ND STOP none", "REPLY 20 ms", "LOST 1000 ms", "START 10.05 Hz",
        "STEP 0.10 Hz", "LOW 0.00 Hz", "HIGH 650.00 Hz", "KEY WAIT 400 ms", "KEY RATE 120 ms",
        "LIGHT 1 min", "LANG. Deutsch", "LOG JSON",
    ]  # fmt: skip
    more = [("code", True), ("accepted", None), ("keys", None)]
    panel = Begun(board=Board(), **values)
    for backlight, serial, lacks in (
        (True, True, ()), (None, True, ("LIGHT 1 min",)), (True, None, ("LOG JSON",)),
        (None, None, ("LIGHT 1 min", "LOG JSON")),
    ):  # fmt: skip
        panel.board.backlight, panel.board.serial = backlight, serial
        shown = setting_list.List(panel, None)
        found = [shown.words(row).decode() for row in range(shown.count())]
        wanted = [row for row in told if row not in lacks]
        assert found == wanted + ["LOCK CODE", "P2014=0 OK", "KEY TEST"], found
        leads = [shown.choose(row, 0) for row in range(shown.count())]
        assert leads[-3:] == more and shown.heading(0) == b"SETTINGS"
        for (name, row), words in zip(leads[:-3], wanted):
            assert name == "value" and words.startswith(row[1].decode().split("%")[0]), row
    panel.light_minutes = 0
    panel.board.backlight = True
    shown = setting_list.List(panel, None)
    assert shown.words(10) == b"LIGHT STAYS ON"
