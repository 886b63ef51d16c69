# SPDX-License-Identifier: MIT
"""The families of drives, for the judge: which words they obey, and what they tell a panel.

Written from the documents, not from the firmware, as `facts`. What a panel can know of a drive
depends on the family that its settings name, and on the PKW words of its telegrams: a `Sight`.

    family = FAMILIES["mm3"]
    sight = Sight(family, 3)
    sight.is_percent, sight.reads_off_time, ...
"""

from tools.soaking.judging.facts import JOG_LEFT, JOG_RIGHT, OFFS, ON, ON_REVERSE

USUAL = "mm420"  # where the settings name none
VARIABLE = 127  # PKW words: as many as a task needs, 3 at the least
PZD_USUAL = 2
USS, USS_ON_BOP = 5, 4  # P0700, P1000, a digit of P0719
LINKED = (2009, 2010, 2011, 2012, 2013, 2014, 2024)  # their index is the link's
ACTUAL_HZ = 21 << 16  # P2019[1]: r0021, the actual frequency

MM4_DANGEROUS = (  # DESIGN, rule 7
    3, 10, 700, 719, 840, 918, 927, 970, 1000, 1070, 2000, 2009, 2010, 2011, 2012, 2013, 2014,
    2016, 2019, 2023, 3900,
)  # fmt: skip


class Family:
    """What the documents say of a family. drives: names of the simulated ones that it is right
    for. layout: PKW words, if it has only these. index: of its link, 1: the BOP link.

    on, reverse, jogs: its control words; reverse 0: a negative setpoint reverses it. signed: HIW
    has a sign; else bit 14 of ZSW is the direction.

    uss: what P0700 and the like are for this link. command, setpoint: their sources, (number,
    right value, whether it is a double word); a digit of `selection` goes before them.
    reference: number and unit ("Hz", "1/min", "steps"; None: nobody knows it). absolute: number
    and value with which PZD2 is in 0.01 Hz. limits: numbers of the lowest and the highest
    frequency. off_time: number and unit in microseconds.
    sent: parameter with its index, and the value with which HIW is the frequency. counter: of
    telegrams. warnings: the number of the list of them.

    address: its number. dangerous: rule 7 of the design. permanent: those among them that the
    drive must not forget. save: a number that is written so that nothing is forgotten, where no
    task writes the EEPROM.
    """

    def __init__(
        self,
        drives,
        layout=None,
        index=0,
        on=ON,
        reverse=ON_REVERSE,
        jogs=(JOG_RIGHT, JOG_LEFT),
        signed=True,
        selection=None,
        command=(),
        setpoint=(),
        reference=(None, None),
        absolute=None,
        limits=(None, None),
        off_time=(None, 0),
        sent=None,
        counter=None,
        warnings=None,
        address=None,
        dangerous=(),
        permanent=(),
        save=None,
    ):
        self.drives = drives
        self.layout = layout
        self.index = index
        self.uss = USS_ON_BOP if index else USS
        self.on = on
        self.reverse = reverse
        self.jogs = jogs
        self.known = OFFS + (on,) + ((reverse,) if reverse else ()) + jogs
        self.signed = signed
        self.selection = selection
        self.command = command
        self.setpoint = setpoint
        self.reference = reference
        self.absolute = absolute
        self.limits = limits
        self.off_time = off_time
        self.sent = sent
        self.counter = counter
        self.warnings = warnings
        self.address = address
        self.dangerous = dangerous
        self.permanent = permanent
        self.save = save

    def is_right_for(self, drive):
        """Whether a panel that is told this family controls that simulated drive."""
        return drive.family.NAME in self.drives and drive.family.LINK["index"] == self.index

    def read(self, drive, number):
        """Of that drive, on this link."""
        return drive.read(number, self.index if number in LINKED else 0)


def _mm4(
    drives,
    absolute=(2009, 1),
    pid=((2200, 0, True),),
    permanent=(2010, 2011, 2012, 2013),
    index=0,
):
    uss, command, received, sent = (
        (USS_ON_BOP, 2032, 2015, 2016) if index else (USS, 2036, 2018, 2019)
    )  # fmt: skip
    return Family(
        drives,
        index=index,
        selection=719,
        command=((700, uss, False), (840, command << 16, True)),
        setpoint=((1000, uss, False), (1070, received << 16 | 1, True)) + pid,
        reference=(2000, "Hz"),
        absolute=absolute,
        limits=(1080, 1082),
        off_time=(2014, 1_000),
        sent=((sent, 1), ACTUAL_HZ),
        counter=2024,
        warnings=2110,
        address=2011,
        dangerous=MM4_DANGEROUS,
        permanent=permanent,
    )


MM420, MM440, GENERIC = "MICROMASTER 420", "MICROMASTER 440", "drive of the specification"
G110, V20, MM3, G120 = "SINAMICS G110", "SINAMICS V20", "MICROMASTER 3", "SINAMICS G120"

FAMILIES = {  # as the settings name them
    "mm420": _mm4((MM420, MM440)),
    "mm440": _mm4((MM440,)),
    "mm420-bop": _mm4((MM420, MM440), index=1),
    "mm440-bop": _mm4((MM440,), index=1),
    "g110": _mm4((G110,), None, ()),
    "v20": _mm4((V20,), None, permanent=(2010, 2011, 2012, 2013, 2023)),
    "mm3": Family(
        (MM3,),
        layout=3,
        on=0x0C7F,  # bit 11: right
        reverse=0x147F,  # bit 12: left
        signed=False,
        command=((910, 1, False),),
        reference=(94, "steps"),
        absolute=(95, 2),
        limits=(12, 13),
        off_time=(93, 1_000_000),
        address=91,
        dangerous=(9, 91, 92, 93, 94, 95, 910, 944),
        permanent=(91, 92),
        save=971,
    ),
    "g120": Family(
        (G120,),
        jogs=(),
        reference=(2000, "1/min"),
        limits=(1080, 1082),
        off_time=(2040, 1_000),
        address=2021,
        dangerous=(
            10, 15, 840, 970, 1070, 2000, 2020, 2021, 2022, 2023, 2030, 2040, 2051,
        ),
        permanent=(2020, 2021, 2022, 2023, 2030),
    ),
    "generic": Family((GENERIC, MM420, MM440, V20), reverse=0, jogs=()),
}  # fmt: skip

RPM_PER_HZ = 30  # 1/min of a motor with two pole pairs
SPEEDS = (21, 63)  # of what a drive may send: r0021, the actual frequency, or speed; smoothed


class Sight:
    """What a panel can know of a drive of this family in telegrams with so many PKW words.

    reads_words, reads_doubles: parameters of these sizes. is_percent: nobody knows what 100 % is
    in hertz.
    """

    def __init__(self, family, pkw_words):
        self.family = family
        self.pkw_words = pkw_words
        number, unit = family.reference
        self.reads_words = pkw_words != 0 and family.off_time[0] is not None
        self.reads_doubles = self.reads_words and pkw_words != 3
        self.reads_limits = self.reads_doubles or unit == "steps"
        self.is_percent = number is None or unit == "1/min" or not self.reads_limits
        self.reads_sent = self.reads_doubles and family.sent is not None
        self.counts = self.reads_words and family.counter is not None

    def reads(self, is_double):
        return self.reads_doubles if is_double else self.reads_words


# PKW words of a drive, and those of the panels that it answers in a length that they take.
ANSWERED = {0: (0,), 3: (3, VARIABLE), 4: (4,), VARIABLE: (0, 3, VARIABLE)}


class Kind:
    """How the panel divides its telegrams to one drive, as far as the line tells, and the family
    that its settings name.

    pzd_words: of each telegram, in the layout that is in force. It changes the layout only to one
    in whose length a mirror telegram came back.
    """

    def __init__(self, name, pkw_words, pzd_words):
        self.family = FAMILIES[name]
        self.pzd_words = pzd_words
        self.told = pkw_words
        self.words = {pkw_words}  # of which one is in force
        self._known = {pkw_words}  # that the settings may name after a restart
        self._told_pzd_words = pzd_words
        self._other = None  # the layout before, which may be in force yet
        self._mirrored = None  # net words of the last mirror telegram
        self._takes_any = False  # that and a shorter one came back: it is asked in any length
        self._came_back = {}  # since the last reply: net words -> whether the panel must know
        self._sights = {}

    def sight(self):
        """The `Sight` that the panel has, or None while that cannot be told."""
        if len(self.words) > 1:
            return None
        (pkw_words,) = self.words
        if pkw_words not in self._sights:
            self._sights[pkw_words] = Sight(self.family, pkw_words)
        return self._sights[pkw_words]

    def send(self, count, task):
        """The panel sends a telegram of so many net words. Whether it may."""
        pkw_words = count - self.pzd_words
        fitting = self.words & _fitting(pkw_words, task)
        if not fitting and self._send_other(count, task):
            return True
        if not fitting:
            fitting = self._found() & _fitting(pkw_words, task)
            self._came_back.clear()
            self._known |= fitting
        if not fitting:
            return False
        self.words = fitting
        return True

    def _send_other(self, count, task):
        """In the layout before. While the panel asks a drive what it is, it sends in both."""
        if self._other is None:
            return False
        words, pzd_words = self._other
        fitting = words & _fitting(count - pzd_words, task)
        if fitting:
            self._other = self.words, self.pzd_words
            self.words, self.pzd_words = fitting, pzd_words
        return bool(fitting)

    def may_ask(self, count):
        """Whether so many net words may be a question to a drive whose layout is looked for. One
        that answers, but makes no sense, is asked in its own length, behind one that is longer.
        """
        back = self._came_back
        is_own = _fitting(count - self.pzd_words, 0) & self.words
        if self._takes_any or count + 1 == self._mirrored and is_own:
            return True
        return count in back or count >= 3 and any(one + 1 in back for one in back)

    def mirror(self, count):
        """A mirror telegram of so many net words is sent."""
        self._mirrored = count
        self._takes_any = False

    def learn(self, layout, count):
        """The panel speaks to a drive of this layout as the drive has it. Whether it may be so."""
        pkw_words, pzd_words = layout
        least = 3 if pkw_words == VARIABLE else pkw_words
        if count < least + pzd_words or pkw_words != VARIABLE and count > least + pzd_words:
            return False
        if pzd_words == self.pzd_words and self.words & _fitting(count - pzd_words, 0):
            if pkw_words not in self.words:
                self._other = self.words, self.pzd_words
            self.words = self.words | {pkw_words}  # this one looks the same in both
        elif self.words != {pkw_words} or self.pzd_words != pzd_words:
            self._other = self.words, self.pzd_words
            self.words, self.pzd_words = {pkw_words}, pzd_words
        if pzd_words == self._told_pzd_words:
            self._known.add(pkw_words)
        return True

    def may_be_taken_for_variable(self):
        """Whether the panel may take the three PKW words of a drive for a variable number: its
        telegrams without a task look the same, until the drive has no room for a double word.
        """
        return 3 in self.words and VARIABLE in self._known

    def may_be_reply(self, count):
        """Whether a drive in the layout that is in force may answer with so many net words."""
        pkw_words = count - self.pzd_words
        return pkw_words in self.words or (VARIABLE in self.words and pkw_words >= 3)

    def is_sure_reply(self, count):
        """Whether the panel must take so many for a reply."""
        return len(self.words) == 1 and self.may_be_reply(count)

    def answered(self):
        """It needs no other layout."""
        self._came_back.clear()

    def returned(self, count, is_sure):
        """A mirror telegram of so many net words has come back."""
        self._came_back[count] = is_sure or self._came_back.get(count, False)
        is_own = _fitting(count - 1 - self.pzd_words, 0) & self.words  # in which it answers, too
        self._takes_any = count - 1 in self._came_back or bool(is_own)
        if 3 in self.words and VARIABLE in self._found():
            self.words = self.words | {VARIABLE}  # its telegrams without a task look the same

    def restarted(self):
        self._mirrored = None
        self._takes_any = False
        self._came_back.clear()
        if self.pzd_words == self._told_pzd_words:
            self.words = set(self._known)

    def _found(self):
        """What the panel may have found out."""
        found = set()
        for count, is_sure in self._came_back.items():
            words = count - self.pzd_words
            if count + 1 in self._came_back:
                found.add(VARIABLE)
                if is_sure and self._came_back[count + 1]:
                    continue
            if words in (0, 3, 4):
                found.add(words)
        return found

    def can_find(self, drive):
        """Whether the panel controls that drive sooner or later. A drive with 3 PKW words answers
        a panel that takes them for a variable number, too, but cannot tell it any double word.
        """
        pkw_words, pzd_words = drive.layout
        if not self.family.is_right_for(drive) or pzd_words != self.pzd_words:
            return False
        if pkw_words == 3 and VARIABLE in self.words:
            return self.family.reference[0] is None
        return self.family.layout is None or pkw_words == self.family.layout

    def is_right_for(self, drive):
        """Whether the panel controls that drive now."""
        return self.can_find(drive) and len(self.words) == 1 and self.answers(drive)

    def answers(self, drive):
        """Whether that drive answers in a layout that may be in force."""
        return bool(self.words & set(ANSWERED[drive.layout[0]]))


def _fitting(pkw_words, task):
    """The layouts whose requests may have so many PKW words."""
    if pkw_words in (0, 3, 4) and not task:
        return {pkw_words, VARIABLE} if pkw_words == 3 else {pkw_words}
    if pkw_words < 3:
        return set()
    return {pkw_words, VARIABLE}


def kinds_of(settings, addresses):
    """A `Kind` for each of these addresses, as the settings name them."""
    told = settings.get("kinds", {})
    found = {}
    for address in addresses:
        name, _, words = told.get(str(address), USUAL).partition("/")
        pkw_words, _, pzd_words = words.partition("+")
        usual = {"mm3": 3, "g110": VARIABLE, "v20": VARIABLE, "g120": VARIABLE}.get(name, 4)
        found[address] = Kind(name, int(pkw_words or usual), int(pzd_words or PZD_USUAL))
    return found
