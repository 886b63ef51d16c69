# SPDX-License-Identifier: MIT
"""A running panel that is talked to in its language, in real time that passes when a test says so.

talk = Talk(addresses=(1, 2))
talk.ready()                        # a front end is there, and drive 1 can be started
talk.tap("START")
talk.wait(2000)                     # meanwhile the front end says that it is alive
assert talk.state() == "running"
"""

import json

import main
from boards.sim.world import World
from tools.live.conversation import Conversation

FRAME_MS = 20
ALIVE_MS = 100


class Time:
    """Real time that passes when the test says so."""

    def __init__(self):
        self.us = 0x3FFF0000  # soon it wraps

    def ticks_us(self):
        return self.us & 0x3FFFFFFF

    def ticks_diff(self, later, earlier):
        return (later - earlier) & 0x3FFFFFFF


class Talk:
    """front ends: the ids of those that say that they are alive while time passes."""

    def __init__(self, speed=1, **options):
        self.world = World(main.start, **options)
        for drive in self.world.drives.values():
            drive.write(2014, 0, 1000)  # supervised: START does not ask
        self.time = Time()
        self.conversation = Conversation(self.world, speed, self.time)
        self.heard = []  # all messages, oldest first
        self.alive = [0]
        self._alive_ms = 0

    def say(self, kind, **fields):
        fields["t"] = kind
        self.say_line(json.dumps(fields))

    def say_line(self, line):
        self.conversation.take(line)
        self._listen()

    def wait(self, ms):
        """Let so much real time pass."""
        for _ in range(ms // FRAME_MS):
            if self.conversation.now_ms - self._alive_ms >= ALIVE_MS:
                self._alive_ms = self.conversation.now_ms
                for one in self.alive:
                    self.say("alive", id=one)
            self.time.us += FRAME_MS * 1000
            self.conversation.follow()
            self._listen()

    def stall(self, ms):
        """The panel stands still for so long."""
        self.time.us += ms * 1000
        self.conversation.follow()

    def tap(self, key, id=0):
        self.say("down", key=key, id=id)
        self.say("up", key=key, id=id)

    def ready(self):
        self.say("hello", v=1)
        for _ in range(100):
            self.wait(100)
            if self.lcd()[1].startswith("READY"):
                return
        raise AssertionError(self.lcd())

    def runs(self):
        """As `ready`, and drive 1 was started."""
        self.ready()
        self.tap("START")
        self.wait(3000)
        assert self.state() == "running", self.world.drives[1].report()

    def state(self, address=1):
        return self.world.drives[address].state

    def lcd(self):
        return self.world.lcd()

    def down(self):
        """The keys that are down."""
        return self.conversation.hand.keys()

    def last(self, kind):
        """The last message of a kind; None: there was none."""
        found = [message for message in self.heard if message["t"] == kind]
        return found[-1] if found else None

    def _listen(self):
        for line in self.conversation.answers() + self.conversation.news():
            assert line.endswith(b"\n") and line.count(b"\n") == 1, line
            self.heard.append(json.loads(line.decode()))
