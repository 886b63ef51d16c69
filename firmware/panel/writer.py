# SPDX-License-Identifier: MIT
"""Writes parameters for the panel, one at a time, and tells what became of it.

    writer.write(control, 1000, 0, 5, False)        # into RAM
    writer.step(now)                                # again and again
    writer.take_result(selected)                    # a row to be shown, once, or None

A drive that is to have another address is followed there, after a look whether anybody answers
there already. When the answer to the write is lost, nobody knows where the drive is: it is looked
for at the new address for a while, and then is taken to be at the old one.
"""

from micropython import const

from panel import texts
from uss import pkw, profiles
from uss.timing import elapsed

_LOOK_US = const(2_000_000)  # a drive that may have moved is looked for so long, or
_LOOK_CYCLES = const(3)  # so many rounds of the bus
_PROBES = const(3)  # telegrams after which nobody is there; the first was under way already

_SILENT_MAX = const(3)  # telegrams without an answer, then the other address is tried

_TRIES_MAX = const(3)

IDLE, PROBING, WAITING, WRITING, LOOKING = range(5)


class Writer:
    """bus: the `Master`, its drives added. settings: a `Settings`. mask: the clock's period - 1.

    busy: a write is on its way. written: the last one was confirmed by the drive.
    """

    def __init__(self, bus, settings, mask):
        self.busy = False
        self.written = False
        self._bus = bus
        self._settings = settings
        self._mask = mask
        # A clock of a short period cannot tell more than half of it.
        patience_us = max(_LOOK_US, _LOOK_CYCLES * bus.longest_cycle_us())
        self._patience_us = min(patience_us, mask >> 2)
        self._phase = IDLE
        self._job = pkw.read(0)
        self._control = None
        self._value = 0
        self._eeprom = False
        self._result = None
        self._old_address = 0  # of the drive that is written
        self._since = 0
        self._stops = 0  # drive.stops when it was spoken to at the new address first
        self._telegrams = 0  # to the drive, then
        self._tries = 0
        self._moves = False  # what is written is the drive's address
        self._silent = 0  # drive.silent when it was last spoken to at the other address

    def write(self, control, number, index, value, eeprom):
        """Write a 16-bit value, 0...65535. Why it cannot even be tried, a text, or None."""
        drive = control.drive
        if self.busy or drive.channel.is_full():
            return texts.WRITER_BUSY
        if not drive.contact:
            return texts.NO_CONTACT
        task = pkw.WRITE_WORD_EEPROM if eeprom else pkw.WRITE_WORD
        self._job.aim(task, number, index, 0, value)
        self._control = control
        self._old_address = drive.address
        self._value = value
        self._eeprom = eeprom
        self._tries = 0
        self.busy = True
        self.written = False
        self._moves = (
            number == profiles.USS_ADDRESS
            and index == profiles.COM_LINK
            and value != drive.address
        )
        if self._moves:
            self._phase = PROBING
            control.moving = True
            self._go_to(value)
        else:
            self._ask()
        return None

    def takes(self, address):
        """Whether a drive is just being given this address."""
        return self.busy and self._moves and self._value == address

    def take_result(self, selected):
        """A row that tells how the write ended, once; None otherwise. selected: what is shown."""
        result, self._result = self._result, None
        if result is None or self._control is selected:
            return result
        outcome = texts.OTHER_WRITTEN if self.written else texts.OTHER_NOT_WRITTEN
        return b"A%d%s" % (self._control.drive.address, outcome)

    def step(self, now):
        if self._phase == IDLE:
            return
        if self._phase == WAITING:
            self._ask()
        elif self._phase == PROBING:
            self._probe()
        elif self._phase == LOOKING:
            self._look(now)
        elif self._phase == WRITING:
            if self._job.state != pkw.PENDING:
                self._finish(now)
            elif self._moves:
                self._follow_silence()

    def _ask(self):
        drive = self._control.drive
        if drive.channel.is_full():
            self._phase = WAITING
            return
        self._phase = WRITING
        self._silent = drive.silent
        self._job.aim(self._job.task, self._job.number, self._job.index, 0, self._value)
        drive.ask(self._job)

    def _finish(self, now):
        job = self._job
        if job.state == pkw.REFUSED:
            self._end(refusal(job.error), False)
        elif job.state == pkw.DONE:
            if job.low == self._value:
                self._confirm()
            elif self._tries < _TRIES_MAX:  # that was an old answer to a reading
                self._tries += 1
                self._ask()
            else:
                self._end(texts.NOT_WRITTEN, False)
        elif self._moves and self._control.drive.silent:
            self._phase = LOOKING
            self._since = now
            self._go_to(self._value)
        elif self._moves and self._control.drive.answered_address == self._value:
            self._confirm()
        else:
            self._end(unanswered(job), False)

    def _confirm(self):
        if self._moves:
            self._bus.readdress(self._control.drive, self._value)
            # The panel must look for it there after a restart: it may run by then.
            self._settings.readdress(self._old_address, self._value)
            self._control.moved = True
        self._end(texts.WRITTEN_EEPROM if self._eeprom else texts.WRITTEN, True)

    def _end(self, result, written):
        self._phase = IDLE
        self._control.moving = False
        self.busy = False
        self.written = written
        self._result = result
        # What may have changed by it is read again before anybody relies on it.
        self._control.survey.recheck()

    # --- a drive that moves to another address --------------------------------------------------

    def _go_to(self, address):
        drive = self._control.drive
        self._bus.readdress(drive, address)
        drive.hurry()
        self._stops = drive.stops
        self._telegrams = sum(drive.counters)

    def _probe(self):
        """Nobody may be at the new address: two drives at one would answer at once for ever."""
        drive = self._control.drive
        telegrams = (sum(drive.counters) - self._telegrams) & 0xFFFF
        if drive.stops != self._stops:  # that is for the drive, which is at the old address
            self._give_up_probe(texts.NOT_WRITTEN)
        elif not drive.silent and drive.answered_address == self._value:
            self._give_up_probe(texts.ADDRESS_TAKEN)
        elif telegrams >= _PROBES:
            self._bus.readdress(drive, self._old_address)
            self._ask()
        elif drive.urgent == drive.served:
            drive.hurry()

    def _give_up_probe(self, result):
        self._bus.readdress(self._control.drive, self._old_address)
        self._control.drive.hurry()
        self._end(result, False)

    def _follow_silence(self):
        """A drive that falls silent while it is told its new address may be there already, or not
        have heard of it: it is spoken to at either in turn, and the task with it.
        """
        drive = self._control.drive
        if not drive.silent:
            self._silent = 0
        elif drive.silent >= self._silent + _SILENT_MAX:
            self._silent = drive.silent
            at_new = drive.address == self._value
            self._bus.readdress(drive, self._old_address if at_new else self._value)

    def _look(self, now):
        drive = self._control.drive
        if not drive.silent and drive.answered_address == self._value:
            self._confirm()
        elif elapsed(now, self._since, self._mask) >= self._patience_us:
            self._bus.readdress(drive, self._old_address)
            self._end(texts.NO_ANSWER, False)


def unanswered(job):
    """Words for a task that ended without an answer, at most a row."""
    return texts.NO_REPLY_TO_THIS if job.state == pkw.UNANSWERED else texts.NO_ANSWER


def refusal(error):
    """Words for the error number of a refused task, at most a row."""
    if error == pkw.NO_CHANGE_RIGHTS:
        return texts.NO_RIGHTS
    return texts.REFUSALS.get(error) or texts.OTHER_REFUSAL + b"%d" % error
