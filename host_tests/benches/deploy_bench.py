# SPDX-License-Identifier: MIT
"""A chip for the tests of tools/deploy: its file system is FLASH, and power can be cut.

Runs under CPython, in pytest. The functions of tools/deploying/on_chip.py see FLASH instead of the
files of this machine; what they change goes through `_step`, where power may fail. `running` tells
what MicroPython would start from it.
"""

import builtins
import io
import os

from tiers import TOP
from tools.deploying.deployment import Deployment, Options
from tools.deploying.errors import DeployError
from tools.deploying.image import Firmware
from tools.deploying.plan import GATE_TEXT

RP2040 = "Raspberry Pi Pico with RP2040"
MPY = 0x1306  # sys.implementation._mpy of MicroPython 1.25 on an RP2040
MODULES = "__main__ gc os hashlib machine Plus any modules on the filesystem"
FROZEN = MODULES + " main app board uss/master"

# Two generations of a small firmware: app changed, one file and one package gone, one new.
OLD = {
    "main.py": b"import app  # 1",
    "board.py": b"pins = 1",
    "app.py": b"import uss.master, panel.view, hal.lcd  # 1",
    "uss/__init__.py": b"",
    "uss/master.py": b"speed = 1",
    "uss/old.py": b"old = 1",
    "panel/view.py": b"view = 1",
    "hal/lcd.py": b"lcd = 1",
}
NEWER = {
    "main.py": b"import app  # 1",
    "board.py": b"pins = 2",
    "app.py": b"import uss.master, panel.view, panel.pages.home  # 2",
    "uss/__init__.py": b"",
    "uss/master.py": b"speed = 2",
    "panel/view.py": b"view = 1",
    "panel/pages/home.py": b"home = 2",
}


class Flash:
    """Files and folders in memory, with as much of `os` and `open` as on_chip.py uses."""

    def __init__(self):
        self.clear()

    def clear(self):
        self.files = {}
        self.folders = {""}

    def copy(self):
        return dict(self.files), set(self.folders)

    def restore(self, copy):
        self.files, self.folders = dict(copy[0]), set(copy[1])

    def put(self, path, data=b"mine"):
        """A file, and the folders that it wants."""
        self.files[path] = data
        while path:
            path = os.path.dirname(path)
            self.folders.add(path)

    # ---- what on_chip.py sees ---------------------------------------------------------------

    def open(self, path, mode):
        assert mode == "rb"
        return io.BytesIO(self._there(path, self.files))

    def stat(self, path):
        if path in self.folders:
            return (0x4000, 0, 0, 0, 0, 0, 0, 0, 0, 0)
        return (0x8000, 0, 0, 0, 0, 0, len(self._there(path, self.files)), 0, 0, 0)

    def rename(self, old, new):
        self.files[new] = self._there(old, self.files)
        del self.files[old]

    def remove(self, path):
        self._there(path, self.files)
        del self.files[path]

    def mkdir(self, path):
        assert os.path.dirname(path) in self.folders and path not in self.folders
        self.folders.add(path)

    def rmdir(self, path):
        if path not in self.folders:
            raise OSError(2)
        if any(os.path.dirname(other) == path for other in [*self.files, *self.folders]):
            raise OSError(39)
        self.folders.remove(path)

    def write(self, path, data):
        assert os.path.dirname(path) in self.folders, path
        self.files[path] = data

    def _there(self, path, files):
        if path not in files:
            raise OSError(2)
        return files[path]


FLASH = Flash()


def imported(name, *others):
    return FLASH if name == "os" else builtins.__import__(name, *others)


ON_CHIP = compile((TOP / "tools/deploying/on_chip.py").read_text(), "on_chip.py", "exec")
BUILTINS = vars(builtins) | {"__import__": imported, "open": FLASH.open}


class PowerCut(BaseException):
    """Nothing can catch it by accident."""


class FakeChip:
    """cut_at: the step after which power fails; None: never. Steps are counted in `steps`."""

    port = "/dev/ttyFAKE"

    def __init__(self, identity=None, modules=MODULES, cut_at=None, error=PowerCut, free=300):
        self.identity = identity or ("micropython", (1, 25, 0), RP2040, MPY)
        self.modules = modules
        self.cut_at = cut_at
        self.error = error
        self.free = free
        self.steps = 0
        self.dead = False
        self.restarts = 0
        self.log = []  # what changed, in the order in which it did
        self.heard = "\r\n>>> "
        self.spoilt = None  # a file that arrives with another content
        self._functions = {}

    def interrupt(self):
        self._alive()
        return self.heard

    def enter(self):
        self._alive()

    def load(self):
        self._functions["__builtins__"] = BUILTINS
        exec(ON_CHIP, self._functions)
        self._functions["stop_watchdog"] = lambda: False
        self._functions["free_blocks"] = lambda: (4096, self.free)

    def restart(self):
        self._alive()
        self.restarts += 1

    def evaluate(self, expression):
        self._alive()
        assert "implementation" in expression
        return self.identity

    def execute(self, code):
        self._alive()
        assert code == "help('modules')"
        return self.modules

    def call(self, function, *arguments):
        self._alive()
        changes = function in ("replace", "remove", "make_folder", "remove_empty")
        if changes:
            self._step()
        answer = self._functions[function](*arguments)
        if changes:
            self.log.append((function, *arguments))
            self._step()
        return answer

    def write(self, path, data):
        self._alive()
        self._step()
        FLASH.write(path, data[: len(data) // 2])
        self._step()
        FLASH.write(path, b"?" if path == self.spoilt else data)
        self._step()

    def _alive(self):
        if self.dead:
            raise DeployError("it has gone")

    def _step(self):
        self.steps += 1
        if self.steps == self.cut_at:
            self.dead = self.error is PowerCut
            raise self.error("here")


def firmware(sources, compiled=True):
    made = Firmware(sources)
    if compiled:
        made.compile(lambda path, source: b"M\x06\x00\x1f" + source)
    return made


def deploy(chip, made, said=None, **options):
    """What was said, which `said` collects as well."""
    said = [] if said is None else said
    Deployment(chip, made, Options(**options), said.append).run()
    return "\n".join(said)


def running(versions, frozen=None):
    """Which of {name: {path: bytes}} the chip starts: its name, None for nothing, "MIXED".

    A path without its ending is a module. `frozen`: what is frozen in, by path.
    """
    main = (frozen or FLASH.files).get("main.py")
    app = _module("app", frozen)
    if main is None or app == GATE_TEXT:
        return None
    for name, files in versions.items():
        if all(_fits(path, data, main, frozen) for path, data in files.items()):
            return name
    return "MIXED"


def _fits(path, data, main, frozen):
    if path == "main.py":
        return main == data
    return _module(path.rpartition(".")[0], frozen) == data


def _module(name, frozen):
    """What `import` finds: a folder before a .py before an .mpy, the files before the frozen."""
    top = name.split("/")[0]
    frozen = frozen or {}
    for files, folders in (
        (FLASH.files, FLASH.folders),
        (frozen, {os.path.dirname(path) for path in frozen}),
    ):
        if top in folders or top + ".py" in files or top + ".mpy" in files:
            if name in folders:
                name += "/__init__"
            return files.get(name + ".py", files.get(name + ".mpy"))
    return None
