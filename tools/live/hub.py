# SPDX-License-Identifier: MIT
"""One running panel for several front ends at once, on CPython's asyncio.

    hub = Hub(["tools/panel", "--lines", "--drives", "1,2"])
    await hub.start()
    seat = hub.join(take)               # take(message) is called for each that it should hear
    seat.say({"t": "down", "key": "STOP"})
    seat.leave()
    status = await hub.end()            # the panel stops its drives, and ends

Each front end has a seat with an id of its own, so that keys and answers are its own: README.md.
"""

import asyncio
import json

from tools.live.language import ANSWERS

LINE_MAX = 1 << 20  # of what the panel says
BACKLOG_MAX = 1 << 18  # characters that a panel which hangs has not taken; then none are added
ENDS_S = 10  # a panel on a real line takes its leave of every drive


class Seat:
    """A front end's place at the panel. Of `Hub.join`."""

    def __init__(self, hub, number, take):
        self.number = number
        self.take = take
        self._hub = hub

    def say(self, message):
        """message: a dict; it gets the id of this seat."""
        self._hub.tell({**message, "id": self.number})

    def leave(self):
        self._hub.part(self)


class Hub:
    """command: runs the panel with --lines. ended: a future of its exit status."""

    def __init__(self, command):
        self.ended = None
        self._command = command
        self._process = None
        self._seats = {}
        self._next = 1
        self._reader = None

    async def start(self):
        loop = asyncio.get_running_loop()
        self.ended = loop.create_future()
        self._process = await asyncio.create_subprocess_exec(
            *self._command,
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            limit=LINE_MAX,
            start_new_session=True,  # Ctrl-C is for us: we end the panel in peace
        )
        self._reader = loop.create_task(self._listen())

    def join(self, take):
        """A seat; everything is told anew, to all. take(message): a dict."""
        seat = Seat(self, self._next, take)
        self._next += 1
        self._seats[seat.number] = seat
        return seat

    def part(self, seat):
        if self._seats.pop(seat.number, None):
            self.tell({"t": "bye", "id": seat.number})

    def tell(self, message):
        """A message to the panel. One that does not take any more gets no more: nobody is heard
        there, and it stops its drives by itself."""
        pipe = self._process.stdin
        if pipe.is_closing() or pipe.transport.get_write_buffer_size() > BACKLOG_MAX:
            return
        pipe.write(json.dumps(message).encode() + b"\n")

    async def end(self):
        """The panel's exit status."""
        if not self.ended.done():
            self._process.stdin.close()
            try:
                await asyncio.wait_for(asyncio.shield(self.ended), ENDS_S)
            except TimeoutError:
                self._process.terminate()
        return await self.ended

    async def _listen(self):
        try:
            while line := await self._process.stdout.readline():
                self._hand_out(json.loads(line))
        except (ValueError, OSError):  # it was cut off in the middle of a line
            pass
        finally:
            self.ended.set_result(await self._process.wait())

    def _hand_out(self, message):
        if message["t"] in ANSWERS:
            seat = self._seats.get(message["id"])
            if seat:
                seat.take(message)
            return
        for seat in list(self._seats.values()):
            seat.take(message)
