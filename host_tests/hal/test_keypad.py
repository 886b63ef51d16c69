# SPDX-License-Identifier: MIT
"""Keys by the hardware: on pins, normally closed, in a matrix without diodes, and broken ones."""

import main
from boards.sim.board import KEYS, NORMALLY_CLOSED, WIRINGS, make_keypad
from boards.sim.chip.machine import Chip, Pin
from boards.sim.chip.switches import Switches
from boards.sim.clock import Clock
from boards.sim.world import World
from hal.keypad import Keypad, Matrix
from panel.keys import Keys
from panel_bench import panel

try:
    from micropython import heap_lock, heap_unlock
except ImportError:  # CPython has no heap to lock

    def heap_lock():
        pass

    def heap_unlock():
        pass


IN_MATRIX = tuple(key for row in WIRINGS["matrix"] for key in row)
DIRECT = tuple(key for key in KEYS if key not in IN_MATRIX)


class Interrupted(Clock):
    def __init__(self, interrupts):
        Clock.__init__(self)
        self._interrupts = interrupts

    def sleep_us(self, us):
        if self._interrupts:
            raise self._interrupts.pop()
        Clock.sleep_us(self, us)


class Bench:
    """A keypad on a chip, and a hand. interrupts: what the next waits of the keypad raise."""

    def __init__(self, wiring="matrix", random=None, interrupts=()):
        self.clock = Interrupted(interrupts)
        self.chip = Chip(self.clock, None)
        self.switches = Switches(self.clock, KEYS, NORMALLY_CLOSED, WIRINGS[wiring], random)
        self.keypad = make_keypad(self.chip, self.switches)

    def hold(self, *keys):
        for key in keys:
            self.switches.hold(key)

    def let_go(self, *keys):
        for key in keys:
            self.switches.let_go(key)

    def down(self):
        """The names of the keys that the keypad reads as down, 2 ms after the last reading."""
        self.clock.advance(2000)
        raw = self.keypad.read()
        assert not raw >> len(KEYS)
        return {name for bit, name in enumerate(self.keypad.names) if raw >> bit & 1}

    def unclear(self):
        """The names of the keys that the last reading could not determine."""
        unclear = self.keypad.unclear
        return {name for bit, name in enumerate(self.keypad.names) if unclear >> bit & 1}

    def reads(self, *keys):
        """What is read while these keys and no others are held."""
        self.hold(*keys)
        read = self.down()
        self.let_go(*keys)
        return read


def refused(function, *arguments, **keywords):
    try:
        function(*arguments, **keywords)
    except ValueError as error:
        return str(error)
    raise AssertionError("taken")


# --- every key -----------------------------------------------------------------------------------


def test_a_bit_for_every_key_in_the_order_of_the_names():
    assert Bench("direct").keypad.names == KEYS
    assert Bench("matrix").keypad.names == DIRECT + IN_MATRIX
    assert sorted(DIRECT + IN_MATRIX) == sorted(KEYS)


def test_every_key_alone():
    for wiring in WIRINGS:
        bench = Bench(wiring)
        for key in KEYS:
            assert bench.reads(key) == {key}
            assert bench.down() == set()


def test_all_keys_at_once_on_pins_of_their_own():
    bench = Bench("direct")
    assert bench.reads(*KEYS) == set(KEYS)


def test_readings_may_follow_each_other_at_once():
    bench = Bench()
    for key in KEYS:
        bench.hold(key)
        bench.clock.advance(10)
        one = bench.keypad.read()
        assert one and bench.keypad.read() == one, key
        bench.let_go(key)
        bench.clock.advance(10)


# --- the matrix ----------------------------------------------------------------------------------


def test_every_two_keys_of_the_matrix_are_read_right():
    bench = Bench()
    for first in IN_MATRIX:
        for second in IN_MATRIX:
            assert bench.reads(first, second) == {first, second}


def test_every_three_keys_are_read_right_or_not_at_all():
    bench = Bench()
    ambiguous = 0
    for one in range(12):
        for two in range(one):
            for three in range(two):
                keys = {IN_MATRIX[one], IN_MATRIX[two], IN_MATRIX[three]}
                read = bench.reads(*keys)
                assert read == keys or not read, (keys, read)
                ambiguous += not read
    # A rectangle is two rows and two columns; three of its four corners are one of these.
    assert ambiguous == 3 * 6 * 4


def test_any_number_of_keys_is_read_right_or_none_of_the_matrix():
    bench = Bench()
    dice = World(main.start, seed=19).random
    print("seed 19")
    right = 0
    for _ in range(1000):
        held = {key for key in KEYS if dice(1, 100) <= 35}
        read = bench.reads(*held)
        assert read in (held, held & set(DIRECT)), (held, read)
        right += read == held
    assert 100 < right < 900


def test_three_corners_and_a_place_without_a_key_do_not_count_either():
    clock = Clock()
    chip = Chip(clock, None)
    grid = (("UP", "DOWN"), ("SET", None))
    switches = Switches(clock, ("STOP", "UP", "DOWN", "SET"), ("STOP",), grid)
    keypad = make_keypad(chip, switches)
    for key in ("UP", "DOWN"):
        switches.hold(key)
    assert keypad.read() == 0b0110
    switches.hold("SET")
    assert keypad.read() == 0


def test_stop_and_start_are_read_while_the_matrix_is_ambiguous():
    bench = Bench()
    bench.hold("UP", "DOWN", "NEXT")
    assert bench.down() == set()
    assert bench.reads("STOP") == {"STOP"}
    assert bench.reads("START", "STOP") == {"START", "STOP"}
    bench.let_go("NEXT")
    assert bench.down() == {"UP", "DOWN"}


class SlowLine:
    """The pins of a row and of a column with one key between them, which is down. What the row
    does arrives at the column 15 us later, down and up."""

    def __init__(self, clock):
        self.clock = clock
        self.changes = [(-100, 1)]
        self.row, self.column = Level(self.put), Level(self.level)

    def put(self, level):
        self.changes.append((self.clock.now_us, level))

    def level(self):
        arrived = [level for at_us, level in self.changes if at_us + 15 <= self.clock.now_us]
        return arrived[-1]


class Level:
    def __init__(self, value):
        self.value = value


def test_a_column_has_time_to_fall_and_to_rise_at_every_look():
    clock = Clock()
    line, other = SlowLine(clock), SlowLine(clock)
    other.column.value = lambda: 1  # no key of that column is down
    names = (("UP", "DOWN"), ("SET", "EDIT"))
    keys = Matrix((line.row, other.row), (line.column, other.column), names, clock)
    assert keys.unclear == 0, "nothing was read yet"
    for _ in range(3):
        assert keys.read() == 1 and keys.unclear == 0
        clock.advance(2000)


def test_keys_of_a_column_on_ground_do_not_count_and_the_others_do():
    bench = Bench()
    bench.switches.ground(1)
    spoilt = {row[1] for row in WIRINGS["matrix"]}
    assert bench.down() == set() and bench.unclear() == spoilt
    for key in KEYS:
        assert bench.reads(key) == {key} - spoilt and bench.unclear() == spoilt
    for first in IN_MATRIX:
        for second in IN_MATRIX:
            read = bench.reads(first, second)
            assert not read & spoilt and read <= {first, second}, (first, second, read)
    assert bench.reads("STOP", "DOWN", "JOG_RIGHT") == {"STOP"} | ({"DOWN"} - spoilt)


def test_a_cut_wire_in_the_matrix_costs_one_key():
    bench = Bench()
    bench.switches.cut("EDIT")
    for key in KEYS:
        assert bench.reads(key) == {key} - {"EDIT"}


def test_a_reading_that_was_broken_off_is_made_good():
    """Ctrl-C while a row is driven: the next reading but one is right again."""
    interrupts = []
    bench = Bench(interrupts=interrupts)
    bench.hold("UP")
    interrupts.append(KeyboardInterrupt)
    try:
        bench.keypad.read()
    except KeyboardInterrupt:
        pass
    assert not interrupts
    bench.down()
    assert bench.down() == {"UP"}


# --- STOP ----------------------------------------------------------------------------------------


def test_a_broken_wire_of_a_normally_closed_stop_is_stop():
    for wiring in WIRINGS:
        bench = Bench(wiring)
        bench.switches.cut("STOP")
        assert bench.down() == {"STOP"}
        assert bench.reads("STOP", "START") == {"STOP", "START"}
        assert bench.down() == {"STOP"}


def test_stop_has_a_pin_of_its_own():
    chip = Chip(Clock(), None)
    pins = [Pin(chip, Pin.IN, Pin.PULL_UP) for _ in range(4)]
    rows = [Pin(chip, Pin.OPEN_DRAIN, value=1)]
    matrix = Matrix(rows, pins[:2], (("STOP", "UP"),), chip.clock)
    assert refused(Keypad, (), matrix) == "STOP has a pin of its own"
    assert refused(Keypad, (("START", pins[2]),), matrix) == "STOP has a pin of its own"
    assert refused(Keypad, (("START", pins[2]),)) == "STOP has a pin of its own"
    assert "stands there twice" in refused(Keypad, (("STOP", pins[2]),), matrix)


def test_what_else_cannot_be_wired():
    chip = Chip(Clock(), None)
    pin = Pin(chip, Pin.IN, Pin.PULL_UP)
    row = Pin(chip, Pin.OPEN_DRAIN, value=1)
    stop = ("STOP", pin)
    matrix = Matrix((row,), (pin,), (("UP",),), chip.clock)
    assert "UP is normally closed" in refused(Keypad, (stop,), matrix, closed=("UP",))
    assert "twice" in refused(Keypad, (stop, ("UP", pin)), matrix)
    many = tuple(("K%d" % number, pin) for number in range(29))
    assert len(Keypad((stop,) + many).names) == 30
    assert "31 keys" in refused(Keypad, (stop, ("UP", pin)) + many)
    assert "1 x 1" in refused(Matrix, (row,), (pin,), (("UP", "DOWN"),), chip.clock)
    assert "1 x 1" in refused(Matrix, (row,), (pin,), (("UP",), ("DOWN",)), chip.clock)
    assert "1 x 2" in refused(Matrix, (row,), (pin, pin), (("UP",),), chip.clock)
    assert "2 x 1" in refused(Matrix, (row, row), (pin,), (("UP",),), chip.clock)


def test_thirty_keys_fit_a_small_integer():
    chip = Chip(Clock(), None)
    pins = [Pin(chip, Pin.IN, Pin.PULL_UP) for _ in range(30)]
    names = ("STOP",) + tuple("K%d" % number for number in range(29))
    keypad = Keypad(tuple(zip(names, pins)))
    for pin in pins:
        pin.apply(0)
    heap_lock()
    try:
        raw = keypad.read()
    finally:
        heap_unlock()
    assert raw == (1 << 30) - 1


# --- as the panel has it -------------------------------------------------------------------------


def test_a_reading_takes_no_heap_and_not_much_time():
    """A matrix takes one look at all rows; with a key down another at none, and one at each."""
    for wiring, keys, us in (
        ("direct", (), 0),
        ("direct", KEYS, 0),
        ("matrix", (), 20),
        ("matrix", ("STOP",), 20),
        ("matrix", ("STOP", "UP"), 20 + 20 + 20 * len(WIRINGS["matrix"])),
        ("matrix", ("UP", "DOWN", "NEXT"), 20 + 20 + 20 * len(WIRINGS["matrix"])),
    ):
        bench = Bench(wiring)
        bench.hold(*keys)
        bench.clock.advance(2000)
        began_us = bench.clock.now_us
        heap_lock()
        try:
            bench.keypad.read()
        finally:
            heap_unlock()
        assert bench.clock.now_us - began_us == us <= 100, (wiring, keys)


def test_a_key_that_bounces_is_pressed_once():
    for wiring in WIRINGS:
        for seed in range(1, 20):
            bench = Bench(wiring, World(main.start, seed=seed).random)
            keys = Keys(bench.keypad.names, bench.clock.ticks_mask)
            pressed = []
            for key in (None, "STOP", "UP", "START"):
                if key:
                    bench.hold(key)
                turns(bench, keys, 30, pressed)
                if key:
                    bench.let_go(key)
                turns(bench, keys, 30, pressed)
            expected = [keys.bit(key) for key in ("STOP", "UP", "START")]
            assert pressed == expected, (wiring, seed, pressed)


def turns(bench, keys, count, pressed):
    """So many turns of a main loop; what is pressed meanwhile is noted."""
    for _ in range(count):
        bench.clock.advance(2000)
        keys.update(bench.keypad.read(), bench.clock.ticks_ms())
        if keys.pressed:
            pressed.append(keys.pressed)


def test_the_whole_panel_obeys_keys_wired_either_way():
    for wiring in WIRINGS:
        for seed in (0, 5):
            world = World(main.start, seed=seed, keys=wiring)
            world.run(1500)
            world.press("UP")
            world.press("START")
            world.run(4000)
            assert world.drives[1].state == "running", world.drives[1].report()
            assert "S: 10.1" in world.lcd()[0], world.lcd()
            world.press("STOP")
            world.run(6000)
            assert world.drives[1].state == "ready", world.drives[1].report()
            world.check()


def test_a_stop_whose_wire_breaks_stops_the_drive_and_lets_none_start():
    world = World(main.start)
    world.run(1500)
    world.press("START")
    world.run(4000)
    assert world.drives[1].state == "running"
    world.keypad.cut("STOP")
    world.run(6000)
    assert world.drives[1].state == "ready"
    world.press("START")
    world.run(1000)
    assert world.drives[1].state == "ready"
    world.check()


def test_keys_stay_down_over_a_reset_of_the_chip():
    for wiring in WIRINGS:
        world = World(main.start, keys=wiring)
        for key in ("START", "DOWN"):
            world.down(key)
        world.reset()
        assert main.escape_wanted(world.app.board.keypad)
        world.up("DOWN")
        world.run(100)
        assert not main.escape_wanted(world.app.board.keypad)
        world.run(3000)
        assert world.drives[1].hz() == 0, "a START that was down at power-on"


def test_keys_are_unclear_only_in_the_reading_that_could_not_tell():
    world = panel(keys="matrix")
    keypad = world.app.board.keypad
    for key in ("JOG_RIGHT", "DOWN", "PARAM"):
        world.down(key)
    assert keypad.read() == 0
    unclear = {name for bit, name in enumerate(keypad.names) if keypad.unclear >> bit & 1}
    assert unclear == set(keypad.names) - {"START", "STOP"}, "those have pins of their own"
    assert keypad.unclear >> len(keypad.names) == 0, "a bit for each key"
    for key in ("JOG_RIGHT", "DOWN", "PARAM"):
        world.up(key)
    world.run(100)  # they have bounced
    assert keypad.read() == 0 and not keypad.unclear
    world.check()


def test_keys_are_wired_one_way_or_the_other():
    assert "direct" in refused(World, main.start, keys="diagonal")


def test_keys_on_pins_of_their_own_are_never_unclear():
    world = panel(keys="matrix")
    for key in ("JOG_RIGHT", "DOWN", "PARAM"):
        world.down(key)
    world.run(100)
    keypad = world.app.board.keypad
    unclear = [name for bit, name in enumerate(keypad.names) if keypad.unclear >> bit & 1]
    assert unclear and set(unclear) == set(IN_MATRIX)
    world.check()


# --- all pins in one register --------------------------------------------------------------------


def test_one_reading_of_all_pins_decides_alone():
    """A contact that bounces must not be remembered as it was a moment later: every reading is
    what the register says at that instant, whatever the pins say when they are asked."""
    chip = Chip(Clock(), None)
    pins = [Pin(chip, Pin.IN, Pin.PULL_UP) for _ in range(2)]
    levels = [0]
    keypad = Keypad(
        (("START", pins[0]), ("STOP", pins[1])),
        closed=("STOP",),
        levels=lambda: levels[0],
        masks=(1 << 13, 1 << 14),
    )
    start_down, stop_down = 0b01, 0b10
    for level, down in (
        (1 << 13, 0),
        (0, start_down),
        (0, start_down),
        (1 << 14, start_down | stop_down),
        (1 << 13 | 1 << 14, stop_down),
        (1 << 13 | 1 << 14, stop_down),
        (1 << 13, 0),
    ):
        for other in (0, 1):
            for pin in pins:
                pin.apply(other)
            levels[0] = level
            assert keypad.read() == down, (level, other)


def test_the_register_is_read_without_taking_heap():
    chip = Chip(Clock(), None)
    stop = Pin(chip, Pin.IN, Pin.PULL_UP)
    levels = [1]
    keypad = Keypad((("STOP", stop),), levels=lambda: levels[0], masks=(1,))
    heap_lock()
    try:
        for turn in range(100):
            levels[0] = turn >> 2 & 1
            assert keypad.read() == 1 - levels[0]
    finally:
        heap_unlock()
