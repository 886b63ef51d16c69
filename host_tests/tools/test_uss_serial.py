# SPDX-License-Identifier: MIT
"""The library on a serial port of a PC: the link, and the small program that holds the port."""

import os
import socket
import struct
import subprocess
import sys
import threading
import time
import tomllib
import types

import pytest
import uss_serial
import uss_serial.frames as frames
from uss_serial import Master, PortError, SerialLink
from uss_serial.any_port import AnyPort
from uss_serial.frames import framed, read_frame
from uss_serial.keeper import PATIENCE_S, Keeper
from uss_serial.port.dead_man import DeadMan, off1, turns
from uss_serial.port.errors import LineCut

from program_bench import Drives, programs
from tiers import TOP
from tools.uss_command.line import Line
from uss.families import MM420
from uss_command_bench import hubs, telegram

INTERPRETERS = "host"

FAST = ("--baud", "115200")

program = pytest.fixture(programs)
hub = pytest.fixture(hubs)


# ---- whom it stops --------------------------------------------------------------------------

ON = {  # PZD words: a telegram that turns drive 3
    2: telegram("02 06 03 04 7F 20 00"),
    4: telegram("02 12 03 00 00 00 00 00 00 00 00 04 7F 0C CD 00 00 01 01"),
    1: telegram("02 0C 03 12 BC 00 00 00 00 00 00 05 7E"),
}


@pytest.mark.parametrize("pzd_words", ON)
def test_a_motor_is_stopped_whatever_layout_its_telegrams_have(pzd_words):
    on = ON[pzd_words]
    assert turns(on, pzd_words) and not turns(on, 0)
    stop = off1(on, pzd_words)
    at = len(on) - 1 - 2 * pzd_words
    assert len(stop) == len(on) and stop[at : at + 2] == b"\x04\x7e"
    assert stop[at + 2 : -1] == on[at + 2 : -1] and not any(stop[3:at])
    assert telegram(stop[:-1].hex()) == stop, "its BCC is right"
    dead_man = DeadMan(115200, PATIENCE_S)
    dead_man.heard(on, 10.0, pzd_words)
    assert dead_man.due(10.3) is None and dead_man.due(10.4) == stop
    assert not dead_man.heard(on, 11.0, pzd_words), "no ON before it has sent OFF itself"
    assert dead_man.heard(stop, 11.1, pzd_words) and dead_man.heard(on, 11.2, pzd_words)


def test_one_that_only_waits_is_alive():
    """A bus with a long cycle time sends nothing for a while, but it polls."""
    dead_man = DeadMan(115200, PATIENCE_S)
    dead_man.heard(ON[2], 0.0, 2)
    for tenth in range(1, 30):
        dead_man.alive(tenth / 10)
        assert dead_man.due(tenth / 10 + 0.05) is None
    assert dead_man.due(2.9 + 0.5) is not None
    dead_man.alive(3.45)
    assert not dead_man.is_done(), "what is owed is still sent"


# ---- the program that holds the port --------------------------------------------------------


class FakePort:
    """A port whose characters may be wrong."""

    is_there = True

    def __init__(self):
        self.written = []
        self.coming = []

    def open(self):
        if not self.is_there:
            raise PortError("there is no port")

    def close(self):
        pass

    def wait(self, seconds):
        if not self.coming:
            time.sleep(0.005)
        return bool(self.coming)

    def read(self):
        came = self.coming.pop(0)
        if came is None:
            raise LineCut("pulled")
        return came

    def write(self, data):
        self.written.append(data)

    def unsent(self):
        return 0


class Kept:
    """A keeper in a thread, with pipes to it. `told` is the next frame."""

    def __init__(self, port):
        read, self._write = os.pipe()
        self._read, write = os.pipe()
        self._answers = os.fdopen(self._read, "rb")
        keeper = Keeper(os.fdopen(read, "rb"), os.fdopen(write, "wb"), lambda *_: port)
        self.thread = threading.Thread(target=keeper.run, daemon=True)
        self.thread.start()
        self.say(frames.OPEN, b'{"port": "fake", "baud": 19200}')

    def say(self, letter, content):
        os.write(self._write, framed(letter, content))

    def send(self, characters, pzd_words):
        now_us = time.monotonic_ns() // 1000
        self.say(frames.TELEGRAM, struct.pack(">QB", now_us, pzd_words) + characters)

    def told(self):
        return read_frame(self._answers)

    def end(self):
        os.close(self._write)
        self.thread.join(10)
        assert not self.thread.is_alive()


def test_characters_with_a_wrong_parity_are_dropped_and_counted():
    port = FakePort()
    kept = Kept(port)
    assert kept.told() == (frames.OPENED, b"")
    port.coming.append((b"\x02\x06\x00", bytes((0, 1, 2))))
    assert kept.told() == (frames.WRONG, bytes((1, 1)))
    letter, content = kept.told()
    assert letter == frames.DATA and content[8:] == b"\x02"
    kept.end()


def test_the_end_of_the_program_stops_what_it_has_left_running():
    port = FakePort()
    kept = Kept(port)
    kept.told()
    kept.send(ON[2], 2)
    kept.end()
    assert port.written == [ON[2]] + 3 * [off1(ON[2], 2)]


def test_an_old_telegram_is_not_sent():
    port = FakePort()
    kept = Kept(port)
    kept.told()
    old_us = time.monotonic_ns() // 1000 - 2_000_000
    kept.say(frames.TELEGRAM, struct.pack(">QB", old_us, 2) + telegram("02 06 03 04 7E 00 00"))
    kept.end()
    assert port.written == []


def test_a_port_that_goes_and_comes_back_is_told():
    port = FakePort()
    kept = Kept(port)
    kept.told()
    port.coming.append(None)
    assert kept.told() == (frames.CUT, b"pulled")
    assert kept.told() == (frames.BACK, b"")
    kept.end()


# ---- the link -------------------------------------------------------------------------------


def test_two_lines_are_enough(program):
    drives = program(Drives, *FAST)
    with Master(SerialLink(drives.path, 115200), baud=115200) as bus:
        drive = bus.add(1, MM420)
        assert drive.read(700) == 5 and drive.read(1082) == 50.0


def test_a_cable_is_pulled_and_plugged_again(program, hub):
    drives = program(Drives, *FAST)
    line = hub(drives.path)
    link = SerialLink(line.path, 115200)
    with Master(link, baud=115200) as bus:
        drive = bus.add(1, MM420)
        assert drive.read(700) == 5
        line.pull()
        assert bus.wait(10, lambda: link.is_cut and not drive.contact)
        assert drive.state == "no contact"
        line.plug()
        assert bus.wait(10, lambda: drive.contact) and not link.is_cut
        gone, back = link.notices
        assert "has gone" in gone and "is back" in back


def test_a_port_that_cannot_be_had_says_why():
    for path, why in (("/dev/nothing", "there is no port"), ("/dev/null", "is no serial port")):
        with pytest.raises(PortError, match=why):
            SerialLink(path, 19200)


def test_an_example_runs_on_a_port(program):
    drives = program(Drives, "--set", "P2014=2000")
    code = os.path.join(TOP, "tools", "pc", "example.py")
    command = [sys.executable, "-B", code, "parameters", "--port"]
    shown = subprocess.run([*command, drives.path], capture_output=True, text=True, timeout=60)
    assert shown.returncode == 0 and "50.0" in shown.stdout, shown.stdout + shown.stderr
    for words, status, why in (
        (("parameters", "--port", "/dev/nothing"), 5, "there is no port"),
        (("nonsense", "--port", drives.path), 2, "there is no program"),
        (("own_program", "--port", drives.path), 1, "a PC has no"),
    ):
        shown = subprocess.run([sys.executable, "-B", code, *words], capture_output=True,
                               text=True, timeout=60)  # fmt: skip
        assert shown.returncode == status and why in shown.stderr, shown.stderr
        assert shown.stderr.count("\n") == 1


# ---- the package ----------------------------------------------------------------------------


def test_the_package_takes_in_all_of_the_protocol():
    with open(os.path.join(TOP, "tools", "pc", "pyproject.toml"), "rb") as file:
        told = tomllib.load(file)
    packages = told["tool"]["setuptools"]["packages"]
    for path, _, names in os.walk(os.path.join(TOP, "firmware", "uss")):
        inside = os.path.relpath(path, os.path.join(TOP, "firmware")).replace(os.sep, ".")
        if any(name.endswith(".py") for name in names):
            assert inside in packages, inside
    for folder in told["tool"]["setuptools"]["package-dir"].values():
        assert os.path.isdir(os.path.join(TOP, "tools", "pc", folder)), folder


def test_every_name_that_stays_is_there_and_told():
    with open(os.path.join(TOP, "tools", "pc", "README.md"), encoding="utf-8") as file:
        manual = file.read()
    for name in uss_serial.__all__:
        assert callable(getattr(uss_serial, name)) and "| `%s(" % name in manual.replace(
            "`PortError`", "`PortError("
        ), name


def test_silence_comes_with_a_hint_and_a_wrong_parity_with_another():
    for wrong, said in ((0, "even parity (8E1)?"), (3, "3 characters came with a wrong parity")):
        link = types.SimpleNamespace(parity_errors=wrong, frame_errors=0)
        line = types.SimpleNamespace(link=link, baud=9600)
        assert said in str(Line.no_reply(line, 1)) and "drive 1 does not answer" in str(
            Line.no_reply(line, 1)
        )


def test_a_port_behind_a_network_goes_through_pyserial():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = AnyPort("socket://127.0.0.1:%d" % server.getsockname()[1], 19200)
        port.open()
        peer, _ = server.accept()
        port.write(b"\x02\x06")
        assert peer.recv(16) == b"\x02\x06" and not port.wait(0.01)
        peer.sendall(b"\x02\x06\x00")
        assert port.wait(5)
        data = port.read()[0]
        while len(data) < 3:
            assert port.wait(5)
            data += port.read()[0]
        assert data == b"\x02\x06\x00"
        peer.close()
        with pytest.raises(LineCut):
            for _ in range(100):
                port.wait(0.05)
                port.read()
        port.close()
    with pytest.raises(PortError, match="socket://"):
        AnyPort(port.path, 19200).open()
