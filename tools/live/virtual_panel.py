# SPDX-License-Identifier: MIT
"""What ./tools/panel runs: the panel's firmware on the virtual board, live or driven by a script.

With --board pico an emulated Raspberry Pi Pico runs its firmware file, and this runs under
emulator/launch.py. With --port the panel talks on a real line, in real time, and this runs under
port/launch.py. It runs on MicroPython. Exit status: 0; 1 if an expectation failed or a rule of the
RS-485 line was broken; 2 if it does not understand the command line or a script; 4, with a
traceback, if the firmware or the simulation failed; 5 if it cannot have the serial port; 130 after
Ctrl-C.
"""

import gc
import json
import os
import select
import sys
import time

import main
from boards.sim.board import KEYPADS
from boards.sim.drives import kinds
from boards.sim.script import LINE_MAX, ExpectationFailed, Script, ScriptError
from boards.sim.world import World
from hal.store import FileStore
from settings_file import SIZE_MAX, load, save
from strict_json import fields
from tools.live.lines import speak
from tools.live.plain import in_ascii, understands_utf_8
from tools.live.usage import USAGE
from uss.telegram import NODE_MAX
from uss.timing import BAUD_RATES

try:
    from os import isatty
except ImportError:  # MicroPython's os has none: asking for the terminal's settings tells

    def isatty(descriptor):
        import termios

        try:
            termios.tcgetattr(descriptor)
        except OSError:
            return False
        return True


BYTE_ORDER_MARK = "\ufeff"  # some editors begin a text with it
ENOENT = 2
EPIPE = 32  # not in MicroPython's errno
KIND, ORDINARY = 0xF000, 0x8000  # of a file, in its mode
NEW = ".new"  # the ending of a file that is being written
FAILED = 1
NOT_UNDERSTOOD = 2
CRASHED = 4  # 3 comes from the wrapper: no MicroPython
NO_PORT = 5
INTERRUPTED = 130
# Bytes between two collections. By default MicroPython collects only when the heap is full, and
# takes ten times as long for everything while it looks for the last holes in it.
COLLECT_AFTER = 1_000_000
SLICE_MS = 10  # of real time, between two looks at standard input
PORT_REPLY_TIMEOUT_MS = 60  # 20 ms, and what an adapter keeps back on the way there and back


class UsageError(Exception):
    """The command line asks for something that cannot be."""


class PortFailed(Exception):
    """The serial port cannot be had; the text says why."""


class StreamError(Exception):
    """Standard input or output failed; args[0] is the OSError."""


def listed(text, on_port):
    """The drives that --drives names. UsageError: nobody can have them."""
    try:
        drives = kinds.listed_drives(text, names=panel_families() if on_port else kinds.NAMES)
    except ValueError as error:
        raise UsageError("--drives: %s" % error)
    if on_port:
        for one in drives:
            if one.factory:
                raise UsageError("--drives: %s: a real drive is as it is" % one.text())
    if len(told(drives)) > NODE_MAX:
        raise UsageError("--drives: the panel knows %d at the most" % NODE_MAX)
    return drives


def panel_families():
    """The names of all that the panel may expect on a line."""
    from uss import families

    return [family.__name__.lower() for family in families.FAMILIES]


def told(drives):
    """Those of them that the panel is told of."""
    return [one for one in drives if not one.factory]


def known_to_drives(baud, drives):
    try:
        kinds.knowing(drives, baud)
    except ValueError as error:
        raise UsageError(error)
    return baud


def number(word):
    if not word.isdigit():
        raise UsageError("--seed %s is no number" % word)
    return int(word)


def one_of(allowed, why):
    """A reader that takes these words or numbers; `why` says what is wrong with another one."""

    def reader(word):
        value = int(word) if word.isdigit() else word
        if value not in allowed:
            raise UsageError(why % word)
        return value

    return reader


RATES = "--baud %s: USS knows " + " ".join(str(rate) for rate in BAUD_RATES)
SPEEDS = "--speed %s: time passes 1...100 times as fast"
TIMEOUTS = "--reply-timeout %s: 20...500 ms"
WIRED = "--keys %s: keys are wired " + " or ".join(sorted(KEYPADS))

# Option: name of the value, default, reader. An option without a reader is a switch.
OPTIONS = {
    "--script": ("script", None, str),
    "--lines": ("lines", False, None),
    "--speed": ("speed", 1, one_of(range(1, 101), SPEEDS)),
    "--drives": ("drives", None, str),
    "--baud": ("baud", None, one_of(BAUD_RATES, RATES)),
    "--settings": ("settings", None, str),
    "--unset": ("unset", False, None),
    "--json": ("json", None, str),
    "--keys": ("keys", "direct", one_of(KEYPADS, WIRED)),
    "--seed": ("seed", 0, number),
    "--polled": ("polled", False, None),
    "--board": ("board", "sim", one_of(("sim", "pico"), "--board %s: there are sim and pico")),
    "--flash": ("flash", None, str),
    "--display": (
        "display",
        None,
        one_of(("wires", "backpack"), "--display %s: there are wires and backpack"),
    ),
    "--port": ("port", None, str),
    "--reply-timeout": ("reply_timeout", None, one_of(range(20, 501), TIMEOUTS)),
    "--help": ("help", False, None),
    "-h": ("help", False, None),
    "--check": ("check", False, None),  # only check that it is possible, before any download
}


# Options that one board alone knows.
ONLY_SIM = ("--settings", "--unset", "--json", "--polled", "--keys")
ONLY_PICO = ("--flash", "--display")
# Options that mean nothing on a real line, and the one that means something only there.
NOT_PORT = ("--speed", "--seed", "--unset", "--polled", "--board") + ONLY_PICO
ONLY_PORT = ("--reply-timeout",)


def options(words):
    """The values of OPTIONS that a command line means. UsageError if it means nothing."""
    values = {name: default for name, default, _ in OPTIONS.values()}
    words, seen = list(words), []
    while words:
        option, equals, given = words.pop(0).partition("=")
        if option not in OPTIONS:
            raise UsageError("unknown option %s" % option)
        if option in seen:
            raise UsageError("%s stands there twice" % option)
        seen.append(option)
        name, _, reader = OPTIONS[option]
        if reader is None:
            if equals:
                raise UsageError("%s takes no value" % option)
            values[name] = True
        else:
            if not equals and not words:
                raise UsageError("%s wants a value" % option)
            values[name] = reader(given if equals else words.pop(0))
    return values


def fit_for_board(chosen):
    """UsageError: an option that the board, or the real line, does not know.

    What --drives says is understood now: which families there are depends on the line.
    """
    board = chosen["board"]
    if chosen["drives"] is not None:
        chosen["drives"] = listed(chosen["drives"], chosen["port"] is not None)
    if chosen["port"] is not None:
        refuse(chosen, NOT_PORT, "%s is not for --port: the line is a real one, in real time")
        return
    if chosen["baud"] is not None:
        known_to_drives(chosen["baud"], chosen["drives"] or usual_drives())
    refuse(chosen, ONLY_PORT, "%s is for --port")
    refuse(chosen, ONLY_SIM if board == "pico" else ONLY_PICO, "%s is not for --board " + board)


def refuse(chosen, names, why):
    """UsageError: one of these options was given."""
    for option in names:
        name, default, _ = OPTIONS[option]
        if chosen[name] != default:
            raise UsageError(why % option)


def world_of(chosen):
    """The world that the options ask for, and what the person should know of it: lines.

    UsageError: there is no such drive, or what is to be kept cannot be.
    """
    if chosen["board"] == "pico":
        return pico_world(chosen)
    store, kept = kept_settings(chosen)
    if chosen["port"] is not None:
        return port_world(chosen, store, kept)
    drives, baud, said = fitting(chosen, kept, chosen["settings"])
    world = World(
        main.start,
        [one.address for one in drives],
        baud,
        settings=dict(setting_of(drives), **log_of(chosen)),
        seed=chosen["seed"],
        polled=chosen["polled"],
        keys=chosen["keys"],
        store=store,
        kinds=kinds.simulated(drives),
        unset=chosen["unset"],
    )
    return world, said + kinds.as_delivered(world.drives, baud)


def usual_drives():
    return kinds.listed_drives("1")


def setting_of(drives):
    """What the panel's settings say of the kinds of these drives."""
    expected = kinds.expected(drives)
    return {"kinds": expected} if expected else {}


def log_of(chosen):
    """What the panel's settings say of its log."""
    return {"log": "JSON"} if chosen["json"] is not None else {}


def keep_log(world, path):
    """What the panel logs goes to the end of this file. UsageError: it cannot.

    A file takes what is written at once, and a pipe or a terminal may hold the panel up.
    """
    try:
        if os.stat(path)[0] & KIND != ORDINARY:
            raise UsageError("--json %s: is no ordinary file" % path)
    except OSError:
        pass  # a new one
    try:
        file = open(path, "ab")
    except OSError as error:
        raise UsageError("--json %s: cannot be kept (%s)" % (path, error))

    def write(characters):
        try:
            file.write(characters)
            file.flush()
        except OSError as error:  # as if nobody read: the panel counts what it drops
            complain("--json %s: is not written any more (%s)" % (path, error))
            world.usb.is_read = False

    world.usb.to = write


def kept_settings(chosen):
    """The store of --settings and what it holds, `Kept`; None and None without it."""
    path = chosen["settings"]
    if path is None:
        return None, None
    try:
        return store_of(path, chosen)
    except OSError as error:
        raise UsageError("--settings %s: cannot be kept (%s)" % (path, error))


def port_world(chosen, store, kept):
    """As `world_of`: a real line."""
    from boards.port.clock import RealClock
    from boards.port.world import PortWorld
    from tools.port.client import Port, PortError

    drives = chosen["drives"] or usual_drives()
    if kept:
        drives = kept.listed(panel_families())
        wanted = chosen["drives"] and kinds.text_of(chosen["drives"])
        for option, given, named in (
            ("--drives", wanted, kinds.text_of(drives)),
            ("--baud", chosen["baud"], kept.baud),
            ("--reply-timeout", chosen["reply_timeout"], kept.reply_timeout_ms),
        ):
            if given not in (None, named):
                raise UsageError("%s: %s says %s" % (option, chosen["settings"], named))
    baud = kept.baud if kept else chosen["baud"] or 19200
    timeout_ms = chosen["reply_timeout"] or PORT_REPLY_TIMEOUT_MS
    try:
        port = Port()
        port.open(chosen["port"], baud)
    except PortError as error:
        raise PortFailed(error)
    settings = dict(setting_of(drives), **log_of(chosen))
    settings["reply_timeout_ms"] = timeout_ms
    world = PortWorld(
        main.start, port, [one.address for one in drives], baud, RealClock(Stopwatch().read_us),
        settings, keys=chosen["keys"], store=store,
    )  # fmt: skip
    return world, []


class Stopwatch:
    """True microseconds since it was made."""

    def __init__(self):
        self._seen = time.ticks_us()
        self._passed_us = 0

    def read_us(self):
        now = time.ticks_us()
        self._passed_us += time.ticks_diff(now, self._seen)
        self._seen = now
        return self._passed_us


def pico_world(chosen):
    """As `world_of`: an emulated Pico, whose flash is kept in a file if that is wanted."""
    from tools.emulator.world import PicoWorld

    image, kept = chosen["flash"], None
    if image is not None:
        image, kept = flash_of(image)
    drives, baud, said = fitting(chosen, kept, chosen["flash"])
    world = PicoWorld(
        "panel",
        [one.address for one in drives],
        baud,
        settings=setting_of(drives),
        seed=chosen["seed"],
        display=chosen["display"] or "wires",
        flash=image,
        kinds=kinds.simulated(drives),
    )
    said = said + kinds.as_delivered(world.drives, baud)
    return world, said + ["USB serial of the emulated Pico: %s" % world.open_serial()]


def fitting(chosen, kept, path):
    """Drives and baud rate of a world, and lines about them.

    kept: the settings in the file `path`, which go before what is usual; None: there are none.
    """
    drives, baud = chosen["drives"], chosen["baud"]
    if not kept:
        drives, baud = drives or usual_drives(), baud or 19200
        return drives, known_to_drives(baud, drives), []
    if baud not in (None, kept.baud):
        raise UsageError("--baud %d: %s says %d" % (baud, path, kept.baud))
    drives = drives or kept.listed(kinds.NAMES)
    said = difference(path, kept.listed(panel_families()), told(drives))
    return drives, known_to_drives(kept.baud, drives), said


class Kept:
    """What a settings file holds that was there, as far as the world goes by it.

    settings: as the panel has loaded them from `data`, bytes.
    """

    def __init__(self, settings, data):
        self.baud = settings.baud
        self.reply_timeout_ms = settings.reply_timeout_ms
        self._addresses = settings.drives
        self._kinds = {}
        try:
            for name, value, _ in fields(data) if len(data) <= SIZE_MAX else ():
                if name == "kinds" and isinstance(value, dict):
                    self._kinds = value
        except ValueError:
            pass  # the panel says that the file is damaged

    def listed(self, names):
        """The drives that the panel looks for; one that is of none of the families is plain."""
        found = []
        for address in self._addresses:
            kind = self._kinds.get(str(address))
            text = "%d=%s" % (address, kind) if isinstance(kind, str) else str(address)
            try:
                found += kinds.listed_drives(text, names=names)
            except ValueError:
                found += kinds.listed_drives(str(address))
        return found


def flash_of(path):
    """The flash image to begin with and the settings in it, `Kept`; None and None for a new file.

    UsageError: it is something else, or could not be written.
    """
    from tools.emulator.flash_image import FlashImage
    from tools.emulator.world import SETTINGS_FILE

    stored, image = None, None
    try:
        if is_new(path):
            open(path + NEW, "wb").close()  # fails now, not at the end, if it cannot be written
            os.remove(path + NEW)
        else:
            if os.stat(path)[0] & KIND != ORDINARY:
                raise UsageError("--flash %s: is no ordinary file" % path)
            open(path, "r+b").close()
            image = path
            try:
                stored = FlashImage(path).read(SETTINGS_FILE)
            except OSError:
                raise ValueError("%s holds no file system, or a damaged one" % path)
    except ValueError as error:
        raise UsageError("--flash %s" % error)
    except OSError as error:
        raise UsageError("--flash %s: cannot be kept (%s)" % (path, error))
    return image, Kept(load(Stored(stored)), stored) if stored else None


def is_new(path):
    """Whether there is nothing at `path`."""
    try:
        os.stat(path)
    except OSError as error:
        if error.args[0] != ENOENT:
            raise
        return True
    return False


class Stored:
    """A store that holds what was found."""

    def __init__(self, data):
        self._data = data

    def read(self, most=-1):
        return self._data[:most] if most >= 0 else self._data


def keep_flash(world, path):
    """Write the chip's flash to its file, in place of what it held."""
    try:
        world.save_flash(path + NEW)
        os.rename(path + NEW, path)
    except Exception as error:
        complain("--flash %s: was not kept (%s)" % (path, error))


def store_of(path, chosen):
    """The store in this file, and the settings in it, `Kept`. A new file gets what was chosen.

    OSError: it cannot be read or written. UsageError: it is a folder, a pipe or the like, which
    could keep the panel waiting for ever.
    """
    store = FileStore(path, open, os)
    try:
        if os.stat(path)[0] & KIND != ORDINARY:
            raise UsageError("--settings %s: is no ordinary file" % path)
    except OSError as error:
        if error.args[0] != ENOENT:
            raise
        if chosen["unset"]:
            store.replace(b"")  # fails now if it cannot be written
            os.remove(path)
            return store, None
        save(store, load(Stored(json.dumps(new_settings(chosen)).encode())))
    if chosen["unset"]:
        raise UsageError("--unset: %s holds settings already" % path)
    data = store.read(SIZE_MAX + 1)  # what `load` would make the best of is an error here
    return store, Kept(load(store), data)


def new_settings(chosen):
    """What a new settings file says, besides what is usual."""
    drives = chosen["drives"] or usual_drives()
    new = dict(setting_of(drives), **log_of(chosen))
    if told(drives):
        new["drives"] = [one.address for one in told(drives)]
    if chosen["baud"]:
        new["baud"] = chosen["baud"]
    if chosen["port"] is not None:
        new["reply_timeout_ms"] = chosen["reply_timeout"] or PORT_REPLY_TIMEOUT_MS
    return new


def difference(path, kept, drives):
    """What the person should know where the settings name other drives than are simulated."""
    kept, drives = (sorted([one.text() for one in some]) for some in (kept, drives))
    if kept == drives:
        return []
    kept, drives = (",".join(some) or "none" for some in (kept, drives))
    return ["by %s the panel looks for drives %s; there are %s" % (path, kept, drives)]


def lines_of(name, world):
    """The lines of a script. Lines of standard input are done as they come."""
    if name == "-":
        return standard_input() if world.port is None else typed_meanwhile(world)
    try:
        with open(name) as script:
            lines = list(pieces(script))
    except OSError as error:
        raise UsageError("--script %s: cannot be read (%s)" % (name, error))
    except UnicodeError:
        raise UsageError("--script %s: is no text" % name)
    return [line.lstrip(BYTE_ORDER_MARK) for line in lines[:1]] + lines[1:]


def pieces(stream):
    """Its lines. A line that is longer than a command may be comes in pieces that are too long
    too.
    """
    line = stream.readline(LINE_MAX + 2)
    while line:
        yield line
        line = stream.readline(LINE_MAX + 2)


def standard_input():
    try:
        yield from pieces(sys.stdin)
    except UnicodeError:
        raise UsageError("standard input is no text")
    except OSError as error:
        raise StreamError(error)


def typed_meanwhile(world):
    """The lines of standard input; real time goes on while none comes."""
    poller = select.poll()
    poller.register(sys.stdin, select.POLLIN)
    line = b""
    while True:
        while not poller.poll(0):
            world.run(SLICE_MS)
            tell_notices(world)
        try:
            character = sys.stdin.buffer.read(1)
        except OSError as error:
            raise StreamError(error)
        if character and character != b"\n":
            if len(line) <= LINE_MAX:
                line += character
            continue
        try:
            yield line.decode()
        except UnicodeError:
            raise UsageError("standard input is no text")
        if not character:
            return
        line = b""


def tell_notices(world):
    """What has happened to the line."""
    for line in world.notices:
        complain(line)
    world.notices = []


def show(line):
    try:
        print(legible(line, 1))
    except OSError as error:
        raise StreamError(error)


def legible(line, descriptor):
    """The line as a person can read it there. What goes into a file or a pipe is UTF-8."""
    return line if understands_utf_8(os.getenv) or not isatty(descriptor) else in_ascii(line)


def run_script(world, name):
    script = Script(world, "standard input" if name == "-" else name, show)
    script.run(lines_of(name, world))


def panel(words):
    """Do what the command line says; answer the exit status."""
    try:
        chosen = options(words)
        if chosen["help"]:
            if not chosen["check"]:
                show(USAGE)
            return 0
        if chosen["lines"] and chosen["script"] is not None:
            raise UsageError("--lines and --script both want standard input")
        silent = chosen["lines"] or chosen["script"] is not None
        if not silent and not (isatty(0) and isatty(1)):
            raise UsageError("this is no terminal: give the panel a --script FILE, or --script -")
        fit_for_board(chosen)
        if chosen["check"]:
            return 0
        if not silent:
            raise UsageError("this shows no picture: start ./tools/panel")
        world, said = world_of(chosen)
        if chosen["json"] is not None:
            keep_log(world, chosen["json"])
        for line in said:
            complain(line)
        try:
            if chosen["lines"]:
                speak(world, chosen["speed"], said)
            else:
                run_script(world, chosen["script"])
        finally:
            if chosen["port"] is not None:
                leave_line(world)
            if chosen["flash"] is not None:
                keep_flash(world, chosen["flash"])
    except PortFailed as error:
        return complain(error, NO_PORT)
    except UsageError as error:
        return complain(error, NOT_UNDERSTOOD)
    except ScriptError as error:
        return complain(error, NOT_UNDERSTOOD)
    except ExpectationFailed as error:
        return complain(error, FAILED)
    except KeyboardInterrupt:
        return complain("ended by Ctrl-C", INTERRUPTED)
    except StreamError as error:
        if error.args[0].errno == EPIPE:
            return FAILED  # the reader of the output has gone
        return complain("input or output failed: %s" % error, FAILED)
    except Exception as error:
        sys.print_exception(error, sys.stderr)
        return complain("the firmware or the simulation failed", CRASHED)
    return judged(world)


def leave_line(world):
    """Stop every drive first."""
    world.close()
    tell_notices(world)
    if world.unconfirmed():
        complain("OFF1 not confirmed by drive %s" % ", ".join(map(str, world.unconfirmed())))


def judged(world):
    """The status of a run that came to its end."""
    try:
        world.check()
    except AssertionError as error:
        return complain(error, FAILED)
    return 0


def complain(message, status=0):
    """A line on standard error; answers the status."""
    print(legible("panel: %s" % message, 2), file=sys.stderr)
    return status


if __name__ == "__main__":
    gc.threshold(COLLECT_AFTER)
    sys.exit(panel(sys.argv[1:]))
