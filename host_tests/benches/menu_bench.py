# SPDX-License-Identifier: MIT
"""What the menu and its lists ask of a panel and its bus, by itself: it notes what it is told."""

from uss import pkw


class Machine:
    """A drive, its control, and the watch of its STOP."""

    is_alarmed = unconfirmed = False

    def __init__(self, address):
        self.drive = self.stop_watch = self
        self.address = address
        self.stopped = 0

    def needs_attention(self):
        return self.is_alarmed

    def stop_unseen(self):
        self.stopped += 1


class Told:
    """A panel with drives 3, which is shown, and 12; and what it was told to do."""

    mask = 0xFFFFF
    page_turns = 0
    time_left = True

    def __init__(self):
        self.announcer = self
        self.controls = [Machine(3), Machine(12)]
        self.selected = self.controls[0]
        self.did, self.lists = [], []

    def has_time(self):
        return self.time_left

    def uncover(self):
        self.did.append("uncover")

    def say(self, now_ms, text):
        self.did.append(text)

    def show_page(self, now_ms, place):
        self.did.append(place)


class PostingBus:
    """A bus that notes the telegrams it is given; the test says what becomes of them."""

    has_other, wait_us = False, 0

    def has_command(self):
        return self.has_other

    def silence_wait_us(self):
        return self.wait_us

    def post(self, telegram):
        telegram.state = pkw.PENDING
        self.note(telegram)
