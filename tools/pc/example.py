# SPDX-License-Identifier: MIT
"""Runs a program of the library on a serial port: ./tools/example FILE --port PATH

The program finds a module `board`, as on a chip, with `clock`, `make_link(baud)` and `idle`; a
computer has no keys, no display and no watchdog. Exit status: 0; 1 if an exception ended the
program, told in one line where it is of the library; 2 not understood; 5 no such port.
"""

import runpy
import sys
import types
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
EXAMPLES = TOP / "tools" / "examples"
sys.path[:1] = map(str, (TOP / "tools" / "pc", TOP))

import uss_serial  # noqa: E402

import uss.bus  # noqa: E402
from tools.command_line import Parser  # noqa: E402
from uss.errors import UssError  # noqa: E402

FAILED, NOT_UNDERSTOOD, NO_PORT, INTERRUPTED = 1, 2, 5, 130


class Board(types.ModuleType):
    """A board of `hal`, as far as a computer is one."""

    name = "PC"
    reset_cause = ""
    timer = None

    def __init__(self, port):
        types.ModuleType.__init__(self, "board")
        self._port = port
        self.clock = None
        self.make_link = self._make_link

    def _make_link(self, baud):
        link = uss_serial.SerialLink(self._port, baud)
        self.clock = link.clock
        return link

    def idle(self):
        """The machine works on its own."""

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        raise AttributeError("a PC has no %s: try it without --port" % name)


def arguments(words):
    parser = Parser(prog="tools/example", description=__doc__.split("\n\n")[0])
    parser.add_argument("program", help="an example's name, or FILE.py")
    parser.add_argument("--port", required=True, metavar="PATH", help="such as /dev/ttyUSB0")
    return parser.parse_args(words)


def main(words):
    chosen = arguments(words)
    path = Path(chosen.program)
    if path.suffix != ".py":
        path = EXAMPLES / (chosen.program + ".py")
    if not path.is_file():
        print("tools/example: there is no program %s" % chosen.program, file=sys.stderr)
        return NOT_UNDERSTOOD
    sys.modules["board"] = Board(chosen.port)
    uss.bus.Master = uss_serial.Master  # the same, but it waits longer for an adapter's reply
    try:
        runpy.run_path(str(path), run_name="__main__")
    except uss_serial.PortError as error:
        return complain(error, NO_PORT)
    except (UssError, AttributeError) as error:
        if isinstance(error, AttributeError) and "a PC has no" not in str(error):
            raise
        return complain(error, FAILED)
    except KeyboardInterrupt:
        return INTERRUPTED
    return 0


def complain(error, status):
    print("tools/example: %s" % error, file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
