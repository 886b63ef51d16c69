"""Starts the panel on the board it finds.

DOWN held at power-on leaves the chip at the prompt instead. So does Ctrl-C, after every drive has
been stopped; but the watchdog, once it runs, cannot be stopped and restarts the chip 2 s later.
"""

from app import App

ESCAPE_KEY = "DOWN"


def start(board):
    """The panel on `board`, its bus at work; whoever calls this calls `step` again and again."""
    app = App(board)
    app.start()
    return app


def loop(app):
    """Step until something ends it: Ctrl-C, an exception. Then stop the drives."""
    try:
        while True:
            app.step()
    finally:
        app.close()


def escape_wanted(keypad):
    """Whether the key that leaves the chip at the prompt is down."""
    if ESCAPE_KEY not in keypad.names:
        return False
    return bool(keypad.read() >> keypad.names.index(ESCAPE_KEY) & 1)


def main():
    import board  # the file that boards/<name>/ puts beside this one

    if not escape_wanted(board.keypad):
        loop(start(board))


if __name__ == "__main__":
    main()
