# SPDX-License-Identifier: MIT
"""What a drive does, in a word or two: the left part of row 2 on the home page.

In use:

    text(control)                       # texts.RUNNING
    of(texts.RUNS_FOR_EVER, MM3)        # b"RUN, P0093=0"
"""

from panel import texts
from panel.phases import JOGGING
from panel.permits import is_local, tells_no_status
from uss import pzd
from uss.families import rows

# Of a MICROMASTER 4, as the texts have them, by row of the survey.
_NUMBERS = (
    (rows.COMMAND_SOURCE, b"P0700"), (rows.SUPERVISION, b"P2014"), (rows.LOWEST, b"P1080"),
    (rows.STATUS_SENT, b"P2019"),
)  # fmt: skip

# Without contact, by `Drive.trouble`.
_TROUBLES = (
    texts.NO_CONTACT, texts.LINE_NOISE, texts.OTHER_LENGTH, texts.WRONG_DRIVE, texts.WRONG_CHECK,
)  # fmt: skip


def of(text, family):
    """The words of a text about a drive, with the parameter numbers of its family."""
    words = texts.of(text)
    for row, number in _NUMBERS:
        if number in words and family.survey[row] is not None:
            words = words.replace(number, b"P%04d" % family.survey[row][0])
    return words


def text(control):
    """The state in words, at most STATE_WIDTH wide. A motor that turns outranks a notice."""
    drive, survey = control.drive, control.survey
    if not drive.contact:
        return control.desk.defect or _TROUBLES[drive.trouble]
    if tells_no_status(survey):
        return texts.STATUS_UNKNOWN
    state = drive.state()
    if state == pzd.FAULT:
        return texts.FAULT
    if state == pzd.RUNNING:
        return _running(control)
    if control.is_starting():
        return texts.STARTING
    if control.notice:
        return control.notice
    if state == pzd.INHIBITED:
        return texts.INHIBITED
    if not survey.complete:
        return texts.CHECKING
    if is_local(survey):
        return texts.LOCAL
    if control.is_half_written():
        return texts.HALF_SET
    return texts.READY if state == pzd.READY else texts.NOT_READY


def _running(control):
    drive = control.drive
    if not drive.is_on():
        if is_local(control.survey):
            return texts.RUNS_LOCALLY
        return texts.STOPPING
    if drive.wanted == pzd.JOG_RIGHT:
        return texts.JOGS_RIGHT
    if drive.wanted == pzd.JOG_LEFT:
        return texts.JOGS_LEFT
    return remark(control) or texts.RUNNING


def alarm(control):
    """What needs attention of a drive, as a row: of a page that takes both."""
    text = texts.OTHER_UNCONFIRMED if control.stop_watch.unconfirmed else texts.OTHER_LOST
    return b"A%d%s" % (control.drive.address, texts.of(text))


def remark(control):
    """What somebody has changed at a drive that is on, since it was started, or NOTHING."""
    if not control.remark and control.phase != JOGGING and control.setpoint.is_below():
        return texts.RUNS_FASTER
    return control.remark
