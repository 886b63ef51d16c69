# SPDX-License-Identifier: MIT
"""tools/uss against drives that ./tools/drive serves, in real time; and the copper in between.

drives = program(Drives, "--address", "1")
told = uss(drives.path, "read", "P0700")    # .status, .json (the last object), .error, .all
line = hub(drives.path)                     # a line that others may talk on, and that breaks
uss(line.path, "mirror"); line.say(ON); line.pull(); line.plug()
"""

import json
import os
import re
import select
import subprocess
import sys
import termios
import threading
import tty

from program_bench import as_in_a_terminal
from tiers import CACHES, TOP
from tools.port.serial_port import Pty

COMMAND = (sys.executable, "-X", CACHES, os.path.join(TOP, "tools", "uss_command"))
PATIENCE_S = 60
ENVIRONMENT = {key: value for key, value in os.environ.items() if not key.startswith("USS_")}


class Told:
    """What a run of tools/uss has said. trips: what it has said last of all, of drives that trip
    because they hear no more; json: the last object before that."""

    def __init__(self, status, output, error):
        self.status = status
        self.output = output
        lines = error.splitlines()
        assert not any(line.startswith("Traceback") for line in lines), error
        self.error = error.removeprefix("tools/uss: ").strip()
        self.all = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
        self.trips = [one for one in self.all if "trips" in one]
        others = [one for one in self.all if one not in self.trips]
        self.json = others[-1] if others else None

    @property
    def rows(self):
        return self.json["rows"]


def start(path, *words, baud=115200, **more):
    options = ["--json", "--reply-timeout", "120", "--baud", str(baud)] + (
        ["--port", path] if path else []
    )
    return subprocess.Popen(
        [*COMMAND, *options, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env=ENVIRONMENT, cwd=more.pop("cwd", "/"), preexec_fn=as_in_a_terminal, **more,
    )  # fmt: skip


def told(process):
    output, error = process.communicate(timeout=PATIENCE_S)
    return Told(process.returncode, output, error)


def uss(path, *words, baud=115200, **more):
    return told(start(path, *words, baud=baud, **more))


def telegram(text):
    """The characters of a telegram, given without its BCC."""
    characters = bytes.fromhex(text)
    bcc = 0
    for one in characters:
        bcc ^= one
    return characters + bytes((bcc,))


class Hub:
    """A line between the pty of drives and `path`, for tools/uss. What `say` says, all hear.

    drives: the path; or several, {rate: path}, that hear only what is sent at their rate.
    cut_after: so many characters from the drives, then the cable is pulled.
    """

    def __init__(self, drives, link):
        self.path = link
        self.cut_after = None
        self._drives = {}
        for rate, path in (drives if isinstance(drives, dict) else {None: drives}).items():
            self._drives[rate] = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            tty.setraw(self._drives[rate])
        self._ours = None
        self._lock = threading.Lock()
        self._closed = False
        self.plug()
        threading.Thread(target=self._carry, daemon=True).start()

    def plug(self):
        with self._lock:
            self._ours = Pty(self.path)
            self._ours.open()

    def pull(self):
        with self._lock:
            self._ours.close()
            self._ours = None

    def say(self, characters):
        self._to_drives(characters, None)
        with self._lock:
            self._hand_over(characters)

    def close(self):
        self._closed = True
        if self._ours:
            self.pull()

    def _hand_over(self, characters):
        if self._ours:
            self._ours.write(characters)

    def _carry(self):
        while not self._closed:
            ours = self._ours
            awaited = [*self._drives.values()] + ([ours] if ours else [])
            try:
                ready = select.select(awaited, (), (), 0.02)[0]
                for number in self._drives.values():
                    if number in ready:
                        self._from_drives(os.read(number, 4096))
                if ours in ready:
                    self._to_drives(ours.read()[0], termios.tcgetattr(ours.fileno())[4])
            except (OSError, ValueError, TypeError):
                continue

    def _to_drives(self, data, speed):
        """speed: as termios has it; None: of all."""
        for rate, number in self._drives.items():
            if rate is None or speed in (None, getattr(termios, "B%s" % rate)):
                os.write(number, data)

    def _from_drives(self, data):
        with self._lock:
            self._hand_over(data)
        if self.cut_after is not None:
            self.cut_after -= len(data)
            if self.cut_after <= 0:
                self.cut_after = None
                self.pull()


def hubs(tmp_path):
    """A fixture: makes hubs, and closes them."""
    made = []

    def make(drives):
        made.append(Hub(drives, str(tmp_path / ("line%d" % len(made)))))
        return made[-1]

    yield make
    for one in made:
        one.close()


SENT = re.compile(r"\s*([\d.]+) > A(\d+) .*STW ([0-9A-F]{4})")


def silence_s(lines, address=1):
    """In a log of ./tools/drive: from the last ON to the first OFF1 behind it, in seconds."""
    last = None
    for line in lines:
        found = SENT.match(line)
        if found and int(found[2]) == address:
            stw = int(found[3], 16)
            if stw & 0x0301:
                last = float(found[1])
            elif last is not None and stw & 0x0400:
                return float(found[1]) - last
    raise AssertionError("no OFF1 behind an ON")
