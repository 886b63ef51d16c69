# SPDX-License-Identifier: MIT
"""trace: both directions in hex and in words, while the drives are asked for what they do.

In a terminal p or the space bar holds the picture and lets it go on, q ends it; the exchange and
the file go on meanwhile.
"""

import select
import sys
import time

from tools.uss_command.errors import Failure
from tools.uss_command.explanation import FROM_DRIVE, TO_DRIVE, explained
from tools.uss_command.facts import parameter
from tools.uss_command.files.capture import Capture
from tools.uss_command.line import Line, Node
from uss import pkw

HELD_MAX = 10_000  # lines that wait while the picture is held


def add(commands):
    parser = commands.add_parser("trace", help="show all telegrams, in hex and in words")
    parser.add_argument(
        "parameters", nargs="*", metavar="P0700", help="to be read again and again"
    )
    parser.add_argument("--save", metavar="FILE", help="for decode --capture")
    parser.add_argument("--every", type=float, default=0.2, metavar="S", help="(%(default)s)")
    parser.add_argument("--for", dest="seconds", type=float, metavar="S", help="until Ctrl-C else")
    parser.set_defaults(run=trace)


def trace(screen, settings, chosen):
    asked = [parameter(word) for word in chosen.parameters]
    nodes = {}
    held = []
    keyboard = Keyboard()

    def show(seconds, is_sent, characters):
        way = TO_DRIVE if is_sent else FROM_DRIVE
        node = nodes.get(characters[2]) if len(characters) > 2 else None
        layout = (node.layout.pkw_words, node.layout.pzd_words) if node else None
        told = explained(characters, layout, way, node.family if node else None)
        shown = characters.hex(" ").upper()
        text = "%12.6f %s %-48s %s" % (seconds, "<>"[is_sent], shown, told.summary)
        line = text, {"at_s": seconds, "way": way, "hex": shown, "summary": told.summary}
        held.append(line)
        del held[:-HELD_MAX]
        if not keyboard.holds:
            for one, more in held:
                screen.event(one, **more)
            held.clear()

    capture = Capture(chosen.save, show)
    try:
        with keyboard, Line(screen, settings, chosen, capture) as line:
            line.listen()
            for address in settings.addresses:
                nodes[address] = line.node(address)
            turn = 0
            until_s = None if chosen.seconds is None else time.monotonic() + chosen.seconds
            while not keyboard.left and (until_s is None or time.monotonic() < until_s):
                for node in nodes.values():
                    _ask(line, node, asked, turn)
                turn += 1
                line.rest(chosen.every, keyboard.read)
    except KeyboardInterrupt:
        pass
    finally:
        capture.close()


def _ask(line, node: Node, asked, turn):
    """One visit; with a parameter of the list in its turn."""
    try:
        if asked:
            line.ask(node, pkw.read(*asked[turn % len(asked)]))
        else:
            line.see(node)
    except Failure:
        if line.link.is_cut or line.bus.foreign:
            raise
        node.forget()  # what it does not say is seen in the trace


class Keyboard:
    """Single keys of a terminal, where there is one. holds, left: what they have said."""

    def __init__(self):
        self.holds = False
        self.left = False
        self._before = None

    def __enter__(self):
        if sys.stdin and sys.stdin.isatty() and sys.platform != "win32":
            import termios
            import tty

            self._before = termios.tcgetattr(0)
            tty.setcbreak(0)
        return self

    def __exit__(self, *_):
        if self._before is not None:
            import termios

            termios.tcsetattr(0, termios.TCSADRAIN, self._before)

    def read(self):
        """Take what was typed; whether to leave."""
        while self._before is not None and select.select([0], (), (), 0)[0]:
            key = sys.stdin.read(1)
            if key in ("p", " "):
                self.holds = not self.holds
            self.left = self.left or key in ("q", "")
            if not key:
                break
        return self.left
