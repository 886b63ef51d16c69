# SPDX-License-Identifier: MIT
"""What the judge knows of one address on the line."""

from tools.soaking.judging.facts import ALWAYS, NEVER, OFF1


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
        self.heard_us = NEVER  # the last one that the panel is sure to have taken,
        self.is_told = False  # it may answer a question of what the drive is
        self.contact_us = NEVER  # the first one since power-on, or the lost time before it
        self.asked_us = NEVER  # the last request, if no reply has come to it
        self.missed_us = NEVER  # a request that stayed without a reply, the last one
        self.lost_us = NEVER  # such a one, for the lost time or more after a reply, was over
        self.task = None  # of the first request that stayed without a reply, and how often
        self.tasks = 0
        self.replies = 0  # ever
        self.heard = self.taken = 0  # replies since power-on: for sure, and perhaps
        self.questions = 0  # since then, of what the drive is,
        self.question_us = NEVER  # and the last one
        self.unheard = 0  # requests since power-on, while no reply has come
        self.requests = 0  # ever, and so many of them up to the last reply that the panel is sure
        self.heard_requests = 0  # to have taken, or up to power-on
        self.run_requests = NEVER  # and so many up to the last one with ON or JOG
        self.off_us = NEVER  # it was running by START, and stopped by something else than STOP
        self.ran = False  # since ON was sent first
        self.ran_us = NEVER  # seen running last
        self.rested_us = NEVER  # heard at rest last, in answer to an OFF
        self.turned_us = NEVER  # ON or JOG sent last
        self.highest_hsw = 0  # that the run may have: what UP left, or less
        self.raised_us = NEVER  # UP, or SET after digits, was down for it last
        self.exposed_us = ALWAYS  # so long the motor was to run on without a panel, by its start
        self.reached = False  # HIW has come up to HSW since one of them, or the direction, changed
        self.run_starts = 0  # of its motor, in this run
        self.again_us = NEVER  # it started once more in this run
        self.powered_us = 0  # mains came last
        self.telltale = False  # when they went it had run so long that its counter tells it
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
        self.settings_us = NEVER  # parameters of the drive may have changed last,
        self.settings_at = NEVER  # at so many replies
        self.accepted = False  # somebody said that it may run though nothing watches its line

    def changes(self, now):
        """Its parameters may be others from now on."""
        self.settings_us = now
        self.settings_at = self.replies


def drive_at(world, address):
    """The drive that would answer there now, or None."""
    for drive in world.drives.values():
        if drive.address == address and drive.plugged and drive.powered:
            return drive
