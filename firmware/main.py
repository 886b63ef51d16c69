# SPDX-License-Identifier: MIT
"""Starts the panel on the board it finds.

Two ways lead to the prompt instead. DOWN held at power-on does, before anything is sent. Ctrl-C
does, at any time: every drive is stopped first, no interrupt is left, and the watchdog is stopped,
so that a person can work on the chip (maintenance mode). Ctrl-D there starts the panel again.

Anything else that ends the panel is a failure of the firmware: the drives are stopped, and the
watchdog restarts the chip within 2 s.
"""

from app import App

ESCAPE_KEY = "DOWN"

RUNS = "USS panel: runs. Ctrl-C stops every drive and ends it."
STOPPED = "USS panel: stopped, and every drive with it. Ctrl-D starts it again."
KEPT_ON = "The watchdog of this board cannot be stopped: it restarts the chip soon."
ESCAPED = "USS panel: not started, %s was down at power-on. Ctrl-D starts it." % ESCAPE_KEY


def start(board):
    """The panel on `board`, its bus at work; whoever calls this calls `step` again and again."""
    app = App(board)
    app.start()
    return app


def loop(app):
    """Start the bus and step until Ctrl-C or an exception ends that. Then stop the drives."""
    try:
        app.start()
        print(RUNS)  # tools/deploy waits for this
        while True:
            app = app.step() or app
    finally:
        app.close()


def escape_wanted(keypad):
    """Whether the key that leaves the chip at the prompt is down."""
    if ESCAPE_KEY not in keypad.names:
        return False
    return bool(keypad.read() >> keypad.names.index(ESCAPE_KEY) & 1)


def main():
    """The panel until Ctrl-C, or until the exception that ends it. Then maintenance mode."""
    import board  # the file that boards/<name>/ puts beside this one

    if escape_wanted(board.keypad):
        print(ESCAPED)
        return
    try:
        loop(App(board))
    except KeyboardInterrupt:
        print(STOPPED if board.watchdog.stop() else KEPT_ON)


if __name__ == "__main__":
    main()
