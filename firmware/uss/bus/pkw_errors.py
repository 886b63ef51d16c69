# SPDX-License-Identifier: MIT
"""Words for the error numbers of the parameter channel (reply 7). The panel has its own, shorter.

In use:

    error_text(job.error)               # of a job that was REFUSED
"""

from uss.pkw import NO_CHANGE_RIGHTS

# Numbers up to 7 are from the specification (table 4.9), up to 100 from the PROFIBUS profile.
# Above that each drive has its own (MICROMASTER, V20, MASTERDRIVES, SIMOREG).
ERRORS = (
    (0, "no such parameter"),
    (1, "read-only parameter"),
    (2, "beyond the limits"),
    (3, "no such index"),
    (4, "not an array"),
    (5, "wrong data type"),
    (6, "may only be reset"),
    (7, "description not changeable"),
    (8, "not to be written in this telegram"),
    (9, "no description"),
    (10, "wrong access group"),
    (11, "no change rights"),
    (12, "key word missing"),
    (13, "text not readable here"),
    (14, "name not readable here"),
    (15, "no text array"),
    (16, "telegram cannot write"),
    (17, "not in this operating state"),
    (18, "other error"),
    (20, "value not allowed"),
    (21, "answer too long"),
    (22, "parameter address invalid"),
    (23, "format invalid"),
    (24, "number of values inconsistent"),
    (101, "parameter inactive"),
    (102, "channel too small"),
    (103, "wrong number of PKW words"),
    (104, "value not permitted"),
    (105, "parameter is indexed"),
    (106, "task not implemented"),
    (107, "text not changeable"),
    (108, "wrong number of values"),
    (200, "below the limit in operation"),
    (201, "above the limit in operation"),
    (204, "access level too low"),
)


def error_text(number):
    """Words for an error number of reply 7, or for NO_CHANGE_RIGHTS."""
    for row, text in ERRORS:
        if row == number:
            return text
    return "no change rights" if number == NO_CHANGE_RIGHTS else "error %d" % number
