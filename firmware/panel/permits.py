# SPDX-License-Identifier: MIT
"""Why a drive may not be started or jogged: the reasons, in the order an operator wants to know.

    why_not_start(control)              # None, or texts.REFUSED_...
    why_not_jog(control)
"""

from panel import texts
from uss import profiles, pzd


def is_foreign(survey, source):
    """Whether a source is known and is not this bus. source: row of profiles.SURVEY."""
    value = survey.values[source]
    return value >= 0 and value != profiles.USS_ON_COM_LINK


def is_local(survey):
    """Whether the drive takes its commands from elsewhere, P0700."""
    return is_foreign(survey, profiles.COMMAND_SOURCE)


def is_unsupervised(survey):
    """Whether the drive runs on for ever when telegrams stay away, P2014 = 0."""
    return survey.values[profiles.SUPERVISION] == 0


def why_not_start(control):
    drive, survey = control.drive, control.survey
    if control.jogging:
        return texts.REFUSED_JOG
    if drive.off != pzd.OFF1:
        return texts.REFUSED_STOPPING
    state = drive.state()
    reason = _why_no_command(control, state)
    if reason is not None:
        return reason
    if is_foreign(survey, profiles.SETPOINT_SOURCE):
        return texts.REFUSED_SETPOINT
    if min(survey.lowest(), survey.values[profiles.HIGHEST]) > survey.scaling.limit_centihertz():
        return texts.REFUSED_MINIMUM
    return _why_not_now(state)


def why_not_jog(control):
    """JOG has its speed from the drive (P1058, P1059): the source of the setpoint is no matter."""
    drive, survey = control.drive, control.survey
    if drive.off != pzd.OFF1:
        return texts.REFUSED_STOPPING
    state = drive.state()
    reason = _why_no_command(control, state)
    if reason is not None:
        return reason
    if control.is_starting() or state == pzd.RUNNING and not control.own_jog_ends():
        return texts.REFUSED_RUNS
    if is_unsupervised(survey) and not control.accepts_unsupervised():
        return texts.REFUSED_UNSUPERVISED
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
    if is_foreign(survey, profiles.COMMAND_SOURCE):
        return texts.REFUSED_COMMAND
    return None


def _why_not_now(state):
    if state == pzd.INHIBITED:
        return texts.REFUSED_INHIBITED
    if state == pzd.NOT_READY:
        return texts.REFUSED_NOT_READY
    return None
