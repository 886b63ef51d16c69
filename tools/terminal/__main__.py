# SPDX-License-Identifier: MIT
"""The live panel in a terminal: tools/panel starts it.

    python tools/terminal COMMAND ARGUMENTS...

COMMAND is a running panel that speaks the language of tools/live/README.md on its standard
streams. Exit status: that of COMMAND; 128 and its number if a signal ended it.
"""

import os
import signal
import sys
from pathlib import Path

sys.path[0] = str(Path(__file__).resolve().parents[2])
# Every key as xterm sends it: a terminal that tells more of a key tells it in a sequence.
os.environ["TEXTUAL_DISABLE_KITTY_KEY"] = "1"

from tools.live.plain import in_ascii, understands_utf_8  # noqa: E402
from tools.terminal.child import Child  # noqa: E402

ENDED_BY = "panel: ended by signal %d"
LEFT = "every drive was sent OFF1."


def main(command):
    child = Child(command)  # it starts while the library is being read
    asked = []
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda number, _: (asked.append(number), child.interrupt(number)))
    signal.signal(signal.SIGINT, lambda *_: child.interrupt())
    from tools.terminal.app import PanelApp
    from tools.terminal.driver import TerminalDriver
    from tools.terminal.told import Told

    told = Told()
    for message in child.first():
        told.take(message)
    crashed, last = 0, ""
    if told.hello:
        app = PanelApp(child, told, driver_class=TerminalDriver)
        app.run()
        crashed = app.return_code or 0
        if app.way_out == "interrupt":
            child.interrupt()
        elif app.way_out == "quit":
            last = farewell(told)
    status = child.leave()
    said = child.said.decode("utf-8", "replace")
    sys.stderr.write(said if understands_utf_8(os.environ.get) else in_ascii(said))
    if status < 0:
        print(ENDED_BY % -status, file=sys.stderr)
    if last and not status:
        print(last)
    return 128 - status if status < 0 else status or crashed


def farewell(told):
    """What the panel says when it has gone; nothing if it goes on without us."""
    if told.hello.get("joined"):
        return "USS panel: left; it goes on."
    if told.hello["real"]:
        return "USS panel: ended; " + LEFT
    seconds = told.us // 1_000_000
    text = "USS panel: ended after %d:%02d:%02d of the world's time; " % (
        seconds // 3600, seconds // 60 % 60, seconds % 60,
    )  # fmt: skip
    ran = ["A%d at %.2f Hz" % (drive["at"], drive["hz"]) for drive in told.drives if drive["hz"]]
    return text + ("stopped: %s." % ", ".join(ran) if ran else "no motor was turning.")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
