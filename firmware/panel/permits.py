# SPDX-License-Identifier: MIT
"""Why a drive may not be started or jogged: the reasons, in the order an operator wants to know.

In use:

    why_not_start(control)              # texts.REFUSED_..., or NOTHING
    why_not_jog(control)
    is_about_source(refusal)            # whether one of these says that it obeys somebody else
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


def is_about_source(refusal):
    """Whether a parameter of the drive would take away this reason, one of REFUSED_SOURCES."""
    return refusal in REFUSED_SOURCES.values()


def is_local(survey):
    """Whether the drive takes its commands from elsewhere: P0700, P0719, P0840."""
    return survey.wrong[rows.COMMAND] != rows.RIGHT


def is_foreign(survey):
    """Whether its setpoint comes from elsewhere, or from here and elsewhere: P1000 and others."""
    return survey.wrong[rows.SETPOINT] != rows.RIGHT


def tells_no_status(survey):
    """Whether what it sends as ZSW is known to be something else, P2019[0]."""
    return survey.wrong[rows.STATUS] != rows.RIGHT


# And where the drive itself is not ready for ON.
_REFUSED_STATES = {
    pzd.INHIBITED: texts.REFUSED_INHIBITED,
    pzd.NOT_READY: texts.REFUSED_NOT_READY,
}


def why_not_start(control):
    if control.phase == JOGGING:
        return texts.REFUSED_JOG
    return _why_not(control, _why_no_start)


def why_not_jog(control):
    """JOG has its speed from the drive (P1058, P1059): the source of the setpoint is no matter."""
    return _why_not(control, _why_no_jog)


def _why_not(control, why_not_this):
    """why_not_this: asks about START or JOG alone."""
    drive, survey = control.drive, control.survey
    state = drive.state()
    if drive.off != pzd.OFF1:
        return texts.REFUSED_STOPPING
    if control.desk.defect:
        return control.desk.defect
    if not drive.contact:
        return texts.REFUSED_SILENT
    if control.moving:
        return texts.WRITER_BUSY
    if control.is_half_written():
        return texts.REFUSED_HALF_SET
    if control.is_unsaved():
        return texts.REFUSED_UNSAVED
    if state == pzd.FAULT:
        return texts.REFUSED_FAULT
    if not survey.complete:
        return texts.REFUSED_SCALING if survey.unreadable else texts.REFUSED_CHECKING
    if tells_no_status(survey):
        return texts.REFUSED_STATUS
    if is_local(survey):
        return REFUSED_SOURCES[survey.wrong[rows.COMMAND]]
    return why_not_this(control, state) or _REFUSED_STATES.get(state, texts.NOTHING)


def _why_no_start(control, state):
    survey = control.survey
    if is_foreign(survey):
        return REFUSED_SOURCES[survey.wrong[rows.SETPOINT]]
    if min(survey.lowest(), survey.own_highest()) > survey.scaling.limit_centihertz():
        return texts.REFUSED_MINIMUM
    return texts.NOTHING


def _why_no_jog(control, state):
    if not control.survey.family.jog_right:
        return texts.REFUSED_NO_JOG
    if control.is_starting() or state == pzd.RUNNING and not control.own_jog_ends():
        return texts.REFUSED_RUNS
    if risks.is_open(control, risks.SUPERVISION):
        is_long = control.survey.values[rows.SUPERVISION] > 0
        return texts.REFUSED_LONG if is_long else texts.REFUSED_UNSUPERVISED
    if control.survey.unchecked:
        return texts.REFUSED_CHECKING  # P2014 may be another by now
    return texts.NOTHING
