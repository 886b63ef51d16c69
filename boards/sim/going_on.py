# SPDX-License-Identifier: MIT
"""The virtual board's link, which goes on by itself as that of the RP2040 does: the optional part
of the contract `link` of `hal`, in plain Python."""

from hal.link.rs485 import Rs485Link


class GoingOnLink(Rs485Link):
    """Arguments: those of `Rs485Link`."""

    goes_on = True

    def __init__(self, *arguments, **options):
        self._expected = (
            0  # characters of the reply after which the telegram is to go out; 0: none
        )
        self._taken = 0  # characters of a reply that stand where they belong already
        self._went_on = False
        self._next = bytearray(256)
        self._next_count = 0
        self._request = b""
        self._after_us = 0
        Rs485Link.__init__(self, *arguments, **options)

    def instruct(self, buffer, says_nothing_new, plan, attention):
        self._into = buffer
        self._says_nothing_new = says_nothing_new
        self._plan = plan
        self._attention = attention

    def prepare(self, request, size, buffer, count, after_us):
        self._request = request
        self._copy(buffer, self._next, 0, count)
        self._next_count = count
        self._after_us = after_us + self._idle_us
        self._expected = size

    def take_back(self):
        self._expected = 0

    def follow(self):
        went_on, self._went_on = self._went_on, False
        if went_on:
            self._hand_over()
        return went_on

    def receive(self, buffer, at):
        return self._hand_over() if self._taken else Rs485Link.receive(self, buffer, at)

    def _hand_over(self):
        count, self._taken = self._taken, 0
        self._burst_ended = self._coming = False
        self.received_at = self._burst_ended_at_us
        return count

    def close(self):
        self._expected = 0
        Rs485Link.close(self)

    def _on_idle(self, uart):
        self._burst_ended_at_us = (self._ticks_us() - self._idle_us) & self._mask
        self._look()
        self._burst_ended = True
        self.on_activity()
        self._clear_fifo(uart)

    def _look(self):
        """Take the reply, if it is as long as expected, and go on if all is as it was to be."""
        size, self._expected = self._expected, 0
        if not size or self._uart.any() != size:
            return
        self._uart.readinto(self._into, size)
        self._taken = size
        passed_us = (self._ticks_us() - self.sent_at) & self._mask
        if self._sending or passed_us < self._after_us:
            return
        if not self._says_nothing_new(
            self._into, size, self._request, self._plan, self._attention
        ):
            return
        if self._fifo_holds is not None and self._fifo_holds():  # somebody goes on talking
            return
        self._went_on = True
        self.send(self._next, self._next_count)
