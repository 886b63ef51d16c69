# SPDX-License-Identifier: MIT
"""A command of the script language that lets time pass, done slice by slice.

So the panel hears the keys and the picture goes on meanwhile, and a person can end it early:

    errand = Errand(world, hand, "hold", ("UP", 3000))      # the key is down now
    while errand.left_us():
        errand.run(10)
    errand.end()                                            # the key is up

It is one step, or several: a key that goes down and up, and the time after that.
"""

from boards.sim.setpoint import typed
from boards.sim.world import RELEASE_MS, TAP_MS


class Errand:
    """world: a `World`. hand: a `Hand`, which is told of the key. name: of one of ERRANDS.

    values: those of the command, as `Script.understood` has them. `run` may raise Untyped, where
    a setpoint cannot be typed.
    """

    def __init__(self, world, hand, name, values):
        self._world = world
        self._hand = hand
        self._key = None
        self._end_us = world.clock.now_us
        self._lives = world.resets if name == "hang" else None
        self._steps = ERRANDS[name](world, *values)
        self._begin()

    def left_us(self):
        """How much of the world's time its step still takes. 0: all is done."""
        return max(0, self._end_us - self._world.clock.now_us)

    def run(self, ms):
        """Let so much of the world's time pass, or what is left of it."""
        world = self._world
        until_us = self._up_us if self._key else self._end_us
        ms = min(ms, -(-(until_us - world.clock.now_us) // 1000))
        if self._lives == world.resets:  # a chip that the watchdog restarted hangs no longer
            world.hang(ms)
        else:
            world.run(ms)
        if world.clock.now_us >= self._up_us:
            self._lift()
        if not self.left_us():
            self._begin()

    def end(self):
        """Let go of the key: its time is over, or the person has ended it."""
        self._lift()
        self._steps = iter(())

    def _begin(self):
        """The next step, if there is one."""
        step = next(self._steps, None)
        if step is None:
            return
        self._key, down_ms, up_ms = step
        self._up_us = self._world.clock.now_us + down_ms * 1000  # when the key is let go
        self._end_us = self._up_us + up_ms * 1000
        if self._key:
            self._world.down(self._key)
            self._hand.fix(self._key, True)

    def _lift(self):
        if self._key:
            self._world.up(self._key)
            self._hand.fix(self._key, False)
            self._key = None


def one(key, down_ms, up_ms):
    return iter(((key, down_ms, up_ms),))


# Command: from its values to its steps: the key that is down, for how long, and the time after
# that, in ms.
ERRANDS = {
    "press": lambda _, key: one(key, TAP_MS, RELEASE_MS),
    "hold": lambda _, key, ms: one(key, ms, RELEASE_MS),
    "setpoint": typed,
    "wait": lambda _, ms: one(None, 0, ms),
    "hang": lambda _, ms: one(None, 0, ms),
}
