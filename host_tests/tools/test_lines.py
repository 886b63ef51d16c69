# SPDX-License-Identifier: MIT
"""./tools/panel --lines as a program: whoever talks to it, and however, the panel goes on."""

import fcntl
import json
import os
import select
import subprocess
import termios
import time
from array import array

import pytest

from program_bench import PANEL, PATIENCE_S, as_in_a_terminal

INTERPRETERS = "host"


class Lines:
    """The program, and one front end that says every message by itself."""

    def __init__(self, *options):
        self.process = subprocess.Popen(
            [PANEL, "--lines", *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            preexec_fn=as_in_a_terminal,
        )
        self._said = b""

    def say(self, kind, **fields):
        self.send(json.dumps({"t": kind, **fields}).encode() + b"\n")

    def send(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def waits(self, kind, fits=lambda message: True):
        """The next message of this kind that fits."""
        for message in self._messages(kind):
            if message["t"] == kind and fits(message):
                return message

    def waits_for_all(self, *kinds):
        """By kind, the next message of each, in whatever order they come."""
        found = {}
        for message in self._messages(kinds):
            found.setdefault(message["t"], message)
            if found.keys() >= set(kinds):
                return found

    def _messages(self, wanted):
        """Those that come; meanwhile the front end is alive."""
        deadline = time.monotonic() + PATIENCE_S
        while True:
            while b"\n" in self._said:
                line, self._said = self._said.split(b"\n", 1)
                yield json.loads(line)
            assert time.monotonic() < deadline, (wanted, self._said[-500:])
            self.say("alive")
            if select.select([self.process.stdout], [], [], 0.1)[0]:
                said = os.read(self.process.stdout.fileno(), 65_536)
                assert said, self.process.stderr.read()
                self._said += said

    def lets_the_pipe_fill(self):
        """Reads nothing until no more goes in."""
        deadline = time.monotonic() + PATIENCE_S
        before, waiting = -1, array("i", [0])
        while waiting[0] != before:
            assert time.monotonic() < deadline, waiting
            before = waiting[0]
            for _ in range(10):
                self.say("alive")
                time.sleep(0.1)
            fcntl.ioctl(self.process.stdout, termios.FIONREAD, waiting)

    def shows(self, text):
        return self.waits("state", lambda message: text in " ".join(message["lcd"]["text"]))

    def ends(self):
        self.process.stdin.close()
        self.process.stdout.close()
        return self.process.wait(PATIENCE_S)


@pytest.fixture
def lines():
    made = []

    def make(*options):
        made.append(Lines(*options))
        return made[-1]

    yield make
    for one in made:
        if one.process.poll() is None:
            one.process.kill()
            one.process.wait()


def test_a_panel_is_run_by_messages_and_ends_with_them(lines):
    panel = lines("--drives", "1,2", "--speed", "5")
    panel.say("hello", v=1)
    assert panel.waits("hello")["drives"] == [1, 2]
    panel.shows("READY")
    panel.say("down", key="START")
    panel.say("up", key="START")
    panel.shows("RUNNING")
    panel.waits("drives", lambda message: message["drives"][0]["hz"] > 5)
    panel.say("do", n=8, line="drive 1")
    assert "state=running" in panel.waits("done")["out"][0]
    assert panel.ends() == 0


def test_a_reader_that_does_not_read_does_not_hold_the_panel_up(lines):
    panel = lines("--speed", "20", "--drives", "1,2,3")
    panel.say("hello", v=1)
    before = panel.waits("time", lambda message: message["us"] > 500_000)
    panel.lets_the_pipe_fill()
    panel.say("do", n=3, line="lcd")
    told = panel.waits_for_all("done", "hello")  # the panel may notice first that there is room
    assert told["done"]["n"] == 3
    assert told["hello"]["v"] == 1, "after a gap all is told anew"
    after = panel.waits("time")
    assert after["us"] > before["us"] + 3_000_000


def test_giant_and_senseless_messages_are_answered_and_the_panel_goes_on(lines):
    panel = lines()
    panel.say("hello", v=1)
    for data, why in (
        (b'{"t":"do","n":1,"line":"' + b"x" * 20_000 + b'"}\n', "2000 characters"),
        (b"\xff\xfe\x00\n", "JSON"),
        (b"\n", "JSON"),
        (b'{"t":"down"}\n', "down wants key"),
    ):
        panel.send(data)
        assert why in panel.waits("error")["text"]
    panel.shows("READY")


def test_with_a_script_it_is_refused():
    run = subprocess.run(
        [PANEL, "--lines", "--script", "-"], input=b"", capture_output=True, check=False
    )
    assert run.returncode == 2 and b"both want standard input" in run.stderr
