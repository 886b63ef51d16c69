# SPDX-License-Identifier: MIT
"""What can happen to the simulated line: every kind of fault, by order and by chance.

And who is to blame: the panel answers for what it could have heard, the weather for the rest.
"""

import main
from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.dice import Dice
from boards.sim.line.faults import KINDS, LOG_LIMIT, SUPPLIES, LineFaults
from boards.sim.line.wire import FRAME, PARITY, Burst, Transceiver, Wire
from boards.sim.world import World
from drive_bench import OFF1, Bench, telegram

REQUEST = telegram(1, 0, 0, 0, 0, OFF1, 0)
SIXTEEN = bytes(range(0x30, 0x40))
EVERYTHING = {
    "flip": 0.001, "lost": 0.0005, "doubled": 0.0005, "stray": 0.0005, "late": 0.01, "cut": 0.01,
    "foreign": 0.005, "noise": 0.5, "babble": 60, "wire cut": 60, "dip": 20,
}  # fmt: skip


class Station:
    def __init__(self, wire, name, **more):
        self.name = name
        self.heard = []
        for attribute, value in more.items():
            setattr(self, attribute, value)
        wire.attach(self)

    def hear(self, burst):
        errors = bytes(burst.errors[: burst.count]) if burst.errors else None
        self.heard.append((bytes(burst.data[: burst.count]), errors))


class Asker(Bench):
    """A drive and its master, whose own telegrams are no replies."""

    is_panel = True


class Line:
    """A drive that talks, one that listens, and faults between them."""

    def __init__(self, rates=None, seed=1, baud=19200):
        self.clock = Clock()
        self.wire = Wire(self.clock, baud)
        self.drive = Station(self.wire, "drive 1")
        self.listener = Station(self.wire, "drive 2")
        self.faults = LineFaults(self.wire, Dice(seed, 1).random, rates)

    def say(self, data=SIXTEEN, station=None):
        """Answers what was heard of it: [(characters, errors), ...]."""
        del self.listener.heard[:]
        self.clock.advance(10_000)
        self.wire.talk(station or self.drive, data, len(data))
        self.clock.advance(1_000_000)
        return self.listener.heard


def refused(error, function, *arguments):
    try:
        function(*arguments)
    except error as raised:
        return str(raised)
    raise AssertionError("accepted")


# --- characters -------------------------------------------------------------------------------


def test_without_faults_everything_comes_over():
    line = Line()
    for _ in range(3):
        assert line.say() == [(SIXTEEN, None)]
    assert line.faults.log == [] and not any(line.faults.count.values())


def test_a_flipped_bit_of_the_data_makes_the_parity_wrong():
    line = Line()
    seen = set()
    for _ in range(200):
        line.faults.strike("flip")
        ((heard, errors),) = line.say()
        assert len(heard) == 16
        ((at, error),) = [(i, error) for i, error in enumerate(errors) if error]
        wrong = heard[at] ^ SIXTEEN[at]
        assert heard == SIXTEEN[:at] + bytes([SIXTEEN[at] ^ wrong]) + SIXTEEN[at + 1 :]
        if wrong:  # a single bit, and even parity tells
            assert wrong & (wrong - 1) == 0 and error == PARITY
        else:  # the parity bit itself, or the stop bit: the data are right
            assert error in (PARITY, FRAME)
        seen.add((wrong, error))
    assert len(seen) == 10
    assert line.faults.count["flip"] == 200
    assert line.say() == [(SIXTEEN, None)], "it was one telegram each"


def test_so_many_characters_of_a_telegram_are_struck():
    line = Line()
    for count in (1, 3, 16):
        line.faults.strike("flip", count)
        ((_, errors),) = line.say()
        assert sum(1 for error in errors if error) == count
        line.faults.strike("lost", count)
        heard = line.say()
        assert len(heard[0][0] if heard else b"") == 16 - count
        line.faults.strike("doubled", count)
        assert len(line.say()[0][0]) == 16 + count
        line.faults.strike("stray", count)
        assert len(line.say()[0][0]) == 16 + count


def test_what_is_heard_lies_within_what_was_said():
    line = Line({"lost": 0.1, "doubled": 0.1, "stray": 0.1, "flip": 0.1})
    ends = []

    class Ears:
        name = "ears"

        def hear(self, burst):
            assert list(burst.ends[: burst.count]) == sorted(burst.ends[: burst.count])
            assert burst.start_us + burst.ends[burst.count - 1] <= burst.end_us
            assert burst.arrived(burst.end_us - 1) <= burst.count
            ends.append(burst.end_us - burst.start_us)

    line.wire.attach(Ears())
    for _ in range(50):
        line.say()
    assert set(ends) == {line.wire.ends[15]}


def test_the_log_of_the_wire_keeps_what_left_the_talker():
    line = Line({"flip": 0.2, "lost": 0.1, "doubled": 0.1})
    for _ in range(20):
        line.say()
    assert [data for _, _, data in line.wire.log.last(99)] == [SIXTEEN] * 20


# --- replies ----------------------------------------------------------------------------------


def test_a_late_reply_comes_so_many_milliseconds_later():
    bench = Asker()
    faults = LineFaults(bench.wire, Dice(1).random)
    faults.strike("late", 30)
    bench.send(REQUEST)
    asked_us = bench.clock.now_us
    bench.wait(0.2)
    assert bench.heard[0][0] == asked_us + bench.drive.reply_delay_us + 30_000
    assert bench.ask(REQUEST) and len(faults.log) == 1


def test_a_reply_is_cut_short():
    bench = Asker()
    faults = LineFaults(bench.wire, Dice(1).random)
    whole = bench.ask(REQUEST)
    for count in (1, 5, 15):
        faults.strike("cut", count)
        assert bench.ask(REQUEST) == whole[:count]
    assert bench.ask(REQUEST) == whole


def test_a_reply_seems_to_be_another_drives():
    bench = Asker()
    faults = LineFaults(bench.wire, Dice(1).random)
    faults.strike("foreign", 7)
    reply = bench.ask(REQUEST)
    check = 0
    for character in reply:
        check ^= character
    assert reply[2] == 7 and check == 0
    assert bench.ask(REQUEST)[2] == 1


def test_only_the_drive_that_is_meant():
    bench = Asker()
    faults = LineFaults(bench.wire, Dice(1).random)
    faults.strike("cut", 3, object())
    assert len(bench.ask(REQUEST)) == 16
    faults.strike("cut", 3, bench.drive)
    assert len(bench.ask(REQUEST)) == 3


def test_a_twin_talks_into_its_brother_or_behind_it():
    bench = Asker()
    faults = LineFaults(bench.wire, Dice(3).random, {"twin": 1})
    good = bad = second = 0
    whole = telegram(1, 0, 0, 0, 0, 0xFB31, 0)
    for _ in range(60):
        first = bench.ask(REQUEST)
        bench.wait(0.06)
        good += first == whole
        bad += first != whole
        second += len(bench.heard) > 1
    assert good > 5 and bad > 20 and second > 5, (good, bad, second)
    faults.set("twin", None)
    assert bench.ask(REQUEST) == whole and len(bench.heard) == 1


# --- the line ---------------------------------------------------------------------------------


def test_noise_comes_between_the_telegrams():
    line = Line()
    line.faults.strike("noise", 5)
    line.clock.advance(100_000)
    ((heard, errors),) = line.listener.heard
    assert len(heard) == 5 and line.faults.log[0][1:] == ("noise", 5)
    # While somebody talks it waits.
    line.wire.talk(line.drive, SIXTEEN, 16)
    line.faults.strike("noise", 5)
    line.clock.advance(100_000)
    assert line.listener.heard[1] == (SIXTEEN, None) and len(line.listener.heard) == 3


def test_a_babbling_node_leaves_no_pause():
    line = Line()
    line.faults.strike("babble", 500)
    longest_us = silent_us = 0
    while line.clock.now_us < 499_000:
        line.clock.advance(100)
        busy = line.wire.busy_until_us() > line.clock.now_us
        silent_us = 0 if busy else silent_us + 100
        longest_us = max(longest_us, silent_us)
    assert longest_us < line.wire.start_interval_us
    line.clock.advance(100_000)
    heard = len(line.listener.heard)
    line.clock.advance(1_000_000)
    assert len(line.listener.heard) == heard > 10


def test_a_node_that_begins_to_babble_a_thousand_times_a_second_just_babbles():
    line = Line({"babble": 3_600_000})
    line.clock.advance(2_000_000)
    assert line.faults.count["babble"] > 500
    assert len(line.listener.heard) > 20


def test_a_cut_wire_to_one_drive():
    bench = Asker()
    faults = LineFaults(bench.wire, Dice(1).random)
    for way, heard_it in (("both", 0), ("hears", 0), ("talks", 1)):
        good = bench.drive.read(2024)
        faults.cut("drive 1", way)
        assert bench.ask(REQUEST) is None
        assert bench.drive.read(2024) == good + heard_it, way
        faults.mend()
        assert bench.ask(REQUEST)


def test_where_nobody_has_a_supply_no_wire_breaks():
    clock = Clock()
    faults = LineFaults(Wire(clock, 19200), Dice(1).random, {"wire cut": 3600})
    clock.advance(30_000_000)
    assert faults.count["wire cut"] == 0


def test_a_wire_that_breaks_cuts_what_is_being_said():
    line = Line()
    line.wire.talk(line.drive, SIXTEEN, 16)
    line.clock.advance(line.wire.ends[4] + 10)
    line.faults.cut("drive 1")
    line.clock.advance(50_000)
    assert line.listener.heard == [(SIXTEEN[:5], None)]
    assert line.say() == []
    line.faults.mend()
    assert line.say() == [(SIXTEEN, None)]


def test_it_stays_cut_while_the_drive_is_switched_off_and_on():
    bench = Asker()
    faults = LineFaults(bench.wire, Dice(1).random)
    faults.cut("drive 1")
    bench.drive.power_off()
    bench.drive.power_on()
    assert bench.ask(REQUEST) is None
    faults.mend()
    assert bench.ask(REQUEST)


def test_behind_a_cut_wire_nobody_is_disturbed():
    line = Line()
    three = Station(line.wire, "drive 3")
    line.faults.cut("drive 1")
    line.wire.talk(line.drive, SIXTEEN, 16)
    line.clock.advance(3_000)
    line.wire.talk(three, SIXTEEN, 16)
    line.clock.advance(50_000)
    assert line.listener.heard == [(SIXTEEN, None)] and line.wire.weather() == []


def test_echo_is_a_switch():
    line = Line({"echo": True})
    assert line.wire.echo
    line.faults.calm()
    assert not line.wire.echo


def test_dips_are_for_whoever_supplies_the_world():
    line = Line()
    line.faults.strike("dip", 200)
    assert line.faults.log == [], "there are no mains here"
    dips = []
    line.faults.on_dip = lambda whose, ms: dips.append((whose, ms))
    line.faults.strike("dip", 200)
    line.faults.set("dip", 3600)
    line.clock.advance(60_000_000)
    assert dips[0][1] == 200 and 20 < len(dips) < 200
    assert {whose for whose, _ in dips} == set(SUPPLIES)


def test_of_three_talkers_at_once_the_panel_hears_until_the_last_one_ends():
    clock = Clock()
    wire = Wire(clock, 19200)
    chip = Chip(clock, wire)
    uart = UART(chip, 19200)
    Transceiver(wire, uart, Pin(chip))
    talkers = [Station(wire, "drive %d" % i) for i in range(3)]
    wire.talk(talkers[0], SIXTEEN, 8)
    clock.advance(2_000)
    long = wire.talk(talkers[1], bytes(60), 60)
    clock.advance(1_000)
    wire.talk(talkers[2], SIXTEEN, 8)
    clock.advance_to(long.end_us - wire.character_us)
    before = uart.any()
    clock.advance_to(long.end_us)
    assert uart.any() == before + 1 and before > 50


def test_what_took_place_on_a_real_line_is_heard_and_not_judged():
    line = Line({"flip": 1})
    burst = Burst(line.wire.ends, line.wire.character_us)
    burst.begin(0, 0)
    burst.append(SIXTEEN, 16)
    line.clock.advance_to(burst.end_us)
    line.wire.took_place(line.drive, burst)
    assert line.listener.heard == [(SIXTEEN, None)] and line.drive.heard == []
    assert line.wire.log.last(9) == [(0, False, SIXTEEN)]
    assert line.wire.violations() == line.wire.weather() == []


# --- chance -----------------------------------------------------------------------------------


def test_rates_are_kept():
    line = Line({"flip": 0.01, "lost": 0.002, "doubled": 0.002, "stray": 0.002})
    for _ in range(1_250):  # 20,000 characters
        line.wire.talk(line.drive, SIXTEEN, 16)
        line.clock.advance(12_000)
    count = line.faults.count
    assert 160 < count["flip"] < 240 and 25 < count["lost"] < 55, count
    assert 25 < count["doubled"] < 55 and 25 < count["stray"] < 55, count
    line = Line({"late": 0.1, "cut": 0.05, "foreign": 0.05})
    for _ in range(1_000):
        line.wire.talk(line.drive, SIXTEEN, 16)
        line.clock.advance(200_000)
    count = line.faults.count
    assert 70 < count["late"] < 130 and 30 < count["cut"] < 70 and 30 < count["foreign"] < 70
    line = Line({"noise": 2, "babble": 360})
    line.clock.advance(100_000_000)
    assert 150 < line.faults.count["noise"] < 250 and 5 <= line.faults.count["babble"] <= 20


def test_a_seed_repeats_everything():
    def life(seed):
        world = World(main.start, seed=seed)
        faults = LineFaults(world.wire, Dice(seed, 1).random, EVERYTHING, world.dip)
        world.run(20_000)
        return faults.log, faults.count, world.wire.log.last(999), world.lcd()

    life(5)  # to load a module takes a step of the loop, which no later life in here needs
    assert life(5) == life(5)
    assert life(5) != life(6)


def test_faults_do_not_shift_the_delays_of_the_drives():
    def delays(rates):
        world = World(main.start, addresses=(1, 2, 3), seed=9)
        LineFaults(world.wire, Dice(9, 1).random, rates)
        world.run(500)
        return [world.drives[address].reply_delay_us for address in (1, 2, 3)]

    assert delays({"noise": 20}) == delays(None)


def test_the_log_keeps_the_last_hundred():
    line = Line({"flip": 1})
    for _ in range(10):
        line.say()
    assert len(line.faults.log) == LOG_LIMIT and line.faults.count["flip"] == 160
    instants = [at_us for at_us, _, _ in line.faults.log]
    assert instants == sorted(instants)


def test_calm_ends_it_all():
    world = World(main.start)
    faults = LineFaults(world.wire, Dice(1).random, dict(EVERYTHING, twin=1, echo=True), world.dip)
    faults.strike("babble", 5_000)
    faults.cut("panel")
    world.run(3_000)
    faults.calm()
    world.run(10_000)  # whoever was off is back
    before = dict(faults.count)
    good = world.drives[1].read(2024)
    world.run(5_000)
    assert faults.count == before and world.drives[1].read(2024) > good + 100
    assert not any(faults.rates[kind] for kind in KINDS)


def test_what_is_no_fault_is_refused():
    faults = Line().faults
    assert refused(KeyError, faults.set, "flop", 1)
    assert "from 0 to 1" in refused(ValueError, faults.set, "flip", 1.5)
    assert "from 0 on" in refused(ValueError, faults.set, "noise", -1)
    assert "address" in refused(ValueError, faults.set, "twin", 32)
    assert refused(KeyError, faults.strike, "flop")
    assert "on or off" in refused(ValueError, faults.strike, "echo")
    assert "260 characters" in refused(ValueError, faults.strike, "noise", 261)
    assert refused(KeyError, faults.cut, "drive 1", "sideways")


# --- who is to blame --------------------------------------------------------------------------


class Judged:
    """A panel on a line with faults, whose driver the test switches itself."""

    def __init__(self):
        self.line = Line()
        self.wire = self.line.wire
        self.clock = self.line.clock
        self.panel = Station(self.wire, "panel", is_panel=True, has_driver_enable=True)
        self.clock.advance(10_000)

    def talk(self):
        """A telegram with the driver exactly as it has to be."""
        self.wire.drive(self.panel, True)
        burst = self.wire.talk(self.panel, REQUEST, 16)
        self.clock.advance_to(burst.end_us)
        self.wire.drive(self.panel, False)

    def blamed(self):
        return self.wire.violation_count(), self.wire.weather_count() > 0


def test_the_panel_is_blamed_for_talking_into_what_it_heard():
    judged = Judged()
    judged.line.faults.strike("noise", 8)
    judged.clock.advance(5 * judged.wire.character_us)  # some characters are over
    judged.talk()
    assert judged.blamed() == (2, False)  # for its driver and for its telegram
    assert "panel enables its driver while noise talks" in judged.wire.violations()[0]


def test_what_it_could_not_hear_yet_is_the_weathers():
    judged = Judged()
    noise = Station(judged.wire, "noise", is_weather=True)
    judged.wire.put(noise, SIXTEEN, 8)
    judged.clock.advance(400)  # not one character is over
    judged.talk()
    assert judged.blamed() == (0, True)
    assert "panel talks while noise talks" in judged.wire.weather()[-1]


def test_a_short_silence_is_blamed_if_it_could_be_heard():
    judged = Judged()
    noise = Station(judged.wire, "noise", is_weather=True)
    judged.wire.put(noise, SIXTEEN, 1)
    judged.clock.advance(573 + 900)
    judged.talk()
    assert judged.blamed() == (1, False)


def test_what_noise_does_to_others_is_not_the_panels():
    judged = Judged()
    judged.wire.drive(judged.panel, True)
    judged.wire.talk(judged.panel, REQUEST, 16)
    judged.clock.advance(3_000)
    noise = Station(judged.wire, "noise", is_weather=True)
    judged.wire.put(noise, SIXTEEN, 1)
    judged.clock.advance_to(judged.wire.busy_until_us())
    judged.wire.drive(judged.panel, False)
    judged.clock.advance(200)
    judged.wire.talk(judged.line.drive, SIXTEEN, 16)  # a drive, too early
    judged.clock.advance(50_000)
    assert judged.blamed() == (0, True)


def test_its_driver_is_the_panels_in_any_weather():
    judged = Judged()
    judged.line.faults.strike("babble", 1_000)
    judged.wire.drive(judged.panel, True)
    judged.clock.advance(5_000)
    judged.wire.drive(judged.panel, False)
    assert "enabled for 5000 us without sending" in judged.wire.violations()[-1]


def test_into_a_node_that_never_stops_it_may_talk_after_half_a_second():
    for waited_us, blamed in ((300_000, True), (510_000, False)):
        judged = Judged()
        judged.line.faults.strike("babble", 2_000)
        judged.clock.advance(waited_us)
        while judged.wire.busy_until_us() - judged.clock.now_us < 3_000:
            judged.clock.advance(100)
        judged.clock.advance(1_200)
        judged.talk()
        assert (judged.wire.violation_count() > 0) == blamed, waited_us


def test_without_faults_everybody_is_judged():
    judged = Judged()
    judged.wire.faults = None
    judged.wire.talk(judged.line.drive, SIXTEEN, 16)
    judged.clock.advance(9_166 + 300)
    judged.wire.talk(judged.line.listener, SIXTEEN, 16)
    assert judged.blamed() == (1, False)
    judged.wire.forgive()
    assert judged.blamed() == (0, False) and judged.wire.violations() == []


# --- the whole panel --------------------------------------------------------------------------


def test_the_panel_keeps_the_rules_in_any_weather():
    for seed in range(1, 9):
        world = World(
            main.start,
            addresses=((1,), (1, 2, 3))[seed % 2],
            baud=(19200, 9600, 115200, 4800)[seed % 4],
            polled=seed % 5 == 0,
            seed=seed,
        )
        rates = dict(EVERYTHING, twin=1 if seed % 3 == 0 else None, echo=seed % 7 == 0)
        faults = LineFaults(world.wire, Dice(seed, 1).random, rates, world.dip)
        world.run(1_500)
        world.press("START")
        world.run(20_000)
        world.check()
        assert world.wire.weather_count() and sum(faults.count.values()) > 10
        faults.calm()
        world.run(6_000)
        assert "NO CONTACT" not in world.lcd()[1] and "-----" not in world.lcd()[0], world.lcd()
        world.check()


def test_a_dip_of_the_mains_restarts_whoever_it_concerns():
    for whose, resets in (("all", 1), ("drives", 0), ("panel", 1)):
        world = World(main.start)
        world.run(1_500)
        world.press("START")
        world.run(3_000)
        assert world.drives[1].state == "running"
        world.dip(whose, 300)
        world.run(200)
        assert world.drives[1].powered == (whose == "panel")
        assert world.resets == resets, whose
        world.run(3_000)
        assert world.drives[1].powered and world.drives[1].state != "running", whose
        world.check()
