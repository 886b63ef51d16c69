# SPDX-License-Identifier: MIT
"""The tiers: the interpreters that every test file runs on, and the processes that run it there.

A tier is one interpreter; runner.py is what runs inside it. `pico` is one of them with an emulated
Raspberry Pi Pico beside it, for the files that ask for it; `pico_again` is the same with a UART
whose receive time-out comes again while characters are left (tools/emulator/README.md).
`pico_hard` and `pico_hard_again` are these two with the firmware of a later MicroPython, whose
timers have hard callbacks (tools/fetch/pico.sh). A file that wants both builds and both behaviours
names two of the four, `pico pico_hard_again`: all four would take twice as long.

`survey` asks each tier for its version; a FileRun runs functions of one file on one tier and
publishes a verdict for each, also when the process crashes or hangs in the middle: then the
function at fault fails, and the ones after it run in a new process. This module knows nothing of
pytest; conftest.py uses it.
"""

import ast
import os
import re
import selectors
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from runner import MARK

TOP = Path(__file__).resolve().parent.parent
RUNNER = "host_tests/runner.py"
SURVEY_TIMEOUT_S = 20


def _environment():
    """A copy: pytest changes the environment in one thread while processes start in others, and a
    new process that is handed the living environment at that instant is not started (EFAULT).

    In it `python3` is the program that runs this. Of pyenv and its like it would be a script that
    takes 90 ms to find that, and the commands under test start it again and again.
    """
    copy = dict(os.environ)
    python = os.path.realpath(sys.executable)
    if os.path.realpath(shutil.which("python3") or python) != python:
        copy["PATH"] = os.pathsep.join((os.path.dirname(python), copy.get("PATH", os.defpath)))
    return copy


ENVIRONMENT = _environment()
OUTPUT_LIMIT = 10_000_000  # characters that one function may print
# Virtual time waits: tests that run in the time of this machine have the larger share of it.
STANDS_BACK = ("nice", "-n", "3") if shutil.which("nice") else ()
REPORT = re.compile(rf"{MARK}(\w+) ?(.*)\n")


class Tier(NamedTuple):
    name: str
    command: tuple[str, ...]
    remedy: str  # the command that lets tools/test have the tier
    everywhere: bool = True  # False: only files that name it run there
    required: bool = True  # False: it may be missing also where nothing else may
    twin: str = ""  # the tier that runs on the very same: where that one is, this one is


# Alone with the standard library, printing at once, keeping what it compiles, though not in
# firmware/, and with tracebacks as short as MicroPython's.
CACHES = f"pycache_prefix={TOP}/build/pycache"
CPYTHON_OPTIONS = ("-I", "-u", "-X", CACHES, "-X", "utf8", "-X", "no_debug_ranges")


def _micropython(name: str, heap: str = "16M") -> tuple[str, ...]:
    return (f"{TOP}/build/{name}/micropython", "-X", f"heapsize={heap}")


# It becomes the interpreter, with the chip at the end of two pipes.
BESIDE_A_CHIP = (sys.executable, "-I", "-B", f"{TOP}/tools/emulator/launch.py")
PICO = (*BESIDE_A_CHIP, *_micropython("unix64", heap="64M"))


def _pico(name: str, twin: str = "") -> Tier:
    remedy = "tools/panel --board pico (it takes 580 MB)"
    return Tier(name, PICO, remedy, everywhere=False, twin=twin)


def _pico_hard(name: str, twin: str = "") -> Tier:
    remedy = "USS_STRICT=1 tools/test, while Debian testing has its MicroPython"
    return Tier(name, PICO, remedy, everywhere=False, required=False, twin=twin)


TIERS = {
    tier.name: tier
    for tier in (
        Tier("unix64", _micropython("unix64"), "apt-get install micropython"),
        Tier("unix32", _micropython("unix32"), "apt-get install gcc-multilib make python3"),
        Tier("cpython", (sys.executable, *CPYTHON_OPTIONS), ""),
        _pico("pico"),
        _pico("pico_again", twin="pico"),
        _pico_hard("pico_hard"),
        _pico_hard("pico_hard_again", twin="pico_hard"),
    )
}


# Debian's package, where unix64 is built here: with its own modules besides, mip say.
PACKAGED = TOP / "build" / "packaged" / "micropython"

# What the test files of a folder run on that do not say it themselves, where that is not every
# tier; of tiers with OR between them, the first one that is here. What only a chip runs is tried
# with the chip's small integers, and where a PC has no such MicroPython, with the one it has. What
# only a PC runs is tried on what PCs have; that the simulation works with small integers as well
# is seen in each test of the panel.
OR = "|"
ON_CHIP, ON_PC = "unix32|unix64", "unix64|unix32"
OF_FOLDER = {
    "panel": (ON_CHIP,),
    "search": (ON_CHIP, "cpython"),
    "sim": (ON_PC, "cpython"),
    "drives": (ON_PC, "cpython"),
    "tools": (ON_PC, "cpython"),
    "house": (ON_PC, "cpython"),
}


def interpreters(tree, path):
    """The words in the INTERPRETERS of a test file; where it has none, those of its folder."""
    return said(tree) or usual(path)


def said(tree):
    """The words in its INTERPRETERS; none where it leaves that to its folder."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "INTERPRETERS":
            return ast.literal_eval(node.value).split()
    return []


def usual(path):
    """What a test file runs on that does not say it."""
    everywhere = [name for name in TIERS if TIERS[name].everywhere]
    return list(OF_FOLDER.get(path.parent.name, everywhere))


class Verdict(NamedTuple):
    passed: bool
    output: str  # what the function printed
    reason: str  # the traceback, or what became of the process
    seconds: float


class Survey(NamedTuple):
    versions: dict[str, str]  # tiers that are here -> what they run on
    missing: dict[str, str]  # the others -> why


def survey(names=TIERS) -> Survey:
    """Asks these tiers what they are, and so learns which are here and are what they promise."""
    found = Survey({}, {})
    wanted = {name: tier for name, tier in TIERS.items() if name in names}
    with ThreadPoolExecutor() as pool:
        asked = {
            name: pool.submit(_ask, TIERS[name])
            for name in {tier.twin or name for name, tier in wanted.items()}
        }
    for name, tier in wanted.items():
        is_here, line = asked[tier.twin or name].result()
        (found.versions if is_here else found.missing)[name] = line
    return found


def _ask(tier):
    """Whether it is here, and its version or why not."""
    try:
        answer = subprocess.run(
            [*tier.command, RUNNER, tier.name],
            cwd=TOP,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=SURVEY_TIMEOUT_S,
        )
    except FileNotFoundError:
        return False, f"there is no {tier.command[0]}"
    except (OSError, subprocess.TimeoutExpired) as error:
        return False, str(error)
    return answer.returncode == 0, _one_line(answer.stdout) or _one_line(answer.stderr)


def _one_line(output):
    """The last line of what a program said: where it failed, that is the reason."""
    return output.strip().rpartition("\n")[2]


class FileRun:
    """The run of functions of one file on one tier: in one process or, after a crash, in more.

    `publish(name, verdict)` is called once for every function, `note_lines(file, numbers)` with
    the lines that were seen to run on CPython. `run` is for a thread; `stop` may come from
    another.
    """

    def __init__(self, tier, path, names, timeout_s, publish, note_lines):
        self.command = [*STANDS_BACK, *tier.command, RUNNER, tier.name, _from_top(path)]
        self.left = list(names)
        self.timeout_s = timeout_s
        self.publish = publish
        self.note_lines = note_lines
        self.process = None
        self.stopped = False

    def run(self):
        while self.left and not self.stopped:
            self._run_process()

    def stop(self):
        self.stopped = True
        if self.process:
            self.process.kill()

    def wait(self):
        """Until it has ended after `stop`."""
        if self.process:
            self.process.wait()

    def _run_process(self):
        """Runs what is left until the process ends; at least one verdict comes of it.

        A verdict is held back until the next function begins: should the process die before that,
        the function that ended last is the one to look at, and fails.
        """
        name = verdict = None
        output, began = "", 0.0
        self.process = start([*self.command, *self.left])
        if self.stopped:  # while it was being started
            self.process.kill()
        for text, word, argument in reports(self.process, self.timeout_s):
            if word == "began":
                if verdict:
                    self._conclude(name, verdict)
                name, verdict, output, began = argument, None, "", time.monotonic()
            elif word == "raised":
                output = text
            elif word == "passed":
                verdict = Verdict(True, text, "", time.monotonic() - began)
            elif word == "failed":
                verdict = Verdict(False, output, text, time.monotonic() - began)
            elif word == "lines":
                file, _, numbers = argument.partition(" ")
                self.note_lines(file, map(int, numbers.split()))
            elif word == "ended" and not self.stopped:
                seconds = time.monotonic() - began
                self._conclude_process(name, verdict, output + text, argument, seconds)

    def _conclude(self, name, verdict):
        self.left.remove(name)
        self.publish(name, verdict)

    def _conclude_process(self, name, verdict, output, death, seconds):
        if name is None:  # most likely the file cannot even be imported
            reason = f"{output}No function of this file could be run: {death or 'it ended'}."
            for name in list(self.left):
                self._conclude(name, Verdict(False, "", reason, 0.0))
        elif verdict is None:
            reason = f"In this function {death or 'the interpreter ended'}."
            self._conclude(name, Verdict(False, output, reason, seconds))
        elif death:
            reason = f"{verdict.reason}After this function {death}."
            self._conclude(name, verdict._replace(passed=False, reason=reason))
        else:
            self._conclude(name, verdict)


def _from_top(path: Path) -> str:
    return str(path.relative_to(TOP) if path.is_relative_to(TOP) else path)


def start(command, cwd=TOP, **options):
    """A process that `reports` listens to."""
    return subprocess.Popen(
        command,
        cwd=cwd,
        env=ENVIRONMENT,
        **options,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )


def reports(process, timeout_s, good=(0,)):
    """Yields (text before the report, word, argument); the last word is always "ended".

    The argument of "ended" says what the process died of and is empty after an end with a `good`
    status. A process that reports nothing for `timeout_s`, or prints without end, is killed.
    """
    pending = death = ""
    deadline = time.monotonic() + timeout_s
    with process, selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        while not death:
            if not selector.select(deadline - time.monotonic()):
                death = f"the interpreter hung and was killed after {timeout_s:g} s"
            elif len(pending) > OUTPUT_LIMIT:
                death = "the interpreter printed without end and was killed"
            else:
                piece = os.read(process.stdout.fileno(), 65536)
                if not piece:
                    break
                pending += piece.decode("utf-8", "replace")
                while found := REPORT.search(pending):
                    yield pending[: found.start()], found[1], found[2]
                    pending = pending[found.end() :]
                    deadline = time.monotonic() + timeout_s
        if death:
            process.kill()
    yield pending, "ended", death or _cause_of_death(process.returncode, good)


def _cause_of_death(status, good):
    if status < 0:
        return f"the interpreter died of {signal.Signals(-status).name}"
    return "" if status in good else f"the interpreter ended with status {status}"
