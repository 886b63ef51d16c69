# SPDX-License-Identifier: MIT
"""The panel's keys for whoever presses them: their letters on a keyboard, and which turn a motor.

Both sides import it, on MicroPython and on CPython.
"""

STOP = "STOP"

# Letter: the key that it taps; the capital holds it. In the order in which a legend shows them.
# A panel has either all functions as keys of their own, or the last three keys for the rest.
LETTERS = (
    ("s", "START"),
    ("t", STOP),
    ("r", "REVERSE"),
    ("l", "JOG_RIGHT"),
    ("j", "JOG_LEFT"),
    ("u", "UP"),
    ("d", "DOWN"),
    ("a", "ADDRESS_UP"),
    ("z", "ADDRESS_DOWN"),
    ("p", "PARAM"),
    ("n", "NEXT"),
    ("b", "PREVIOUS"),
    ("e", "EDIT"),
    ("w", "SET"),
    ("j", "JOG"),
    ("p", "P"),
    ("f", "FN"),
)
JOGS = ("JOG_RIGHT", "JOG_LEFT", "JOG")
STARTERS = ("START",) + JOGS  # what turns a motor
ARM = "g"  # typed before each of these on a real line
