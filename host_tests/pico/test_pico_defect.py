# SPDX-License-Identifier: MIT
"""What the chip finds wrong with its bus before the first telegram, and what it does not take for
wrong."""

from boards.sim.drives.kinds import listed_drives, simulated
from panel_bench import row_2, said, starts
from pico_bench import BOOT_MS, start
from tools.emulator.world import DRIVER_ENABLE, LOW, NOBODY, RECEIVES, SHORTED_HIGH, PicoWorld

INTERPRETERS = "pico_again"

RATES = (1_200, 9_600, 19_200, 187_500)
LONGEST_US = 20_000
BUSY_MS = 700  # longer than the panel takes to its first telegram
ALL = ("DE STUCK ON", "UART BROKEN", "LINE IS LOW")
QUICK = {2014: 2_000}

# What the check takes, told by the LED: it is on meanwhile.
TIMED = b"""
from machine import Pin
from chips import rp2
find_defect, led = rp2.find_defect, Pin(25, Pin.OUT, value=0)

def timed(*arguments):
    led(1)
    try:
        return find_defect(*arguments)
    finally:
        led(0)

rp2.find_defect = timed
"""


def switched_on(gpio=None, state=NOBODY, **options):
    """A panel with a wire at one of its pins, before it does anything."""
    if options.get("baud") == 187_500:  # which no MICROMASTER knows
        options["kinds"] = simulated(listed_drives("1=g120"))
    else:
        options["parameters"] = QUICK
    world = PicoWorld("panel", **options)
    if gpio is not None:
        world.tell("P", gpio, state)
    return world


def took_us(world):
    """How long the check of the bus took."""
    (began_us, began), (ended_us, ended) = world.led[1:3]
    assert began and not ended
    return ended_us - began_us


def test_it_takes_less_than_20_ms():
    for baud in RATES:
        world = switched_on(files={"boot.py": TIMED}, baud=baud)
        assert world.run_until(lambda w=world: len(w.led) > 2, BOOT_MS)
        assert 0 < took_us(world) < LONGEST_US, (baud, world.led)


def test_a_sound_board_starts():
    world = switched_on()
    assert world.run_until(lambda: row_2(world).startswith("READY"), BOOT_MS)
    start(world)
    world.check()


def test_it_leaves_the_registers_of_the_uart_as_they_were():
    """The LED goes on if the divisors, the format and the interrupts are the same afterwards."""
    looks = b"""
from machine import Pin, mem32
from chips import rp2
find_defect, led = rp2.find_defect, Pin(25, Pin.OUT, value=0)

def registers():
    return [mem32[rp2.UART_REGISTERS + place] for place in (0x24, 0x28, 0x2C, 0x30, 0x38)]

def watched(*arguments):
    before = registers()
    defect = find_defect(*arguments)
    led(before == registers() and before[4] != 0)
    return defect

rp2.find_defect = watched
"""
    world = switched_on(files={"boot.py": looks})
    assert world.run_until(lambda: world.led and world.led[-1][1], BOOT_MS), world.led


def test_nothing_of_it_is_on_the_line():
    world = switched_on()
    world.run(BOOT_MS)
    first = world.wire.log.last(1000)[0]
    assert len(first[2]) == 16 and world.figures.driver[0][1] == 1
    assert not world.station.complaints
    world.check()


def test_a_driver_enable_that_is_stuck_is_said_and_nothing_starts():
    world = switched_on(DRIVER_ENABLE, SHORTED_HIGH)
    assert world.run_until(lambda: world.reads("DE STUCK ON"), BOOT_MS), world.lcd()
    world.press("START")
    assert "DE STUCK ON" in said(world, 1_000)
    world.run(8_000)
    assert starts(world) == 0


def test_a_line_that_is_low_is_said_until_a_drive_answers():
    world = switched_on(RECEIVES, LOW, files={"boot.py": TIMED})
    assert world.run_until(lambda: world.reads("LINE IS LOW"), BOOT_MS), world.lcd()
    assert took_us(world) < LONGEST_US, world.led
    world.tell("P", RECEIVES, NOBODY)
    assert world.run_until(lambda: row_2(world).startswith("READY"), 8_000), world.lcd()
    start(world)


def test_a_line_of_1200_baud_that_is_low_is_said_as_well():
    """A character takes 10 ms there: no other rate of these drives is watched for so long."""
    world = switched_on(RECEIVES, LOW, baud=1_200)
    assert world.run_until(lambda: world.reads("LINE IS LOW"), BOOT_MS), world.lcd()


def test_a_uart_that_does_not_hear_itself_is_said_and_nothing_starts():
    # The program that looks is broken here, so that its loopback is none.
    broken = b"""
import hal.link.rp2_check as check
find = check.find

class Deaf:
    def __init__(self, registers):
        self._registers = registers

    def __getitem__(self, address):
        return self._registers[address]

    def __setitem__(self, address, value):
        if address & 0xFFF == 0x30 and value != 0x80:
            value &= ~0x80
        self._registers[address] = value

from chips import rp2
import machine

def deaf(*arguments):
    return find(Deaf(machine.mem32), rp2.UART_REGISTERS, *arguments)

rp2.find_defect = deaf
"""
    world = switched_on(files={"boot.py": broken})
    assert world.run_until(lambda: world.reads("UART BROKEN"), BOOT_MS), world.lcd()
    world.run(3_000)
    world.press("START")
    assert "UART BROKEN" in said(world, 1_000)
    assert starts(world) == 0


def test_a_line_that_is_merely_busy_is_no_defect():
    """Somebody sends zeros without a pause: the line is high for one bit in eleven."""
    for baud in (9_600, 115_200, 187_500):
        world = switched_on(baud=baud)
        talk(world, baud, BUSY_MS)
        assert world.run_until(lambda w=world: w.figures.driver, BOOT_MS)
        assert world.clock.now_us < BUSY_MS * 1_000
        world.run(500)
        assert not any(world.reads(text) for text in ALL), world.lcd()


def talk(world, baud, ms):
    """Zeros from now on. The pin shows them; the UART, which takes whole characters, does not."""
    bit_ns, began_ns = 1_000_000_000 // baud, world.chip.now_ns
    for character in range(ms * 1_000_000 // (11 * bit_ns)):
        at_ns = began_ns + character * 11 * bit_ns
        world.chip.tell(at_ns, "P", RECEIVES, LOW)
        world.chip.tell(at_ns + 10 * bit_ns, "P", RECEIVES, NOBODY)
