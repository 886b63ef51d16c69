# SPDX-License-Identifier: MIT
"""A slave that no family of the library knows: what a program says of it holds."""

from boards.sim.drives import pump
from bus_bench import Bench, refusal
from tools.examples.own_family import TurboPump
from tools.examples.simulation import Stage
from uss import bits, families, pkw
from uss.bus import Master, NoContact, NotStarted, UssError
from uss.drive import Drive
from uss.families import G120, GENERIC, MM420
from uss.layout import Layout
from uss.master import Master as Engine
from uss.s7 import USS_CTRL, USS_INIT, Port
from uss.timing import Timing

PUMP = {1: {"family": pump}}
RAMPS = {1120: 1.0, 1121: 1.0, 2014: 0}
ORDER = ([0x047E, 0], [0x047F, 0x2000])  # OFF1, then ON


def bench(family=TurboPump, **options):
    options.setdefault("kinds", PUMP)
    return Bench(family=family, unsupervised=True, parameters=RAMPS, **options)


def without_control():
    """A bench whose drive is told nothing but parameters."""
    world = bench()
    world.bus.remove(world.drive)
    world.bus.add(1, TurboPump, control=False)
    return world


def let_run(world):
    """Somebody else's order, by terminals: it is none of the bus's telegrams."""
    for words in ORDER:
        world.motor().process.accept(words)


# --- its status word ----------------------------------------------------------------------------


def test_the_states_are_those_that_its_own_bits_mean():
    world = bench()
    drive = world.drive
    world.bus.wait(0.5)
    assert (drive.state, drive.zsw & 0x7FFF) == ("ready", 0x0001)
    drive.run(percent=40)
    world.bus.wait(0.3)
    assert drive.is_running and drive.zsw == 0x8814, "%04X" % drive.zsw  # faster: bit 4, no OFF2
    world.bus.wait(2)
    assert drive.zsw == 0x8804 and drive.state == "running"
    drive.stop()
    world.bus.wait(0.2)
    assert drive.state == "running" and drive.zsw & 0x0820 == 0x0820  # it turns, and gets slower
    world.bus.wait(2)
    assert drive.state == "ready"
    world.motor().fault(5)
    world.bus.wait(0.2)
    assert drive.state == "fault" and drive.zsw & 0x0008
    drive.acknowledge()
    world.bus.wait(1)
    assert drive.state == "ready"
    world.end()


def test_by_the_specifications_bits_it_would_not_start():
    class Mistaken(TurboPump):
        zsw_says = None

    world = bench(Mistaken)
    assert "is inhibited" in refusal(NotStarted, world.drive.run, None, 40)
    world.end()


def test_a_fault_takes_on_back_by_its_own_bit():
    world = bench()
    world.drive.run(percent=40)
    world.motor().fault(5)
    world.bus.wait(0.3)
    assert world.drive.engine.stopped_by_engine()
    world.drive.acknowledge()
    world.bus.wait(3)
    assert world.motor().starts == 1 and world.motor().hz() == 0
    world.end()


def test_its_words_are_as_they_came():
    world = bench()
    world.bus.wait(0.5)
    assert world.drive.word(1) == world.drive.zsw == world.motor().process.zsw()
    assert world.drive.engine.zsw == 0x0031
    world.drive.put(6, 0x1234)
    world.bus.wait(0.2)
    assert world.motor().process.image[5] == 0x1234
    world.end()


def test_a_drive_that_says_nothing_of_being_ready_is_ready_when_nothing_is_wrong():
    class Silent(GENERIC):
        layout = Layout(4, 6)
        zsw_says = ((0, 0, 0x0031), (0x0004, 0x0004, 0x0004), (0x0048, 0x0008, 0x0008))

    world = bench(Silent)
    world.bus.wait(0.5)
    assert world.drive.state == "ready" and bits.may_start(world.drive.engine.zsw)
    world.end()


def test_a_family_of_the_specification_has_the_plain_drive():
    assert families.drive_maker(MM420) is Drive


def test_the_blocks_of_a_plc_run_it_as_well():
    world = bench()
    world.bus.close()
    clock = world.clock

    def open_bus(baud):
        return Engine(world.board.make_link(baud), Timing(baud), clock.ticks_mask)

    port = Port(open_bus, clock, types=(TurboPump,))
    init, motor = USS_INIT(port), USS_CTRL(port)
    port.scan()
    init(EN=True, MODE=1, BAUD=19200, ACTIVE=0b10)
    for step in range(2_000):
        port.scan()
        motor(RUN=step > 300, DRIVE=1, TYPE=0, SPEED_SP=40.0)
        clock.advance(2_000)
    assert motor.RUN_EN and motor.STATUS == 0x8804 and not motor.INHIBIT
    assert abs(motor.SPEED - 40.0) < 0.1
    port.close()


# --- its tasks ----------------------------------------------------------------------------------


def test_it_has_no_task_for_the_eeprom():
    class Saves(TurboPump):
        save = (8, 1)

    world = bench(Saves)
    assert "no task of turbo pump" in refusal(ValueError, world.drive.write, 18, 7, 0, True)
    assert world.drive.write(18, 7) == 7 and world.motor().eeprom_writes == 0
    world.end()


# --- parameters alone ---------------------------------------------------------------------------


def test_parameters_are_read_and_written_without_control():
    world = without_control()
    drive = world.bus.drives[0]
    since_us = world.clock.now_us
    assert drive.read(18) == 0 and drive.write(18, 9) == 9 and drive.read(18) == 9
    stws = {
        characters[11] << 8 | characters[12]
        for at_us, from_panel, characters in world.wire.log.last(1000)
        if from_panel and at_us > since_us
    }
    assert stws == {0x0000}
    for action in (lambda: drive.run(percent=10), drive.jog_right):
        assert refusal(NotStarted, action) in (
            "drive 1 was added without control", "a turbo pump has no jog",
        )  # fmt: skip
    assert refusal(UssError, drive.acknowledge) == "drive 1 was added without control"
    sent = world.clock.now_us
    world.end()
    assert all(
        characters[11] == characters[12] == 0
        for at_us, from_panel, characters in world.wire.log.last(50)
        if from_panel and at_us > sent
    )


def test_a_drive_of_the_specification_may_be_without_control_as_well():
    world = Bench()
    world.bus.remove(world.drive)
    world.bus.wait(0.3)
    since_us = world.clock.now_us
    drive = world.bus.add(1, MM420, control=False)
    assert drive.read(1120) == 1.0
    assert set(world.stws(1, since_us)) == {0x0000}
    assert refusal(NotStarted, drive.run, 10.0) == "drive 1 was added without control"
    world.end()


def test_a_motor_that_runs_by_its_terminals_is_left_alone_and_goes_on():
    world = without_control()
    drive = world.bus.drives[0]
    drive.read(18)
    other = world.bus.add(2)  # under control, and not there: it changes nothing
    let_run(world)
    world.bus.wait(0.5)
    heard = world.motor().slave.counters()[0]
    world.bus.wait(2)
    assert world.motor().state == "running" and world.motor().slave.counters()[0] == heard
    text = "drive 1 runs, and this bus has no control of it: it is left alone"
    assert refusal(NoContact, drive.read, 18) == text
    assert drive.state == "no contact, may run" and world.bus.drives == [other]
    world.end()
    assert world.motor().state == "running"


def test_so_it_is_where_the_bus_has_control_of_nobody():
    world = Stage((1,), kinds=PUMP, parameters=RAMPS)
    bus = Master(world.board.make_link(19200))
    drive = bus.add(1, TurboPump, control=False)
    assert drive.read(18) == 0 and not drive.left_alone
    for words in ORDER:
        world.drives[1].process.accept(words)
    bus.wait(0.1)
    assert drive.left_alone and bus.drives == [] and world.drives[1].state == "running"
    bus.close()


def test_a_task_that_waits_when_the_motor_starts_to_run_ends_with_the_reason():
    world = without_control()
    drive = world.bus.drives[0]
    drive.read(18)
    let_run(world)
    job = pkw.read(18)
    text = "drive 1 runs, and this bus has no control of it: it is left alone"
    assert refusal(NoContact, drive.do, job) == text
    world.end()


def test_an_explicit_stop_takes_control_and_is_sent():
    world = without_control()
    drive = world.bus.drives[0]
    drive.read(18)
    drive.stop()
    world.bus.wait(0.3)
    assert world.motor().stw == 0x047E
    assert "without control" in refusal(NotStarted, drive.run, None, 10)
    world.end()


def test_a_family_may_say_that_it_takes_nothing_without_control():
    world = Bench((), parameters=RAMPS)
    text = refusal(ValueError, lambda: world.bus.add(1, G120, control=False))
    assert text == "a SINAMICS G120 takes no telegrams without control"
    world.end()
