# SPDX-License-Identifier: MIT
"""Parameters of a drive that somebody else has changed, as it reports them (replies 9...12).

The drive sends a report instead of an answer; the master acknowledges it by sending bit 11 of its
PKE back (specification C-4.2.1.2). A drive reports only if it is set up to; no MICROMASTER, G110
or V20 does. Jobs go on as usual.

    reports = Reports(drive.channel)
    report = reports.get()              # the oldest, or None
    if report: print(report.number, report.integer_value())
"""

from array import array

from micropython import const

from uss import pkw

REPORT, REPORT_DOUBLE, REPORT_ELEMENT, REPORT_ELEMENT_DOUBLE = range(9, 13)  # AK
REPORTS_MAX = const(8)  # so many may wait; a power of two

_FIELDS = const(5)  # of a report in the ring: PKE, IND, width, high word, low word
_TOGGLE = const(0x08)  # bit 11 of PKE


class Report:
    """A parameter that somebody else has changed.

    number, index: of the parameter; index pkw.ALL is the whole array. width: pkw.WORD or
    pkw.DOUBLE, with the value as in a `Job`; or 0 if the report has no value, as for a whole
    array: then read the parameter.
    """

    def __init__(self, words):
        self.number = (words[0] & 0x07FF) + pkw.PNU_PER_PAGE * page_of(words[1])
        self.index = words[1] & 0xFF
        self.width = words[2]
        self.high = words[3]
        self.low = words[4]

    integer_value = pkw.Job.integer_value
    signed_value = pkw.Job.signed_value
    float_value = pkw.Job.float_value


class Reports:
    """Takes the change reports of a drive, and acknowledges each by sending its bit 11 back.

    channel: the drive's. RuntimeError if it has no PKW words. As long as REPORTS_MAX wait, the
    next report is not acknowledged: the drive repeats it, and answers no task before. `close` ends
    it.

    The loop writes _out, the engine everything else.
    """

    def __init__(self, channel):
        self.bit = 0  # for the first character of PKE
        self._known = False  # a reply has said what the bit is
        self._ring = array("H", [0] * (_FIELDS * REPORTS_MAX))
        self._in = 0
        self._out = 0
        self._channel = channel
        channel.follow(self)

    def get(self):
        """Take the oldest `Report` that waits; None if there is none."""
        out = self._out
        if out == self._in:
            return None
        at = out % REPORTS_MAX * _FIELDS
        report = Report(self._ring[at : at + _FIELDS])
        self._out = (out + 1) % (2 * REPORTS_MAX)
        return report

    def close(self):
        """Stop following reports."""
        self._channel.follow(None)

    # --- for the engine: allocates nothing ------------------------------------------------------

    def take(self, net, at, count, form):
        """Look at the PKW words of a reply, `count` characters in `net` from index `at` on."""
        bit = net[at] & _TOGGLE
        if REPORT <= net[at] >> 4 <= REPORT_ELEMENT_DOUBLE:
            # The drive repeats a report with the same bit until that bit comes back to it.
            if self._known and bit == self.bit:
                return
            if (self._in - self._out) % (2 * REPORTS_MAX) == REPORTS_MAX:
                return
            self._keep(net, at, count, form)
        self.bit = bit  # other replies carry the bit that was acknowledged last
        self._known = True

    def _keep(self, net, at, count, form):
        wide = not net[at] >> 4 & 1  # AK 10 and 12
        low_at = at + 6 if wide or form == pkw.FOUR_WORDS else at + 4
        ring = self._ring
        to = self._in % REPORTS_MAX * _FIELDS
        ring[to] = net[at] << 8 | net[at + 1]
        ring[to + 1] = net[at + 2] << 8 | net[at + 3]
        if net[at + 3] == pkw.ALL or wide and count < pkw.FOUR_WORDS:
            ring[to + 2] = ring[to + 3] = ring[to + 4] = 0
        else:
            ring[to + 2] = pkw.DOUBLE if wide else pkw.WORD
            ring[to + 3] = net[at + 4] << 8 | net[at + 5] if wide else 0
            ring[to + 4] = net[low_at] << 8 | net[low_at + 1]
        self._in = (self._in + 1) % (2 * REPORTS_MAX)


def page_of(ind):
    """The page of 2000 numbers that an IND word names; see `pkw.ind`."""
    return ind >> 15 & 0x01 | ind >> 11 & 0x0E | ind >> 6 & 0x30
