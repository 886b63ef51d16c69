# SPDX-License-Identifier: MIT
"""The operator's manual, as tests: keys are pressed, the display is read, the shaft is watched.

Everything runs on the virtual board, in virtual time, with the same firmware as on the chip. What
START asks, STOP promises, and becomes of it when something fails is in the files beside this one.
"""

import sys

import main
import on_demand
import settings_file as settings
from boards.sim.world import World
from panel import texts
from panel.keys import NAMES, Acts, Keys
from panel.pages import Page, splash
from panel.pages.table import PAGES, PARAMETER
from panel.phases import CHECKING, IDLE, JOGGING, RUNNING
from panel_bench import (
    LOOP_US,
    OFF1,
    ON,
    comes_to,
    panel,
    row_1,
    row_2,
    running,
    starts,
    telegrams,
)  # fmt: skip
from uss.drive import Drive
from version import VERSION

# --- switching on --------------------------------------------------------------------------------


def test_after_power_on_the_panel_says_what_it_is_not():
    world = World(main.start)
    world.run(200)
    assert world.reads("USS %s IS NO EMERGENCY STOP" % VERSION)
    world.check()


def test_a_second_later_it_shows_setpoint_frequency_state_and_address():
    world = panel(loop_us=LOOP_US)
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    world.check()


def test_the_display_works_a_week_after_power_on_as_well():
    """Ctrl-D starts the panel anew while the chip's clock counts on."""
    world = World(main.start, ticks_start=600_000_000_000)  # more than half of the clock's period
    assert world.clock.ticks_ms() > world.clock.ticks_mask // 2
    world.run(1000)
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    world.check()


def test_a_slow_loop_draws_the_whole_picture():
    world = panel(addresses=(1, 2))
    board = world.app.board
    usual_idle = board.idle
    for more_us in (8_000, 20_000, 40_000):
        board.idle = lambda more_us=more_us: (usual_idle(), world.clock.advance(more_us))
        world.drives[1].fault(7)
        world.run(4_000)
        assert row_2(world) == "FAULT F0007  A1", (more_us, world.lcd())
        world.press("STOP", 300)
        world.run(4_000)
        assert row_2(world) == "READY        A1", (more_us, world.lcd())
    world.check()


def test_the_first_telegram_to_any_drive_is_off1_with_the_control_bit():
    world = panel(addresses=(1, 2, 3))
    for address in (1, 2, 3):
        assert telegrams(world, 0, address)[0][1] == OFF1
    for _, stw in telegrams(world, 0):
        assert stw == OFF1
    world.check()


def test_the_panel_listens_before_it_talks():
    world = panel()
    first_us = telegrams(world, 0)[0][0]
    assert 200_000 <= first_us <= 1_000_000  # 100 ms boot, 100 ms of silence heard
    world.check()


# --- start and stop ------------------------------------------------------------------------------


def test_start_turns_the_motor_and_stop_stops_it():
    world = panel()
    world.press("START")
    world.run(5000)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    assert abs(world.drives[1].hz() - 10) < 0.01
    world.press("STOP")
    world.run(500)
    assert row_2(world) == "STOPPING     A1"
    world.run(7500)
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    assert world.drives[1].hz() == 0 and starts(world) == 1
    world.check()


def test_the_same_without_a_receive_interrupt():
    world = running(polled=True)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    world.press("STOP")
    world.run(8000)
    assert world.drives[1].hz() == 0 and row_2(world) == "READY        A1"
    world.check()


def test_it_works_at_every_rate_the_drive_knows():
    for baud in (1200, 2400, 4800, 9600, 19200, 38400, 57600):
        for polled in (False, True):
            world = World(main.start, baud=baud, polled=polled)
            assert comes_to(world, "READY        A1"), (baud, polled)
            world.press("START")  # on a slow line it takes seconds to ask the drive
            assert comes_to(world, "RUNNING      A1"), (baud, polled)
            world.press("STOP")
            assert comes_to(world, "READY        A1"), (baud, polled)
            world.check()


def test_up_and_down_move_the_setpoint_while_the_motor_turns():
    world = running()
    for _ in range(5):
        world.press("UP", 60)
        world.run(60)
    assert row_1(world).startswith("S: 10.5")
    world.run(1000)
    assert row_1(world) == "S: 10.5 F: 10.50"
    world.press("DOWN", 60)
    world.run(1000)
    assert row_1(world) == "S: 10.4 F: 10.40"
    world.check()


def test_a_key_that_is_held_repeats_and_soon_moves_faster():
    world = panel()
    world.press("UP", 380)
    world.run(60)
    assert row_1(world).startswith("S: 10.1")  # 400 ms before the first repeat
    world.press("UP", 60)
    world.run(100)
    world.press("UP", 1420)  # the press, 8 repeats of 0.1 Hz, and the ninth of 1 Hz
    world.run(60)
    assert row_1(world).startswith("S: 12.1"), row_1(world)
    world.check()


def test_the_setpoint_stays_within_the_limits_of_the_drive():
    world = panel()
    world.drives[1].write(1080, 0, 9.5)
    world.drives[1].write(1082, 0, 10.5)
    world.run(3000)
    world.press("UP", 3000)
    assert row_1(world).startswith("S: 10.5")
    world.press("DOWN", 3000)
    world.run(100)
    assert row_1(world).startswith("S:  9.5")
    world.check()


def test_a_motor_that_turns_left_is_shown_with_a_sign():
    world = running()
    world.press("STOP")
    world.run(8000)
    drive = world.app.bus.turns.drives[0]
    drive.start(0x10000 - 0x0CCD)  # an own program may reverse by the sign of the setpoint
    world.run(5000)
    assert row_1(world) == "S: 10.0 F:-10.00"
    world.check()


def test_start_while_the_motor_runs_down_lets_it_run_up_again():
    world = running()
    world.press("STOP")
    world.run(500)
    world.press("START")
    world.run(3000)
    assert row_2(world) == "RUNNING      A1"
    world.check()


def test_stop_beats_start():
    world = panel(loop_us=LOOP_US)
    world.down("STOP")
    world.run(100)
    world.press("START")
    assert row_2(world) == "NO: STOP IS DOWN"
    world.up("STOP")
    world.run(3000)
    assert starts(world) == 0
    world.down("STOP")  # both in the same moment
    world.down("START")
    world.run(100)
    world.up("STOP")
    world.up("START")
    world.run(3000)
    assert starts(world) == 0
    world.check()


def test_stop_is_in_the_next_telegram_but_one_at_the_latest():
    """STOP pressed to OFF on the line: debounce and two exchanges, with 31 drives in the list."""
    world = panel(addresses=tuple(range(1, 32)), loop_us=LOOP_US)
    world.run(8000)
    exchange_us = 2 * 9167 + 2 * 1719
    for offset_ms in range(0, 44, 4):
        world.press("START")
        world.run(1000 + offset_ms)
        assert row_2(world) == "RUNNING      A1"
        pressed_us = world.clock.now_us
        world.press("STOP")
        offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
        assert offs and offs[0] - pressed_us <= 24_000 + 2 * exchange_us, offs[:1]
        world.run(1000)
    world.check()


def test_a_stop_is_sent_however_soon_start_follows():
    """Both within one exchange of a slow line: the drive is told to stop all the same."""
    for offset_ms in range(0, 200, 20):
        world = panel(baud=2400)
        world.run(4000)
        world.press("START")
        world.run(7000)
        world.run(offset_ms)
        pressed_us = world.clock.now_us
        world.press("STOP", 30)
        world.run(30)
        world.press("START", 30)
        world.run(5000)
        assert OFF1 in [stw for _, stw in telegrams(world, pressed_us, 1)], offset_ms
        assert telegrams(world, pressed_us, 1)[-1][1] == ON
        world.check()


def test_a_stop_that_noise_destroys_is_repeated_out_of_turn():
    addresses = tuple(range(1, 17))
    world = panel(addresses=addresses)
    world.run(4000)
    world.press("START")
    world.run(4000)
    for address in addresses[1:]:
        world.drives[address].unplug()
    world.run(2000)
    drive = world.drives[1]
    drive.unplug()  # the first telegrams with OFF1 do not reach it
    pressed_us = world.clock.now_us
    world.press("STOP", 100)
    assert drive.state == "running"
    drive.plug()
    world.run(100)  # one of 16 silent drives takes 30 ms, a round half a second
    assert drive.state == "stopping"
    assert len(telegrams(world, pressed_us, 1)) >= 3  # the STOP itself, and its repetitions
    world.check()


def test_stop_held_down_since_power_on_beats_start_and_is_said():
    """Jammed, or its wire is broken."""
    for happens in ("down", "cut"):
        world = panel()
        if happens == "down":
            world.down("STOP")
        else:
            world.keypad.cut("STOP")
        world.reset()
        world.run(2000)
        assert row_2(world) == "STOP IS DOWN", happens
        world.press("START")
        world.run(5000)
        assert row_2(world) == "STOP IS DOWN" and starts(world) == 0
        if happens == "down":
            world.up("STOP")
            world.run(200)
            assert row_2(world) == "READY        A1"
        world.check()


def test_start_during_the_splash_starts_nothing():
    """Nobody has seen which drive it would be, and how fast."""
    world = World(main.start)
    world.run(500)
    world.press("START")
    world.run(3000)
    assert starts(world) == 0 and row_2(world) == "READY        A1"
    world.check()


def test_a_bouncing_key_counts_once():
    world = panel()
    for _ in range(6):
        world.down("UP")
        world.run(6)
        world.up("UP")
        world.run(6)
    world.press("UP")
    world.run(60)
    assert row_1(world).startswith("S: 10.1")
    world.check()


def test_a_start_key_that_is_jammed_at_power_on_starts_nothing():
    world = panel()
    world.down("START")
    world.reset()
    world.run(3000)
    assert starts(world) == 0
    world.up("START")
    world.run(100)
    world.press("START")
    world.run(1000)
    assert starts(world) == 1
    world.check()


# --- several drives ------------------------------------------------------------------------------


def test_another_address_starts_and_stops_nothing():
    world = running(addresses=(1, 2, 5))
    world.press("ADDRESS_UP")
    world.run(1600)
    for _ in range(40):  # the display tells of drive 1 and of the state of drive 2 in turn
        if row_2(world) == "READY        A2":
            break
        world.run(100)
    assert row_2(world) == "READY        A2"
    world.run(2000)
    assert world.drives[1].state == "running" and abs(world.drives[1].hz() - 10) < 0.01
    assert starts(world, 2) == 0
    world.press("ADDRESS_DOWN")
    world.run(100)
    assert row_2(world) == "RUNNING      A1"
    world.press("ADDRESS_DOWN")  # the list goes round
    world.run(100)
    assert world.app.panel.selected.drive.address == 5
    world.press("ADDRESS_UP")
    assert world.app.panel.selected.drive.address == 1
    assert starts(world, 5) == 0 and starts(world, 2) == 0 and starts(world, 1) == 1
    world.check()


def test_a_drive_that_runs_unseen_is_announced():
    world = running(addresses=(1, 2))
    world.press("ADDRESS_UP")
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "A1 RUN,HOLD=ALL" in seen and "READY        A2" in seen
    world.check()


def test_each_drive_has_a_setpoint_of_its_own():
    world = panel(addresses=(1, 2))
    world.press("UP", 60)
    world.run(60)
    world.press("ADDRESS_UP")
    world.run(100)
    assert row_1(world).startswith("S: 10.0")
    world.press("ADDRESS_DOWN")
    world.run(100)
    assert row_1(world).startswith("S: 10.1")
    world.check()


# --- other things the display says ---------------------------------------------------------------


def test_another_drive_that_was_lost_or_does_not_stop_is_announced():
    world = running(addresses=(1, 12))
    world.drives[1].unplug()
    world.press("ADDRESS_UP")
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "A1 LOST,MAY RUN" in seen and "READY        A12" in seen
    world.press("ADDRESS_DOWN")
    world.press("STOP")
    world.press("ADDRESS_UP")
    world.run(1500)
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "A1 NOT STOPPED" in seen and "A1 LOST,MAY RUN" not in seen
    world.check()


def test_another_master_on_the_line_is_shown_and_not_fought():
    class OtherMaster:
        name = "other master"

        def hear(self, burst):
            pass

    world = World(main.start)
    other = OtherMaster()
    world.wire.attach(other)
    for _ in range(40):
        world.wire.talk(other, b"\x02\x06\x05\x04\x7e\x00\x00\x7b", 8)
        world.run(50)
    assert row_2(world) == "LINE IN USE" and telegrams(world, 0) == []
    world.run(1500)  # it falls silent
    assert row_2(world) == "READY        A1"
    world.check()


def test_damaged_settings_are_said_and_the_defaults_used():
    world = World(main.start, settings={"setpoint_centihertz": -1})
    world.run(1000)
    assert row_2(world) == "SETTINGS DAMAGED"
    world.run(3000)
    assert row_2(world) == "setpoint_centihe"
    world.run(3000)
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    world.check()


def test_what_is_wrong_with_the_settings_file_is_named():
    deep = b'{"new": ' + 1000 * b"[" + 1000 * b"]" + b"}"
    big = b'{"new": "' + 5000 * b"x" + b'"}'
    for data, row in (
        (b'{"baud": 14400}', "baud"),
        (b'{"baud": 9600,}', "FILE IS NO JSON"),
        (deep, "FILE IS NO JSON"),
        (big, "FILE TOO BIG"),
    ):
        world = World(main.start)
        world.flash.files["settings.json"] = data
        world.reset()
        world.run(1000)
        assert row_2(world) == "SETTINGS DAMAGED", row
        world.run(3000)
        assert row_2(world) == row, (row_2(world), row)
        world.check()
    assert set(splash.SETTINGS_SUSPECTS) == {
        settings.NO_JSON, settings.TOO_BIG, settings.UNREADABLE,
    }  # fmt: skip


def test_a_key_that_the_panel_does_not_know_is_named():
    """A board file with a slip of the pen had a dead key, and nobody was told."""

    def start(board):
        names = board.keypad.names
        board.keypad.names = tuple("ADRESS_UP" if name == "ADDRESS_UP" else name for name in names)
        return main.start(board)

    world = World(start)
    world.run(1000)
    assert row_2(world) == "NO KEY ADRESS_UP"
    world.run(3000)
    assert row_2(world) == "READY        A1"
    world.check()


# --- the splash by itself ------------------------------------------------------------------------


class Begun:
    """What the splash asks of its panel, and what has come of it."""

    mask = 0xFFFF

    def __init__(self, began_ms):
        self.began_ms = began_ms
        self.happened = []
        self.page = splash.Splash(self)

    def uncover(self):
        self.happened.append("gone")

    def say(self, now_ms, text):
        self.happened.append((now_ms, text))

    def step(self, ms):
        self.page.step(None, self.began_ms + ms & self.mask)
        return self.happened

    def press(self, *names, repeats=False):
        keys = Keys(NAMES, self.mask)
        bits = keys.bits(names)
        keys.pressed, keys.repeated = (0, bits) if repeats else (bits, 0)
        self.page.take_keys(Acts(keys), 55)
        return self.happened


def test_the_splash_is_there_for_800_ms_or_until_a_key_is_pressed():
    for began_ms in (0, 0xFFFF - 300):  # the clock begins anew meanwhile
        begun = Begun(began_ms)
        assert begun.step(0) == begun.step(799) == [] and begun.step(800) == ["gone"]
    for keys, come_of_it in (
        ((), []), (("UP",), ["gone"]), (("STOP",), ["gone"]),
        (("START",), ["gone", (55, texts.REFUSED_EARLY)]),
        (("START", "UP"), ["gone", (55, texts.REFUSED_EARLY)]),
    ):  # fmt: skip
        begun = Begun(0)
        assert begun.press("START", repeats=True) == [] and begun.press(*keys) == come_of_it


class Complaint:
    def __init__(self, complaint=None, suspect=None):
        self.complaint, self.suspect = complaint, suspect


def test_what_is_said_after_the_splash_fits_the_row_and_has_its_order():
    fine = Complaint()
    assert splash.notices(fine, NAMES, ()) == []
    assert splash.notices(fine, NAMES, (texts.NOTHING,)) == []
    keys = ("START", "START_STOP", "FN", 17)
    first = (texts.WATCHDOG_RESTART, texts.NOTHING, texts.PANEL_HUNG)
    for suspect, said in (
        ("lowest_centihertz", (splash.SETTING, b"lowest_centihert")),
        ("too big", (b"FILE TOO BIG",)), ("no JSON", (b"FILE IS NO JSON",)),
        ("unreadable", (b"FILE UNREADABLE",)),
    ):  # fmt: skip
        found = splash.notices(Complaint("it is wrong", suspect), keys, first)
        assert found == [
            (texts.WATCHDOG_RESTART,), (texts.PANEL_HUNG,), (splash.SETTINGS_DAMAGED,), said,
            (splash.KEY_UNKNOWN, b"START_STO"), (splash.KEY_UNKNOWN, b"17"),
        ]  # fmt: skip


# --- other worlds --------------------------------------------------------------------------------


def test_other_delays_and_loop_times_change_nothing():
    for seed in range(1, 13):
        print("seed", seed)
        world = panel(seed=seed, addresses=(1, 7), polled=bool(seed & 1))
        world.press("START")
        world.run(5000)
        assert row_2(world) == "RUNNING      A1"
        world.press("STOP")
        world.run(8000)
        assert world.drives[1].hz() == 0 and starts(world) == 1
        world.check()


def test_down_goes_on_from_the_setpoint_that_is_shown():
    world = panel()
    world.drives[1].write(1082, 0, 5.0)
    world.run(3000)
    assert row_1(world).startswith("S:  5.0")
    world.press("DOWN")
    assert row_1(world).startswith("S:  4.9")
    world.check()


def test_a_step_that_takes_long_leaves_the_display_or_the_silent_drives_to_the_next():
    """Both have their turns all the same, however slow the chip is."""
    for look_us in (0, 5_000):
        app = panel().app
        done = []
        app.board.display = Counted(done)
        refresh, ticks_us = app.refresh_bus, app.ticks_us
        looked = []

        def look(now, looks=True):
            refresh(now, looks)
            if looks:
                done.append("look")
                looked.append(look_us)

        app.refresh_bus = look
        app.ticks_us = lambda: ticks_us() + (looked.pop() if looked else 0)
        for _ in range(240):
            before = len(done)
            app.step()
            assert len(done) - before <= (1 if look_us else 2)
        assert done[:4] == ["look", "show"] * 2
        assert abs(done.count("look") - done.count("show")) <= 1
        assert len(done) >= (120 if not look_us else 60) - 1, len(done)


class Counted:
    """A display that only counts."""

    def __init__(self, done):
        self._done = done

    def show(self, _picture):
        self._done.append("show")


class Steps:
    """The main loop of a panel whose page takes so long in each step, and then says whether the
    step may go on. Nothing else takes any time.

    done: what the last step has done besides, one letter each: l(ook at the silent drives),
    e(nter the engine), s(how a piece), f(eed the watchdog), h(ear the logger), i(dle).
    """

    def __init__(self, **options):
        self.world = panel(**options)
        self.app = app = self.world.app
        self.clock = self.world.clock
        self.done = ""
        self.look_us = self.enter_us = 0
        self.wants_engine = False
        self.refresh, app.refresh_bus = app.refresh_bus, self.look
        app.step_panel = self.step_panel
        app.board.display = self
        app.board.idle = lambda: self.note("i")
        app.board.watchdog.feed = lambda: self.note("f")
        app.bus.is_overtaken = lambda _now: self.wants_engine
        if app.board.serial():
            app.board.serial().hear = lambda: self.note("h")

    def note(self, letter):
        self.done += letter

    def look(self, now_us, looks=True):
        self.refresh(now_us, looks)
        if looks:
            self.note("l")
            self.clock.advance(self.look_us)

    def poll(self, _now_us):
        """The engine is entered, by the loop or by an interrupt meanwhile."""
        if self.done[-1:] != "e":
            self.note("e")
            self.clock.advance(self.enter_us)
        return 1_000_000

    def have_engine(self):
        """The engine is that of the test, and wants to be entered."""
        self.app.bus.poll = self.poll
        self.clock.advance(60_000)  # what was set before is over
        self.wants_engine = True

    def show(self, _picture):
        self.note("s")
        return True

    def step_panel(self, *_):
        self.clock.advance(self.taken_us)
        return self.goes_on

    def step(self, taken_us=0, goes_on=True):
        self.taken_us, self.goes_on, self.done = taken_us, goes_on, ""
        self.app.step()
        assert self.done[-1] == "i"
        return self.done[:-1]

    def fed(self):
        """The watchdog has just been fed, and the look and the display have had their turn."""
        self.clock.advance(-self.clock.now_us % 1_000)
        for _ in range(101):
            if self.fed_after(1):
                break
        assert self.done == "fi" and "s" in self.step() + self.step()
        return self

    def fed_after(self, ms, taken_us=0):
        """Whether a step that begins then, and of which the page leaves nothing, feeds it."""
        self.clock.advance(ms * 1_000)
        return "f" in self.step(taken_us, False)


def test_a_step_in_which_the_page_took_long_is_over():
    """1.5 ms leave no time for anything; half a millisecond leaves it for one of two."""
    steps = Steps().fed()
    for taken_us, does in (
        (0, "ls"), (500, "ls"), (501, "l"), (1_500, "s"), (501, "l"), (501, "s"), (1_500, "l"),
        (1_501, ""), (1_501, ""), (0, "s"), (0, "ls"),
    ):  # fmt: skip
        assert steps.step(taken_us) == does, taken_us
    for steps.look_us, does in ((500, "ls"), (501, "l"), (501, "s")):
        assert steps.step() == does, steps.look_us


def test_a_step_that_has_entered_the_engine_for_long_shows_nothing():
    steps = Steps().fed()
    steps.have_engine()
    for steps.enter_us, does in ((500, "les"), (501, "le"), (0, "s"), (0, "les")):
        assert steps.step() == does, steps.enter_us
    assert steps.step(501) == "l"  # for the engine it is too late as well
    steps.wants_engine = False
    assert steps.step() == "s" and steps.step() == "ls"


def test_a_step_of_which_the_page_left_nothing_enters_the_engine_all_the_same():
    """If that has just asked for it, and the step has not taken long."""
    steps = Steps().fed()
    steps.have_engine()
    for taken_us, does in ((0, "e"), (500, "e"), (501, "")):
        assert steps.step(taken_us, False) == does, taken_us
    steps.wants_engine = False
    assert steps.step(0, False) == ""


def test_the_watchdog_is_fed_each_100_ms_by_a_step_that_has_time_and_each_500_by_any():
    steps = Steps()
    for ms, taken_us, is_fed in (
        (99, 0, False), (100, 0, True), (100, 1_999, True), (100, 2_000, False),
        (499, 1_999, True), (499, 2_000, False), (500, 2_000, True),
    ):  # fmt: skip
        assert steps.fed().fed_after(ms, taken_us) is is_fed, (ms, taken_us)


def test_the_watchdog_is_fed_only_as_long_as_the_engine_gets_on():
    for patience_us, times in ((299_999, 2), (300_000, 2), (300_001, 3)):
        steps = Steps().fed()
        steps.have_engine()
        steps.wants_engine = False
        bus = steps.app.bus
        bus.patience_us = lambda patience_us=patience_us: patience_us
        for _ in range(2):
            bus.progress += 1
            assert steps.fed_after(100)
            fed = [steps.fed_after(100) for _ in range(6)]
            assert fed == [True] * times + [False] * (6 - times), patience_us


def test_the_log_has_its_turn_in_a_step_that_has_taken_less_than_700_us():
    steps = Steps(settings={"log": "JSON"}).fed()
    for taken_us, heard in ((0, True), (699, True), (700, False)):
        found = ""
        for _ in range(8):  # it does one thing in each
            found += steps.step(taken_us, False)
        assert ("h" in found) is heard and "e" not in found, taken_us


def test_settings_that_could_not_be_saved_are_tried_again_ten_seconds_later():
    """What else wants to write meanwhile does not wait for that."""
    steps = Steps(addresses=(1, 2))
    app, tried, done = steps.app, [], []

    def replace(_data):
        tried.append(steps.clock.now_us)
        raise OSError(28)

    app.board.store.replace = replace
    app.bus.pause = lambda: setattr(app.bus, "paused", True)  # at once
    app.settings.accept_unsupervised(1)
    steps.step()
    assert len(tried) == 1 and app.settings.dirty and app.panel.message is not None
    for ms, count in ((9_999, 1), (10_000, 2), (19_999, 2), (20_000, 3)):
        steps.clock.advance(tried[0] + ms * 1_000 - steps.clock.now_us)
        app.panel.errand = lambda: done.append("errand")
        steps.step()
        assert done.pop() == "errand" and app.panel.errand is None
        steps.step()
        assert len(tried) == count, ms
    steps.clock.advance(10_000_000)
    del app.board.store.replace
    steps.step()
    assert not app.settings.dirty and not app.bus.paused
    app.settings.accept_unsupervised(2)
    steps.step()
    assert not app.settings.dirty


FINDER = ("uss.finding", "uss.finding.mirror", "uss.finding.finder")


def test_what_finds_another_layout_is_loaded_after_three_silences_or_a_doubt():
    """A module in each step, which does nothing else."""

    def silent_again(steps):
        steps.app.bus.deadlines.silence.count = 3

    def in_doubt(_steps):
        Drive.doubts += 1

    for happens in (silent_again, in_doubt):
        steps = Steps().fed()
        for name in FINDER:  # of which some are kept where there is room
            sys.modules.pop(name, None)
        steps.app.bus.deadlines.silence.count = 2
        assert [steps.step() for _ in range(3)] == ["ls"] * 3
        assert len(on_demand.missing(FINDER)) == 3
        happens(steps)
        for left in (2, 1, 0, 0):
            assert steps.step() == "" and len(on_demand.missing(FINDER)) == left
        assert [steps.step() for _ in range(3)] == ["ls"] * 3


def test_a_display_that_does_not_show_the_farewell_is_given_up_after_100_pieces():
    for pieces, shown in ((3, "sisis"), (100, "si" * 99 + "s"), (101, "si" * 100)):
        steps = Steps()
        answers = [False] * (pieces - 1) + [True]
        steps.show = lambda _picture, steps=steps, answers=answers: (
            steps.note("s") or answers.pop(0)
        )
        steps.app.board.idle = lambda steps=steps: steps.note("i") or steps.clock.advance(1_000)
        steps.app.close()
        assert steps.done[steps.done.index("s") :] == shown, pieces


# --- the time of a step --------------------------------------------------------------------------


class ByItself:
    """A panel whose clock and line are those of the test: when its step began, how late it is now,
    and until when nothing disturbs."""

    dead_man_trips = 0

    def __init__(self, now_us=0):
        self.panel = panel().app.panel
        self.now_us = now_us
        self.free_until_us = 0
        self.deadlines = self.panel.bus.deadlines
        self.panel.board.clock = self.panel.bus = self

    def ticks_us(self):
        return self.now_us & self.panel.mask

    def is_undisturbed(self, until_us):
        return until_us <= self.free_until_us

    def is_line_in_use(self):
        return False

    def begin(self, taken_us, now_ms=0):
        """A step has begun, so long ago."""
        self.panel.step(0, now_ms, self.now_us - taken_us & self.panel.mask)

    def tries(self, count):
        """How often what takes long was put off, each time it was asked for, until it began."""
        put_off = []
        for _ in range(count):
            put_off.append(0)
            while not self.panel.has_time():
                put_off[-1] += 1
                assert put_off[-1] < 50
        return put_off


def test_what_takes_long_waits_for_a_telegram_and_then_for_a_step_that_has_just_begun():
    alone = ByItself()
    alone.begin(799)
    alone.free_until_us = 2_000  # so long it takes
    assert alone.tries(2) == [0, 0]
    alone.free_until_us = 1_999
    assert alone.tries(2) == [7, 7]
    alone.begin(800)  # interrupted already
    alone.free_until_us = 9_999
    assert alone.tries(2) == [15, 15]


def test_how_long_a_step_has_taken_is_told_by_a_clock_that_begins_anew():
    for now_us in (5_000, 300):
        alone = ByItself(now_us)
        alone.begin(500)
        assert alone.panel.has_taken(500) and not alone.panel.has_taken(501)
    alone.now_us = alone.panel.mask
    alone.begin(0)
    alone.free_until_us = 99  # of the next period
    assert alone.panel.is_undisturbed(100) and not alone.panel.is_undisturbed(101)


def test_what_is_said_stands_for_three_seconds():
    alone = ByItself()
    mask = alone.panel.mask
    for said_ms in (20_000, mask - 500):
        alone.panel.say(said_ms, b"SO IT IS")
        for ms, stands in ((0, True), (2_999, True), (3_000, False)):
            for _ in range(8):  # one thing in each step
                alone.begin(0, said_ms + ms & mask)
            assert (alone.panel.message is not None) == stands, ms


class Busy:
    """A page that covers the home page and has something long to do, again and again."""

    is_busy = True
    modules = ()

    def __init__(self, alone, work_us=0):
        self.alone = alone
        self.work_us = work_us  # what it does before it asks for time
        self.put_off = self.begun = 0
        alone.panel.cover(self)

    def is_ready(self):
        return False

    def step(self, _keys, _now_ms):
        pass

    def work(self, _now_ms):
        self.alone.now_us += self.work_us
        if self.alone.panel.has_time():
            self.begun += 1
        else:
            self.put_off += 1

    def steps(self, count):
        """What each step of the panel made of it: begun, put off, or neither."""
        found = ""
        for _ in range(count):
            put_off, begun = self.put_off, self.begun
            self.alone.begin(0)
            found += "-" * (self.put_off - put_off) + "B" * (self.begun - begun) or "."
        return found


def test_what_was_put_off_has_the_next_step_that_nothing_disturbs():
    alone = ByItself()
    page = Busy(alone)
    while not page.put_off:
        page.steps(1)
    alone.free_until_us = 2_000
    assert page.steps(12) == "BB.....B.B.."
    alone.free_until_us = 1_999
    assert page.steps(36) == "...-.-.." * 3 + "...-.B.." + "...-"


def test_what_is_too_late_again_and_again_begins_after_sixteen_times():
    alone = ByItself()
    page = Busy(alone, work_us=900)
    alone.free_until_us = 1 << 29
    assert page.steps(34) == ".." + "-" * 15 + "B" + "-" * 15 + "B"


def test_what_does_not_wait_any_more_leaves_no_haste_to_the_next():
    alone = ByItself()
    page = Busy(alone)
    while not page.put_off:
        page.steps(1)
    page.is_busy = False
    alone.free_until_us = 2_000
    assert page.steps(8) == "........"
    alone.free_until_us = 0
    assert alone.tries(1) == [7]


def test_a_page_comes_a_module_at_a_time_and_on_a_busy_line_every_eighth():
    modules = PAGES[PARAMETER][2]
    alone = ByItself()
    on_demand.drop(*modules)
    on_demand.flush()
    alone.panel.turn_page(0, PARAMETER)

    def come(steps):
        before = len(on_demand.missing(modules))
        for _ in range(steps):
            alone.begin(0)
        return before - len(on_demand.missing(modules))

    assert len(on_demand.missing(modules)) >= 10
    come(1)  # it has every second step
    assert [come(14), come(2), come(14), come(2)] == [0, 1, 0, 1]
    alone.free_until_us = 2_000
    assert [come(2) for _ in range(6)] == [1] * 6


class Pictures:
    """Counts the pictures that are begun, as the warning of the drive shown."""

    active = False
    begun = number = digits = 0

    def step(self, _now_us):
        self.begun += 1


def test_a_picture_is_begun_45_ms_after_the_one_before():
    alone = ByItself()
    pictures = alone.panel.warning = Pictures()

    def begun(ms):
        before = pictures.begun
        for _ in range(160):  # enough to draw it to its end
            alone.begin(0, 50_000 + ms)
        return pictures.begun - before

    assert [begun(ms) for ms in (0, 44, 45, 89, 90, 400)] == [1, 0, 1, 0, 1, 1]


class Coming(Page):
    """A page that is reached through the menu, and that has still to look for what it shows."""

    is_there = False
    is_busy = True
    worked = 0

    def is_coming(self):
        return not self.is_there

    def work(self, _now_ms):
        self.worked += 1

    def draw(self, screen, _now_ms):
        screen.put(1, 0, 13, b"COMES")


class ComingParameters:
    """Meanwhile the page of parameters is `Coming`: a list of those that were made."""

    def __enter__(self):
        self.modules = PAGES[PARAMETER][2]
        for name in self.modules:
            self.module = on_demand.load(name)
        self.its_own = self.module.Parameter
        self.module.Parameter = self.made
        self.pages = []
        return self.pages

    def made(self, front):
        self.pages.append(Coming(front))
        return self.pages[-1]

    def __exit__(self, *_):
        self.module.Parameter = self.its_own
        on_demand.drop(*self.modules)


def test_a_page_that_is_coming_has_the_time_of_the_picture_for_300_ms():
    alone = ByItself()
    alone.free_until_us = 1 << 29
    pictures = alone.panel.warning = Pictures()

    def begun(ms):
        before = pictures.begun
        for _ in range(160):
            alone.begin(0, 50_000 + ms)
        return pictures.begun - before

    assert begun(0) == 1
    with ComingParameters() as pages:
        alone.panel.turn_page(0, PARAMETER)
        assert begun(299) == 0 and pages[0].worked > 100
        alone.free_until_us = 0
        assert [begun(ms) for ms in (300, 301, 599, 600, 610)] == [1, 0, 0, 1, 0]
        pages[0].is_there = True  # what was drawn before is not of this page
        assert [begun(ms) for ms in (611, 655, 656)] == [1, 0, 1]
        pages[0].is_there = False
        alone.panel.cover(Coming(alone.panel))  # it is this one that is shown
        assert [begun(ms) for ms in (700, 701, 746)] == [0, 1, 1]


def test_a_message_is_shown_though_a_page_is_still_coming():
    """As soon as the 300 ms are over; the page has the rest of its time."""
    alone = ByItself()

    def row_2_at(ms):
        for _ in range(160):
            alone.begin(0, ms)
        return alone.panel.screen.rows()[1].rstrip()

    row_2_at(50_000)
    with ComingParameters() as pages:
        alone.panel.turn_page(0, PARAMETER)
        alone.panel.say(50_001, texts.NO_MEMORY)
        assert row_2_at(50_299) != "NO MEMORY LEFT" and row_2_at(50_300) == "NO MEMORY LEFT"
        worked = pages[0].worked
        row_2_at(50_301)
        assert pages[0].worked > worked


def test_a_page_that_is_coming_has_each_step_that_nothing_disturbs():
    alone = ByItself()
    alone.free_until_us = 1 << 29
    with ComingParameters() as pages:
        alone.panel.turn_page(0, PARAMETER)
        while not pages:
            alone.begin(0)
        worked = []
        for _ in range(12):
            alone.begin(0)
            worked.append(pages[0].worked)
        assert worked == list(range(1, 13))
        alone.free_until_us = 0
        for _ in range(16):
            alone.begin(0)
        assert 16 <= pages[0].worked < 24, pages[0].worked


def test_a_key_that_is_pressed_has_a_picture_at_once_and_one_that_repeats_has_not():
    alone = ByItself()
    front, pictures = alone.panel, Pictures()
    front.warning = pictures
    up = 1 << front.board.keypad.names.index("UP")

    def begun(ms, raw=up):
        before = pictures.begun
        for _ in range(160):
            front.step(raw, 50_000 + ms, 0)
        return pictures.begun - before

    setpoint = front.selected.setpoint.centihertz
    assert [begun(0, 0), begun(1), begun(20)] == [1, 0, 0]
    assert begun(21) == 1  # it counts after 20 ms
    assert front.selected.setpoint.centihertz > setpoint
    assert [begun(65), begun(66)] == [0, 1]
    setpoint = front.selected.setpoint.centihertz
    delay_ms = 21 + front.settings.key_delay_ms
    assert [begun(delay_ms - 1), begun(delay_ms), begun(delay_ms + 43)] == [1, 0, 0]
    assert front.selected.setpoint.centihertz > setpoint and begun(delay_ms + 44) == 1


def test_in_eight_steps_the_drive_shown_is_asked_three_times_and_watched_once():
    """And the bus learns what it has told."""
    alone = ByItself()
    front, calls = alone.panel, []
    control = front.selected
    ask, watch, ask_on, heed = control.ask, control.watch, control.ask_on, front.heed

    def asked(now_us):
        calls.append("ask")
        ask(now_us)
        return control.news

    def on(now_us):
        calls.append("ask on")
        ask_on(now_us)

    def watched(now_us):
        calls.append("watch")
        watch(now_us)

    def heeded(whose):
        assert whose is control
        calls.append("heed")
        heed(whose)

    control.ask, control.ask_on, control.watch, front.heed = asked, on, watched, heeded
    once = ["ask", "watch", "ask on", "ask"]
    for control.news, wanted in (
        (False, once), (True, ["ask", "heed", "watch", "ask on", "ask", "heed"])
    ):  # fmt: skip
        del calls[:]
        for _ in range(16):
            alone.begin(0)
        seen = calls * 2
        assert len(calls) == 2 * len(wanted), calls
        assert any([seen[at : at + len(wanted)] == wanted for at in range(len(calls))]), calls


def test_what_there_is_to_say_of_a_drive_waits_while_its_start_is_checked():
    alone = ByItself()
    control, looked = alone.panel.selected, []
    control.ask = control.ask_on = control.watch = lambda now_us: None
    alone.panel.announcer.look = looked.append
    for control.phase, looks in ((IDLE, [0]), (CHECKING, []), (RUNNING, [0]), (JOGGING, [0])):
        looked.clear()
        for _ in range(8):
            alone.begin(0)
        assert looked == looks, control.phase


def test_keys_that_bounce_put_off_every_other_step_of_what_can_wait():
    """Which is the display, and drives that are silent or wait too long."""
    alone = ByItself()
    front = alone.panel
    for _ in range(160):  # until there is nothing to draw
        alone.begin(0, 50_000)

    def leaves(raw):
        return [front.step(raw, 50_001, 0) for _ in range(16)].count(True)

    assert [leaves(0), leaves(4), leaves(0), leaves(0)] == [8, 4, 7, 8]  # one step settles them


def test_the_bus_knows_the_telegram_off_time_of_a_drive_that_has_told_all():
    alone = ByItself()
    supervised = []

    class Told:
        complete = False

        def off_time_ms(self):
            return 1_500

        def supervise(self, drive, ms):
            supervised.append((drive, ms))

    told = Told()
    told.survey = told.drive = alone.deadlines = told
    alone.panel.heed(told)
    assert supervised == []
    told.complete = True
    alone.panel.heed(told)
    assert supervised == [(told, 1_500)]
