# SPDX-License-Identifier: MIT
"""Checks a chip with MicroPython before and while it is wired: tools/bringup --help."""

import os
import sys
import time
from pathlib import Path

from serial.tools.list_ports import comports

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)
sys.path.append(str(TOP / "firmware"))

from tools.bringing_up.checks import (  # noqa: E402
    CHECKS,
    JUMPERS,
    NOTHING,
    RESTART,
    WHY_NOT,
    judge_identity,
    line_of,
)
from tools.bringing_up.options import arguments  # noqa: E402
from tools.deploying.chip import Chip  # noqa: E402
from tools.deploying.errors import DeployError  # noqa: E402
from tools.deploying.ports import choose, waits_for_uf2  # noqa: E402
from version import VERSION  # noqa: E402

HERE = Path(__file__).parent
ON_CHIP = ("on_chip.py", "on_line.py", "rp2_pulses.py", "boot.py")
PLACE = "bringup"  # a folder on the chip, for as long as this lasts
BOOT, BITTEN = "boot.py", f"{PLACE}/bitten"
OLDEST = "the firmware needs MicroPython 1.25 or newer"
RESTART_S = 60  # until a chip that has restarted is at its prompt; an emulated one takes its time
AGAIN_S = 0.2
ASK_BARE = "The board is bare, GP4 is joined to GP5 and GP6 to GP3? This sends on them. yes/no: "
ASK_WIRED = "The jumpers are gone, and no motor can start? This sends on the bus. yes/no: "
AFTERWARDS = "The chip is at its prompt now. A panel on it starts when it gets power anew."
ASK_PAGE = "Does the display show the characters {first:02X}h to {last:02X}h? yes/no: "


def files():
    """{path on the chip: bytes}: `chips/rp2.py` and `hal` of this tree, whatever is deployed."""
    found = {name: (HERE / name).read_bytes() for name in ON_CHIP}
    found["chips/rp2.py"] = (TOP / "boards/chips/rp2.py").read_bytes()
    for path in sorted((TOP / "firmware/hal").rglob("*.py")):
        found[path.relative_to(TOP / "firmware").as_posix()] = path.read_bytes()
    return {f"{PLACE}/{path}": data for path, data in found.items()}


def folders(paths):
    """Those that the files are in, the outermost first."""
    return sorted({"/".join(path.split("/")[:end]) for path in paths
                   for end in range(1, path.count("/") + 1)})  # fmt: skip


class Bench:
    """The chip on the table. say(line): tells the person, and the report. asks: whether there is
    a person to answer."""

    def __init__(self, port, options, say):
        self._port = port
        self._options = options
        self._say = say
        self._chip = Chip(port)
        wired = options.wired
        self._present = {NOTHING, *wired} if wired else {NOTHING, JUMPERS, RESTART}
        self._why_not = dict(WHY_NOT)
        self.passed, self.failed = [], []

    def close(self):
        self._chip.close()

    def run(self):
        wanted = files()
        self._to_the_prompt()
        self._chip.load()
        try:
            for folder in folders(wanted):
                self._chip.call("make_folder", folder)
            for path, data in wanted.items():
                self._chip.write(path, data)
            if RESTART in self._present:
                self._restart()
            self._import()
            about, fits = judge_identity(self._chip.call("identity"))
            self._say(f"USS panel {VERSION}, {about}")
            if not fits:
                raise DeployError(OLDEST)
            for check in CHECKS:
                self._make(check)
        finally:
            self._to_the_prompt()
            self._chip.load()
            self._remove([*wanted, BITTEN])

    def _to_the_prompt(self):
        self._chip.interrupt()
        self._chip.enter()

    def _import(self):
        self._chip.execute(f"import sys\nsys.path.insert(0, '/{PLACE}')")
        self._chip.execute("from on_chip import *\nfrom on_line import *")

    def _restart(self):
        """Hang the chip with its driver on, until the watchdog restarts it."""
        if self._chip.call("look", [BOOT]):
            self._present.discard(RESTART)
            self._why_not[RESTART] = "the chip has a boot.py of its own: take it off first"
            return
        self._chip.call("replace", f"{PLACE}/{BOOT}", BOOT)
        self._import()
        self._chip.begin("hang()")
        self._chip.close()
        deadline = time.monotonic() + RESTART_S
        while True:
            try:
                self._chip = Chip(self._port)
                self._to_the_prompt()
                return
            except DeployError:
                self._chip.close()
                if time.monotonic() > deadline:
                    raise
                time.sleep(AGAIN_S)

    def _make(self, check):
        if check.needs not in self._present:
            figure, right = self._why_not[check.needs], None
        elif check.pages and self._options.yes:
            figure, right = "somebody has to look: leave out --yes", None
        else:
            figure, right = self._judged(check)
        self._say(line_of(check, figure, right))
        if right:
            self.passed.append(check)
        elif right is False:
            self.failed.append(check)
            self._say(f"      What to do: {check.remedy}.")

    def _judged(self, check):
        options = self._options
        given = check.filled(options.address, options.baud)
        try:
            if not check.pages:
                return check.judge(self._chip.call(check.function, *given))
            return check.judge([
                (self._chip.call(check.function, *given, page), confirmed(page))
                for page in check.pages
            ])  # fmt: skip
        except DeployError as error:
            return str(error), False

    def _remove(self, paths):
        for path in paths:
            if self._chip.call("look", [path]):
                self._chip.call("remove", path)
        self._chip.call("remove_empty", folders(paths)[::-1])


def agreed(question):
    """Whether a person says yes; nobody there to ask is no."""
    try:
        return input(question).strip() == "yes"
    except EOFError:
        print()
        return False


def confirmed(page):
    return agreed(ASK_PAGE.format(first=page, last=page + 31))


def summary(bench):
    """The last lines: what the chip has confirmed of what the firmware takes for granted."""
    made = len(bench.passed) + len(bench.failed)
    yield f"{len(bench.passed)} of {made} passed, {len(CHECKS) - made} not checked."
    for checks, words in ((bench.passed, "confirms"), (bench.failed, "does not confirm")):
        if checks:
            yield f"This chip {words} that"
            yield from (f"  {check.number:2} {check.proves}" for check in checks)


def writable(report):
    """Raises DeployError unless the report can be written: better now than after a minute."""
    place = report if report.exists() else report.parent
    if report.is_dir() or not os.access(place, os.W_OK):
        raise DeployError(f"the report cannot be written: {report}")


def made(options, say):
    """The bench, its checks made. DeployError: they could not be."""
    writable(Path(options.report))
    if not options.yes and not agreed(ASK_WIRED if options.wired else ASK_BARE):
        raise DeployError("nothing was sent, for you did not say yes")
    bench = Bench(options.port or choose(comports(), waits_for_uf2()), options, say)
    try:
        bench.run()
    finally:
        bench.close()
    return bench


def main():
    options = arguments(sys.argv[1:])
    lines = []

    def say(line):
        print(line, flush=True)
        lines.append(line)

    bench, ended = None, ""
    try:
        bench = made(options, say)
    except DeployError as error:
        ended = str(error)
    except KeyboardInterrupt:
        ended = "interrupted"
    if bench:
        for line in summary(bench):
            say(line)
        print(AFTERWARDS)
    else:
        print(f"tools/bringup: {ended}", file=sys.stderr)
    if lines:
        whole = [*lines, f"broken off: {ended}"] if ended else lines
        Path(options.report).write_text("\n".join(whole) + "\n")
    return 0 if bench and not bench.failed else 1


if __name__ == "__main__":
    sys.exit(main())
