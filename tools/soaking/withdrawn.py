# SPDX-License-Identifier: MIT
"""Whether the program has taken ON back from a drive: what the engine was told last.

The only thing that the judge has from the firmware. Nobody else can tell whether a telegram with
ON began before or after it: a telegram too much lasts a few milliseconds, which keys, motors and
display do not show.
"""

NODES = 32


class Withdrawn:
    """Notes from now on what is said to drives of the class `drive_class`, on the tape too.

    flags: by address, whether ON was taken back since the last START.
    """

    def __init__(self, drive_class, tape, clock):
        self.flags = tape.withdrawn_now
        self._tape = tape
        self._clock = clock
        known = getattr(drive_class, "noted_by", None)
        if known is None:
            drive_class.noted_by = known = [self]
            _listen(drive_class, known)
        known[0] = self  # of an earlier world nobody asks any more

    def stopped(self, address):
        self.flags[address] = 1

    def started(self, address):
        self.flags[address] = 0

    def revoked(self, address):
        """The engine has taken ON back, because of a reply or because the loop is dead. What went
        out in the same instant went out too late.
        """
        self.flags[address] = 1
        self._tape.too_late(address, self._clock.now_us)


def _listen(drive_class, noted_by):
    start, stop, revoke = drive_class.start, drive_class.stop, drive_class.revoke

    def noted_start(drive, *arguments):
        noted_by[0].started(drive.address)
        start(drive, *arguments)

    def noted_stop(drive, *arguments):
        stop(drive, *arguments)
        noted_by[0].stopped(drive.address)

    def noted_revoke(drive):
        was_on = drive.is_on()
        revoke(drive)
        if was_on:
            noted_by[0].revoked(drive.address)

    drive_class.start, drive_class.stop, drive_class.revoke = noted_start, noted_stop, noted_revoke
