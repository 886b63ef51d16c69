# SPDX-License-Identifier: MIT
"""The blocks for parameters of the S7-200's USS library: USS_RPM_W/D/R, USS_WPM_W/D/R.

W: a word; D: a double word; R: floating point. RPM reads, WPM writes. A part of `s7`, which has
the port that they share; only one of them at a time works there.

    frequency = USS_RPM_R(port)
    frequency(EN=True, XMT_REQ=button(), DRIVE=1, PARAM=21)     # once a scan, until DONE
    if frequency.DONE and not frequency.ERROR: print(frequency.VALUE)
"""

from uss import pkw
from uss.s7 import codes
from uss.tasks import arrays

FLOAT_MAX = 3.4028235e38  # the largest number of a REAL


class Block:
    """What every block has.

    ERROR: a code of `codes`. STATUS_WORD: that of the S7-1200.
    """

    ERROR = codes.NO_ERROR
    STATUS_WORD = codes.word(codes.NO_ERROR)

    def _tell(self, code, word=None):
        self.ERROR = code
        self.STATUS_WORD = word or codes.word(code)


class Parameter(Block):
    """What the blocks for parameters share. Only one of them at a time works on a port.

    EN: on until DONE. XMT_REQ: makes one request each time that it and EN become on; another edge
    makes none while a request goes on. DRIVE: 0...31. PARAM: 0...127999; INDEX: 0...254.

    DONE: the request is over; stays on until the next one. ERROR: a code of `codes`; STATUS_WORD:
    that of the S7-1200. PKW_ERROR: with PARAMETER_REPLY the number with which the drive refused,
    see `pkw_errors.error_text`; else None.
    """

    width = pkw.WORD

    def __init__(self, port):
        self.DONE = False
        self.PKW_ERROR = None
        self._port = port
        self._was_requested = False
        self._job = None
        self._drive = None
        self._counters = None  # the drive's, when it was asked

    def _serve(self, enabled, request, address, number, index, value=None, eeprom=False):
        rises = enabled and request and not self._was_requested
        self._was_requested = bool(enabled and request)
        if not enabled:
            return
        if self._job is not None:
            if not self._port.is_waiting_for(self._job):
                self._finish()
        elif rises:
            self._request(address, number, index, value, eeprom)

    def _request(self, address, number, index, value, eeprom):
        self.DONE = False
        self.PKW_ERROR = None
        port = self._port
        refusal = port.refusal(address)
        if refusal:
            self._end(refusal)
        elif port.is_busy():
            self._end(codes.PORT_BUSY)
        elif not _is_parameter(number, index):
            self._end(codes.PARAMETER_NUMBER)
        elif eeprom and not port.families[address].has_eeprom_tasks:
            self._end(codes.ILLEGAL_COMMAND)
        elif not port.drives[address].layout.pkw_words:
            self._end(codes.ILLEGAL_COMMAND)
        else:
            self._ask(port.drives[address], number, index, value, eeprom)

    def _ask(self, drive, number, index, value, eeprom):
        try:
            job = self._make_job(number, index, value, eeprom)
            arrays.with_array_task(job, self._port.families[drive.address])
        except (ValueError, TypeError, OverflowError):
            self._end(codes.ILLEGAL_COMMAND, codes.WRONG_VALUE_TYPE)
            return
        try:
            self._port.ask(drive, job)
        except RuntimeError:  # the drive's queue is full, but not by these blocks
            self._end(codes.PORT_BUSY)
            return
        self._job = job
        self._drive = drive
        self._counters = list(drive.counters)
        self._tell(codes.NO_ERROR)

    def _finish(self):
        job = self._job
        drive = self._drive
        self._job = self._drive = None
        reply_code = codes.NO_ERROR
        if job.state == pkw.PENDING:
            self._end(codes.PORT_NOT_USS)
            return
        if drive.silent:
            reply_code = codes.of_reply(drive.counters, self._counters)
        code = codes.of_job(job, self.width, reply_code)
        if job.state == pkw.REFUSED:
            self.PKW_ERROR = job.error
        if code == codes.NO_ERROR:
            self._take(job)
        self._end(code, codes.word_of_job(job, code))

    def _end(self, code, word=None):
        self._tell(code, word)
        self.DONE = True

    def _make_job(self, number, index, value, eeprom):
        return pkw.read(number, index)

    def _take(self, job):
        """Keep the value that was confirmed."""


def _is_parameter(number, index):
    is_number = isinstance(number, int) and 0 <= number <= pkw.NUMBER_MAX
    return is_number and isinstance(index, int) and 0 <= index <= pkw.INDEX_MAX


class USS_RPM_W(Parameter):
    """Reads a parameter of 16 bits. VALUE: 0...65535, by the last DONE without ERROR."""

    def __init__(self, port):
        super().__init__(port)
        self.VALUE = 0

    def __call__(self, EN=True, XMT_REQ=False, DRIVE=0, PARAM=0, INDEX=0):
        self._serve(EN, XMT_REQ, DRIVE, PARAM, INDEX)

    def _take(self, job):
        self.VALUE = job.integer_value()


class USS_RPM_D(USS_RPM_W):
    """Reads a parameter of 32 bits. VALUE: 0...2**32 - 1."""

    width = pkw.DOUBLE


class USS_RPM_R(USS_RPM_W):
    """Reads a floating-point parameter. VALUE: a float."""

    width = pkw.DOUBLE

    def _take(self, job):
        self.VALUE = job.float_value()


class USS_WPM_W(Parameter):
    """Writes a parameter of 16 bits. VALUE: -32768...65535.

    EEPROM: write to EEPROM, not to RAM alone; not with TYPE 0.
    """

    def __call__(self, EN=True, XMT_REQ=False, EEPROM=False, DRIVE=0, PARAM=0, INDEX=0, VALUE=0):
        self._serve(EN, XMT_REQ, DRIVE, PARAM, INDEX, VALUE, EEPROM)

    def _make_job(self, number, index, value, eeprom):
        return pkw.write_word(number, value, index, eeprom)


class USS_WPM_D(USS_WPM_W):
    """Writes a parameter of 32 bits. VALUE: -2**31...2**32 - 1."""

    width = pkw.DOUBLE

    def _make_job(self, number, index, value, eeprom):
        return pkw.write_double(number, value, index, eeprom)


class USS_WPM_R(USS_WPM_W):
    """Writes a floating-point parameter. VALUE: a finite number."""

    width = pkw.DOUBLE

    def _make_job(self, number, index, value, eeprom):
        if not -FLOAT_MAX <= value <= FLOAT_MAX:  # true of a NaN too
            raise ValueError("%r for a parameter" % (value,))
        return pkw.write_float(number, value, index, eeprom)
