# SPDX-License-Identifier: MIT
"""The drives of the panel: a `Control` for each, in the order of the address keys.

A drive comes or goes while the others run. The settings keep who is there, and as what.

    roster = Roster(bus, settings, mask)
    control = roster.add(5, "g110/127")
    roster.remove(control)              # ValueError while it may be running
"""

import on_demand

# From the bottom of the house up: an import inside an import inside an import takes stack.
from uss.survey import Survey, spare_jobs
from panel import texts
from panel.control import Control, Desk


_KINDS = "uss.families.kinds"


class Roster:
    """bus: the `Master`. settings: a `Settings`. mask: the clock's period - 1. defect: see `Desk`.

    controls: at least one, the same list for good. Nobody else changes it.
    """

    def __init__(self, bus, settings, mask, defect=texts.NOTHING):
        self.controls = []
        self._bus = bus
        self._settings = settings
        self._mask = mask
        self._spares = spare_jobs()
        self._desk = Desk(bus, settings, mask, defect)
        known = {}  # most drives are of the same kind
        for address in settings.drives:
            kind = settings.kind(address)
            if kind not in known:
                known[kind] = _understood(kind)
            self._take(address, *known[kind])
        self._arrange()

    def add(self, address, kind):
        """Put a drive at the end; return its control.

        kind: as `families.kinds` has it. ValueError: no such kind, 31 are there, or one has this
        address.
        """
        family, layout = _understood(kind)
        self._settings.add(address, kind)
        control = self._take(address, family, layout)
        self._arrange()
        return control

    def note_layout(self, drive):
        """The drive has got another layout."""
        for control in self.controls:
            family = control.survey.family
            if control.drive is drive and drive.layout.suits(family):
                kind = on_demand.call(_KINDS, "text", family, drive.layout)
                self._settings.set_kind(drive.address, kind)

    def remove(self, control):
        """ValueError if it is the only one, or may be running."""
        if len(self.controls) == 1:
            raise ValueError("the panel has a drive at the least")
        self._bus.turns.remove(control.drive)
        self._settings.remove(control.drive.address)
        self.controls.remove(control)
        self._arrange()

    def _arrange(self):
        """The circulating list: some stand in it several times, as far apart as can be."""
        repeats, controls = self._settings.repeats, self.controls
        if repeats:
            entries = []  # (when in the round, place), in thousandths of it
            for place, control in enumerate(controls):
                times = repeats.get(str(control.drive.address), 1)
                first = 1000 * place // len(controls)
                entries += [
                    ((first + 1000 * turn // times) % 1000, place) for turn in range(times)
                ]
            self._bus.turns.arrange([controls[place].drive for _, place in sorted(entries)])
        self._desk.follow_list()

    def _take(self, address, family, layout):
        drive = self._bus.turns.add(address, layout)
        survey = Survey(drive, family, self._mask, self._spares)
        control = Control(drive, survey, self._desk)
        self.controls.append(control)
        return control


def _understood(kind):
    """Family and layout."""
    return on_demand.call(_KINDS, "kind", kind)
