# SPDX-License-Identifier: MIT
"""Where settings and sets are kept: in a folder of this computer, or on a chip.

with Folder("panel1.json") as place:
    data = place.read(place.settings)           # bytes, None: there is none
    place.write(place.settings, data)           # all or nothing
    place.sets()                                # ["1.set", "2.set"]
"""

import os
import tempfile
from pathlib import Path

ENDING = ".set"
SETTINGS = "settings.json"
BAD = ".bad"  # the ending of a file that was set aside


class Folder:
    """file: path of the settings; the sets stand beside it."""

    def __init__(self, file):
        self._folder = Path(file).parent
        self.settings = Path(file).name

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def read(self, name):
        """OSError."""
        path = self._folder / name
        return path.read_bytes() if path.exists() else None

    def write(self, name, data):
        """OSError; then what was there is there still."""
        number, aside = tempfile.mkstemp(dir=self._folder, prefix=f".{name}.")
        try:
            with os.fdopen(number, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            path = self._folder / name
            os.chmod(aside, path.stat().st_mode if path.exists() else 0o644)
            os.replace(aside, path)
        except BaseException:
            os.unlink(aside)
            raise

    def sets(self):
        return sorted(path.name for path in self._folder.glob("*" + ENDING))


class OnChip:
    """The files of a chip at a serial port. What runs there ends, and starts again afterwards.

    say: takes a line of progress.
    """

    settings = SETTINGS

    def __init__(self, port, say):
        self._port = port
        self._say = say
        self._chip = None
        self._panel_ran = False

    def __enter__(self):
        """DeployError: the chip cannot be had, or is no MicroPython."""
        from tools.deploying.chip import Chip
        from tools.deploying.deployment import STOPPED

        self._say(f"{self._port}: a panel that runs there stops all its drives now.")
        self._chip = Chip(self._port)
        try:
            self._panel_ran = STOPPED in self._chip.interrupt()
            self._chip.enter()
            self._chip.load()
            self._chip.call("stop_watchdog")  # before it restarts the chip
        except BaseException:
            self._chip.close()
            raise
        return self

    def __exit__(self, *raised):
        """The chip starts again, whatever has happened."""
        from tools.deploying.arrival import wait_for_panel
        from tools.deploying.chip import Chip

        try:
            self._chip.restart()
            if self._panel_ran:
                wait_for_panel(lambda: Chip(self._port))
                self._say("The panel runs again.")
        except Exception as error:
            if raised == (None, None, None):
                raise
            self._say(f"It could not be started again: unplug it, and plug it in ({error}).")
        finally:
            self._chip.close()

    def read(self, name):
        return self._chip.read(name) if self._chip.call("look", [name]) else None

    def write(self, name, data):
        from tools.deploying.errors import DeployError
        from tools.deploying.plan import NEW, sha256

        block, free = self._chip.call("free_blocks")
        if len(data) > (free - 2) * block:
            raise DeployError(f"{name}: {free * block // 1024} KB are free on the chip")
        self._chip.write(name + NEW, data)
        if self._chip.call("look", [name + NEW])[0][2] != sha256(data):
            raise DeployError(f"{name} did not arrive as it was sent")
        self._chip.call("replace", name + NEW, name)

    def sets(self):
        return self._chip.call("names", ENDING)
