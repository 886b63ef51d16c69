# SPDX-License-Identifier: MIT
"""A copy of this process tries what would change it, on CPython where there is `os.fork`.

So a test that does many things to a world in one state brings it there once:

    for ms in range(100):
        assert twin(stops_when_the_cable_is_pulled_after, ms, world)
"""

import os
import pickle
import sys
import traceback
from contextlib import suppress

NOTES = "line_notes"  # this module notes the lines that run, if anybody wants to know them


class TwinFailed(AssertionError):
    """The text is the traceback of what a twin has raised."""


def twin(function, *arguments):
    """What the function returns, done by a copy of this process: nothing changes here."""
    positions = _positions()
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        before = _notes() and _notes().state()
        outcome = _outcome(function, arguments)
        with open(writing, "wb") as file:
            file.write(pickle.dumps((*outcome, _notes() and list(_notes().seen(before)))))
        os._exit(0)
    os.close(writing)
    with open(reading, "rb") as file:
        outcome = file.read()
    os.waitpid(child, 0)
    for number, position in positions:
        os.lseek(number, position, os.SEEK_SET)
    if not outcome:
        raise TwinFailed("a copy of the process has died")
    is_good, result, lines = pickle.loads(outcome)
    if lines:
        _notes().add(lines)
    if not is_good:
        raise TwinFailed(result)
    return result


def _outcome(function, arguments):
    """(True, what it returns) or (False, a traceback). Whatever it raises, a twin ends here."""
    try:
        return True, function(*arguments)
    except TwinFailed as error:  # a twin of this twin has
        return False, str(error)
    except BaseException:
        return False, traceback.format_exc()


def _notes():
    """The module by which the lines that run are noted, if anybody does."""
    return sys.modules.get(NOTES)


def _positions():
    """[(number of an open file, where it is read next)]: a process and its twin share that."""
    found = []
    for number in map(int, os.listdir("/dev/fd")):
        if number > 2:
            with suppress(OSError):  # a pipe, or what listed them
                found.append((number, os.lseek(number, 0, os.SEEK_CUR)))
    return found
