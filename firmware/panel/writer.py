"""Writes parameters for the panel, one at a time, and tells what became of it.

    writer.write(control, 1000, 0, 5, False)        # into RAM
    writer.step(now)                                # each step of the loop
    writer.take_result()                            # a row to be shown, once, or None

A drive whose address is written is followed to the new one. When the answer to that is lost,
nobody knows where the drive is: the new address is tried for a while, then the old one again.
"""

from micropython import const

from panel import texts
from uss import pkw, profiles
from uss.timing import elapsed

TRY_US = const(2_000_000)  # a drive that was moved is looked for at its new address so long


class Writer:
    """bus: the `Master`. settings: a `Settings`. mask: the clock's period - 1.

    busy: a write is on its way. written: the last one was confirmed by the drive.
    """

    def __init__(self, bus, settings, mask):
        self.busy = False
        self.written = False
        self._bus = bus
        self._settings = settings
        self._mask = mask
        self._job = pkw.read(0)
        self._control = None
        self._value = 0
        self._eeprom = False
        self._result = None
        self._trying = False  # the drive is looked for at the address that was written
        self._tried_at = 0
        self._good = 0  # its good answers then
        self._old_address = 0  # of the drive that is written

    def write(self, control, number, index, value, eeprom):
        """Write a 16-bit value, 0...65535. Why it cannot even be tried, a text, or None."""
        drive = control.drive
        if self.busy or drive.channel.is_full():
            return texts.WRITER_BUSY
        if not drive.contact:
            return texts.NO_CONTACT
        task = pkw.WRITE_WORD_EEPROM if eeprom else pkw.WRITE_WORD
        self._job.aim(task, number, index, 0, value)
        drive.ask(self._job)
        self._control = control
        self._old_address = drive.address
        self._value = value
        self._eeprom = eeprom
        self.busy = True
        self.written = False
        return None

    def take_result(self, selected):
        """A row that tells how the write ended, once; None otherwise. selected: what is shown."""
        result, self._result = self._result, None
        if result is None or self._control is selected:
            return result
        outcome = texts.OTHER_WRITTEN if self.written else texts.OTHER_NOT_WRITTEN
        return b"A%d%s" % (self._control.drive.address, outcome)

    def step(self, now):
        if self._trying:
            self._look_for_drive(now)
        elif self.busy and self._job.state != pkw.PENDING:
            self._finish(now)

    def _finish(self, now):
        job = self._job
        moves = job.number == profiles.USS_ADDRESS and job.index == profiles.COM_LINK
        if job.state == pkw.REFUSED:
            self._end(refusal(job.error), False)
        elif job.state == pkw.DONE:
            if moves:
                self._follow()
            self._end(texts.WRITTEN_EEPROM if self._eeprom else texts.WRITTEN, True)
        elif moves and self._control.drive.silent:
            self._try_new_address(now)
        else:
            self._end(texts.NO_ANSWER, False)

    def _end(self, result, written):
        self.busy = False
        self.written = written
        self._result = result
        # What may have changed by it is read again before anybody relies on it.
        self._control.survey.recheck()

    # --- a drive that moves to another address --------------------------------------------------

    def _follow(self):
        """The drive is at its new address, and the panel must look for it there after a restart:
        it may run by then.
        """
        if self._value != self._old_address:
            self._settings.readdress(self._old_address, self._value)
            self._control.moved = True
        self._bus.readdress(self._control.drive, self._value)

    def _try_new_address(self, now):
        drive = self._control.drive
        self._good = drive.counters[0]
        self._tried_at = now
        self._trying = True
        self._bus.readdress(drive, self._value)

    def _look_for_drive(self, now):
        drive = self._control.drive
        if drive.counters[0] != self._good:
            self._trying = False
            self._follow()
            self._end(texts.WRITTEN_EEPROM if self._eeprom else texts.WRITTEN, True)
        elif elapsed(now, self._tried_at, self._mask) >= TRY_US:
            self._trying = False
            self._bus.readdress(drive, self._old_address)
            self._end(texts.NO_ANSWER, False)


def refusal(error):
    """Words for the error number of a refused task, at most a row."""
    if error == pkw.NO_CHANGE_RIGHTS:
        return texts.NO_RIGHTS
    return texts.REFUSALS.get(error) or texts.OTHER_REFUSAL + b"%d" % error
