# SPDX-License-Identifier: MIT
"""What the world of a seed is: how many drives, of which families, the line, the settings.

The same seed gives the same world, whatever else is asked of the soak.

    plan = plan_of(7)
    world = SoakWorld(main.start, plan)
"""

from boards.sim import g110, mm420, mm440, v20
from boards.sim.world import World, supervision, supervision_ms
from tools.soaking.dice import Dice

# Families that this panel can control, with the layout that it speaks (4 PKW, 2 PZD), and two that
# answer it with another one, or not at all.
ABLE = ((mm420, {}), (mm420, {}), (mm440, {}))
OTHERS = ((g110, {}), (mm420, {2013: 3}), (mm440, {2012: 4}), (v20, {2013: 4, 2014: 0}))

BAUDS = (19200, 19200, 19200, 19200, 19200, 9600, 38400, 38400, 57600, 115200, 4800)
CLEAN, ROUGH, WILD = range(3)
NAMES = ("clean", "rough", "wild")


class Plan:
    """seed, dice, addresses, baud, settings, keys, polled, echo, level (CLEAN, ROUGH, WILD), and
    what else a `World` is given: `ticks_start`, `ticks_mask`, `kinds`.
    """

    def __init__(self, seed, drives=None):
        self.seed = seed
        self.dice = dice = Dice(seed)
        self.level = (CLEAN, CLEAN, ROUGH, ROUGH, ROUGH, WILD)[dice.below(6)]
        self.addresses = _addresses(dice, drives or _count(dice))
        self.baud = BAUDS[dice.below(len(BAUDS))] if dice.below(3) else 19200
        self.polled = not dice.below(5)
        self.keys = "matrix" if not dice.below(3) else "direct"
        self.ticks_mask = (1 << (24, 27, 30, 30)[dice.below(4)]) - 1
        if len(self.addresses) > 3 or self.baud < 9600:  # a round takes long beside 16 s
            self.ticks_mask |= (1 << 27) - 1
        self.supervised = dice.below(4)  # else no drive watches its line
        self.ticks_start = dice.below(self.ticks_mask)
        if dice.below(2):  # the counter wraps within the first minute
            self.ticks_start = self.ticks_mask - dice.below(60_000_000) & self.ticks_mask
        self.echo = not dice.below(10)
        self.settings = _settings(dice, self.addresses)
        self.kinds = {address: _kind(self, address) for address in self.addresses}

    def __str__(self):
        return "%d drives at %d baud%s, keys %s, %s, settings %s" % (
            len(self.addresses), self.baud,
            (", polled" if self.polled else "") + (", echo" if self.echo else ""), self.keys,
            NAMES[self.level], self.settings,
        )  # fmt: skip


class SoakWorld(World):
    """A `World` that tells its `witness` when the chip restarts and when its flash is written."""

    def __init__(self, start, plan):
        self.witness = None
        World.__init__(
            self,
            start,
            addresses=plan.addresses,
            baud=plan.baud,
            settings=plan.settings,
            seed=plan.seed + 1,
            polled=plan.polled,
            ticks_start=plan.ticks_start,
            ticks_mask=plan.ticks_mask,
            keys=plan.keys,
            kinds=plan.kinds,
        )
        self.wire.echo = plan.echo

    def reset(self):
        bitten = self._bitten
        if self.witness is not None:
            self.witness.reset(bitten)
        World.reset(self)
        del self.chips[:-1]
        if self.witness is not None:
            self.witness.booted()

    def _flash_is_busy(self, us):
        World._flash_is_busy(self, us)
        if self.witness is not None:
            self.witness.flash_written()


def _count(dice):
    roll = dice.below(100)
    if roll < 60:
        return 1
    if roll < 85:
        return 2 + dice.below(2)
    if roll < 97:
        return 5 + dice.below(6)
    return 31


def _addresses(dice, count):
    found = []
    while len(found) < count:
        address = dice.below(32)
        if address not in found:
            found.append(address)
    return tuple(found)


def _settings(dice, addresses):
    settings = {}
    if dice.below(2):
        settings["second_stop"] = ("OFF3", "OFF2", "none")[dice.below(3)]
    if not dice.below(3):
        settings["reply_timeout_ms"] = 20 + dice.below(41)
    if not dice.below(3):
        settings["lost_ms"] = (300, 500, 2000, 5000)[dice.below(4)]
    if not dice.below(3):
        settings["setpoint_step_centihertz"] = 1 + dice.below(300)
        settings["setpoint_centihertz"] = dice.below(6500)
    if not dice.below(4):
        settings["lowest_centihertz"] = dice.below(1500)
        settings["highest_centihertz"] = 1500 + dice.below(6000)
    if not dice.below(4):
        settings["unsupervised"] = [address for address in addresses if dice.below(2)]
    return settings


def _kind(plan, address):
    dice = plan.dice
    table = ABLE if dice.below(8) or len(plan.addresses) == 1 else OTHERS
    family, parameters = table[dice.below(len(table))]
    if plan.baud not in family.BAUD_CODES.values():
        family, parameters = mm420, {}
    if plan.supervised:
        parameters = dict(parameters)
        parameters.update(
            supervision(family, supervision_ms(plan.baud, len(plan.addresses)))
        )
    return {"family": family, "parameters": parameters}
