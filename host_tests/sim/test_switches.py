# SPDX-License-Identifier: MIT
"""The simulated keys: a hand, contacts that bounce, wires that break, and a matrix with ghosts."""

from boards.sim.chip.machine import Chip, Pin
from boards.sim.chip.switches import RISE_US, Switches
from boards.sim.clock import Clock

NAMES = ("START", "STOP", "UP", "DOWN", "EDIT", "SET")
GRID = (("UP", "DOWN"), ("EDIT", None), (None, "SET"))


class Bench:
    """START and STOP, normally closed, on pins; the others in a matrix of 3 x 2."""

    def __init__(self, random=None):
        self.clock = Clock()
        self.chip = Chip(self.clock, None)
        self.switches = Switches(self.clock, NAMES, ("STOP",), GRID, random)
        self.boot()

    def boot(self):
        self.start, self.stop = self.pins = self.inputs(2)
        self.rows = [Pin(self.chip, Pin.OPEN_DRAIN, value=1) for _ in range(3)]
        self.columns = self.inputs(2)
        self.switches.connect(self.pins, self.rows, self.columns)

    def inputs(self, count):
        return [Pin(self.chip, Pin.IN, Pin.PULL_UP) for _ in range(count)]

    def rest(self):
        self.clock.advance(RISE_US)

    def low_columns(self, row):
        """The columns that are low while a row is driven."""
        self.rows[row](0)
        self.rest()
        low = [number for number, pin in enumerate(self.columns) if not pin()]
        self.rows[row](1)
        self.rest()
        return low


def test_a_key_on_a_pin_of_its_own_joins_it_to_ground():
    bench = Bench()
    assert bench.switches.names == NAMES and bench.switches.direct == ("START", "STOP")
    assert bench.start() == 1
    bench.switches.hold("START")
    bench.switches.hold("START")
    assert bench.start() == 0
    bench.switches.let_go("START")
    assert bench.start() == 1


def test_a_normally_closed_key_parts_it_from_ground():
    bench = Bench()
    assert bench.stop() == 0
    bench.switches.hold("STOP")
    assert bench.stop() == 1
    bench.switches.let_go("STOP")
    assert bench.stop() == 0


def test_a_cut_wire_leaves_the_pin_to_its_pull_up():
    bench = Bench()
    bench.switches.hold("START")
    for key in ("START", "STOP", "UP"):
        bench.switches.cut(key)
    assert bench.start() == 1 and bench.stop() == 1
    bench.switches.hold("STOP")
    bench.switches.let_go("STOP")
    bench.switches.hold("UP")
    assert bench.stop() == 1 and bench.low_columns(0) == []


def test_a_column_falls_at_once_and_rises_slowly():
    bench = Bench()
    bench.switches.hold("UP")
    row, column = bench.rows[0], bench.columns[0]
    row(0)
    assert column() == 0
    row(1)
    bench.clock.advance(RISE_US - 1)
    assert column() == 0
    bench.clock.advance(1)
    assert column() == 1
    row(0)
    row(1)
    row(0)  # and one that had begun to rise falls again
    bench.rest()
    assert column() == 0


def test_each_key_of_the_matrix_joins_its_row_to_its_column():
    for row, keys in enumerate(GRID):
        for column, key in enumerate(keys):
            if key:
                bench = Bench()
                bench.switches.hold(key)
                for driven in range(3):
                    assert bench.low_columns(driven) == ([column] if driven == row else []), key


def test_three_keys_at_the_corners_of_a_rectangle_look_like_four():
    bench = Bench()
    for key in ("UP", "DOWN", "EDIT"):
        bench.switches.hold(key)
    assert [bench.low_columns(row) for row in range(3)] == [[0, 1], [0, 1], []]


def test_current_goes_backwards_through_as_many_keys_as_there_are():
    bench = Bench()
    for key in ("UP", "DOWN", "EDIT", "SET"):
        bench.switches.hold(key)
    assert [bench.low_columns(row) for row in range(3)] == [[0, 1]] * 3
    bench.switches.let_go("UP")
    bench.rest()
    assert [bench.low_columns(row) for row in range(3)] == [[1], [0], [1]]


def test_a_column_on_ground_pulls_down_what_keys_join_to_it():
    bench = Bench()
    bench.switches.ground(0)
    assert [pin() for pin in bench.columns] == [0, 1]
    bench.switches.hold("UP")
    assert [pin() for pin in bench.columns] == [0, 1]
    bench.switches.hold("DOWN")
    assert [pin() for pin in bench.columns] == [0, 0]


def test_a_chip_that_was_reset_finds_the_keys_as_they_are():
    bench = Bench()
    bench.switches.hold("START")
    bench.switches.hold("UP")
    bench.rows[0](0)  # and a reset in the middle of a scan lets go of the row
    bench.chip.reset()
    bench.boot()
    assert bench.start() == 0 and bench.stop() == 0
    bench.rest()
    assert [bench.low_columns(row) for row in range(3)] == [[0], [], []]


def test_rows_that_would_short_each_other_are_refused():
    bench = Bench()
    rows = [Pin(bench.chip, Pin.OUT, value=1) for _ in range(3)]
    try:
        bench.switches.connect(bench.pins, rows, bench.columns)
    except ValueError:
        return
    raise AssertionError("smoke")


def test_a_key_that_is_not_there_is_named():
    switches = Bench().switches
    for move in (switches.hold, switches.let_go, switches.cut):
        try:
            move("STRAT")
        except ValueError as error:
            assert str(error) == "no key STRAT: there are START STOP UP DOWN EDIT SET"
        else:
            raise AssertionError("no such key")


def test_without_a_seed_a_contact_moves_once():
    bench = Bench()
    assert edges(bench, "START", bench.switches.hold) == [(0, 0)]
    assert edges(bench, "STOP", bench.switches.hold) == [(0, 1)]


def test_with_a_seed_contacts_bounce_for_some_milliseconds_and_come_to_rest():
    counts = set()
    for seed in range(1, 30):
        bench = Bench(Dice(seed).random)
        books = taps(bench)
        assert books == taps(Bench(Dice(seed).random)), seed
        for book, level in zip(books, (0, 1, 1, 0)):
            assert book[-1][0] < 5_000 and book[-1][1] == level, (seed, book)
            counts.add(len(book))
    assert min(counts) == 1 and max(counts) == 9


def test_a_hand_that_is_quicker_than_the_bounces_has_the_last_word():
    for seed in range(1, 30):
        bench = Bench(Dice(seed).random)
        bench.switches.hold("START")
        bench.clock.advance(200)
        bench.switches.let_go("START")
        bench.clock.advance(10_000)
        assert bench.start() == 1, seed


class Dice:
    """Numbers that the seed decides."""

    def __init__(self, seed):
        self._state = seed

    def random(self, low, high):
        self._state = (self._state * 75 + 74) % 65537
        return low + self._state % (high - low + 1)


def taps(bench):
    """What the pins of START and STOP do while each is held and let go."""
    switches = bench.switches
    moves = (switches.hold, switches.let_go)
    return [edges(bench, key, move) for key in switches.direct for move in moves]


def edges(bench, key, move):
    """Every change of the key's pin in the 6 ms after a move, as (us, level), to 10 us."""
    pin = bench.pins[NAMES.index(key)]
    book = []
    level = pin()
    began_us = bench.clock.now_us
    move(key)
    while bench.clock.now_us < began_us + 6_000:
        if pin() != level:
            level = pin()
            book.append((bench.clock.now_us - began_us, level))
        bench.clock.advance(10)
    return book
