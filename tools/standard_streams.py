"""What a program should know of the three streams that it was started with.

    open_missing()              # before anything else is opened
    is_ours(0)                  # whether we may read, and are not stopped for it
    has_room(1)                 # whether a line can be written without waiting

Streams are named by their numbers. On CPython, where there are terminals and jobs.
"""

import os
import select


def open_missing():
    """Lead a closed stream to nowhere; or the next file that is opened takes its number."""
    for number, how in ((0, os.O_RDONLY), (1, os.O_WRONLY), (2, os.O_WRONLY)):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, how), True)  # the lowest number that is free


def is_ours(number):
    """Whether we may read: not a terminal in which another program is in the foreground."""
    try:
        return not os.isatty(number) or os.tcgetpgrp(number) == os.getpgrp()
    except OSError:
        return True  # the terminal has gone: reading tells


def has_room(number):
    """Whether a line can be written without waiting for whoever reads."""
    return bool(select.select((), (number,), (), 0)[1])
