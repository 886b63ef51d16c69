# SPDX-License-Identifier: MIT
"""The end of a command: what becomes of drives that trip when they hear no more (P2014).

A drive begins to watch its line with the first telegram that it gets, even a mirror telegram, and
trips when none comes for its telegram-off time. Nothing on the line ends that: to acknowledge is a
telegram, too. So a drive that trips by the silence of its end is asked on until another master
talks, if its motor runs, or if the command is to leave no drive in a fault.
"""

from tools.uss_command.errors import Failure
from uss import pkw
from uss.errors import UssError

USUAL_NUMBER = 2014
ASKED_MAX_S = 1.0  # between two telegrams to a drive, at the most,
SHARE = 4  # or this part of its time

ASKED_ON = (
    "drive {0.address} {does}, and trips ({0.fault}) when it hears nothing for {0.off_time_ms} ms "
    "({0.number}): it is asked on until another master talks. Ctrl-C ends that; --leave omits it"
)
TAKEN_OVER = "another master talks, so nothing more is sent"
LATE_TRIP = (
    "drive {0.address} {does}, and trips ({0.fault}) {0.off_time_ms} ms from now, because it "
    "hears no more ({0.number}): the next master has to acknowledge that"
)
HAS_TRIPPED = (
    "drive {0.address} has tripped ({0.fault}), because it was not asked in time for its "
    "{0.off_time_ms} ms ({0.number}): the next master has to acknowledge that"
)


class Supervised:
    """A drive that trips after so long without a telegram. number: of the parameter."""

    def __init__(self, node, runs, off_time_ms):
        family = node.family
        fault = family.off_time_fault
        self.address = node.address
        self.number = "P%04d" % (family.off_time_number or USUAL_NUMBER)
        self.runs = runs
        self.node = node
        self.off_time_ms = off_time_ms
        self.fault = family.fault_format % fault if fault else "a fault"

    @property
    def pause_s(self):
        """It is to be asked so often."""
        return min(self.off_time_ms / 1000 / SHARE, ASKED_MAX_S)

    def tell(self, screen, text):
        screen.event(
            text.format(self, does="runs" if self.runs else "stands"), address=self.address,
            trips=self.fault, after_ms=self.off_time_ms, runs=self.runs, asked_on=text is ASKED_ON,
        )  # fmt: skip


def leave(line):
    """Tell which drives trip by the end of this command, and stay as long as `line.stays` says."""
    if line.link.is_cut or line.is_taken:
        return
    found = list(_commanded(line) if line.commands else _asked(line))
    if not found:
        return
    stays = line.stays
    if stays is None:
        stays = any(one.runs for one in found)
    if stays and not line.bus.drives:  # else STOP is still on its way to one
        for one in found:
            one.tell(line.screen, ASKED_ON)
        if _stay(line, found):
            line.screen.event(TAKEN_OVER)
            return
    for one in found:
        one.tell(line.screen, LATE_TRIP)


def _asked(line):
    """Those of the drives that were asked: each says whether its motor runs, and its time."""
    for node in line.nodes.values():
        number = node.family.off_time_number
        off_time_ms = node.off_time_ms
        line.at(node.baud)
        try:
            if number is not None and node.layout.pkw_words:
                job = line.ask(node, pkw.read(number, node.family.link_index))
                if job.state == pkw.DONE:  # as it is by now
                    off_time_ms = job.integer_value() * node.family.off_time_unit_ms
            elif off_time_ms:
                line.see(node)
        except Failure:
            if line.link.is_cut or line.is_taken:
                return
            continue  # it is lost
        if off_time_ms:
            one = Supervised(node, node.runs, off_time_ms)
            if not node.has_fault:
                yield one
            elif not node.had_fault:
                one.tell(line.screen, HAS_TRIPPED)


def _commanded(line):
    """Those of the drives that this bus has commanded. It commands none of them any more if all of
    them rest."""
    for drive in list(line.bus.drives):
        family = drive.family
        if family.off_time_number is None or not drive.layout.pkw_words or not drive.contact:
            continue
        try:
            value = drive.read(family.off_time_number, family.link_index)
            if value and not drive.fault:
                node = line.left(drive)
                yield Supervised(node, drive.is_running, value * family.off_time_unit_ms)
        except UssError:
            continue  # it is lost, or has no such parameter


def _stay(line, found):
    """Ask them until another master talks: True; or Ctrl-C: False."""
    rates = sorted({one.node.baud for one in found})
    pause_s = min(one.pause_s for one in found) / len(rates)
    try:
        while True:
            for baud in rates:
                line.at(baud)
                for one in found:
                    if one.node.baud == baud:
                        line.visit(one.node)
                line.rest(pause_s)
    except KeyboardInterrupt:
        return False
    except Failure:
        if line.link.is_cut:
            raise
        return True
