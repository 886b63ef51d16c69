# SPDX-License-Identifier: MIT
"""What the engine was told last: whether the program has taken ON back from a drive, and which
addresses its drives have left.

The only thing that the judge has from the firmware. Nobody else can tell whether a telegram began
before or after it: a telegram too much lasts a few milliseconds, which keys, motors and display do
not show.
"""

NODES = 32


class Withdrawn:
    """Notes from now on what is said to drives of the class `drive_class`, on the tape too.

    flags: by address, whether ON was taken back since the last START. left: by address, whether a
    drive was here and is somewhere else now.
    """

    def __init__(self, drive_class, tape, clock):
        self.flags = tape.withdrawn_now
        self.left = tape.left_now
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

    def moved(self, old, new):
        self.left[old] = 1
        self.left[new] = 0

    def made(self, address):
        self.left[address] = 0


def _listen(drive_class, noted_by):
    start, stop, revoke = drive_class.start, drive_class.stop, drive_class.revoke
    make, move = drive_class.__init__, drive_class.move

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

    def noted_make(drive, address, *others):
        make(drive, address, *others)
        noted_by[0].made(address)

    def noted_move(drive, address):
        old = drive.address
        move(drive, address)
        noted_by[0].moved(old, address)

    drive_class.start, drive_class.stop, drive_class.revoke = noted_start, noted_stop, noted_revoke
    drive_class.__init__, drive_class.move = noted_make, noted_move
