# SPDX-License-Identifier: MIT
"""A motor that ./tools/uss turns, or a program with uss_serial, stops however that ends."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest

from program_bench import Drives, programs
from tiers import TOP
from uss_command_bench import hubs, silence_s, start, told, uss

INTERPRETERS = "host"

FAST = ("--baud", "115200")
PROMISED_S = 0.5
TRIES = 4  # another program may have the processor for as long as that
TURN = ("run", "10", "--unsupervised")

program = pytest.fixture(programs)
hub = pytest.fixture(hubs)


def turning(path, *words):
    """tools/uss, when it says that the motor runs. A machine that stalls may refuse the start."""
    for _ in range(TRIES):
        process = start(path, *(words or TURN))
        line = process.stdout.readline()
        if '"running"' in line:
            return process
        refused = told(process)
        assert refused.status == 1, refused.error
    raise AssertionError(line + refused.error)


def log_until_it_stands(drives):
    """What the drives have said until the motor is at rest."""
    lines = []
    deadline = time.monotonic() + 30
    while True:
        drives.does("drive 1")
        while True:
            line = drives.line()
            lines.append(line)
            if line.startswith("address=1"):
                break
        if "state=ready" in line or "state=fault" in line:
            return lines
        assert time.monotonic() < deadline, line
        time.sleep(0.05)


def stops_within(program, end):
    """However `end(process)` ends it: nothing but the small program stops this motor."""
    known = []
    for _ in range(TRIES):
        drives = program(Drives, *FAST, "--log", "--set", "P1121=0.5")
        process = turning(drives.path)
        end(process)
        known.append(silence_s(log_until_it_stands(drives)))
        process.send_signal(signal.SIGCONT)
        process.kill()
        told(process)
        drives.kill()
        if known[-1] <= PROMISED_S:
            return
    raise AssertionError(known)


def test_one_that_is_killed(program):
    stops_within(program, lambda process: process.send_signal(signal.SIGKILL))


def test_one_that_hangs(program):
    stops_within(program, lambda process: process.send_signal(signal.SIGSTOP))


def test_one_whose_time_is_over_or_that_is_asked_to_end(program):
    drives = program(Drives, *FAST, "--set", "P1121=0.5")
    ended = uss(drives.path, *TURN, "--for", "0.5")
    assert ended.status == 0 and ended.json["stopped"], ended.error
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        process = turning(drives.path)
        process.send_signal(number)
        ended = told(process)
        assert ended.status == 130 and ended.json["stopped"]
        assert drives.report()["state"] == "ready"


def test_one_that_has_lost_its_port_stops_by_p2014(program, hub):
    drives = program(Drives, *FAST, "--set", "P2014=600")
    line = hub(drives.path)
    process = turning(line.path, "run", "10")
    line.pull()
    drives.waits(state="fault", fault="F0072")
    line.plug()
    ended = told(process)
    assert ended.status == 1 and "is stopped by its P2014 alone" in ended.error
    assert drives.report()["starts"] == "1"
    fault = uss(line.path, "run", "10")
    assert fault.status == 1 and "F0072 - USS lost on COM" in fault.error
    assert uss(line.path, "ack").json["acknowledged"] == 72
    assert uss(line.path, "stop").json["stopped"]


def test_it_starts_only_what_may_be_started(program):
    drives = program(Drives, *FAST)
    refused = uss(drives.path, "run", "10")
    assert refused.status == 1 and "--supervise 2" in refused.error
    assert "beyond the limit" in uss(drives.path, *TURN[:1], "99", "--unsupervised").error
    assert drives.report()["starts"] == "0"
    assert uss(drives.path, "run", "10", "--supervise", "2", "--for", "0.2").status == 0
    assert drives.asked("param 1 P2014[0]") == "P2014[0]=2000"


def test_jog_turns_and_stop_stops(program):
    drives = program(Drives, *FAST, "--set", "P1061=0.2", "--set", "P2014=60000")
    process = turning(drives.path, "jog", "left")
    assert drives.report()["stw"] == "067E"
    process.send_signal(signal.SIGINT)
    assert told(process).json["stopped"]
    assert uss(drives.path, "stop", "--off", "3").json["stopped"]


PROGRAM = """
    import sys, time
    sys.path.insert(0, "tools/pc")
    from uss_serial import Master, PortError, SerialLink

    link = SerialLink(sys.argv[1], 115200)
    with Master(link, baud=115200) as bus:
        drive = bus.add(1, unsupervised=True)
        drive.run(percent=20)
        print("runs", flush=True)
        time.sleep(2)
        bus.wait(0.3)
        print(link.stopped, drive.is_on(), drive.engine.stopped_by_engine(), flush=True)
        bus.wait(10, lambda: not drive.is_running)
        drive.stop()
        drive.run(percent=20)
        print(drive.is_running, flush=True)
"""


def test_a_program_of_ones_own_that_blocks_commands_nothing_until_a_fresh_run(program):
    drives = program(Drives, *FAST, "--log", "--set", "P1121=0.5")
    own = subprocess.run(
        [sys.executable, "-B", "-c", textwrap.dedent(PROGRAM), drives.path], cwd=TOP,
        capture_output=True, text=True, timeout=60, env={**os.environ, "PYTHONPATH": ""},
    )  # fmt: skip
    assert own.returncode == 0, own.stderr
    assert own.stdout.splitlines() == ["runs", "(1,) False True", "True"]
    assert "state=ready" in log_until_it_stands(drives)[-1], "leaving `with` has stopped it"
