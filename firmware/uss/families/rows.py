# SPDX-License-Identifier: MIT
"""What must be known of a drive before a motor may turn: the words for it, and how it is judged.

A family says in `survey` which parameter stands in which row, and in `meaning` which values are
right. Panel and library read the one and judge by the other, with the same function.

    number, index, kind, missing = family.survey[REFERENCE]
    index_of(family.survey[REFERENCE], values)  # the index of the data set that is active
    wrong_rows(family.meaning, values)[COMMAND] # the row by which somebody else commands, or RIGHT
"""

from micropython import const

# Rows of a survey. A drive has a command data set and a drive data set that are active.
COMMAND_SOURCE, SETPOINT_SOURCE, REFERENCE, ABSOLUTE, LOWEST, HIGHEST, SUPERVISION = range(7)
RESTART, COUNTER, COMMAND_SET, DRIVE_SET = range(7, 11)
STATUS_SENT, ACTUAL_SENT, SELECTION, ON_SOURCE, MAIN_SOURCE, PID = range(11, 17)
COUNT_OF_ROWS = const(17)

# How the value of a row is to be read.
# WORD: as it is. CENTIHERTZ: a floating-point frequency; the panel keeps it in 0.01 Hz. RPM: a
# floating-point speed in 1/min. STEPS: a frequency in 0.1 Hz, or in 0.01 Hz when the row ABSOLUTE
# is not 0. SOURCE: a connector, as `source` makes it. COUNT: a counter of 16 bits that wraps.
WORD, CENTIHERTZ, RPM, STEPS, SOURCE, COUNT = range(6)

# In place of an index: that of the command data set, or of the drive data set, that is active.
BY_COMMAND_SET, BY_DRIVE_SET = -1, -2

# What the rules of `meaning` are about: who commands, whence the setpoint comes, whether PZD1 is
# the status word, whether PZD2 is the actual frequency.
COMMAND, SETPOINT, STATUS, ACTUAL = range(4)
ALL_DIGITS = const(0)

UNKNOWN = const(-1)  # in place of a value
RIGHT = const(-1)  # in place of a row: none is wrong
NOTHING_WRONG = (RIGHT,) * 4


def source(number, index=0):
    """The value of a connector, P0840 = 2036:0 for one: what it is connected with."""
    return number << 16 | index


def index_of(row, values):
    """The index by which a row of a survey is asked for, as far as the active sets are known."""
    index = row[1]
    if index >= 0:
        return index
    return max(values[DRIVE_SET if index == BY_DRIVE_SET else COMMAND_SET], 0)


def wrong_rows(meaning, values):
    """For each subject the first row whose value is known and wrong, or RIGHT.

    values: for each row of the survey, UNKNOWN where nobody knows it.
    """
    wrong = NOTHING_WRONG
    selection = max(values[SELECTION], 0)
    for subject, row, place, right, digit in meaning:
        value = values[row]
        if value == UNKNOWN or wrong[subject] != RIGHT or digit and selection // digit % 10:
            continue
        if (value // place % 10 if place else value) not in right:
            if wrong is NOTHING_WRONG:
                wrong = list(wrong)
            wrong[subject] = row
    return wrong
