# SPDX-License-Identifier: MIT
"""./tools/panel on a real line: at the other end of a pty are drives served by ./tools/drive.

Real programs in real time. A test waits for what it expects, and gives up after a while.
"""

import json
import os
import signal
import socket
import time

import pytest

from program_bench import PANEL, PATIENCE_S, Drives, Panel, Talking, programs
from terminal_bench import Terminal, terminals
from tools.port.launch import Relay
from tools.port.serial_port import Pty

INTERPRETERS = "host"

RUN = bytes.fromhex("020E010000000000000000047F0CCDB7")
STOP = bytes.fromhex("020E010000000000000000047E000077")

SUPERVISED = ("--set", "P2014=2000")

program = pytest.fixture(programs)
terminal = pytest.fixture(terminals)


def test_a_drive_is_parameterised_started_and_stopped(program):
    drives = program(Drives, "--address", "1,2=mm440")
    panel = program(Panel, drives.path, "--drives", "1,2")
    panel.shows("READY")
    assert drives.asked("param 1 P2014[0]") == "P2014[0]=0"
    panel.does("press START")
    panel.shows("SET=FIX START=GO")
    panel.does("wait 1200", "press SET")  # a question has to be readable before it is answered
    panel.shows("WRITTEN (RAM)")
    assert int(drives.asked("param 1 P2014[0]").split("=")[1]) > 100
    drives.asked("param 1 P2014[0] 2000")  # no longer, or START asks
    panel.shows("NOT STARTED")
    panel.runs()
    drives.waits(state="running", hz="10.00")
    panel.does("press UP")
    panel.runs()
    drives.waits(hz="10.10")
    panel.does("press STOP")
    drives.waits(state="ready", stw="047E")
    panel.shows("READY")
    panel.does("press PARAM")
    panel.shows("P0700:     5 A1")
    panel.does("press ADDRESS_UP")
    panel.shows("P0700:     5 A2")
    panel.process.stdin.close()
    assert panel.ends() == 0 and panel.rest == ""


@pytest.mark.parametrize("ending", ["end", "expect SOMETHING ELSE", "SIGINT", "SIGTERM", "SIGHUP"])
def test_whatever_ends_the_panel_the_drives_are_stopped_first(program, ending):
    drives = program(Drives, *SUPERVISED)
    panel = program(Panel, drives.path)
    panel.runs()
    if ending == "end":
        panel.process.stdin.close()
    elif ending.startswith("SIG"):
        panel.process.send_signal(getattr(signal, ending))
    else:
        panel.does(ending)
    assert panel.ends() == {"end": 0, "expect SOMETHING ELSE": 1}.get(ending, 130)
    report = drives.report()
    assert report["stw"] == "047E" and report["state"] in ("stopping", "ready"), report
    assert "Traceback" not in panel.rest and "not confirmed" not in panel.rest


def test_the_program_inside_cannot_be_ended_without_that(program):
    drives = program(Drives, *SUPERVISED)
    panel = program(Panel, drives.path)
    panel.runs()
    os.kill(child_of(panel.process.pid), signal.SIGTERM)
    os.kill(panel.process.pid, signal.SIGTERM)
    assert panel.ends() == 130
    assert drives.report()["stw"] == "047E"


def child_of(process):
    with open("/proc/%d/task/%d/children" % (process, process)) as file:
        return int(file.read().split()[0])


def test_a_panel_that_hangs_has_its_drives_stopped_from_outside(program):
    drives = program(Drives)  # without P2014
    panel = program(Panel, drives.path)
    runs_unsupervised(panel)
    firmware = child_of(panel.process.pid)
    os.kill(firmware, signal.SIGSTOP)
    drives.waits(state="ready", stw="047E")
    os.kill(firmware, signal.SIGCONT)
    panel.shows("READY", "WATCHDOG RESTART", "PANEL HUNG")
    assert drives.report()["starts"] == "1"
    panel.process.stdin.close()
    assert panel.ends() == 0
    assert panel.rest.endswith("drive 1 was sent OFF1 in its place\n")


def test_a_panel_that_was_killed_too(program):
    drives = program(Drives)
    panel = program(Panel, drives.path)
    runs_unsupervised(panel)
    os.kill(child_of(panel.process.pid), signal.SIGKILL)
    assert panel.ends() == 128 + signal.SIGKILL
    assert panel.rest == "panel: it hung or died, and drive 1 was sent OFF1 in its place\n"
    assert drives.report()["stw"] == "047E"


def runs_unsupervised(panel):
    """START, with the risk of P2014 = 0 taken."""
    panel.shows("READY")
    panel.does("press START")
    panel.shows("SET=FIX START=GO")
    panel.does("wait 1200", "press START")
    panel.shows("RUNNING")


def test_a_panel_is_not_suspended(program):
    drives = program(Drives, *SUPERVISED)
    panel = program(Panel, drives.path)
    panel.runs()
    for process in (panel.process.pid, child_of(panel.process.pid)):
        os.kill(process, signal.SIGTSTP)  # Ctrl-Z
    panel.does("press UP")
    panel.runs()
    drives.waits(state="running", hz="10.10")


def test_what_could_not_be_sent_in_its_time_is_not_sent_at_all():
    ours, data = socket.socketpair()
    control, _ = socket.socketpair()
    data.setblocking(False)
    relay = Relay(data, control)
    port = Pty()
    port.open()
    relay.open(port.path, 19200)
    for written, sent in ((2 * [RUN], b""), ([RUN], RUN), (100 * [RUN] + [STOP], b"")):
        for telegram in written:
            ours.send(telegram)
        relay.send()
        assert port.read()[0] == sent
    port.close()


def test_a_closed_standard_input_is_an_empty_script(program):
    drives = program(Drives)
    command = 'exec "$1" --port "$2" --script - <&-'
    panel = program(Talking, "bash", "-c", command, "-", PANEL, drives.path)
    assert panel.ends() == 0 and "failed" not in panel.rest


def test_drives_that_do_not_answer_are_named_at_the_end(program):
    drives = program(Drives)
    panel = program(Panel, drives.path, "--drives", "1,9")
    panel.shows("READY")
    panel.process.stdin.close()
    assert panel.ends() == 0
    assert panel.rest == "panel: OFF1 not confirmed by drive 9\n"


def test_a_port_that_goes_is_a_cut_line_and_taken_again(program, tmp_path):
    link = str(tmp_path / "line")
    drives = program(Drives, "--link", link)
    panel = program(Panel, link)
    panel.shows("READY")
    drives.process.terminate()
    assert drives.ends() == 0
    assert "has gone" in told(panel)
    panel.shows("NO CONTACT")
    drives = program(Drives, "--link", link)
    assert told(panel) == "panel: %s is back" % link
    panel.shows("READY")


def told(panel):
    """The next thing that the panel says of its own accord."""
    deadline = time.monotonic() + PATIENCE_S
    while time.monotonic() < deadline:
        panel.does("wait 20", "lcd")
        line = panel.line()
        if line.startswith("panel: "):
            panel.line(), panel.line()
            return line
        line = panel.line()
        assert line.startswith("|")
    raise AssertionError("it says nothing")


@pytest.mark.parametrize("ending", ["q", "\x03", "SIGTERM"])
def test_the_live_panel_works_and_leaves_the_same_way(program, terminal, ending):
    drives = program(Drives, *SUPERVISED)
    panel = terminal("--port", drives.path)
    panel.shows("READY        A1")
    assert drives.path in panel.screen.text()
    panel.type("s")
    panel.shows("two keys within 2 s")
    assert drives.report()["starts"] == "0"
    panel.type("g")
    panel.shows("now the letter of START")
    panel.type("s")
    panel.shows("RUNNING      A1")
    drives.waits(state="running")
    if ending == "SIGTERM":
        panel.process.terminate()
    else:
        panel.type(ending)
    assert panel.ends() == (0 if ending == "q" else 130)
    assert panel.is_as_before()
    assert drives.report()["stw"] == "047E"
    assert "every drive was sent OFF1" in panel.screen.text() or ending != "q"


def test_a_terminal_that_goes_away_leaves_no_motor_without_a_stop_key(program):
    drives = program(Drives, *SUPERVISED)
    panel = Terminal("--port", drives.path)
    panel.shows("READY        A1")
    panel.type("g")
    panel.shows("now the letter of START")
    panel.type("s")
    panel.shows("RUNNING      A1")
    os.close(panel.slave)
    os.close(panel.master)
    drives.waits(stw="047E", fault="-")  # OFF1, and before P2014 was over
    panel.process.wait(PATIENCE_S)


def test_somebody_else_may_not_use_the_port(program):
    drives = program(Drives)
    panel = program(Panel, drives.path)
    panel.shows("READY")
    other = program(Panel, drives.path)
    assert other.ends() == 5
    assert other.rest == "panel: %s is in use by another program\n" % drives.path


def test_what_is_no_port_is_said(program, tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    for path, why in (
        ("/dev/no_such", "panel: there is no port /dev/no_such\n"),
        ("/dev/no\nsuch", "panel: there is no port '/dev/no\\nsuch'\n"),
        (str(file), "panel: %s is no serial port\n" % file),
    ):
        panel = program(Panel, path)
        assert panel.ends() == 5 and panel.rest == why


@pytest.mark.parametrize(
    "options, why",
    [
        (("--speed", "3"), "--speed is not for --port"),
        (("--seed", "3"), "--seed is not for --port"),
        (("--polled",), "--polled is not for --port"),
        (("--board", "pico"), "--board is not for --port"),
        (("--reply-timeout", "5"), "--reply-timeout 5: 20...500 ms"),
    ],
)
def test_options_that_make_no_sense_on_a_real_line_are_refused(program, options, why):
    panel = program(Panel, "/dev/no_such", *options)
    assert panel.ends() == 2 and panel.rest.startswith("panel: " + why)


def test_what_the_settings_say_is_not_overruled(program, tmp_path):
    kept = tmp_path / "kept.json"
    for options in (("--drives", "1,2"), ("--baud", "9600"), ("--reply-timeout", "100")):
        kept.write_text('{"drives": [1, 3], "baud": 19200, "reply_timeout_ms": 40}')
        panel = program(Panel, "/dev/no_such", "--settings", str(kept), *options)
        assert panel.ends() == 2
        assert panel.rest.startswith("panel: %s: %s says " % (options[0], kept))


def test_new_settings_have_time_for_an_adapter(program, tmp_path):
    drives = program(Drives, "--address", "4")
    new = tmp_path / "new.json"
    panel = program(Panel, drives.path, "--settings", str(new), "--drives", "4")
    panel.shows("READY        A4")
    stored = json.loads(new.read_text())
    assert stored["drives"] == [4] and stored["reply_timeout_ms"] == 60
