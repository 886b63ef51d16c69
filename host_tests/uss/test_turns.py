# SPDX-License-Identifier: MIT
"""Whose turn it is, without a line, a link or a master: `choose` is asked, and answers."""

from uss.layout import VARIABLE, Layout
from uss.outside import Mirror
from uss.receiver import SILENT
from uss.timing import Timing
from uss.turns import Turns

MASK = (1 << 30) - 1
LOST_US = 1_000_000
EXCHANGE_US = 20_000
READY = b"\xfb\x31\x00\x00"


class Table:
    """Drives at these addresses, and whoever asks those that have their turn; `silent` ones do
    not answer."""

    def __init__(self, *addresses, abandon=None):
        self.now = 0
        self.silent = set()
        self.turns = Turns(Timing(19200), MASK, LOST_US, lambda drive: False, abandon)
        self.drives = {address: self.turns.add(address) for address in addresses}

    def asked(self, count):
        """Whose the next so many turns are: addresses, None where it was nobody's."""
        return [self._ask() for _ in range(count)]

    def _ask(self):
        self.now += EXCHANGE_US
        drive = self.turns.choose(self.now)
        if drive is None:
            return None
        drive.fill(self.now)
        if drive.address in self.silent:
            drive.miss(SILENT, self.now, LOST_US, MASK)
        else:
            reply = bytes((2, 14, drive.address)) + bytes(8) + READY + bytes(1)
            drive.take(reply, len(reply), self.now)
        return drive.address

    def rest(self, count):
        """The loop comes round so often, and nobody has a turn meanwhile."""
        for _ in range(count):
            self.now += 4_000
            self.turns.deadlines.look(self.now)


def test_the_list_goes_round_as_it_is_arranged():
    table = Table(1, 2, 3)
    assert table.asked(7) == [1, 2, 3, 1, 2, 3, 1]
    one, two, three = table.turns.drives
    table.turns.arrange((one, two, one, three))
    assert table.asked(6) == [1, 2, 1, 3, 1, 2]
    table.turns.remove(two)
    assert table.asked(4) == [3, 1, 1, 3]
    assert table.turns.exchanges == 17


def test_nobody_has_a_turn_in_an_empty_list():
    table = Table()
    assert table.asked(3) == [None] * 3
    assert table.turns.wait_us() == 0 and table.turns.exchanges == 0


def test_a_round_that_is_over_early_waits_for_its_cycle_time():
    table = Table(1, 2)
    table.turns.cycle_us = 5 * EXCHANGE_US
    assert table.asked(3) == [1, 2, None]
    assert table.turns.wait_us() == 3 * EXCHANGE_US
    assert table.asked(7) == [None, None, 1, 2, None, None, None]


def test_a_round_that_begins_late_keeps_in_step_unless_it_is_late_by_a_whole_one():
    """To the microsecond, also where the counter of the clock begins anew."""
    for began in (0, MASK - 50_000, MASK - 150_000, MASK - 450_000):
        turns = Table(1).turns
        turns.cycle_us = 100_000
        for at, wait_us in (
            (0, 0),
            (99_999, 1),
            (130_000, 0),  # the second round, 30 ms late
            (199_999, 1),
            (200_000, 0),
            (399_999, 0),  # the fourth has begun in step, so the fifth begins
            (400_000, 0),
            (600_000, 0),  # one is left out
            (699_999, 1),
            (750_000, 0),
            (799_999, 1),
            (800_000, 0),
        ):
            drive = turns.choose((began + at) & MASK)
            assert (drive is None) == (wait_us > 0), (began, at)
            assert turns.wait_us() == wait_us, (began, at)


def test_a_cycle_time_is_a_quarter_of_what_the_clock_can_tell_at_the_most():
    for cycle_us in (MASK >> 2, 1 << 28, 1 << 29, MASK):
        turns = Table(1).turns
        turns.cycle_us = cycle_us
        assert turns.choose(0)
        assert turns.choose((MASK >> 2) - 1) is None and turns.wait_us() == 1
        assert turns.choose(MASK >> 2)


def test_a_stop_goes_before_other_commands_and_these_before_the_list():
    table = Table(1, 2, 3, 4)
    table.asked(4)
    table.drives[3].acknowledge()
    table.drives[4].stop()
    table.drives[2].start(0x1000)
    table.asked(3)
    table.drives[3].hurry()
    table.drives[2].stop()
    assert table.asked(4) == [2, 3, 1, 2]


def test_of_equal_calls_the_one_behind_the_last_goes_first():
    table = Table(0, 1, 2, 31)
    table.asked(4)
    for last, order in ((2, [1, 2, 31, 0]), (31, [31, 0, 1, 2])):
        for drive in table.turns.drives:
            drive.stop()
        assert table.asked(4) == order
        table.drives[last].stop()
        assert table.asked(1) == [last], last
    for drive in table.turns.drives:
        drive.stop()
    assert table.asked(4) == [0, 1, 2, 31]


def test_an_on_that_is_taken_back_goes_ahead_of_the_list():
    table = Table(1, 2, 3, 4)
    table.asked(4)
    table.drives[3].start(0x1000)
    table.asked(1)
    table.drives[3].revoke()
    assert table.turns.has_command() and table.asked(2) == [3, 1]
    table.drives[3].revoke()  # it is off already
    assert not table.turns.has_command() and table.asked(2) == [2, 3]


def test_what_nobody_answered_is_repeated_unless_the_drive_was_removed():
    table = Table(1, 2, 3)
    table.asked(1)
    table.turns.repeat(table.drives[1])
    assert table.asked(3) == [1, 2, 3]
    table.turns.repeat(table.drives[2])
    table.turns.remove(table.drives[2])
    table.turns.repeat(table.drives[2])
    assert table.asked(3) == [1, 3, 1]


def test_telegrams_outside_the_list_have_every_second_turn_and_one_ahead_the_next():
    table = Table(1, 2)
    table.asked(2)
    urgent = Mirror(9)
    urgent.ahead = True
    for telegram in (Mirror(7), Mirror(8), urgent):
        table.turns.post(telegram)
    assert table.turns.has_command() and not table.turns.all_told()
    assert [address & 0x1F for address in table.asked(6)] == [9, 7, 1, 8, 2, 1]
    assert not table.turns.has_command()


def test_a_stop_is_told_when_it_is_answered_or_the_drive_is_lost_and_was_sent_it_often_enough():
    table = Table(1, 2)
    table.asked(2)
    for drive in table.turns.drives:
        drive.start(0x1000)
    table.asked(2)
    table.silent.add(2)
    for drive in table.turns.drives:
        drive.stop()
    assert not table.turns.all_told()
    table.asked(30)
    assert table.drives[1].answered_off() and table.drives[2].contact
    assert not table.turns.all_told()
    table.asked(60)
    assert not table.drives[2].contact and table.turns.all_told()


def test_a_lost_drive_is_told_when_it_was_sent_its_stop_often_enough_or_once_if_it_stood():
    table = Table(1, 2, 3)
    table.asked(3)
    one, two = table.drives[1], table.drives[2]
    two.start(0x1000)
    table.asked(3)
    assert not table.turns.all_told()  # it runs
    table.silent.update((1, 2))
    two.lose()
    sent = 0
    while not table.turns.all_told():
        sent += table.asked(1) == [2]
    assert sent == 11
    one.lose()
    assert table.turns.all_told()
    one.stop()
    assert not table.turns.all_told()
    assert table.asked(1) == [1] and table.turns.all_told()


def test_a_drive_that_does_not_answer_rests_and_comes_back():
    table = Table(1, 2, 3)
    table.silent.add(2)
    table.asked(3)
    table.rest(200)
    assert table.turns.round_count == 2
    assert table.asked(4).count(2) <= 1
    table.silent.clear()
    for _ in range(10):
        table.rest(200)
        table.asked(4)
    assert table.turns.round_count == 3 and table.drives[2].contact


def eight(*lost):
    """Eight drives, those that are lost left the round."""
    table = Table(*range(1, 9))
    table.asked(8)
    table.silent.update(lost)
    for _ in range(3):
        table.rest(50)
        table.asked(40)
    assert [drive.address for drive in table.turns.drives if not drive.contact] == list(lost)
    table.turns.arrange(table.turns.drives)  # a round begins
    return table


def asked_of_pressed(table, pressed, count):
    """Whose turns they are while the loop presses these as long as they wait."""
    waiting, asked = list(pressed), []
    for _ in range(count):
        for address in waiting:
            table.drives[address].press()
        asked += table.asked(1)
        if asked[-1] in waiting:
            waiting.remove(asked[-1])
    return asked


def test_two_drives_that_would_be_late_go_before_each_turn_of_the_list():
    assert asked_of_pressed(eight(), (5, 6, 7, 8), 8) == [5, 6, 1, 7, 8, 2, 3, 4]
    assert asked_of_pressed(eight(), (5,), 4) == [5, 1, 2, 3]
    table, asked = eight(), []
    for _ in range(9):
        for address in (5, 6, 7, 8):  # they are always late, and have equal turns
            table.drives[address].press()
        asked += table.asked(1)
    assert asked == [5, 6, 1, 7, 8, 2, 5, 6, 3]
    table = eight()
    table.drives[4].press(1)  # at rest: behind one that may run
    assert asked_of_pressed(table, (7,), 4) == [7, 4, 1, 2]


def test_a_drive_that_wants_more_gets_every_second_turn_or_every_fourth():
    table = eight()
    table.drives[5].want_turns(True)
    assert table.asked(8) == [5, 1, 5, 2, 5, 3, 5, 4]
    table.drives[6].want_turns(True)  # by turns with it,
    for address in (10, 11):  # and both with telegrams outside the list
        table.turns.post(Mirror(address))
    asked = [address & 0x1F for address in table.asked(12)]
    assert asked[1::2] == [5, 6, 7, 8, 1, 2], asked
    assert asked[0::2] == [10, 6, 11, 5, 6, 5], asked
    table = eight()
    table.turns.lists_between = 3
    table.drives[8].want_turns(True)
    assert table.asked(12) == [8, 1, 2, 3, 8, 4, 5, 6, 8, 7, 8, 1]
    table.drives[8].want_turns(False)
    assert table.asked(9) == [2, 3, 4, 5, 6, 7, 8, 1, 2]


def test_a_drive_that_wants_more_is_not_forgotten_behind_a_repeat_or_a_foreseen_turn():
    table = eight()
    assert not table.turns.is_called()
    table.drives[5].want_turns(True)
    table.turns.repeat(table.drives[8])
    assert table.turns.is_called() and table.asked(4) == [8, 5, 1, 5]
    assert not table.turns.is_called()
    table = eight()
    assert table.turns.foresee(0) is table.drives[1]
    table.drives[5].want_turns(True)
    assert table.asked(4) == [1, 5, 2, 5] and not table.turns.is_called()


def foreseen(table, count):
    """Whose the next turns are by `foresee`, each of them passed on at once."""
    asked = []
    for _ in range(count):
        table.now += EXCHANGE_US
        drive = table.turns.foresee(table.now)
        assert table.turns.foresee(table.now) is drive
        drive.fill(table.now)
        drive.take(bytes((2, 14, drive.address)) + bytes(8) + READY + bytes(1), 16, table.now)
        table.turns.pass_on()
        asked.append(drive.address & 0x1F)
    return asked


def test_what_is_foreseen_is_what_would_be_chosen():
    table = eight()
    exchanges = table.turns.exchanges
    assert foreseen(table, 10) == [1, 2, 3, 4, 5, 6, 7, 8, 1, 2]
    assert table.turns.exchanges == exchanges + 10
    table.drives[5].want_turns(True)
    assert foreseen(table, 8) == [5, 3, 5, 4, 5, 5, 5, 6]
    table.turns.lists_between = 3
    assert foreseen(table, 12) == [5, 7, 8, 1, 5, 2, 3, 4, 5, 5, 6, 7]
    table.drives[5].want_turns(False)
    assert foreseen(table, 4) == [8, 1, 2, 3]
    table.turns.exchanges = 0xFFFF
    assert foreseen(table, 1) == [4] and table.turns.exchanges == 0


def test_who_was_foreseen_keeps_the_turn_behind_what_is_more_urgent():
    table = eight()
    turns, drives = table.turns, table.drives
    assert turns.foresee(0) is drives[1]
    drives[3].stop()
    assert turns.foresee(0) is None
    assert table.asked(1) == [3]
    turns.repeat(drives[7])
    assert turns.foresee(0) is None
    assert table.asked(3) == [7, 1, 2]
    mirror = Mirror(9)
    mirror.ahead = True
    turns.post(mirror)
    assert turns.foresee(0) is None
    assert [address & 0x1F for address in table.asked(3)] == [9, 3, 4]
    drives[8].press()
    assert turns.foresee(0) is None
    assert table.asked(3) == [8, 5, 6]
    assert turns.foresee(0) is drives[7]
    turns.remove(drives[8])
    assert turns.foresee(0) is drives[7] and not turns.is_called()
    turns.remove(drives[7])
    assert turns.is_called()  # what was made ready is perhaps for it
    assert turns.foresee(0) is drives[1]
    assert table.asked(3) == [1, 2, 3]
    turns.cycle_us = 1_000_000
    assert turns.foresee(0) is None


def test_stops_go_before_other_commands_and_those_in_vain_leave_room_for_who_would_be_late():
    table = eight(6, 7, 8)
    for address in (1, 6):
        table.drives[address].stop()
    for address in (2, 3):
        table.drives[address].start(0x1000)
    table.drives[4].acknowledge()
    asked = table.asked(5)
    assert set(asked[:3]) == {1, 4, 6} and set(asked[3:]) == {2, 3}, asked
    table = eight(6, 7, 8)
    for address in (6, 7, 8):
        table.drives[address].stop()
    asked = asked_of_pressed(table, (1, 2, 3, 4, 5), 8)
    places = [place for place, address in enumerate(asked) if address > 5]
    assert places == [0, 4, 7] and set(asked) == set(range(1, 9)), asked
    table = eight(6, 7, 8)  # but one that is told to run waits for the stops
    table.drives[2].start(0x1000)
    table.asked(2)
    for address in (6, 7, 8):
        table.drives[address].stop()
    asked = asked_of_pressed(table, (2,), 4)
    assert set(asked[:3]) == {6, 7, 8} and asked[3] == 2, asked


def test_a_stop_to_a_drive_in_contact_waits_for_none_that_would_be_late():
    table = eight(6, 7, 8)
    table.drives[6].stop()
    for address in (1, 2, 4):
        table.drives[address].press()
    assert table.asked(1) == [6]  # in vain: now those have their turns,
    table.drives[3].stop()
    assert table.asked(1) == [3]  # but not before this one
    table.drives[7].stop()
    assert table.asked(4) == [1, 2, 4, 7]


def test_a_drive_that_trips_soon_has_its_turn_in_time_in_a_long_list():
    table = Table(*range(1, 32))
    table.asked(31)
    first = table.drives[1]
    first.start(0x1000)
    table.turns.deadlines.supervise(first, 900)
    asked = []
    for _ in range(200):
        table.rest(4)
        asked += table.asked(1)
    gaps = [len(piece) for piece in "".join([".1"[each == 1] for each in asked]).split("1")]
    assert max(gaps[1:-1]) < 300 // 36, gaps
    assert set(asked) == set(range(1, 32))


def test_a_drive_that_has_moved_calls_at_its_new_address_and_no_more_at_the_old_one():
    for old, new in ((9, 5), (5, 9)):
        table = Table(1, 2, old)
        turns, drive = table.turns, table.drives[old]
        table.asked(3)
        drive.stop()
        turns.readdress(drive, new)
        assert turns.has_command()
        assert table.asked(1) == [new] and not turns.has_command()
        assert turns.at(old) is None and turns.at(new) is drive
        drive.want_turns(True)
        turns.readdress(drive, new)  # where it is already
        assert turns.at(new) is drive
        turns.readdress(drive, old)
        assert table.asked(6)[0::2] == [old] * 3
        drive.want_turns(False)
        turns.add(new)  # somebody else, who has not called
        assert table.asked(5).count(new) in (1, 2) and turns.at(new) is not drive


def test_who_called_and_is_gone_or_wants_no_more_is_forgotten_and_the_others_are_heard():
    table = Table(*range(1, 10))
    table.asked(9)
    for address in range(1, 7):
        table.drives[address].stop()
    for address in range(1, 7):
        table.turns.remove(table.drives[address])
    table.drives[8].stop()
    table.turns.remove(table.drives[7])  # no other call is lost by it
    assert table.asked(1) == [8]
    table = eight()
    for address in range(1, 7):
        table.drives[address].want_turns(True)
        table.drives[address].want_turns(False)
    table.drives[8].want_turns(True)  # an interrupt forgets four of them at the most
    assert table.asked(5) == [1, 8, 2, 8, 3]
    table.drives[8].want_turns(False)
    table.drives[7].want_turns(True)
    assert table.asked(8).count(7) >= 4


def test_who_leaves_the_round_or_joins_it_takes_no_turn_from_anybody():
    order = (1, 2, 1, 3, 4, 1, 5)
    for rests in (1, 2, 3, 5):
        for before in range(len(order) + 1):
            for between in range(4):
                table = Table(*range(1, 6))
                turns, drive = table.turns, table.drives[rests]
                turns.arrange([table.drives[address] for address in order])
                table.asked(before)
                turns.deadlines.silence.rests[rests] = True
                turns.leave_round(drive)
                rest = [each for each in order[before:] + order if each != rests]
                assert table.asked(between) == rest[:between], (rests, before)
                turns.deadlines.silence.rests[rests] = False
                turns.join_round(drive)
                place, left = before, between
                while left:  # the turns that the others had meanwhile
                    left -= order[place % len(order)] != rests
                    place += 1
                place %= len(order)
                others = table.asked(7)
                assert [each for each in others if each != rests] == [
                    each for each in (order + order)[place : place + 9] if each != rests
                ][: len(others) - others.count(rests)], (rests, before, between)
                behind = table.asked(14)
                assert behind[:7] == behind[7:] and behind.count(rests) == 2 * order.count(rests)


def test_a_stop_in_the_midst_of_another_layout_is_heard_and_goes_first():
    def abandon(drive):
        drive.stop()
        assert table.turns.at(4) is None
        assert table.asked(2) == [1, 5]  # an interrupt comes in, and does not find it

    table = Table(*range(1, 9), abandon=abandon)
    table.asked(8)
    drive = table.drives[4]
    drive.lose()
    table.drives[5].want_turns(True)
    assert table.asked(1) == [5]
    layout = Layout(3, 2)
    table.turns.relayout(drive, layout)
    assert drive.layout is layout and table.turns.at(4) is drive
    table.silent.add(4)
    assert table.asked(1) == [4] and table.turns.round_count == 8
    other = Table(4)
    try:
        other.turns.relayout(drive, layout)
    except ValueError as error:
        assert str(error) == "drive 4 is not on this bus"
    else:
        raise AssertionError


def test_a_layout_that_comes_too_late_or_to_nothing_leaves_the_drive_in_its_place():
    for error in (None, MemoryError):

        def abandon(drive, error=error):
            assert table.turns.round_count == 2
            if error:
                raise error
            drive.contact = True  # it has answered

        table = Table(1, 2, 3, abandon=abandon)
        table.asked(3)
        drive = table.drives[2]
        drive.lose()
        before = drive.layout
        try:
            table.turns.relayout(drive, Layout(3, 2))
        except (ValueError, MemoryError):
            pass
        else:
            raise AssertionError(error)
        assert drive.layout is before and table.turns.at(2) is drive
        assert table.asked(3) == [1, 2, 3] and table.turns.round_count == 3


def test_the_longest_exchange_is_that_of_the_largest_layout_that_is_left():
    turns = Table().turns
    assert turns.longest_exchange_us == turns.longest_cycle_us() == 0
    small, large = Layout(3, 2), Layout(4, 16)
    one = turns.add(1, small)
    assert turns.longest_exchange_us == turns.longest_cycle_us([one]) > 0
    two = turns.add(2, large)
    three = turns.add(3, Layout(3, 2))
    turns.add(3)
    assert turns.longest_exchange_us == turns.longest_cycle_us([two])
    assert turns.longest_cycle_us() == turns.longest_cycle_us([one, two, three, three])
    turns.remove(two)
    assert turns.longest_exchange_us == turns.longest_cycle_us([one])
    turns.relayout(one, large)
    assert turns.longest_exchange_us == turns.longest_cycle_us([one])
    fixed_us = turns.longest_exchange_us
    turns.add(4, Layout(VARIABLE, 2))  # its reply may have any length
    assert turns.longest_exchange_us > fixed_us + 200 * turns.timing.character_us
