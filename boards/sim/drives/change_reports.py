# SPDX-License-Identifier: MIT
"""Change reports of a simulated drive: it tells the master what others have changed.

It knows which report is open, and what bit 11 of PKE has to be (USS specification C-4.2.1.2). It
knows no values; parameter_channel.py makes the words. MICROMASTERs make no reports.

    reports.add(1120, 0)        # somebody has changed P1120
    reports.send()              # (1120, 0), again and again, with `bit` toggled once
    reports.hear(reports.bit)   # the master echoes the bit: the report is over
"""

BIT = 0x0800
WAITING_LIMIT = 16


class Reports:
    """bit   bit 11 of PKE in every reply, as it is now"""

    def __init__(self):
        self.bit = 0
        self._open = None
        self._waiting = []

    def add(self, number, index):
        """Add a report to be sent; one that finds no room is dropped."""
        if len(self._waiting) < WAITING_LIMIT:
            self._waiting.append((number, index))

    def hear(self, bit):
        """Take bit 11 of a request."""
        if bit == self.bit:
            self._open = None

    def send(self):
        """The report that the reply carries, number and index, or None: the reply itself."""
        if self._open is None and self._waiting:
            self._open = self._waiting.pop(0)
            self.bit ^= BIT
        return self._open
