# SPDX-License-Identifier: MIT
"""The steps of tools/deploy, one after the other; it says each in a line.

    Deployment(chip, firmware, options, say).run()

The chip never has a firmware that is half the old and half the new one and starts. The steps
remove main.py first and write it last. That is not enough if a main.py is frozen into MicroPython,
because that cannot be removed. Therefore they put up the gate (plan.GATE) before everything else,
and take it away last of all. Each file is written beside the one it replaces, and a rename puts it
in place.
"""

from typing import NamedTuple

from tools.deploying.errors import DeployError
from tools.deploying.image import BOARD, MAIN
from tools.deploying.plan import (
    GATE,
    GATE_TEXT,
    LIST,
    NEW,
    Found,
    Plan,
    paths,
    read_list,
    sha256,
    write_list,
)
from tools.progress import Progress

OLDEST = (1, 25)
STOPPED = "USS panel: stopped"  # how the line begins that firmware/main.py prints
FROZEN_PANEL = "uss/master"  # frozen in if the panel is
LOOK_AT_ONCE = 16  # paths; the answer stays small

FROZEN = """\
The panel is frozen into its MicroPython. What is copied goes before that, but for main.py,
    which stays the frozen one: where that has changed, tools/uf2 helps.
    tools/deploy --remove takes it away again; with --dry-run it lists what is there."""

FROZEN_AGAIN = "The panel that is frozen into its MicroPython runs now."

FROZEN_OTHER = """\
another program is frozen into its MicroPython as main.py, and goes before the panel's:
    put plain MicroPython onto it first"""

IN_THE_WAY = """\
these on the chip are not from tools/deploy, or were changed, and are in the way:
    %s
    --replace replaces the files; keep a copy of what you need first"""

INCOMPLETE = """\
What is on the chip now is not complete. It starts no panel until tools/deploy has run to its
    end: just run it again."""

IDENTITY = (
    "(lambda sys: (lambda it: (it.name, tuple(it.version[:3]),"
    ' getattr(it, "_machine", sys.platform), getattr(it, "_mpy", 0)))'
    '(sys.implementation))(__import__("sys"))'
)


class Options(NamedTuple):
    dry_run: bool = False
    replace: bool = False  # replace files in the way that are not ours
    new_board: bool = False  # the board file was named: it replaces any that is there


class Identity(NamedTuple):
    mpy: int  # sys.implementation._mpy, 0 where there is none
    panel_is_frozen: bool


class Deployment:
    """chip: see chip.py. firmware: see image.py. say: takes a line of progress."""

    def __init__(self, chip, firmware, options, say):
        self.chip = chip
        self.firmware = firmware
        self.options = options
        self.say = say
        self.gate_closed = False  # whether the panel was kept from starting, and still is

    def run(self):
        """Ends what runs on the chip, brings its files up to date, and restarts it."""
        self.say(
            f"{self.chip.port}: a panel that runs there stops all its drives now,"
            " and is restarted afterwards."
        )
        try:
            heard = self.chip.interrupt()
        except KeyboardInterrupt:
            self.say("What ran there may have ended: run this again, or unplug it and plug it in.")
            raise
        if STOPPED in heard:
            self.say("It has stopped them.")
        try:
            self.chip.enter()
            self._update()
        except BaseException:
            self._leave()
            raise
        self.chip.restart()
        self.say("Restarted.")

    def _leave(self):
        """After a failure: the chip's files are either as they were, or it starts nothing."""
        if self.gate_closed:
            self.say(INCOMPLETE)
            return
        try:
            self.chip.restart()
            self.say("Nothing was changed. Restarted.")
        except DeployError:
            self.say("Nothing was changed. It could not be restarted: unplug it, and plug it in.")

    def _update(self):
        identity = self._identify()
        plan = self._plan(self._files(identity))
        if self.options.dry_run:
            self._announce(plan)
        elif plan.nothing_to_do:
            self.say(
                f"All {len(plan.files)} files are there already, nothing is copied."
                if plan.files
                else "There is nothing to remove."
            )
        else:
            self._copy(plan)
        if identity.panel_is_frozen and not plan.files and not self.options.dry_run:
            self.say(FROZEN_AGAIN)

    # ---- what is there ------------------------------------------------------------------------

    def _identify(self):
        name, version, machine, mpy = self.chip.evaluate(IDENTITY)
        number = ".".join(map(str, version))
        self.say(f"It is {machine}, {name} {number}.")
        if name != "micropython":
            raise DeployError(f"{name} is not MicroPython")
        chip = self.firmware.chip
        if self.firmware.sources and machine.rpartition(" with ")[2] != chip:
            raise DeployError(f"the firmware is for the {chip}, not for {machine}")
        if version < OLDEST:
            oldest = ".".join(map(str, OLDEST))
            raise DeployError(f"MicroPython {number} is too old: {oldest} or newer is wanted")
        self.chip.load()
        if self.chip.call("stop_watchdog"):  # before it restarts the chip
            self.say("A watchdog was running, and is stopped.")
        frozen = frozenset(self.chip.execute("help('modules')").split())
        if "main" in frozen and FROZEN_PANEL not in frozen:
            raise DeployError(FROZEN_OTHER)
        return Identity(mpy, "main" in frozen)

    def _files(self, identity):
        """{path: bytes} of what should be there."""
        files = self.firmware.files(identity.mpy)
        if not files:  # all of it is to be removed
            return files
        if not self.firmware.compiled:
            self.say("There is no mpy-cross here: the sources are copied.")
        elif not self.firmware.suits(identity.mpy):
            version = f"{identity.mpy & 0xFF}.{identity.mpy >> 8 & 3}"
            self.say(f"It wants .mpy files of version {version}: the sources are copied instead.")
        if identity.panel_is_frozen:
            del files[MAIN]
            self.say(FROZEN)
        return files

    def _plan(self, files):
        text = self._list_text()
        listed = read_list(text)
        if text and not listed:
            self.say(f"{LIST} on the chip is damaged: what is there counts as somebody else's.")
        found = self._look(paths(files, listed))
        plan = Plan(files, listed, found, text, self.options.replace, self.options.new_board)
        if plan.keeps_board:
            self.say(
                f"{BOARD} on the chip is not the tree's, and is kept. --board-file replaces it."
            )
        for path in plan.replaced:
            self.say(f"{path} on the chip is not ours, and is replaced.")
        if plan.conflicts:
            raise DeployError(IN_THE_WAY % " ".join(plan.conflicts))
        block, free = self.chip.call("free_blocks")
        wanted = plan.blocks_wanted(block)
        if not plan.nothing_to_do and wanted > free:
            raise DeployError(
                f"the file system is too full: {wanted * block // 1024} KiB are wanted,"
                f" {free * block // 1024} KiB are free"
            )
        return plan

    def _list_text(self):
        there = self._look([LIST])
        return self.chip.call("read", LIST) if there and there[LIST].size >= 0 else b""

    def _look(self, wanted):
        found = {}
        for start in range(0, len(wanted), LOOK_AT_ONCE):
            for path, size, digest in self.chip.call("look", wanted[start : start + LOOK_AT_ONCE]):
                found[path] = Found(size, digest)
        return found

    # ---- what is done -------------------------------------------------------------------------

    def _announce(self, plan):
        for path in plan.remove:
            self.say(f"would remove  {path}")
        for path, data in plan.copy.items():
            self.say(f"would copy    {path}  {len(data)} bytes")
        if plan.gate_is_closed:
            self.say("An earlier copying was not finished.")
        total = sum(map(len, plan.copy.values()))
        self.say(
            f"Would copy {len(plan.copy)} of {len(plan.files)} files, {total} bytes,"
            f" and remove {len(plan.remove)}."
        )

    def _copy(self, plan):
        self._put(LIST, write_list(plan.listed, plan.new_list))
        self.gate_closed = True
        self._put(GATE, GATE_TEXT)
        main = {MAIN} & {*plan.found} & {*plan.files}
        for path in sorted({*plan.remove} | main, key=lambda path: (path != MAIN, path)):
            self.say(f"remove  {path}")
            self.chip.call("remove", path)
        files = [path for path in plan.copy if path not in (MAIN, GATE)]
        progress, sent = Progress(sum(len(plan.copy[path]) for path in files)), 0
        for number, path in enumerate(files, 1):
            data = plan.copy[path]
            far = ", ".join(filter(None, (f"{number} of {len(files)}", progress.left(sent))))
            self.say(f"copy    {path}  {len(data)} bytes, {far}")
            self._put(path, data)
            sent += len(data)
        self._verify(plan.files, [path for path in plan.files if path not in (MAIN, GATE)])
        if MAIN in plan.files:
            self.say(f"copy    {MAIN}  {len(plan.files[MAIN])} bytes")
            self._put(MAIN, plan.files[MAIN])
            self._verify(plan.files, [MAIN])
        self.chip.call("remove_empty", plan.folders_to_leave())
        if plan.list_text:
            self._put(LIST, plan.list_text)
        else:
            self.chip.call("remove", LIST)
        self._open_gate(plan)
        self.gate_closed = False
        if plan.files:
            self.say(f"All {len(plan.files)} files are there, compared by their SHA-256.")
        else:
            self.say("All that was copied is gone.")

    def _open_gate(self, plan):
        """From here on the panel starts."""
        if GATE in plan.files:
            self._put(GATE, plan.files[GATE])
            self._verify(plan.files, [GATE])
        else:
            self.chip.call("remove", GATE)

    def _put(self, path, data):
        folder = path.rpartition("/")[0]
        if folder:
            self.chip.call("make_folder", folder)
        self.chip.write(path + NEW, data)
        self.chip.call("replace", path + NEW, path)

    def _verify(self, files, wanted):
        found = self._look(wanted)
        for path in wanted:
            if path not in found or found[path].sha256 != sha256(files[path]):
                raise DeployError(f"{path} did not arrive as it was sent")
