# SPDX-License-Identifier: MIT
"""tools/bringup on a bare emulated Pico: what it finds right, and that it finds what is wrong."""

import os

from test_pico_deploy import Deploy

from bringup_bench import Jumper, ask, bare_pico, files
from tools.bringing_up.checks import CHECKS, line_of
from tools.emulator.repl import ReplError
from tools.emulator.world import PicoWorld, temporary

INTERPRETERS = "pico"

ON_CHIP = "on_chip.py"


def lost(byte):
    return None if byte == 31 else byte


def wrong(byte):
    return byte | 1 if byte > 250 else byte


# A line of on_chip.py, and what takes its place.
LATE = b"self.came_at = ticks_us()\n        self.came += 1"
VERY_LATE = b"self.came_at = ticks_us() + 900\n        self.came += 1"
COLLECT = b"            gc.collect()\n        time"
COLLECT_LONG = b"""            irq = machine.disable_irq()
            time.sleep_us(25_000)
            machine.enable_irq(irq)
        time"""
ABSENT = b"    except OSError:\n"
ABSENT_LATE = b"    except OSError:\n        time.sleep_ms(2)\n"

# What is broken; `alters` of the wire, True: it is missing; what stands in on_chip.py, and what
# takes its place; part of the title of the check that must find it.
BROKEN = (
    ("the wire is missing", True, None, None, "bursts at 115200"),
    ("a character is lost", lost, None, None, "bursts at 115200"),
    ("the interrupt comes at another time", None, LATE, VERY_LATE, "bursts at 115200"),
    ("a bit is wrong", wrong, None, None, "all characters"),
    ("the wire is missing", True, None, None, "400 characters"),
    ("the heap is small", None, b"gc.mem_free()", b"50_000", "chip and"),
    ("MicroPython is old", None, b"os.uname().release", b"'1.24.1'", "chip and"),
    ("something pulls GP6 up", None, b"machine.mem32[rp2.GPIO_IN]", b"0x40", "driver enable"),
    ("the flash is slow", None, b"time.ticks_diff(time.ticks_ms(), began)", b"400", "saves"),
    ("collections are long", None, COLLECT, COLLECT_LONG, "timer callbacks"),
    ("a write to nobody takes long", None, ABSENT, ABSENT_LATE, "I2C"),
    ("the watchdog does not stop", None, b"    watchdog.stop()\n", b"", "watchdog stops"),
)


def check_of(title):
    return [check for check in CHECKS if title in check.title][0]


def judged(world, check):
    arguments = ", ".join(repr(argument) for argument in check.arguments)
    return check.judge(ask(world, "%s(%s)" % (check.function, arguments)))


def test_a_bare_board_passes_every_check():
    for check in CHECKS:
        baud = check.arguments[0] if "bursts" in check.title else 115_200
        figure, right = judged(bare_pico(baud=baud), check)
        assert right, line_of(check, figure, right)


def test_each_check_finds_what_it_is_there_for():
    for what, alters, old, new, title in BROKEN:
        changes = ((ON_CHIP, old, new),) if old else ()
        world = bare_pico(alters is not True, changes, alters)
        try:
            figure, right = judged(world, check_of(title))
        except ReplError:  # the chip has restarted
            assert "watchdog" in title, (what, title)
            continue
        assert not right, (what, figure)


def test_every_check_was_seen_to_fail():
    assert {check_of(title).function for _, _, _, _, title in BROKEN} == {
        check.function for check in CHECKS
    }


class BringUp(Deploy):
    def __init__(self, world, report):
        self.world = world
        self._output = temporary()
        world.tell("S", 1)
        os.system(
            "{ ./tools/bringup --port $USS_PICO_SERIAL --yes --report %s; echo EXIT $?; } "
            ">%s 2>&1 </dev/null &" % (report, self._output)
        )


def test_the_command_says_a_line_for_each_and_leaves_nothing_behind():
    world = PicoWorld("stock", addresses=(), baud=115_200)
    world.station = Jumper(world, look_us=150)  # the command waits in real time
    report = temporary()
    status, said = BringUp(world, report).ends()
    lines = [line for line in said.split("\n") if line[:4] in ("PASS", "FAIL")]
    assert len(lines) == len(CHECKS), said
    # The wire of this test is one for 115200 baud.
    failed = [line for line in lines if line[:4] == "FAIL"]
    assert all("bursts at" in line for line in failed), said
    assert status == (1 if failed else 0)
    with open(report) as file:
        assert lines[-1] in file.read()
    os.remove(report)
    for path in files():
        assert world.read_file("bringup/" + path) is None, path
