# SPDX-License-Identifier: MIT
"""What the judge knows of one address on the line, and what its drive lets a setpoint be."""

from tools.soaking.facts import NEVER, OFF1


class Case:
    """What is known of one address on the line."""

    def __init__(self):
        self.start_us = NEVER  # START pressed for it
        self.used_us = NEVER  # the START that the ON in force goes back to
        self.void_us = NEVER  # STARTs up to here do not count any more
        self.on_us = NEVER  # first telegram of the ON or JOG in force
        self.stw = OFF1  # sent last, without an acknowledgement
        self.hsw = 0
        self.sent_us = NEVER
        self.zsw = 0  # of the last whole reply
        self.answered_us = NEVER  # the end of that
        self.heard_us = NEVER  # the last one that the panel is sure to have taken
        self.asked_us = NEVER  # the last request, if no reply has come to it
        self.missed_us = NEVER  # a request that stayed without a reply, the last one
        self.ran = False  # since ON was sent first
        self.ran_us = NEVER  # seen running last
        self.turned_us = NEVER  # ON or JOG sent last
        self.stop_us = NEVER  # STOP pressed for it last
        self.owed_us = NEVER  # STOP pressed, and no OFF sent since
        self.owed_requests = 0  # to whomever, since that must have had its effect
        self.brakes = False  # it was to stop already when STOP was pressed
        self.jog_us = NEVER  # when the key was pressed whose jog is in force
        self.jog_void_us = NEVER  # jog keys pressed up to here do not count any more
        self.excused_us = NEVER  # until when an OFF needs no other reason
        self.acknowledge_us = NEVER  # STOP that may acknowledge
        self.second_us = NEVER  # OFF2 or OFF3 sent last
        self.second_since_us = NEVER  # sent first, of those without another word between
        self.bad_us = NEVER  # a status word that forbids a START, and that the panel has taken
        self.good_us = NEVER  # one that does not
        self.settings_us = NEVER  # parameters of the drive may have changed last
        self.accepted = False  # somebody said that it may run though nothing watches its line


def drive_at(world, address):
    """The drive that would answer there now, or None."""
    for drive in world.drives.values():
        if drive.address == address and drive.plugged and drive.powered:
            return drive


class Limits:
    """What a drive lets a setpoint be: P1080, P1082, P2000, and whether PZD2 is in 0.01 Hz."""

    def __init__(self, lowest_hz, highest_hz, reference_hz, absolute):
        self.lowest_hz = lowest_hz
        self.highest_hz = highest_hz
        self.reference_hz = reference_hz
        self.absolute = absolute

    def hz(self, hsw):
        return hsw / 100 if self.absolute else hsw * self.reference_hz / 0x4000

    def allow(self, hsw, settings):
        if hsw & 0x8000:
            return False
        hz = self.hz(hsw)
        highest_hz = min(self.highest_hz, settings.get("highest_centihertz", 65000) / 100)
        lowest_hz = max(self.lowest_hz, settings.get("lowest_centihertz", 0) / 100)
        full_hz = 327.67 if self.absolute else 1.99994 * self.reference_hz
        highest_hz = min(highest_hz, full_hz)
        lowest_hz = min(lowest_hz, highest_hz)
        slack_hz = 0.006 + self.reference_hz / 0x4000
        return lowest_hz - slack_hz <= hz <= highest_hz + slack_hz


def limits_of(drive):
    try:
        absolute = bool(drive.read(2009))
    except KeyError:
        absolute = False
    try:
        return Limits(drive.read(1080), drive.read(1082), drive.read(2000), absolute)
    except KeyError:
        return Limits(0, 650, 50, False)
