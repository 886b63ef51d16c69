# SPDX-License-Identifier: MIT
"""The world of a seed: how many drives it has, of which families, its line, and its settings.

The same seed gives the same world, whatever the other arguments of the soak.

    plan = plan_of(7)
    world = SoakWorld(main.start, plan)
"""

from boards.sim.board import LOOP_US
from boards.sim.drives.families import BOP, WITH_BOP, g110, mm420, mm440, named, v20
from boards.sim.drives.switches import SWITCHES
from boards.sim.world import World, supervision, supervision_ms
from tools.soaking.dice import Dice, may
from tools.soaking.digest import Digest
from tools.soaking.judging.facts import S, exchange_us, lost_us

# Of a panel that is told nothing: drives as it expects them (MICROMASTER 4 with 4 PKW and 2 PZD);
# and such as are in another layout, or of another family.
ABLE = ((mm420, {}), (mm420, {}), (mm440, {}))
OTHERS = ((g110, {}), (mm420, {2013: 3}), (mm440, {2012: 4}), (v20, {2013: 4, 2014: 0}))

SETS_DRIVES, SETS_BAUD = 2, 19200  # parameter sets take long

# One world in so many has drives of all families and layouts. Of these the panel is told the
# truth, or another layout, now and then that it is a drive of which nothing is known.
FAMILIES_IN = 3
FAMILIES = ("mm420", "mm440", "mm3", "mm3", "g110", "v20", "g120", "g120", "generic")
ON_BOP_IN = 3  # of so many MICROMASTER 4 one has its USS on the BOP link
PKW_WORDS = (0, 3, 4, 127)
PZD_WORDS = (2, 2, 2, 4)

BAUDS = (19200, 19200, 19200, 19200, 19200, 9600, 38400, 38400, 57600, 115200, 4800)
CLEAN, ROUGH, WILD = range(3)
NAMES = ("clean", "rough", "wild")

# The values, besides the default, of the drives' switches that are not yes-or-no.
VALUES = {
    "stale_replies": (1, 2),
    "text_bits_error": (3, 5),
    "no_rights_error": (7, 11),
    "buffered_ms": (20, 200),
    "dark_ms": (100, 1_000),
    "boot_ms": (200, 700, 2_500),
    "silence_s": ({970: 2.0, 971: 1.0},),
}
LOCK_CODES = (0, 1, 4711, 9999)  # 0: none yet
LONG_MS = (8_000, 20_000, 65_535)  # such a P2014 hardly protects
SLOW_LOOP_US = 10_000  # the longest step of a busy main loop


class Plan:
    """seed, dice, addresses, listed (these, and the addresses of the panel's list without a
    drive), baud, settings, keys, polled, echo, level (CLEAN, ROUGH, WILD), loop_us (the longest
    step of the main loop), and further arguments of a `World`: `ticks_start`, `ticks_mask`,
    `kinds`. pzd_words: the most of a telegram. types: the operator sets setpoints digit by digit.

    troubles: how many things the hand lets fail at once, 1 or 2. roams: it opens the menu and the
    search; else there is more time for the rest.
    """

    def __init__(self, seed, drives=None, troubles=1, roams=True):
        self.seed = seed
        self.troubles = troubles
        self.roams = roams
        self.dice = dice = Dice(seed)
        # Later additions to the worlds have their own dice, so that they do not change the rest.
        self.more = more = Dice(seed, 7)
        self.level = (CLEAN, CLEAN, ROUGH, ROUGH, ROUGH, WILD)[dice.below(6)]
        count = drives or _count(dice)
        if troubles > 1 and count == 1 and not drives:
            count = 2 + more.below(4)
        self.addresses = _addresses(dice, count)
        self.loop_us = LOOP_US * 2 if more.below(4) else SLOW_LOOP_US
        self.listed = self.addresses + _silent(more, self.addresses)
        self.baud = BAUDS[dice.below(len(BAUDS))] if dice.below(3) else 19200
        self.polled = not dice.below(5)
        self.keys = "matrix" if not dice.below(3) else "direct"
        self.ticks_mask = (1 << (24, 27, 30, 30)[dice.below(4)]) - 1
        if len(self.listed) > 3 or self.baud <= 9600:  # a round takes long beside 16 s
            self.ticks_mask |= (1 << 27) - 1
        self.supervised = dice.below(4)  # 0: no drive supervises its line
        self.ticks_start = dice.below(self.ticks_mask)
        if dice.below(2):  # the counter wraps within the first minute
            self.ticks_start = self.ticks_mask - dice.below(60_000_000) & self.ticks_mask
        self.echo = not dice.below(10)
        self.settings = _settings(dice, self.addresses)
        self.settings["drives"] = list(self.listed)
        self.types = may("types", seed)
        self.looks_up = roams and may("looks_up", seed)
        self.diagnoses = roams and may("diagnoses", seed)
        self.commissions = roams and may("commissions", seed)
        self.locks = roams and may("locks", seed)
        self.arranges = roams and may("arranges", seed) and len(self.listed) > 1
        self.resets = roams and may("resets", seed)
        few = len(self.listed) <= SETS_DRIVES and self.baud >= SETS_BAUD
        self.keeps_sets = roams and may("keeps_sets", seed) and few
        # Drives of all families.
        self.families = families = Dice(seed, 11)
        self.has_families = families.below(FAMILIES_IN) == 0
        self.links = Dice(seed, 17)
        self.pzd_words = families.one_of(PZD_WORDS) if self.has_families else PZD_WORDS[0]
        # The judge cannot tell which PZD words a drive has that a reset gives others.
        self.resets = self.resets and self.pzd_words == PZD_WORDS[0]
        self.kinds = {address: _kind(self, address) for address in self.addresses}
        if self.has_families:
            told = {str(address): _put_family(self, address) for address in self.addresses}
            self.settings["kinds"] = {address: told[address] for address in told if told[address]}
        if self.locks:
            self.settings["lock_code"] = LOCK_CODES[Dice(seed, 57).below(len(LOCK_CODES))]
        if self.resets:
            self._keep_apart()

    def _keep_apart(self):
        """A drive that a reset gives another address must not meet another drive there."""
        for kind in self.kinds.values():
            if len(self.listed) > 1:
                kind["switches"].pop("keeps_link", None)

    def __str__(self):
        return "%d drives of %d at %d baud%s, keys %s, loop %d ms, %s, settings %s" % (
            len(self.addresses), len(self.listed), self.baud,
            (", polled" if self.polled else "") + (", echo" if self.echo else ""), self.keys,
            self.loop_us // 1000, NAMES[self.level],
            ", ".join("%s %r" % pair for pair in sorted(self.settings.items())),
        ) + ("; the drives are %s" % self._real_kinds() if self.has_families else "")  # fmt: skip

    def _real_kinds(self):
        families = [self.kinds[one]["family"] for one in self.addresses]
        links = [BOP if family.LINK["index"] else "" for family in families]
        names = [family.NAME + link for family, link in zip(families, links)]
        found = ["%d %s" % pair for pair in zip(self.addresses, names)]
        layouts = ["%d+%d" % self.kinds[one]["layout"] for one in self.addresses]
        return ", ".join("%s %s" % pair for pair in zip(found, layouts))


class SoakWorld(World):
    """A `World` that tells its `witness` when the chip restarts, when another program has it, and
    when its flash is written.

    digest: of all that has happened in it.
    """

    def __init__(self, start, plan):
        self.witness = None
        self._longest_loop_us = plan.loop_us
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
        self.digest = Digest(self)

    def run(self, ms):
        World.run(self, ms)
        self.digest.look()

    def hang(self, ms):
        World.hang(self, ms)
        self.digest.look()

    def reset(self):
        bitten = self._bitten
        if self.witness is not None:
            self.witness.reset(bitten)
        World.reset(self)
        del self.chips[:-1]
        if self.witness is not None:
            self.witness.booted()

    def _uneven_loop_us(self):
        return self.random(LOOP_US // 4, self._longest_loop_us)

    def _hand_over(self, following):
        World._hand_over(self, following)
        between = not hasattr(following, "board")  # it only makes the next one
        if self.witness is not None and not between:
            self.witness.handed_over(searches=not hasattr(following, "panel"))

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


def _silent(dice, addresses):
    """Addresses of the list at which there is no drive."""
    roll = dice.below(16)
    count = 0 if roll > 2 else 1 + dice.below(4) if roll else 31
    free = [address for address in range(32) if address not in addresses]
    return tuple(free[: min(count, 31 - len(addresses))])


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
        parameters.update(supervision(family, supervision_ms(plan.baud, len(plan.listed))))
    if plan.more.below(12) == 0 and family in (mm420, mm440):
        parameters = dict(parameters)
        parameters[2014] = plan.more.one_of(LONG_MS)
    switches = switched(plan.more)
    if not bears_silences(plan) and (lost_us(plan) < S or "stale_replies" in switches):
        switches.pop("silent_refusals", None)
    return {"family": family, "parameters": parameters, "switches": switches}


def _put_family(plan, address):
    """Give the drive there a family and a layout; what the panel is told of it, or None."""
    dice, kind = plan.families, plan.kinds[address]
    name, pkw_words, told_words = (
        dice.one_of(FAMILIES), dice.one_of(PKW_WORDS), dice.one_of(PKW_WORDS),
    )  # fmt: skip
    is_told, is_generic = dice.below(3), not dice.below(8)
    family = named(name)
    fixed = family.LINK["layout"]
    if plan.baud not in family.BAUD_CODES.values() or (
        fixed and (address > 30 or plan.pzd_words != fixed[1])
    ):
        name, family, fixed = "mm420", mm420, None
    if name in WITH_BOP and not is_generic and plan.links.below(ON_BOP_IN) == 0:
        name += BOP
        family = named(name)
    layout = fixed or (pkw_words, plan.pzd_words)
    off_time_ms = kind["parameters"].get(mm420.LINK["off time"], 0)
    kind.update(family=family, parameters=supervision(family, off_time_ms), layout=layout)
    told = (name, "generic")[is_generic and name in ("mm420", "mm440", "v20")]
    words = layout[0] if fixed or is_told else told_words
    return _kind_text(told, words, plan.pzd_words)


def _kind_text(name, pkw_words, pzd_words):
    """As the settings name a family and a layout."""
    return "%s/%d%s" % (name, pkw_words, "" if pzd_words == 2 else "+%d" % pzd_words)


def bears_silences(plan):
    """Whether three silences of a drive in a row do not lose it. Otherwise the panel asks in vain
    for a parameter on which the drive is silent, even more if the drive lags.
    """
    return lost_us(plan) >= 3 * len(plan.listed) * exchange_us(plan)


def switched(dice):
    """Some of the switches of a drive, each with another value than its default."""
    found = {}
    for name, default, _, _ in SWITCHES:
        if not dice.below(8):
            found[name] = not default if isinstance(default, bool) else dice.one_of(VALUES[name])
    return found
