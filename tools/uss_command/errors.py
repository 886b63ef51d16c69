# SPDX-License-Identifier: MIT
"""Why a command did not do what it was asked for."""

DONE, FAILED, NOT_UNDERSTOOD, NO_PORT, INTERRUPTED = 0, 1, 2, 5, 130  # exit status


class Failure(Exception):
    """The text says it in one line."""

    status = FAILED


class Misused(Failure):
    """What was asked for makes no sense."""

    status = NOT_UNDERSTOOD
