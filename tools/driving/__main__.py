# SPDX-License-Identifier: MIT
"""Simulated drives for any USS master, on a pty or a serial port, in real time: tools/drive.

Its output never holds up the drives: if the output is not read, it leaves lines out.

Exit status: 0 after Ctrl-C or `quit`, 2 if it does not understand the command line, 5 if it cannot
have the port.
"""

import argparse
import os
import signal
import sys
import textwrap
from functools import partial

from boards.sim.drives import families
from boards.sim.drives.kinds import USUAL, as_delivered, listed_drives, simulated
from boards.sim.drives.switches import SWITCHES, switch_value
from boards.sim.script import (
    LINE_MAX,
    ORDER,
    ExpectationFailed,
    Script,
    ScriptError,
    parameter,
    value,
)
from tools.command_line import Parser
from tools.driving.line import OF_THE_PANEL, DriveLine
from tools.port.serial_port import PortError, Pty, SerialPort
from tools.port.standard_streams import Output, is_ours, open_missing

BAUD_RATES = (
    300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 76800, 93750, 115200, 187500,
)  # fmt: skip
NODE_MAX = 31
REPLY_DELAY_MAX_MS = 60_000
READ_MAX = 4096
NOT_UNDERSTOOD, NO_PORT = 2, 5  # exit status
INDENTED = {"initial_indent": "    ", "subsequent_indent": "    "}

COMMANDS = [name for name in ORDER if name not in OF_THE_PANEL] + ["help", "quit"]
UNKNOWN = "unknown command %s (there are: %s)"

UNHEARD = "standard output: %s; the drives are served all the same"

DESCRIPTION = """\
Serves simulated drives to a USS master of your own: a PLC, an Arduino, a program. They are those
of the panel's simulation, in real time."""

EPILOG = """\
With --pty the path of the pty is the first line printed. A pty takes no parity and no rate: open
it with parity NONE (pyserial: parity="N"). The simulated line has the rate of --baud all the
same, and characters take their time. A serial port is set to 8E1.

While it runs it takes commands, one a line:
  drive 1            the state of drive 1        param 1 P2014[0] 0   read or set a parameter
  fault 1 F0001      it trips                    unplug 1, plug 1     its RS-485 connector
  off 1, on 1        its mains                   bus 10               the last telegrams
  switch 1 boot_ms=0 as --switch, from now on
  help               lists all                   quit                 or Ctrl-C ends it

examples:
  ./tools/drive --pty --address 1 --family mm440 --log
  ./tools/drive --pty --address 1,2=g110,3=v20 --set 2:P2013=0 --set P2014=500
  ./tools/drive --port /dev/ttyUSB0 --baud 38400 --address 4
"""


class Once(argparse.Action):
    """Keeps a value, and refuses a second one, because either could be meant."""

    given = False

    def __call__(self, parser, chosen, value, option_string=None):
        if self.given:
            parser.error("%s stands there twice" % option_string)
        self.given = True
        setattr(chosen, self.dest, value)


def arguments(words):
    parser = Parser(
        prog="tools/drive",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add, once = parser.add_argument, partial(parser.add_argument, action=Once)
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--pty", action="store_true", help="on a new pty, whose path is printed")
    where.add_argument("--port", action=Once, metavar="PATH", help="on a port, as /dev/ttyUSB0")
    once("--link", metavar="PATH", help="with --pty: a symbolic link to it, always the same")
    once("--address", "--drives", default="1", metavar="LIST",
         help="such as 1,2=g110,3=v20/4,8=mm420/factory (%(default)s)")  # fmt: skip
    once("--family", default=USUAL, choices=families.NAMES,
         help="of those without one (%(default)s)")  # fmt: skip
    once("--baud", type=int, default=19200, choices=BAUD_RATES, metavar="RATE", help="(19200)")
    add("--set", action="append", default=[], metavar="A:P2014=0",
        help="a parameter of drive A, of all without A:")  # fmt: skip
    add("--switch", action="append", default=[], metavar="A:NAME=VALUE",
        help="how A behaves where the documents leave it open; --switch help")  # fmt: skip
    once("--reply-delay", type=milliseconds, metavar="MS", help="of each reply (three characters)")
    add("--log", action="store_true", help="print every telegram, decoded")
    if "--switch=help" in words or ("--switch", "help") in zip(words, words[1:]):
        parser.exit(message=switches() + "\n")
    chosen = parser.parse_args(words)
    if chosen.link and not chosen.pty:
        parser.error("--link is for --pty")
    try:
        return chosen, kinds(chosen)
    except ValueError as error:
        parser.error(str(error))


def milliseconds(word):
    """ValueError if it is not a delay of a reply."""
    ms = float(word)
    if not 0 <= ms <= REPLY_DELAY_MAX_MS:
        raise argparse.ArgumentTypeError("%s is not 0...%d ms" % (word, REPLY_DELAY_MAX_MS))
    return ms


def is_node(word):
    return word.isascii() and word.isdigit() and int(word) <= NODE_MAX


def kinds(chosen):
    """{address: keyword arguments of `Drive`}. ValueError if there is no such drive."""
    try:
        found = simulated(listed_drives(chosen.address, usual=chosen.family))
    except ValueError as error:
        raise ValueError("--address: %s" % error) from None
    for kind in found.values():
        kind.update({"parameters": {}, "switches": {}})
        if chosen.reply_delay is not None:
            kind["reply_delay_us"] = int(chosen.reply_delay * 1000)
    for entry in chosen.set:
        addresses, name, word = assignment("--set", "P2014=0", entry, found)
        try:
            which, new = parameter(None, name), value(None, word)
        except ValueError as error:
            raise ValueError("--set %s: %s" % (entry, error)) from None
        for one in addresses:
            found[one]["parameters"][which] = new
    for entry in chosen.switch:
        addresses, name, new = assignment("--switch", "stale_replies=2", entry, found)
        try:
            new = switch_value(name, new)
        except ValueError as error:
            raise ValueError("--switch %s: %s" % (entry, error)) from None
        for one in addresses:
            found[one]["switches"][name] = new
    return found


def assignment(option, example, entry, found):
    """What "1:NAME=VALUE" means: addresses, name, the word. ValueError if it means nothing."""
    left, equals, right = entry.partition("=")
    address, colon, name = left.rpartition(":")
    if not equals or colon and not (is_node(address) and int(address) in found):
        use = "use A:%s, A one of the addresses" % example
        raise ValueError("%s %s: %s" % (option, entry, use))
    return [int(address)] if colon else list(found), name, right


def switches():
    """What --switch help prints: a paragraph for each."""
    lines = []
    for name, default, what, where in SWITCHES:
        if default is None:
            continue  # a table, which does not fit a command line
        lines.append("%s (%s)" % (name, int(default) if isinstance(default, bool) else default))
        lines += textwrap.wrap("%s. %s" % (what, where), 95, **INDENTED)
    return "\n".join(lines)


class Keyboard:
    """The commands on standard input, which may end before the drives do; `say` answers them."""

    def __init__(self, line, say):
        self._line = line
        self._say = say
        self._script = Script(line, "standard input", say)
        self._typed = b""
        self.open = True
        self.left = False

    def fileno(self):
        return 0

    def listens(self):
        """Whether what is typed comes to this program."""
        return self.open and is_ours(0)

    def read(self):
        try:
            typed = os.read(0, READ_MAX)
        except OSError:
            if not is_ours(0):
                return  # it went into the background a moment ago
            typed = b""  # the terminal has gone
        self.open = bool(typed)
        self._typed += typed
        while b"\n" in self._typed and not self.left:
            command, self._typed = self._typed.split(b"\n", 1)
            self._do(command.decode("utf-8", "replace"))
        self._typed = self._typed[: LINE_MAX + 1]  # the rest of a line that is too long is lost

    def _do(self, command):
        words = command.split("#")[0].split()
        if words[:1] in (["quit"], ["q"]):
            self.left = True
        elif words[:1] == ["help"]:
            self._say(" ".join(COMMANDS))
        elif words and words[0] not in COMMANDS and words[0] not in OF_THE_PANEL:
            self._say(UNKNOWN % (words[0], " ".join(COMMANDS)))
        else:
            self._obey(command)

    def _obey(self, command):
        try:
            name, values = self._script.understood(command)
            if name:
                self._script.do(name, values)
        except (ScriptError, ExpectationFailed) as error:
            self._say(str(error))
        except OverflowError:
            self._say("%s: a number is too large" % command.split()[0])


class Complaints:
    """Say something on standard error, as long as it can be written."""

    def __init__(self):
        self._output = Output(2)

    def __call__(self, line):
        try:
            self._output.say("tools/drive: %s" % line)
        except BrokenPipeError:
            pass

    def go_on(self):
        try:
            self._output.go_on()
        except BrokenPipeError:
            pass


def serve(chosen, found, complain):
    port = Pty(chosen.link) if chosen.pty else SerialPort(chosen.port, chosen.baud)
    port.open()
    output = Output(1, lambda why: complain(UNHEARD % why))
    try:
        log = output.say if chosen.log else None
        line = DriveLine(port, found, chosen.baud, log, complain)
        output.say(chosen.link or port.path)
        for told in as_delivered(line.drives, chosen.baud):
            complain(told)
        keyboard = Keyboard(line, output.say)
        while not keyboard.left:
            if line.serve(keyboard if keyboard.listens() else None):
                keyboard.read()
            output.go_on()
            complain.go_on()
    finally:
        port.close()


def main(words):
    chosen, found = arguments(words)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:  # nohup
        signal.signal(signal.SIGHUP, signal.default_int_handler)
    signal.signal(signal.SIGTTIN, signal.SIG_IGN)  # in the background it reads no keyboard
    signal.signal(signal.SIGTTOU, signal.SIG_IGN)
    open_missing()
    complain = Complaints()
    try:
        serve(chosen, found, complain)
    except (KeyboardInterrupt, BrokenPipeError):
        pass  # Ctrl-C; or the reader of the log has gone
    except (PortError, ValueError, KeyError) as error:
        complain(error.args[0])
        return NO_PORT if isinstance(error, PortError) else NOT_UNDERSTOOD
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
