# SPDX-License-Identifier: MIT
"""The display on a state machine of the RP2040: what it is told, and the pulses that it makes of
that. The state machine is simulated here as far as this program needs it, a cycle in 1 us."""

import sys

from boards.sim.clock import Clock
from boards.sim.ports.module import Module
from lcd_bench import HOURGLASS, RUNNING

E = 1 << 1  # of the six pins: register select, enable, D4...D7


class Step:
    """An instruction: what it does, the level of E while it does it, and the cycles."""

    def __init__(self, operation, *arguments):
        self.operation, self.arguments = operation, arguments
        self.level, self.cycles = 0, 1

    def side(self, level):
        assert level in (0, 1), "it has one pin"
        self.level = level
        return self

    def __getitem__(self, delay):
        self.cycles += delay
        return self


class StateMachine:
    """Takes words and notes when each came, and how it was made."""

    def __init__(self, number, program, **options):
        self.made = (number, program, options)
        self.works = 0
        self.taken = []
        made.append(self)

    def active(self, on):
        self.works = on

    def put(self, word):
        assert self.works and 0 <= word < 1 << 32
        self.taken.append((self.clock.now_us, word))


made = []  # the state machines
options_of_program = {}


def asm_pio(**options):
    options_of_program.update(options)
    return lambda program: program


PIO = Module(OUT_LOW="low", SHIFT_RIGHT="right", JOIN_TX="send")
before = sys.modules.get("rp2")
sys.modules["rp2"] = Module(PIO=PIO, asm_pio=asm_pio, StateMachine=StateMachine)
try:
    from hal.display import rp2_hd44780 as driver
finally:
    sys.modules.pop("rp2")
    if before:
        sys.modules["rp2"] = before


def program():
    """The instructions of the program, and where its labels lead."""
    steps, labels = [], {}

    def step(*words):
        steps.append(Step(*words))
        return steps[-1]

    words = {name: name for name in ("block", "pins", "x", "y", "x_dec", "y_dec")}
    words["label"] = lambda name: labels.update({name: len(steps)})
    for name in ("pull", "out", "nop", "jmp"):
        words[name] = lambda *arguments, name=name: step(name, *arguments)
    for name, meaning in words.items():
        setattr(driver, name, meaning)
    driver.nibbles()
    for name in words:
        delattr(driver, name)
    return steps, labels


def pulses_of(word):
    """(pins, us that these stood before E rises, us that E is high, us until the word is over or
    the next E rises) for each pulse that the state machine makes of the word."""
    steps, labels = program()
    registers = {"pins": 0, "x": 0, "y": 0}
    at = cycle = changed = shifted = 0
    was_high, rises, found = 0, 0, []
    while at < len(steps):
        step = steps[at]
        at += 1
        if step.level and not was_high:
            rises = cycle
            found.append([registers["pins"], cycle - changed, 0, 0])
        elif was_high and not step.level:
            found[-1][2] = cycle - rises
        was_high = step.level
        cycle += step.cycles
        if step.operation == "pull":
            shifted = word
        elif step.operation == "out":
            name, bits = step.arguments
            registers[name] = shifted & (1 << bits) - 1
            shifted >>= bits
            if name == "pins":
                changed = cycle - step.cycles
                assert not step.level and not registers[name] & E
        elif step.operation == "jmp":
            name = step.arguments[0][0]
            if registers[name]:
                at = labels[step.arguments[1]]
            registers[name] -= 1
        for pulse in found[-1:]:
            pulse[3] = cycle - rises
    return [tuple(pulse) for pulse in found]


class Bench:
    def __init__(self):
        self.clock = StateMachine.clock = Clock()
        self.display = driver.PioHd44780(4, "RS", "E", self.clock)
        self.display.define(HOURGLASS)
        self.taken = made[-1].taken

    def show(self, picture, us, every_us=1):
        """For so long, with a look in each so many microseconds; whether all is shown."""
        shown = False
        for _ in range(0, us, every_us):
            shown = self.display.show(picture)
            self.clock.advance(every_us)
        return shown

    def bytes_of(self, picture):
        """How many bytes a look has written, and whether all is shown."""
        before = len(self.taken)
        return self.display.show(picture), len(self.taken) - before


def test_the_state_machine_has_six_pins_in_a_row_and_a_cycle_in_a_microsecond():
    Bench()
    number, program, options = made[-1].made
    assert number == 4 and program is driver.nibbles and made[-1].works
    assert options == {"freq": 1_000_000, "out_base": "RS", "sideset_base": "E"}
    assert options_of_program == {
        "out_init": ("low",) * 6, "sideset_init": "low", "out_shiftdir": "right",
        "fifo_join": "send",
    }  # fmt: skip


def test_a_byte_is_a_word_and_two_pulses_and_its_pause():
    """The lines stand 1 us before E rises, E is high for 2 us, and 61 us follow."""
    bench = Bench()
    assert bench.show(RUNNING, 60_000, 100)
    pulses = [pulses_of(word) for _, word in bench.taken]
    assert [len(pulse) for pulse in pulses] == [1] * 4 + [2] * (len(pulses) - 4)
    said = []
    for pulse in pulses:
        for _, stood_us, high_us, _ in pulse:
            assert stood_us == 1 and high_us == 2
        (first, last) = (pulse[0], pulse[-1])
        assert pulse == [last] or first[3] == 4
        assert 61 <= last[3] - 2 <= 70 if len(pulse) == 2 else 100 <= last[3] - 2 <= 110
        assert {pins & 1 for pins, _, _, _ in pulse} in ({0}, {1})
        code = 0
        for pins, _, _, _ in pulse:
            code = code << 4 | pins >> 2
        said.append((first[0] & 1, code))
    rows = [(0, 0x80)] + [(1, code) for code in RUNNING[:16]]
    rows += [(0, 0xC0)] + [(1, code) for code in RUNNING[16:]]
    order = [(0, code) for code in (3, 3, 3, 2, 0x28, 0x06, 0x02)]
    dots = [(0, 0x40)] + [(1, code) for code in HOURGLASS]
    assert said == order + dots + rows + [(0, 0x0C)]


def test_a_wait_is_longer_by_what_the_fifo_may_still_hold():
    """It may take 0.7 ms until the state machine has come to what was put there last."""
    bench = Bench()
    bench.show(RUNNING, 60_000)
    instants = sorted({at_us for at_us, _ in bench.taken[:8]})
    waits = [later - at for at, later in zip([0] + instants, instants)]
    assert waits == [40_701, 4_801, 802, 2_861]


def test_a_look_compares_half_the_cells_and_writes_five_bytes_at_most():
    bench = Bench()
    assert bench.show(RUNNING, 60_000, 100)
    for cells, looks in (
        ((0,), [(True, 2)]),
        ((15,), [(True, 2)]),
        ((16,), [(False, 0), (True, 2)]),
        ((0, 1, 2, 3), [(True, 5)]),
        ((0, 1, 2, 3, 4), [(False, 5), (True, 1)]),
        ((0, 2), [(True, 4)]),
        ((0, 2, 4), [(False, 4), (True, 2)]),
    ):
        bench.show(RUNNING, 10_000, 100)
        picture = bytearray(RUNNING)
        for cell in cells:
            picture[cell] = ord("#")
        assert [bench.bytes_of(picture) for _ in looks] == looks, cells
