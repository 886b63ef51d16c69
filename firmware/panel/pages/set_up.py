# SPDX-License-Identifier: MIT
"""After a START that was refused because the drive obeys somebody else: writes what it needs.

    A0: P0700=5             in turn with what that means. SET writes this one parameter, any other
    SET=DO  PARAM=NO        key does not. The next START runs the drive, or asks for the next one

What a drive needs stands in the tables `meaning` and `access` of its family.
"""

from panel.pages.question import Question
from uss.families import rows
from uss.pzd import ZSW_RUNNING

# The questions: number, value.
_TO_BE_WRITTEN = b"A%d: P%04d=%d"
_DO_OR_NOT = b"SET=DO  PARAM=NO"
ASK_UNLOCK = ((_TO_BE_WRITTEN, b"PANEL MAY WRITE", b"MORE THEN"), _DO_OR_NOT)
ASK_SET_UP = ((_TO_BE_WRITTEN, b"PANEL COMMANDS", b"THE DRIVE THEN"), _DO_OR_NOT)
ASK_SET_UP_EEPROM = (
    (_TO_BE_WRITTEN, b"INTO ITS EEPROM:", b"PANEL COMMANDS", b"THE DRIVE THEN"),
    _DO_OR_NOT,
)

# Of those that may be wrong: what sets the others, or overrides them.
_SET = (rows.SELECTION, rows.COMMAND_SOURCE, rows.SETPOINT_SOURCE)


def offer(panel):
    """Ask about the drive that is shown, if a parameter would help and its motor stands."""
    control = panel.selected
    wanted = _wanted(control.survey)
    if wanted is not None:
        eeprom = control.survey.family.has_eeprom_tasks
        _ask(panel, ASK_SET_UP_EEPROM if eeprom else ASK_SET_UP, wanted, eeprom)


def unlock(panel):
    """The drive shown has refused a value because its access level is too low: ask about that."""
    access = panel.selected.survey.family.access
    if access is not None:
        _ask(panel, ASK_UNLOCK, (access[0], 0, access[1]), False)


def _ask(panel, text, wanted, eeprom):
    control = panel.selected
    if control.drive.zsw & ZSW_RUNNING or not control.drive.contact:
        return
    number, index, value = wanted

    def write(now_ms):
        if not control.drive.zsw & ZSW_RUNNING:
            panel.write(now_ms, control, number, index, value, eeprom)

    values = (control.drive.address, number, value)
    panel.cover(Question(panel, text, values, {"SET": write}))


def _wanted(survey):
    """Number, index and value of the first parameter that is wrong and can be put right."""
    for subject in (rows.COMMAND, rows.SETPOINT):
        row = survey.wrong[subject]
        if row not in _SET:
            continue
        number = survey.family.survey[row]
        for rule in survey.family.meaning:
            if rule[0] == subject and rule[1] == row:
                value = 0 if row == rows.SELECTION else rule[3][0]
                return number[0], rows.index_of(number, survey.values), value
    return None
