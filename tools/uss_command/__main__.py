# SPDX-License-Identifier: MIT
"""USS from this computer: finds, reads, sets, watches, runs and explains drives on a serial port.

Only run, jog, stop and ack (and send --on) change what a motor does. All other commands listen
first, and send nothing while another master talks.

Exit status: 0 done, 1 it failed, for the reason given in one line, 2 not understood, 5 the port
cannot be had, 130 ended by Ctrl-C.
"""

import argparse
import json
import os
import signal
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)
sys.path.append(str(TOP / "tools" / "pc"))

import uss_serial  # noqa: E402, F401 - finds firmware/uss
from uss_serial.port.errors import PortError  # noqa: E402

from tools.command_line import Parser  # noqa: E402
from tools.uss_command import (  # noqa: E402
    commissioning,
    explaining,
    finding,
    free,
    listening,
    motor,
    parameters,
    sets,
    tracing,
    watching,
)
from tools.uss_command.errors import INTERRUPTED, NO_PORT, Failure  # noqa: E402
from tools.uss_command.screen import Screen  # noqa: E402
from tools.uss_command.settings import Settings  # noqa: E402

GROUPS = (
    finding, parameters, motor, watching, tracing, listening, sets, explaining, free,
    commissioning,
)  # fmt: skip

EPILOG = """\
Settings of the port: options, else USS_PORT, USS_BAUD, USS_ADDRESS, USS_KIND and
USS_REPLY_TIMEOUT, else uss.toml here or ~/.config/uss.toml:  port = "/dev/ttyUSB0"

examples:
  ./tools/uss --port /dev/ttyUSB0 --baud 9600 mirror
  ./tools/uss --port /dev/ttyUSB0 scan --rates all --standing
  ./tools/uss --port /dev/ttyUSB0 --kind mm440 read P0700 P1082 r0021[0]
  ./tools/uss --port /dev/ttyUSB0 run 25.0
  ./tools/uss decode 02 06 00 04 7F 20 00 5F
Without a drive: ./tools/drive --pty --baud 9600 prints the path of a port with one behind it.
"""


def options(default):
    """Those of every command. default: argparse.SUPPRESS where they stand a second time."""
    parser = Parser(add_help=False, argument_default=default)
    add = parser.add_argument
    add("--port", metavar="PATH", help="/dev/ttyUSB0, COM5, or socket://host:port")
    add("--baud", metavar="RATE", help="(9600)")
    add("--address", metavar="LIST", help="of the drive, or drives: 1, 1,2,5-8 (1)")
    add("--kind", metavar="KIND", help="what a drive is: mm440, 1=v20,2=mm440/4+4, pump.py:Pump")
    add("--reply-timeout", metavar="MS", help="(60)")
    add("--config", metavar="FILE", help="a file of settings")
    add("--standing", action="store_true", help="the motors stand: any drive may be asked")
    add("--leave", dest="stay", action="store_false", default=default,
        help="end although a drive trips because it hears no more (P2014)")  # fmt: skip
    add("--stay", action="store_true", default=default,
        help="go on asking such drives until another master talks, or Ctrl-C")  # fmt: skip
    add("--json", action="store_true", help="for programs")
    add("--trace", metavar="FILE", help="keep all telegrams; decode --capture FILE explains them")
    return parser


def arguments(words):
    parser = Parser(
        prog="tools/uss",
        description=__doc__,
        epilog=EPILOG,
        parents=[options(None)],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    again = _Again(commands, options(argparse.SUPPRESS))
    for group in GROUPS:
        group.add(again)
    return parser.parse_args(words)


class _Again:
    """Subparsers that take the options of every command as well."""

    def __init__(self, commands, parent):
        self._commands = commands
        self._parent = parent

    def add_parser(self, name, help):
        return self._commands.add_parser(
            name, help=help, description=help, parents=[self._parent], prog="tools/uss " + name
        )


def main(words):
    chosen = arguments(words)

    def end(*_):
        chosen.stay = False  # whoever ends this from outside wants it to end
        raise KeyboardInterrupt

    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number and signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, end)
    screen = Screen(chosen.json)
    trace = None
    try:
        settings = Settings(chosen)
        chosen.watch = None
        if chosen.trace:
            trace = tracing.Capture(chosen.trace)
            chosen.watch = trace
        status = chosen.run(screen, settings, chosen) or 0
        sys.stdout.flush()
        return status
    except PortError as error:
        return complain(screen, str(error), NO_PORT)
    except Failure as failure:
        return complain(screen, str(failure), failure.status)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # who read this has gone
        return 1
    finally:
        if trace:
            trace.close()


def complain(screen, text, status):
    text = " ".join(text.split())
    if screen.as_json:
        print(json.dumps({"error": text}), flush=True)
    print("tools/uss: %s" % text, file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
