# SPDX-License-Identifier: MIT
"""The script language: what each command does, and what is said to a line that is none."""

import main
from boards.sim.script import COMMANDS, ORDER, ExpectationFailed, Script, ScriptError
from boards.sim.world import World


class Session:
    """A script on a fresh panel, and what it printed."""

    def __init__(self, **options):
        self.world = World(main.start, **options)
        self.printed = []
        self.script = Script(self.world, "test.txt", self.printed.append)

    def do(self, *lines):
        """Answers what these lines printed."""
        del self.printed[:]
        self.script.run(lines)
        return list(self.printed)

    def refused(self, line):
        """Answers the message of the error that `line` must be."""
        before_us = self.world.clock.now_us
        try:
            self.do(line)
        except ScriptError as error:
            assert self.world.clock.now_us == before_us, "half of it was done"
            return str(error)
        raise AssertionError("%r was understood" % line)


def test_the_script_of_the_readme():
    session = Session()
    session.do("wait 1000", "press START", "wait 5000")
    assert session.do("lcd") == ["|S: 10.0 F: 10.00|", "|RUNNING      A1 |"]
    running = session.do("drive 1")[0]
    for field in ("address=1", "state=running", "hz=10.00", "stw=047F", "zsw=FB34"):
        assert field in running.split(), running
    session.do("press STOP", "wait 8000")
    assert "state=ready" in session.do("drive 1")[0]
    session.world.check()


def test_blank_lines_and_comments_are_nothing():
    session = Session()
    assert session.do("", "   ", "# wait 1000", "\t# nothing", "wait 10 # a comment\n") == []
    assert session.world.clock.now_us < 200_000


def test_keys_are_tapped_held_and_let_go():
    session = Session()
    session.do("wait 1000", "press UP", "wait 60")
    assert session.do("lcd")[0].startswith("|S: 10.1")
    session.do("hold UP 850", "wait 60")
    assert session.do("lcd")[0].startswith("|S: 10.6")
    session.do("down UP", "wait 100", "up UP", "wait 60")
    assert session.do("lcd")[0].startswith("|S: 10.7")


def test_a_press_holds_the_key_for_100_ms_and_lets_it_go():
    session = Session()
    session.do("wait 1000")
    before_us = session.world.clock.now_us
    session.do("press UP")
    assert 140_000 <= session.world.clock.now_us - before_us < 146_000
    session.do("press UP", "press UP", "wait 60")  # one right after the other
    assert session.do("lcd")[0].startswith("|S: 10.3")


def test_bus_shows_the_last_telegrams():
    session = Session()
    session.do("wait 1000")
    shown = session.do("bus 4")
    assert len(shown) == 4
    instants = []
    for line in shown:
        instant, direction, *pairs = line.split()
        instants.append(int(instant))
        assert direction in "<>"
        assert [len(pair) for pair in pairs] in ([2] * 16, [2] * len(pairs))
        assert pairs[:3] == ["02", "0E", "01"]
    assert instants == sorted(instants)
    assert session.do("bus 0") == []


def test_param_looks_into_the_drive_and_changes_it():
    session = Session()
    assert session.do("param 1 P0700[0]") == ["P0700[0]=5"]
    assert session.do("param 1 P0700") == ["P0700[0]=5"]
    assert session.do("param 1 P0700[0] 2") == ["P0700[0]=2"]
    assert session.do("param 1 P1082 45.5") == ["P1082[0]=45.5"]
    assert session.do("param 1 r0052")[0].startswith("P0052[0]=")


def test_the_drive_can_trip_and_be_unplugged():
    session = Session()
    session.do("wait 1000", "fault 1 F0001", "wait 300", "expect FAULT")
    assert "fault=F0001" in session.do("drive 1")[0]
    session = Session(addresses=(1, 2))
    session.do("param 1 P2014[0] 0", "wait 1000", "unplug 1", "wait 1500", "expect NO CONTACT")
    session.do("plug 1", "wait 2000", "expect READY")


def test_hang_and_reset():
    session = Session()
    session.do("wait 1000", "press START", "wait 3000", "hang 1000", "wait 12000")
    session.do("expect PANEL HUNG", "reset", "wait 1500", "expect READY")
    assert session.world.resets == 1


def test_a_lasting_fault_and_a_warning():
    session = Session()
    session.do("wait 1000", "fault 1 F0001 lasting", "wait 1500", "press STOP", "wait 500")
    session.do("expect FAULT F0001", "wait 1500", "clear 1", "press STOP", "wait 800")
    session.do("expect READY")
    session.do("warn 1 A0501")
    assert session.world.drives[1].read(2110, 0) == 501
    session.do("warn 1 A0501 off", "load 1 80 constant", "supply 1 300", "supply 1 400")
    assert session.world.drives[1].read(2110, 0) == 0


def test_the_line_gets_its_faults():
    session = Session()
    session.do("wait 1000", "line flip 0.01", "line noise 2", "wait 5000")
    kind, rest = session.do("line flip")[0].split(": ")
    rate, times = rest.split(", ")
    assert (kind, rate) == ("flip", "0.01") and int(times.split()[0]) > 20
    session.do("line calm", "wait 1000")
    good = session.world.drives[1].read(2025)
    session.do("wait 2000", "expect READY")
    assert session.world.drives[1].read(2025) == good
    session.world.check()


def test_one_fault_at_a_time():
    session = Session(addresses=(1, 2))
    session.do("wait 1000", "strike flip 3", "strike lost", "strike cut 5", "strike foreign 9")
    session.do("strike noise 4", "late 2 30", "wait 300")
    count = session.world.wire.faults.count
    struck = {kind: times for kind, times in count.items() if times}
    assert struck == {"flip": 3, "lost": 1, "cut": 1, "foreign": 1, "noise": 1, "late": 1}
    session.do("babble 800", "wait 900")
    assert count["babble"] == 1
    session.do("wait 1000", "expect READY")
    session.world.check()


def test_a_cut_wire_and_a_dip_of_the_mains():
    session = Session()
    session.do("wait 1000", "cut 1", "wait 1500", "expect NO CONTACT", "mend", "wait 1000")
    session.do("expect READY", "cut panel hears", "wait 1500", "expect NO CONTACT", "mend")
    session.do("wait 1000", "expect READY", "press START", "wait 2000", "expect RUNNING")
    session.do("dip 200 drives", "wait 1000")
    assert session.world.resets == 0 and session.world.drives[1].state != "running"
    session.do("dip 200")
    assert session.world.resets == 1
    session.do("wait 3000", "expect READY")
    session.world.check()


def test_a_twin_and_an_echo_are_switched():
    session = Session()
    session.do("wait 1000", "line twin 1", "line echo on", "wait 1000")
    assert session.world.wire.echo and session.world.wire.faults.count["twin"] > 5
    session.do("line twin off", "line echo off", "wait 2000", "expect READY")
    session.world.check()


def test_power_that_is_cut_is_back_at_once_and_the_display_begins_anew():
    session = Session()
    session.do("wait 1000", "press START", "wait 1000", "power cut")
    assert session.world.resets == 1
    assert session.do("lcd") == ["|%s|" % (16 * " ")] * 2
    session.do("wait 9000", "expect READY")
    assert "starts=1" in session.do("drive 1")[0]
    assert "use: power cut" in session.refused("power on")


def test_what_a_world_cannot_do_is_refused_before_anything_is_done():
    session = Session()
    session.world.refused = {"hang": "this one never hangs"}
    assert session.refused("hang 100") == "test.txt:1: this one never hangs"


def test_an_expectation_that_fails_shows_the_display():
    session = Session()
    session.do("wait 1000")
    session.do("expect READY", "expect F:  0.00", "expect READY A1")
    try:
        session.do("# one", "expect RUNNING")
    except ExpectationFailed as error:
        text = str(error)
        assert "test.txt:6:" in text and "RUNNING" in text
        assert "|S: 10.0 F:  0.00|" in text and "|READY        A1 |" in text
        return
    raise AssertionError("the display shows READY")


def test_what_cannot_be_understood_names_script_and_line_and_does_nothing():
    session = Session()
    for line, said in (
        ("press", "use: press KEY"),
        ("press STRAT", "no key STRAT"),
        ("press start", "no key start"),
        ("press START 100", "use: press KEY"),
        ("hold UP", "use: hold KEY MS"),
        ("hold UP 0", "1 millisecond at the least"),
        ("wait", "use: wait MS"),
        ("wait soon", "soon is no number of milliseconds"),
        ("wait 1" + 23 * "0", "more than 8640000000 milliseconds (100 days) are too many"),
        ("hang 8640000001", "more than 8640000000 milliseconds"),
        ("load 1 1" + 23 * "0", "has more than 9 digits"),
        ("expect " + 3_000_000 * "x", "a line of more than 1000 characters is no command"),
        ("wait -5", "-5 is no number of milliseconds"),
        ("drive", "use: drive A"),
        ("drive 9", "no drive at address 9: there are 1"),
        ("drive one", "no drive at address one"),
        ("param 1", "use: param A P0700[0] [VALUE]"),
        ("param 1 0700", "0700 is no parameter"),
        ("param 1 P07x0", "P07x0 is no parameter"),
        ("param 1 P0700[", "P0700[ is no parameter"),
        ("param 1 P0700[]", "P0700[] is no parameter"),
        ("param 1 P0700[0]x", "is no parameter"),
        ("param 1 P0700[0] much", "much is no number"),
        ("param 1 P9999", "9999"),
        ("param 1 P0700[7]", "7"),
        ("param 1 P0700 99", "99"),
        ("param 1 P2000 nan", "nan is no number"),
        ("fault 1 1", "1 is no fault"),
        ("fault 1 Fx", "Fx is no fault"),
        ("fault 1 F0000", "F0000 is no fault"),
        ("fault 1 F10000", "F10000 is no fault"),
        ("fault 1 F0001 long", "long is none of lasting"),
        ("warn 1 F0501", "F0501 is no warning like A0501"),
        ("warn 1 A0501 perhaps", "perhaps is neither on nor off"),
        ("load 1 much", "much is no number"),
        ("load 1 50 pump", "pump is none of constant fan linear"),
        ("line", "use: line KIND|calm [RATE]"),
        ("line flop 1", "no fault of the line is called flop: there are babble cut dip"),
        ("line flip often", "often is no rate: a number, on or off"),
        ("line flip 2", "flip has a rate from 0 to 1 of the characters"),
        ("line wire-cut -1", "wire cut has a rate from 0 on an hour"),
        ("line twin 40", "a twin has an address from 0 to 31"),
        ("strike", "use: strike KIND [N]"),
        ("strike echo", "echo is on or off"),
        ("late 9 30", "no drive at address 9: there are 1"),
        ("late 1", "use: late A MS"),
        ("babble", "use: babble MS"),
        ("cut 9", "no drive at address 9"),
        ("cut panel sideways", "sideways is none of both hears talks"),
        ("dip", "use: dip MS"),
        ("dip 200 lights", "lights is none of all drives panel"),
        ("expect", "use: expect TEXT"),
        ("bus", "use: bus N"),
        ("bus all", "all is no number"),
        ("jump", "unknown command jump"),
        ("PRESS START", "unknown command PRESS"),
    ):
        message = session.refused(line)
        assert message.startswith("test.txt:"), message
        assert said in message and len(message) < 1000, (line[:50], message)


def test_what_the_firmware_raises_is_no_mistake_of_the_script():
    for error in (ValueError("x"), KeyError("x"), AssertionError("x"), OSError(28)):
        for line in ("wait 10", "press UP", "hold UP 50", "hang 5000", "reset"):
            session = Session()
            session.do("wait 1000")

            def fail(error=error):
                raise error

            session.world.app.step = fail
            session.world.start = lambda board: fail()
            try:
                session.do(line)
            except Exception as raised:
                assert raised is error, (line, raised)
                continue
            raise AssertionError("swallowed: " + line)


def test_a_drive_that_is_off_cannot_trip():
    session = Session()
    session.world.drives[1].power_off()
    assert "drive 1 is off (use: fault A F0001 [lasting])" in session.refused("fault 1 F0001")


def test_the_line_number_is_that_of_the_script():
    session = Session()
    try:
        session.do("wait 1", "", "# three", "jump")
    except ScriptError as error:
        assert str(error).startswith("test.txt:4: ")
        return
    raise AssertionError("understood")


def test_every_command_is_listed_once():
    assert sorted(ORDER) == sorted(COMMANDS)
    for name, (usage, _, _, _) in COMMANDS.items():
        assert usage.split()[0] == name
