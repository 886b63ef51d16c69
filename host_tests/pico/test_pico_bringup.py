# SPDX-License-Identifier: MIT
"""tools/bringup on a bare emulated Pico: what it finds right, and that each check finds what it is
there for."""

import os

from bringup_bench import BOTH, DRIVER, HEARS_ITSELF, PLACE, ask, bare_pico, bite, files
from serial_tool_bench import at_port
from tools.bringing_up.checks import (
    CHECKS,
    DISPLAY,
    DRIVE,
    JUMPERS,
    NOTHING,
    PAGES,
    RESTART,
    TRANSCEIVER,
    judge_identity,
    line_of,
)
from tools.emulator.world import HIGH, PicoWorld, temporary

INTERPRETERS = "pico"

ON_CHIP, ON_LINE = "on_chip.py", "on_line.py"
BARE = (NOTHING, JUMPERS, RESTART)
ADDRESS, BAUD = 1, 19_200


def lost(byte):
    return None if byte == 31 else byte


def wrong(byte):
    return byte | 1 if byte > 250 else byte


def driver_comes_up(world):
    """Something switches the driver on as soon as the chip lets go of it."""
    world.tell("P", DRIVER[0], HIGH)


def somebody_talks(world):
    """A character every 100 ms on the wire to GP5, for as long as a check may last."""
    for at in range(200):
        world.chip.tell(world.chip.now_ns + at * 100_000_000, "C", 0x55, BAUD // 50 << 2)


def changed(file, old, new):
    return {"changes": ((file, old, new),)}


COLLECTS_LONG = changed(
    ON_CHIP,
    b"            gc.collect()\n        elif",
    b"            irq = machine.disable_irq()\n            time.sleep_us(25_000)\n"
    b"            machine.enable_irq(irq)\n        elif",
)
ANSWERS_LATE = changed(
    ON_CHIP, b"        except OSError:\n            longest_us", b"        except OSError:\n"
    b"            time.sleep_ms(2)\n            longest_us",
)  # fmt: skip
WRITE = b"            bus.writeto(address, LIGHT)\n        except OSError:\n            failed"
FAILS_AT_TIMES = changed(ON_CHIP, WRITE, WRITE.replace(b"address", b"address + (failed == 0)"))
TURN = b"        if self.left:"
SLOW = changed(ON_LINE, TURN, b"        time.sleep_us(300)\n" + TURN)
CLOCK_OFF = changed(ON_LINE, b"machine.freq() //", b"1.03 * machine.freq() //")

# The number of a check; what is broken; what the chip is made with; what happens before it is
# asked. The person says that nothing is to be seen.
BROKEN = (
    (1, "the time-out never comes", {"model": {"receive_timeout": "never"}}, None),
    (1, "there is no loopback", changed(ON_LINE, b"LOOPBACK = 1 << 7", b"LOOPBACK = 0"), None),
    (2, "the wire is missing", {"jumpers": (DRIVER,)}, None),
    (2, "a character is lost", {"alters": lost}, None),
    (
        2,
        "the interrupt comes late",
        changed(ON_LINE, b"self.came_at = ticks_us()", b"self.came_at = ticks_us() + 4_000"),
        None,
    ),
    (
        2,
        "the interrupt comes early",
        changed(ON_LINE, b"self.came_at = ticks_us()", b"self.came_at = ticks_us() - 300"),
        None,
    ),
    (3, "a bit is wrong", {"alters": wrong}, None),
    (3, "the parity is odd", changed("hal/link/rp2_rs485.py", b"0x6996", b"0x9669"), None),
    (4, "its wire is missing", {"jumpers": (HEARS_ITSELF,)}, None),
    (
        4,
        "the driver goes off early",
        changed("hal/link/rp2_rs485.py", b'"character").side(1)', b'"character").side(0)'),
        None,
    ),
    (5, "its wire is missing", {"jumpers": (HEARS_ITSELF,)}, None),
    (5, "the driver is on after a restart", {}, driver_comes_up),
    (6, "the wire is missing", {"jumpers": (DRIVER,)}, None),
    (6, "the chip is slow", SLOW, None),
    (7, "the flash is slow", {"model": {"flash_times": "maximum"}}, None),
    (8, "it bites too soon", changed("chips/rp2.py", b"_MS = 2_000", b"_MS = 1_800"), None),
    (8, "it says nothing", changed("chips/rp2.py", b"0x6AB7_3121", b"0x6AB7_3122"), None),
    (8, "it does not stop", changed(ON_CHIP, b"    stopped.stop()\n", b""), None),
    (9, "collections are long", COLLECTS_LONG, None),
    (10, "the wire is missing", {"jumpers": (DRIVER,)}, None),
    (11, "the heap is small", changed(ON_CHIP, b"gc.mem_alloc()", b"-60_000"), None),
    (12, "a write to nobody takes long", ANSWERS_LATE, None),
    (12, "a backpack fails at times", dict(FAILS_AT_TIMES, display="backpack"), None),
    (13, "the person does not see it", {"display": "wires"}, None),
    (14, "the receiver is on", {}, somebody_talks),
    (15, "the line is noisy", {}, somebody_talks),
    (16, "there is no drive", {"jumpers": ()}, None),
    (16, "the chip's clock is off", CLOCK_OFF, None),
)  # fmt: skip


def answered(world, check, happens=None, seen=True):
    """What the chip answers, and with it a person who looks at its display."""
    if happens:
        happens(world)
    if check.needs == RESTART and not world.resets:
        bite(world)
    given = check.filled(ADDRESS, BAUD)
    if not check.pages:
        return ask(world, "%s%s" % (check.function, called_with(given)))
    return [
        (ask(world, "%s%s" % (check.function, called_with(given + (page,)))), seen)
        for page in check.pages
    ]


def called_with(arguments):
    return "(%s)" % ", ".join([repr(argument) for argument in arguments])


def test_a_bare_board_confirms_every_assumption():
    world = bare_pico()
    assert judge_identity(ask(world, "identity()"))[1]
    for check in CHECKS:
        if check.needs in BARE:
            figure, right = check.judge(answered(world, check))
            assert right, line_of(check, figure, right)


def test_both_kinds_of_receive_time_out_are_right():
    for model, words in (("once", "comes once"), ("again", "again at once")):
        world = bare_pico(model={"receive_timeout": model})
        figure, right = CHECKS[0].judge(answered(world, CHECKS[0]))
        assert right and words in figure, (model, figure)


def test_a_wired_board_confirms_the_rest():
    # The jumper brings the drive's part: what the chip itself sends is what it measures.
    for needs in (DISPLAY, TRANSCEIVER, DRIVE):
        world = bare_pico(jumpers=(HEARS_ITSELF,) if needs == DRIVE else ())
        for check in CHECKS:
            if check.needs == needs:
                figure, right = check.judge(answered(world, check))
                assert right, line_of(check, figure, right)


def test_a_backpack_takes_ten_thousand_pieces():
    world = bare_pico(display="backpack")
    figure, right = CHECKS[11].judge(answered(world, CHECKS[11]))
    assert right and "a backpack, 0 of 10000" in figure, figure


def test_the_display_shows_the_pages_one_by_one():
    for display in ("wires", "backpack"):
        world = bare_pico(jumpers=(), display=display)
        for page in PAGES:
            assert ask(world, "show%s" % called_with(CHECKS[12].arguments + (page,)))
            world.run(10)
            shown = world.lcd_chip.ddram
            assert shown[:16] + shown[40:56] == bytes(range(page, page + 32)), (display, page)


def test_check_1_finds_a_receive_time_out_that_never_comes():
    check_finds(1)


def test_check_2_finds_bursts_that_are_spoilt():
    check_finds(2)


def test_check_3_finds_characters_that_are_wrong():
    check_finds(3)


def test_check_4_finds_a_driver_enable_that_moves():
    check_finds(4)


def test_check_5_finds_a_driver_that_is_on_after_a_restart():
    check_finds(5)


def test_check_6_finds_a_chip_that_is_slow():
    check_finds(6)


def test_check_7_finds_a_flash_that_is_slow():
    check_finds(7)


def test_check_8_finds_a_watchdog_that_is_another():
    check_finds(8)


def test_check_9_finds_collections_that_are_long():
    check_finds(9)


def test_check_10_finds_a_line_that_nobody_hears():
    check_finds(10)


def test_check_11_finds_a_heap_that_is_small():
    check_finds(11)


def test_check_12_finds_an_i2c_that_fails():
    check_finds(12)


def test_check_13_finds_a_display_that_shows_nothing():
    check_finds(13)


def test_check_14_finds_a_receiver_that_is_on_while_it_sends():
    check_finds(14)


def test_check_15_finds_a_line_that_is_noisy():
    check_finds(15)


def test_check_16_finds_a_drive_at_another_rate():
    check_finds(16)


def check_finds(number):
    for place, what, options, happens in BROKEN:
        if place == number:
            assert finds(CHECKS[number - 1], options, happens), what


def finds(check, options, happens):
    world = bare_pico(**options)
    resets = world.resets
    try:
        figure, right = check.judge(answered(world, check, happens, seen=False))
    except Exception:
        # The watchdog that does not stop restarts the chip, which then says nothing.
        assert world.resets > resets + 1, (check.number, world.restarts)
        return True
    return not right


def test_every_check_was_seen_to_fail():
    assert {number for number, _, _, _ in BROKEN} == {check.number for check in CHECKS}
    assert [check.number for check in CHECKS] == list(range(1, 17))


def bring_up(*words, jumpers=BOTH):
    """The tool on a board that nothing else was done to: its exit status, the first words of its
    sixteen lines, what it said."""
    world = PicoWorld("stock", addresses=(), baud=115_200, jumpers=jumpers)
    report = temporary()
    status, said = at_port(world, "bringup", "--yes", "--report", report, *words)
    lines = [line for line in said.split("\n") if line[:4] in ("PASS", "FAIL", "NOT ")]
    told, _, what_now = said.partition("The chip is at its prompt now.")
    assert "starts when it gets power anew" in what_now
    with open(report) as file:
        assert told == file.read()
    os.remove(report)
    left = ["boot.py", PLACE + "bitten"] + [PLACE + path for path in files()]
    assert all(world.read_file(path) is None for path in left)
    return status, [line[:11].strip() for line in lines], said


def test_the_command_says_sixteen_lines_and_leaves_nothing_behind():
    status, words, said = bring_up()
    assert words == ["PASS"] * 12 + ["NOT CHECKED"] * 4, said
    assert "12 of 12 passed, 4 not checked." in said and status == 0
    assert "This chip confirms that\n   1 the UART says so" in said


def test_the_command_on_a_board_without_jumpers():
    status, words, said = bring_up(jumpers=())
    assert status == 1 and words.count("FAIL") == 6, said
    assert "What to do: join GP4 to GP5" in said
    assert "This chip does not confirm that" in said


def test_the_command_on_a_board_with_a_transceiver():
    status, words, said = bring_up("--wired", "transceiver", jumpers=())
    assert status == 0 and words.count("PASS") == 7, said
    assert words.count("NOT CHECKED") == 9
