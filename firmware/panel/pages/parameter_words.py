# SPDX-License-Identifier: MIT
"""The texts of the parameter page and of what writes, in memory only while one of them is at work.

See `panel.texts`.
"""

from panel import texts
from uss import pkw

# In front of a value, PARAMETER_WIDTH wide, and in place of one, VALUE_WIDTH wide.
PARAMETER = b"P    :"  # with its number
READ_PARAMETER = b"r    :"
PARAMETER_WIDTH = 6
REFUSED_VALUE = b" -----"  # the drive does not tell it

NO_PARAMETERS = b"NO PARAMETERS"  # the drive has no parameter channel, or nobody knows any
EDIT_FIRST = b"PRESS EDIT FIRST"
READ_ONLY = b"READ ONLY"
NOT_READ_YET = b"NOT READ YET"
ADDRESS_TAKEN = b"ADDRESS IS TAKEN"  # by another drive of this panel
WRITTEN = b"WRITTEN (RAM)"
WRITTEN_EEPROM = b"WRITTEN (EEPROM)"
NO_ANSWER = b"NO ANSWER"
NO_REPLY_TO_IT = b"NO REPLY TO IT"  # the drive answers, but falls silent on this task
NOT_WRITTEN = b"NOT WRITTEN"

# What became of a write to a drive that is not shown any more.
OTHER_WRITTEN = b"A%d: WRITTEN"
OTHER_NOT_WRITTEN = b"A%d: NOT WRITTEN"

# Why a drive refused a parameter task, by the error number of its reply (specification table 4.9,
# and what drives add to it). NO_RIGHTS is reply 8, which carries no number.
NO_RIGHTS = b"NO WRITE RIGHTS"
REFUSALS = {
    0: b"NO SUCH PARAM.",
    1: b"READ ONLY",
    2: b"BEYOND LIMITS",
    3: b"NO SUCH INDEX",
    4: b"NOT AN ARRAY",
    5: b"WRONG DATA TYPE",
    6: b"MAY ONLY BE 0",
    7: b"NOT CHANGEABLE",
    11: NO_RIGHTS,
    12: b"KEYWORD MISSING",
    17: b"MODE FORBIDS IT",  # most often: not while it runs
    18: b"DRIVE ERROR",
    20: b"ILLEGAL VALUE",
    101: b"INACTIVE NOW",
    102: b"REPLY TOO LONG",
    103: b"BAD PKW LENGTH",
    104: b"NOT THIS VALUE",
    105: b"IS AN ARRAY",
    106: b"TASK UNKNOWN",
    107: b"TEXT IS FIXED",
    200: b"BELOW LIMIT NOW",
    201: b"ABOVE LIMIT NOW",
    204: texts.ACCESS_TOO_LOW,
}
OTHER_REFUSAL = b"REFUSED: %d"


def failure(job):
    """Why a job was not done: a text and the values in it."""
    if job.state == pkw.UNANSWERED:
        return (NO_REPLY_TO_IT,)
    if job.state != pkw.REFUSED:
        return (NO_ANSWER,)
    if job.error == pkw.NO_CHANGE_RIGHTS:
        return (NO_RIGHTS,)
    if job.error in REFUSALS:
        return (REFUSALS[job.error],)
    return OTHER_REFUSAL, job.error
