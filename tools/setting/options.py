# SPDX-License-Identifier: MIT
"""The command line of tools/settings. As a program it only says what is wrong with one, or helps:
that needs nothing that has to be installed.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.command_line import Parser  # noqa: E402

DESCRIPTION = """\
The settings and the parameter sets of a panel: of one on USB, real or emulated, or those in a
file, as ./tools/panel --settings has it; sets are the files that end in .set beside it.

On USB, Ctrl-C ends what runs on the chip: a panel stops all its drives first, and is started
again afterwards."""

EPILOG = """\
examples:
  ./tools/settings get                               all settings of the panel on USB
  ./tools/settings set baud=9600 drives=1,2,5 kinds.2=g110
  ./tools/settings set kinds.2=                      drive 2 is of the usual kind again
  ./tools/settings --file panel1.json edit           in the editor of $VISUAL or $EDITOR
  ./tools/settings out kept                          settings and sets into the folder kept
  ./tools/settings in kept/settings.json kept/1.set  and onto another panel
"""


def arguments(words):
    parser = Parser(
        prog="tools/settings",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    place(parser, None)
    commands = parser.add_subparsers(metavar="COMMAND", required=True, dest="command")

    def add(name, what):
        command = commands.add_parser(
            name, help=what, description=what, prog="tools/settings " + name
        )
        place(command, argparse.SUPPRESS)  # what stands before the command holds
        return command

    get = add("get", "show settings, what they mean and may be")
    get.add_argument("names", nargs="*", metavar="NAME", help="(all)")
    get.add_argument("--json", action="store_true", help="for programs")
    change = add("set", "change settings: NAME=VALUE")
    change.add_argument("changes", nargs="+", metavar="NAME=VALUE")
    add("edit", "change them in an editor")
    out = add("out", "copy settings and sets into a folder")
    out.add_argument("folder", metavar="FOLDER")
    bring = add("in", "copy settings and sets onto the panel")
    bring.add_argument("files", nargs="+", metavar="FILE", help="settings, or NAME.set")
    chosen = parser.parse_args(words)
    if chosen.port and chosen.file:
        parser.error("--port and --file: one at a time")
    for change in getattr(chosen, "changes", ()):
        if "=" not in change:
            parser.error(f"{change}: say NAME=VALUE")
    return chosen


def place(parser, otherwise):
    """Where the settings are may be said before the command and behind it."""
    say = partial(parser.add_argument, default=otherwise)
    say("--port", metavar="PATH", help="serial port of the chip; of several")
    say("--file", metavar="FILE", help="a file of settings, and no chip")


if __name__ == "__main__":
    arguments(sys.argv[1:])
