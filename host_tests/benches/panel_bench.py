# SPDX-License-Identifier: MIT
"""What the tests of the panel share: a panel on the virtual board, hands and eyes for it.

The same firmware as on the chip, in virtual time.
"""

import main
import on_demand
import panel.panel
from boards.sim.board import LONG_LOOP_US, LOOP_US  # noqa: F401 - for the tests
from boards.sim.clock import Clock
from boards.sim.world import World
from panel.at_hand import NAMES
from panel.pages.table import HOME, PAGES
from strict_screen import StrictScreen

panel.panel.Screen = StrictScreen

QUICK_TAP_MS, LOOK_MS = 60, 100  # of a hand that is used to the panel: less virtual time

_start, _drop = main.start, on_demand.drop


def start_with_modules(board):
    """`main.start`, where the modules that a panel has at hand may be loaded already, as the rest
    of the firmware is: the panel before this one, in the same process, has left them. To drop them
    and to read them again took two thirds of the time in which a world begins.
    """
    drop, on_demand.drop = on_demand.drop, _drop_what_is_not_at_hand
    try:
        return _start(board)
    finally:
        on_demand.drop = drop


def _drop_what_is_not_at_hand(*names):
    _drop(*[name for name in names if name not in NAMES])


main.start = start_with_modules


def taken_at_ms(page_class, press):
    """When a page of this class took keys while `press()` ran: readings of the clock."""
    take_keys, taken_ms = page_class.take_keys, []

    def noting(page, acts, now_ms):
        taken_ms.append(now_ms)
        take_keys(page, acts, now_ms)

    page_class.take_keys = noting
    try:
        press()
    finally:
        page_class.take_keys = take_keys
    return taken_ms


class SlowWorld(World):
    """A step of the main loop may take as long as it does where it has much to do."""

    def _uneven_loop_us(self):
        return self.random(500, 10_000)


class SlowClock(Clock):
    """To read it takes `reading_us`: so the time goes on within a step, as on a slow chip."""

    reading_us = 0

    def ticks_us(self):
        if not self._advancing:
            self.advance(self.reading_us)
        return super().ticks_us()


def switched_on(*arguments, **options):
    """A `World` with a panel that has just been switched on.

    Its main loop takes steps as long as the longest on the chip, for so the tests of the panel
    take an eighth less. One that looks sooner than such steps can show says loop_us=LOOP_US.
    """
    options.setdefault("loop_us", LONG_LOOP_US)
    return World(main.start, *arguments, **options)


def panel(**options):
    """A panel that was switched on a second ago."""
    world = switched_on(**options)
    world.run(1000)
    return world


def running(**options):
    """A panel whose drive 1 has been started and has reached its setpoint."""
    world = panel(**options)
    wait_until_known(world)
    world.press("START")
    world.run(4000)
    assert world.drives[1].state == "running", world.drives[1].report()
    return world


def wait_until_known(world, ms=20_000):
    """Let time pass until the panel has read what it must know of the drive shown."""
    for _ in range(ms // 20):
        if row_2(world).startswith("READY"):
            return
        world.run(20)
    raise AssertionError(world.lcd())


def wait_until(world, condition, ms):
    """Let time pass until it is so, `ms` at most."""
    until_us = world.clock.now_us + ms * 1000
    while not condition() and world.clock.now_us < until_us:
        world.run(50)


def comes_to(world, text, ms=8_000):
    """Whether row 2 reads so, within this time."""
    wait_until(world, lambda: row_2(world) == text, ms)
    return row_2(world) == text


def all_running(addresses, **options):
    """A panel whose drives have all been started and have reached their setpoints."""
    world = panel(addresses=addresses, **options)
    for _ in addresses:
        wait_until_known(world)
        world.press("START")
        world.press("ADDRESS_UP")
        world.run(200)
    world.run(4000)
    for drive in world.drives.values():
        assert drive.state == "running", drive.report()
    return world


def late(world, number, address=1):
    """Until a question about this parameter is given up, the drive goes on with its old answer."""
    channel, drive = world.drives[address].channel, world.drives[address]
    asked = (0x1000 | number % 2000, 0x8000 if number >= 2000 else 0)
    accept = channel.accept
    when = []  # it was asked

    def accept_late(words, layout):
        if (words[0], words[1]) == asked:
            when.append(world.clock.now_us)
        drive.stale_replies = 10_000 if (words[0], words[1]) == asked else 0
        accept(words, layout)

    channel.accept = accept_late
    for _ in range(1000):
        world.run(20)
        if when and world.clock.now_us - when[-1] > 100_000:
            break
    assert when and when[-1] - when[0] > 1_500_000, when
    channel.accept = accept


def unsupervised(*addresses):
    """Options of a panel whose drives run on without telegrams, P2014 = 0, as was accepted."""
    addresses = addresses or (1,)
    return {
        "addresses": addresses,
        "parameters": {2014: 0},
        "settings": {"unsupervised": list(addresses)},
    }


def take_commands_elsewhere_in_second_set(drive):
    """r0050 of a MICROMASTER 440: its second data set is active, with commands of terminals."""
    readings = drive.readings.value
    drive.parameters.reading = lambda *place: 1 if place[0] == 50 else readings(*place)
    drive.write(700, 1, 2)


def press(world, *keys):
    """Press keys one after the other, and look what each has done."""
    for key in keys:
        world.press(key, QUICK_TAP_MS)
        world.run(LOOK_MS)


def hold(world, key, ms=1500):
    """PARAM held this long opens the menu."""
    world.press(key, ms)
    world.run(LOOK_MS)


def row_1(world):
    return world.lcd()[0]


def row_2(world):
    return world.lcd()[1].rstrip()


def settled_row_2(world):
    """Row 2 as a person reads it: a picture that changes needs some steps of the main loop."""
    seen = None
    while seen != row_2(world):
        seen = row_2(world)
        world.run(10)
    return seen


def settled(world):
    """Both rows, when nothing has changed in them for a while."""
    rows, same = None, 0
    while same < 2:
        world.run(20)
        same = same + 1 if rows == world.lcd() else 0
        rows = world.lcd()
    return rows


def said(world, ms):
    """What a person reads in row 2 in the time that follows, as {row: for how long, in ms}.

    Nobody reads a picture that is still being written.
    """
    rows = {}
    until_us = world.clock.now_us + ms * 1000
    while world.clock.now_us < until_us:
        since_us = world.clock.now_us
        row = settled(world)[1].rstrip()
        rows[row] = rows.get(row, 0) + (world.clock.now_us - since_us) // 1000
    return {row: read_ms for row, read_ms in rows.items() if read_ms >= 200}


def starts(world, address=1):
    """How often the motor has been set going."""
    return int(world.drives[address].report().split("starts=")[1].split()[0])


def telegrams(world, since_us, address=None):
    """Telegrams of the panel since an instant, as (instant, control word)."""
    sent = []
    for at_us, from_panel, characters in world.wire.log.last(1000):
        if len(characters) < 16:
            continue  # cut off by a reset
        if from_panel and at_us >= since_us and address in (None, characters[2]):
            sent.append((at_us, characters[11] << 8 | characters[12]))
    return sent


ON, OFF1 = 0x047F, 0x047E
ERROR = ValueError("on purpose")  # made beforehand: the heap is locked in an interrupt


def page_back(world):
    """PARAM leads through all pages; this is how to come back to the one before."""
    place = PAGES[HOME][1]
    while place != HOME:
        world.press("PARAM")
        place = PAGES[place][1]
