# SPDX-License-Identifier: MIT
"""The menu by itself: how its lists are opened, walked and closed."""

import sys

from menu_bench import Machine, Told
from panel import texts
from panel.keys import NAMES as ALL
from panel.keys import Acts, Keys
from panel.menu import BACK, PAGE, Entries
from panel.menu.engine import Menu


class Own(Entries):
    """Three entries, the first of which is the argument; what it does is what its fields say."""

    entries, follows, taken, moves = 3, None, False, False
    does = seeks = False
    of_drive = None

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self.did = []
        panel.lists.append(self)

    def first(self):
        return self.argument

    def count(self):
        return self.entries

    def heading(self, position):
        return b"OWN %d" % len(self.panel.lists)

    def words(self, position):
        return b"ENTRY %d" % position

    def is_busy(self):
        return self.does

    def is_searching(self):
        return self.seeks

    def search(self):
        self.did.append("search")

    def control_at(self, position):
        return self.of_drive

    def choose(self, position, now_ms):
        self.did.append(position)
        return self.follows

    def change(self, position, steps):
        self.did.append(steps)
        return self.moves

    def take_keys(self, acts):
        return self.taken

    def leave(self, now_ms):
        self.did.append("leave")

    def end(self):
        self.did.append("end")


class Module:
    """Where the list stands."""

    List = Own


class Full:
    """One for which there is no memory."""

    @staticmethod
    def List(panel, argument):
        raise MemoryError


class Opened:
    """The menu of such a panel, with that list in it."""

    def __init__(self, name="own", module=Module, at_ms=0):
        self.panel = Told()
        self.now_ms = at_ms
        self.name = "panel.menu." + name
        sys.modules[self.name] = module
        self.menu = Menu(self.panel, (name, 0))
        self.come()

    def come(self):
        sys.modules.setdefault(self.name, Module)
        for _ in range(9):
            if self.menu.is_busy:
                self.menu.work(self.now_ms)

    def press(self, *keys):
        for key in keys:
            acts = Acts(Keys(ALL, self.panel.mask))
            acts.pressed = acts.bit(key)
            self.menu.take_keys(acts, self.now_ms)

    def repeat(self, key, times):
        acts = Acts(Keys(ALL, self.panel.mask))
        acts.repeated, acts.repeats = acts.bit(key), times
        self.menu.take_keys(acts, self.now_ms)

    def step(self, ms=0):
        self.now_ms = self.now_ms + ms & self.panel.mask
        self.menu.step(None, self.now_ms)
        return not self.is_closed()

    def is_closed(self):
        return "uncover" in self.panel.did

    def rows(self):
        self.picture = [bytearray(b"." * 16), bytearray(b"." * 16)]
        self.menu.draw(self, self.now_ms)
        self.menu.draw_row_2(self, self.now_ms)
        return tuple([bytes(row).decode() for row in self.picture])

    def put(self, row, column, width, words):
        assert len(words) <= width, words
        self.picture[row][column : column + width] = words + b" " * (width - len(words))

    def place(self):
        return int(self.rows()[1][len(">ENTRY ") :])


def test_a_list_goes_round_by_either_pair_of_keys_and_by_the_address_keys_one_alone():
    for name, walks in (("own", False), ("address", True)):
        opened = Opened(name)
        for key, place in (
            ("DOWN", 1), ("DOWN", 2), ("DOWN", 0), ("UP", 2), ("UP", 1), ("NEXT", 2), ("NEXT", 0),
            ("PREVIOUS", 2), ("ADDRESS_UP", 0 if walks else 2), ("ADDRESS_UP", 1 if walks else 2),
            ("ADDRESS_DOWN", 0 if walks else 2), ("ADDRESS_DOWN", 2), ("EDIT", 2),
        ):  # fmt: skip
            opened.press(key)
            assert opened.place() == place, (name, key)
        opened.repeat("DOWN", 30)  # by one, however long it is held
        assert opened.place() == 0
        opened.menu.close()
        sys.modules.pop(opened.name, None)  # the list of that name is another one


def test_a_list_says_where_it_is_unless_it_has_one_entry_alone():
    opened = Opened()
    (own,) = opened.panel.lists
    assert opened.rows() == ("OWN 1        1/3", ">ENTRY 0        ")
    opened.press("UP")
    assert opened.rows() == ("OWN 1        3/3", ">ENTRY 2        ")
    own.entries = 2  # what was last in it has gone
    assert opened.rows() == ("OWN 1        2/2", ">ENTRY 1        ")
    opened.press("SET")
    own.entries = 1
    assert opened.rows() == ("OWN 1           ", ">ENTRY 0        ")
    opened.press("SET")
    assert own.did[-2:] == [1, 0]  # what is shown was chosen
    own.entries = 120
    assert opened.rows()[0] == "OWN 1      3/120"


def test_up_and_down_move_a_value_the_faster_the_longer_they_are_held():
    opened = Opened()
    (own,) = opened.panel.lists
    own.moves = True
    opened.press("UP", "DOWN")
    for times in (8, 9, 16, 17):
        opened.repeat("UP", times)
    opened.repeat("DOWN", 17)
    assert own.did == [1, -1, 1, 10, 10, 100, -100] and opened.place() == 0


def test_set_leads_to_another_list_and_param_back_to_where_that_was_chosen():
    opened = Opened()
    panel = opened.panel
    (own,) = panel.lists
    opened.press("DOWN", "SET")
    assert own.did[-1] == 1 and opened.rows() == ("OWN 1        2/3", ">ENTRY 1        ")
    own.follows = "own", 2
    panel.time_left = False
    opened.press("SET", "UP", "PARAM")  # it comes where there is time; until then no key counts
    opened.come()
    assert len(panel.lists) == 1 and opened.menu.is_busy and opened.place() == 1
    panel.time_left = True
    opened.come()
    assert not opened.menu.is_busy and opened.rows() == ("OWN 2        3/3", ">ENTRY 2        ")
    opened.press("PARAM")
    assert panel.lists[1].did == ["leave", "end"] and opened.place() == 1
    own.follows = BACK
    opened.press("SET")
    assert own.did[-2:] == ["leave", "end"] and panel.did == ["uncover"]


def test_a_list_may_take_the_keys_or_leave_by_them():
    opened = Opened()
    (own,) = opened.panel.lists
    own.taken = True
    opened.press("DOWN", "SET", "PARAM", "START")
    assert own.did == [] and opened.rows()[1] == ">ENTRY 0        "
    own.taken = BACK
    opened.press("EDIT")
    assert own.did == ["leave", "end"] and opened.is_closed()


def test_a_page_comes_when_the_lists_have_gone_one_by_one_the_one_shown_with_it():
    opened = Opened()
    panel = opened.panel
    panel.lists[0].follows = "own", 1
    opened.press("SET")
    opened.come()
    panel.lists[1].follows = PAGE, 7
    panel.time_left = False
    opened.press("SET", "PARAM", "DOWN")
    assert opened.menu.is_busy
    opened.menu.work(0)
    assert panel.lists[0].did[-1] == "end" and panel.did == [] and opened.place() == 1
    opened.menu.work(0)
    assert panel.did == []
    panel.time_left = True
    opened.menu.work(0)
    assert panel.did == [7] and panel.lists[1].did == [1]


def test_what_is_said_in_place_of_an_entry_has_three_seconds_or_until_a_key_is_pressed():
    for key in ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT"):
        opened = Opened(at_ms=Told.mask - 1_000)
        opened.press(key)
        told = ">NO: IN THE MENU"
        assert opened.step() and opened.rows()[1] == told
        opened.step(2_999)
        opened.repeat("EDIT", 1)
        assert opened.rows()[1] == told
        opened.step(1)
        assert opened.rows()[1] == ">ENTRY 0        "
        opened.press(key, "EDIT")
        assert opened.rows()[1] == ">ENTRY 0        "


def test_a_menu_is_open_for_a_minute_from_the_last_key_or_from_what_its_list_does():
    opened = Opened(at_ms=Told.mask - 70_000)
    assert opened.step() and opened.step(59_999)
    opened.repeat("DOWN", 1)
    assert opened.step(59_999)
    opened.press("EDIT")
    (own,) = opened.panel.lists
    own.does = True
    assert opened.step(59_999) and opened.step(500_000)
    own.does = False
    assert opened.step(59_999) and not opened.step(1)
    assert own.did[-1] == "end" and opened.panel.did == ["uncover"]


def test_an_alarm_of_the_drive_shown_closes_it_when_it_comes_and_else_has_every_other_turn():
    opened = Opened()
    opened.panel.selected.is_alarmed = True
    assert not opened.step()
    panel = Told()
    panel.selected.is_alarmed = True
    sys.modules[opened.name] = Module
    opened.panel, opened.menu = panel, Menu(panel, ("own", 0))
    opened.come()
    assert opened.step() and opened.step(1_000)  # it was there when that was opened
    for turn, row in ((0, "OWN 1        1/3"), (1, "A3 LOST,MAY RUN "), (2, "OWN 1        1/3")):
        panel.page_turns = turn
        assert opened.rows()[0] == row, turn
    panel.selected.is_alarmed = False
    assert opened.step()
    panel.page_turns = 1
    assert opened.rows()[0] == "OWN 1        1/3"
    panel.selected.is_alarmed = True
    assert not opened.step()


def test_stop_in_the_menu_stops_the_drive_that_its_entry_names_once_and_says_so():
    """The one that is shown has been stopped already."""
    for named, other, told in (
        (None, 0, "A3: STOP"), (0, 0, "A3: STOP"), (1, 1, "A3 A12: STOP"), ("gone", 0, "A3: STOP")
    ):  # fmt: skip
        opened = Opened()
        shown, second = opened.panel.controls
        gone = Machine(9)
        own = opened.panel.lists[0]
        own.of_drive = {None: None, 0: shown, 1: second, "gone": gone}[named]
        opened.press("STOP")
        assert (shown.stopped, second.stopped, gone.stopped) == (0, other, 0), named
        assert opened.rows()[1].rstrip() == ">" + told
    own.tells_stop = False
    opened.press("EDIT", "STOP")
    assert opened.rows()[1] == ">ENTRY 0        "


def test_a_list_for_which_there_is_no_memory_says_so_and_leaves_what_was_shown():
    opened = Opened(module=Full)
    assert opened.panel.did == [texts.NO_MEMORY, "uncover"] and not opened.menu.is_ready()
    opened = Opened()
    (own,) = opened.panel.lists
    own.follows = "own", 1
    opened.press("SET")
    sys.modules[opened.name] = Full
    opened.come()
    assert opened.panel.did == [texts.NO_MEMORY] and not opened.menu.is_busy
    assert opened.menu.is_ready() and opened.place() == 0


def test_a_menu_that_closes_ends_each_list_once_whatever_was_to_come():
    opened = Opened()
    panel = opened.panel
    panel.lists[0].follows = "own", 1
    opened.press("SET")
    opened.come()
    panel.lists[1].follows = "own", 1
    panel.lists[1].seeks = True
    assert opened.menu.is_busy
    opened.menu.work(0)
    assert panel.lists[1].did == ["search"]
    opened.press("SET")
    opened.menu.close()
    assert [own.did[-1] for own in panel.lists] == ["end"] * 2 and panel.did == ["uncover"]
    assert [own.did.count("end") for own in panel.lists] == [1, 1]
    assert not opened.menu.is_busy and not opened.menu.is_ready()
    assert opened.rows() == ("." * 16, "." * 16)
