# SPDX-License-Identifier: MIT
"""monitor and record: what drives do, over time, without telling them anything."""

import csv
import time

from tools.uss_command.errors import Failure, Misused
from tools.uss_command.facts import parameter
from tools.uss_command.files.svg import chart
from tools.uss_command.line import Line
from uss import bits, pkw, pzd
from uss.bus import STATES
from uss.families import rows as survey_rows
from uss.families.questions import value as value_of_row
from uss.families.rows import index_of
from uss.scaling import Scale

COLUMNS = ("address", "state", "hertz", "percent", "zsw", "bits", "fault", "per_s", "bad")
WORDS = {"zsw": "", "hiw": "", "hertz": "Hz", "percent": "%"}
USUAL = (
    "READY_TO_SWITCH_ON", "READY_TO_RUN", "RUNNING", "FAULT", "INHIBIT", "CONTROL_REQUESTED",
    "BRAKE", "BRAKE_OPEN", "RUNS_RIGHT",
)  # fmt: skip
VALUES_MAX = 32
KEEP_S = 0.2  # between two telegrams to a drive, in a third of the least P2014 that is usual


def add(commands):
    parser = commands.add_parser("monitor", help="state, speed, faults and rates of the drives")
    add_times(parser, 1.0)
    parser.set_defaults(run=monitor)
    parser = commands.add_parser("record", help="values over time, to CSV and SVG")
    parser.add_argument("csv", metavar="FILE.csv")
    parser.add_argument("--values", required=True, metavar="LIST",
                        help="such as r0027,r0026[0],hertz; also " + " ".join(WORDS))  # fmt: skip
    parser.add_argument("--svg", metavar="FILE", help="a picture of them as well")
    add_times(parser, 0.5)
    parser.set_defaults(run=record)


def add_times(parser, every_s):
    parser.add_argument("--every", type=float, default=every_s, metavar="S", help="(%(default)s)")
    parser.add_argument("--for", dest="seconds", type=float, metavar="S", help="until Ctrl-C else")


def rounds(line, chosen, keep):
    """The seconds since the beginning, every so often, until the time is over or Ctrl-C. keep: is
    called meanwhile, so that no drive trips because it hears nothing."""
    if not chosen.every > 0:
        raise Misused("--every: more than 0 s")
    began_s = time.monotonic()
    count = 0
    try:
        while True:
            now_s = time.monotonic() - began_s
            yield now_s
            count = max(count + 1, int(now_s / chosen.every) + 1)
            if chosen.seconds is not None and count * chosen.every > chosen.seconds:
                return
            next_s = began_s + count * chosen.every
            while time.monotonic() < next_s:
                left_s = next_s - time.monotonic()
                line.rest(min(left_s, KEEP_S))
                if left_s > KEEP_S:
                    keep()
    except KeyboardInterrupt:
        return


class Watched:
    """One drive. node: None until it answers."""

    def __init__(self, line, address):
        self.line = line
        self.address = address
        self.node = None
        self.scale = None
        self.lost = "silent"
        self._counted = (0.0, 0)

    def look(self):
        """Visit it; whether it answers."""
        try:
            if self.node is None:
                self.node = self.line.node(self.address)
                self.scale = scale_of(self.line, self.node)
            self.line.see(self.node)
        except Failure as reason:
            if self.line.link.is_cut or self.line.bus.foreign:
                raise
            self.lost = str(reason)
            if self.node is not None:
                self.node.forget()
            return False
        return True

    def keep(self):
        """Let it hear something."""
        if self.node is not None and self.node.visit.in_a_row == 0:
            self.line.visit(self.node)

    def word(self, name):
        """zsw, hiw, hertz or percent of the last reply; None: it does not tell."""
        words = self.node.visit.words
        if name == "zsw":
            return self.node.zsw
        if len(words) < 2:
            return None
        if name == "hiw":
            return words[1]
        signed = pzd.signed_hiw(self.node.family, words[1], words[0])
        try:
            value = getattr(self.scale, name)(signed)
        except (AttributeError, TypeError, ValueError):
            return None
        return round(value, 3)

    def read(self, number, index):
        job = self.line.ask(self.node, pkw.read(number, index))
        return None if job.state == pkw.REFUSED else self.node.facts.value(job)

    def row(self, now_s):
        """Of the table of `monitor`."""
        row = {"address": self.address}
        if not self.look():
            return {**row, "state": "no contact", "bits": self.lost}
        zsw = self.word("zsw")
        if zsw is not None:
            row.update(
                state=STATES[pzd.state(zsw)], zsw="%04X" % zsw, hertz=self.word("hertz"),
                percent=self.word("percent"),
                bits=remarkable(zsw, self.node.family),
            )  # fmt: skip
            number = self.node.family.fault_number
            if zsw & pzd.ZSW_FAULT and number is not None and self.node.layout.pkw_words:
                told = self.node.facts.fault(self.read(number, 0) or 0)
                row["fault"] = " ".join([told["fault"], told.get("name", "")]).strip()
        visit = self.node.visit
        before_s, before = self._counted
        if now_s > before_s + KEEP_S:
            row["per_s"] = round((visit.good - before) / (now_s - before_s), 1)
        self._counted = now_s, visit.good
        row["bad"] = visit.bad
        return row


def remarkable(zsw, family):
    """The names of the bits that `state` does not tell."""
    names = bits.names(zsw, family.zsw_bits)
    return " ".join(name for name in names if name not in USUAL)


def scale_of(line, node):
    """What 100 % of the actual value is, as far as the drive tells; else of 4000h."""
    survey, values = node.family.survey, [survey_rows.UNKNOWN] * survey_rows.COUNT_OF_ROWS
    absolute, reference = survey_rows.ABSOLUTE, survey_rows.REFERENCE
    if not node.layout.pkw_words:
        return Scale()
    for row in (survey_rows.DRIVE_SET, absolute, reference):
        if survey[row]:
            job = line.ask(node, pkw.read(survey[row][0], index_of(survey[row], values)))
            if job.state == pkw.DONE:
                values[row] = value_of_row(job, survey[row][2], values[absolute] > 0)
    is_absolute = survey[absolute] and values[absolute] == node.family.absolute_value
    if values[reference] == survey_rows.UNKNOWN:
        return Scale(absolute=bool(is_absolute))
    if survey[reference][2] == survey_rows.RPM:
        return Scale(reference_rpm=values[reference], absolute=bool(is_absolute))
    return Scale(reference_hertz=values[reference], absolute=bool(is_absolute))


def monitor(screen, settings, chosen):
    with Line(screen, settings, chosen) as line:
        line.listen()
        for address in settings.addresses:
            line.permit(address)
        watched = [Watched(line, address) for address in settings.addresses]
        with screen.live() as show:
            for now_s in rounds(line, chosen, lambda: [one.keep() for one in watched]):
                rows = [one.row(now_s) for one in watched]
                title = "%s, %d baud, %.0f s; Ctrl-C ends" % (settings.port, line.baud, now_s)
                show(title, COLUMNS, rows)
    if all(one.node is None for one in watched):
        raise Failure(watched[0].lost)


def record(screen, settings, chosen):
    values = [value_of(word) for word in chosen.values.split(",")]
    if len(values) > VALUES_MAX:
        raise Misused("--values: %d at the most" % VALUES_MAX)
    with Line(screen, settings, chosen) as line:
        line.listen()
        watched = Watched(line, settings.the_address())
        if not watched.look():
            raise Failure(watched.lost)
        heads = [head_of(watched.node, value) for value in values]
        rows = []
        try:
            file = open(chosen.csv, "w", newline="", encoding="utf-8")
        except OSError as error:
            raise Failure("%s: %s" % (chosen.csv, error.strerror)) from None
        with file:
            writer = csv.writer(file)
            writer.writerow(["time_s"] + heads)
            for now_s in rounds(line, chosen, watched.keep):
                is_there = watched.look()
                row = [round(now_s, 3)]
                row += [_one(watched, value) if is_there else None for value in values]
                rows.append(row)
                writer.writerow(row)
                file.flush()
    if chosen.svg:
        try:
            with open(chosen.svg, "w", encoding="utf-8") as file:
                file.write(chart(heads, rows))
        except OSError as error:
            raise Failure("%s: %s" % (chosen.svg, error.strerror)) from None
    screen.event("%d rows in %s" % (len(rows), chosen.csv), rows=len(rows), file=chosen.csv)


def value_of(word):
    """A name of WORDS, or (number, index). Misused."""
    return word if word in WORDS else parameter(word)


def head_of(node, value):
    if value in WORDS:
        unit = WORDS[value]
        name = value
    else:
        unit = node.facts.unit(value[0])
        name = " ".join([node.facts.label(*value), node.facts.name(value[0])]).strip()
    return "%s (%s)" % (name, unit) if unit else name


def _one(watched, value):
    return watched.word(value) if value in WORDS else watched.read(*value)
