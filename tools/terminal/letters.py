# SPDX-License-Identifier: MIT
"""Which stroke is which key of the panel, and what else a stroke does."""

from tools.live.keys import LETTERS, STOP

ARROWS = (("space", STOP), ("up", "UP"), ("down", "DOWN"), ("right", "NEXT"), ("left", "PREVIOUS"))
COMMAND, SETPOINT, HELP, PAUSE, HEX, QUIT = ":", "=", "?", "v", "x", "q"


def keys_of(names):
    """Stroke (a letter, or a name of Textual's): key, for a panel that has these keys."""
    return {stroke: key for stroke, key in LETTERS + ARROWS if key in names}
