# SPDX-License-Identifier: MIT
"""What real chips do and the emulated one does not: here it is done before the panel starts.

A boot.py does it; there is no USB in it, the LED tells.
"""

from panel_bench import row_2
from pico_bench import BOOT_MS, panel, start
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico pico_hard_again"

# A radio takes a state machine of PIO 1, and room for its program; here it has taken all of both.
RADIO = b"""
import rp2
machine_of = rp2.StateMachine

def left_over(number, *arguments, **named):
    if number >= 4:
        raise ValueError("StateMachine claimed by external resource")
    return machine_of(number, *arguments, **named)

@rp2.asm_pio()
def program():
    for _ in range(32):
        nop()

rp2.PIO(1).add_program(program)
rp2.StateMachine = left_over
"""

# Ports answer each in its way to a timer with hard callbacks that they have not.
REFUSES = b"""
import machine
from chips import rp2

class Timer:
    ONE_SHOT = 0
    deinit = None

    def init(self, **options):
        if "hard" in options:
            raise %s

rp2.Timer = Timer
rp2.HardTimer.ONE_SHOT = 0
if isinstance(rp2.make_timer(), Timer):
    machine.Pin(25, machine.Pin.OUT, value=1)
"""


# 2500 turns of 4 us: looked at after 5 ms, stopped for 20 ms, and looked at as it ends.
COUNTS = b"""
import rp2, time

@rp2.asm_pio()
def counts():
    pull()
    mov(x, osr)
    label("wait")
    jmp(x_dec, "wait")[3]
    mov(isr, invert(null))
    push()

tell = [rp2.asm_pio_encode(text, 0) for text in ("mov(isr, x)", "push()")]
machine = rp2.StateMachine(0, counts, freq=1_000_000)
machine.active(1)
began = time.ticks_us()
machine.put(2500)
time.sleep_ms(5)
for instruction in tell:
    machine.exec(instruction)
print("left", machine.get())
machine.active(0)
stopped = time.ticks_us()
time.sleep_ms(20)
began += time.ticks_diff(time.ticks_us(), stopped)
machine.active(1)
print("ends", machine.get() == 0xFFFFFFFF, time.ticks_diff(time.ticks_us(), began))
"""

# A telegram at each rate, and what the link says of it while it is on the line.
SENDS = b"""
import time
from chips import rp2

clock = rp2.Clock()
said = open("said.txt", "w")
for baud in (1_200, 9_600, 187_500):
    driver = rp2.low(6)
    link = rp2.make_link(4, 5, driver, clock, baud)
    early = clock.ticks_us()
    link.send(bytes(14), 14)
    left = [link.sending_us(early)]
    while driver.value():
        left.append(link.sending_us(clock.ticks_us()))
    off_at = clock.ticks_us()
    falls = all([one >= other for one, other in zip(left, left[1:])])
    late = time.ticks_diff(off_at, link.sent_at)
    print(baud, len(left), left[0], falls, left[-2], link.sending_us(off_at), late, file=said)
    link.close()
said.close()
"""


def said(world, word):
    return [line.split()[1:] for line in bytes(world.usb).decode().splitlines() if word in line][0]


def test_the_link_says_how_long_it_sends_and_when_the_driver_is_off():
    world = panel(files={"boot.py": SENDS})
    lines = world.read_file("said.txt").decode().splitlines()
    assert len(lines) == 3, lines
    for line in lines:
        baud, looks, left_us, falls, last_us, over_us, late_us = line.split()
        bit_us = 1_000_000 // int(baud)
        telegram_us = 14 * 11 * 1_000_000 // int(baud)
        assert telegram_us <= int(left_us) <= telegram_us + bit_us + 2, line
        assert int(looks) > 10 and falls == "True" and int(last_us) >= 1 and over_us == "0", line
        assert -1 <= int(late_us) <= bit_us // 4 + 100, line  # the program sees it a little later


def test_a_state_machine_that_counts_down_is_as_far_as_its_time_says():
    world = PicoWorld("stock", addresses=(), files={"main.py": COUNTS})
    world.run(2_000)
    assert 1200 < int(said(world, "left")[0]) <= 1250, bytes(world.usb)  # Python takes its time
    ends, took_us = said(world, "ends")
    assert ends == "True" and 10_000 < int(took_us) < 10_500, took_us


def test_the_radio_of_a_pico_w_has_taken_its_part_of_the_chip_first():
    world = panel(files={"boot.py": RADIO})
    start(world)
    assert world.lcd()[0].startswith("S: 10.0 F: ")
    world.check()


def test_the_slowest_rate_works_with_a_fast_system_clock():
    """The emulated chip's own clock stays as it is, so the line is slower than it should be."""
    world = PicoWorld(
        "panel",
        baud=300,
        addresses=(),
        settings={"drives": [1]},
        files={"boot.py": b"import machine\nmachine.freq(250_000_000)\n"},
    )
    world.run(4_000)
    assert b"USS panel: runs" in world.usb, bytes(world.usb)
    assert row_2(world).startswith("A1"), world.lcd()
    assert world.figures.release_ns


def test_a_board_file_for_another_chip_says_so_and_drives_nothing():
    with open("boards/pico/board.py", "rb") as source:
        other = source.read().replace(b'"RP2040"', b'"RP2350"')
    world = PicoWorld("panel", files={"board.py": other})
    world.run(BOOT_MS)
    sentence = b"ValueError: this board file is for the RP2350, and here is a RP2040"
    assert sentence in world.usb, bytes(world.usb)
    assert b"runs" not in world.usb and not world.figures.release_ns


def test_a_port_without_hard_timers_gets_a_soft_one():
    for error in (b"TypeError", b"ValueError"):
        world = PicoWorld("panel", files={"boot.py": REFUSES % error})
        assert world.run_until(lambda: world.led and world.led[-1][1], BOOT_MS), error
