# SPDX-License-Identifier: MIT
"""Why a drive may not be started or jogged: the reasons, in the order an operator wants to know.

In use:

    why_not_start(control)              # texts.REFUSED_..., or NOTHING
    why_not_jog(control)
"""

from panel import risks, texts
from panel.phases import JOGGING
from uss import pzd
from uss.families import rows

# Why START is refused where this row of a survey says that somebody else commands the drive,
# tells it its speed, or that its status word is none.
REFUSED_SOURCES = {
    rows.COMMAND_SOURCE: texts.REFUSED_COMMAND,
    rows.SETPOINT_SOURCE: texts.REFUSED_SETPOINT,
    rows.SELECTION: texts.REFUSED_SELECTION,
    rows.ON_SOURCE: texts.REFUSED_ON_SOURCE,
    rows.MAIN_SOURCE: texts.REFUSED_MAIN_SOURCE,
    rows.PID: texts.REFUSED_PID,
    rows.STATUS_SENT: texts.REFUSED_STATUS,
}


def is_local(survey):
    """Whether the drive takes its commands from elsewhere: P0700, P0719, P0840."""
    return survey.wrong[rows.COMMAND] != rows.RIGHT


def is_foreign(survey):
    """Whether its setpoint comes from elsewhere, or from here and elsewhere: P1000 and others."""
    return survey.wrong[rows.SETPOINT] != rows.RIGHT


def tells_no_status(survey):
    """Whether what it sends as ZSW is known to be something else, P2019[0]."""
    return survey.wrong[rows.STATUS] != rows.RIGHT


def why_not_start(control):
    drive, survey = control.drive, control.survey
    if control.phase == JOGGING:
        return texts.REFUSED_JOG
    if drive.off != pzd.OFF1:
        return texts.REFUSED_STOPPING
    state = drive.state()
    reason = _why_no_command(control, state)
    if reason:
        return reason
    if is_foreign(survey):
        return REFUSED_SOURCES[survey.wrong[rows.SETPOINT]]
    if min(survey.lowest(), survey.values[rows.HIGHEST]) > survey.scaling.limit_centihertz():
        return texts.REFUSED_MINIMUM
    return _why_not_now(state)


def why_not_jog(control):
    """JOG has its speed from the drive (P1058, P1059): the source of the setpoint is no matter."""
    drive, survey = control.drive, control.survey
    if drive.off != pzd.OFF1:
        return texts.REFUSED_STOPPING
    state = drive.state()
    reason = _why_no_command(control, state)
    if reason:
        return reason
    if control.is_starting() or state == pzd.RUNNING and not control.own_jog_ends():
        return texts.REFUSED_RUNS
    if risks.is_open(control, risks.SUPERVISION):
        is_long = survey.values[rows.SUPERVISION] > 0
        return texts.REFUSED_LONG if is_long else texts.REFUSED_UNSUPERVISED
    if survey.unchecked:
        return texts.REFUSED_CHECKING  # P2014 may be another by now
    return _why_not_now(state)


def _why_no_command(control, state):
    drive, survey = control.drive, control.survey
    if not drive.contact:
        return texts.REFUSED_SILENT
    if control.moving:
        return texts.WRITER_BUSY
    if control.moved and control.is_unsaved():
        return texts.REFUSED_UNSAVED
    if state == pzd.FAULT:
        return texts.REFUSED_FAULT
    if not survey.complete:
        return texts.REFUSED_SCALING if survey.unreadable else texts.REFUSED_CHECKING
    if tells_no_status(survey):
        return texts.REFUSED_STATUS
    if is_local(survey):
        return REFUSED_SOURCES[survey.wrong[rows.COMMAND]]
    return texts.NOTHING


def _why_not_now(state):
    if state == pzd.INHIBITED:
        return texts.REFUSED_INHIBITED
    if state == pzd.NOT_READY:
        return texts.REFUSED_NOT_READY
    return texts.NOTHING
