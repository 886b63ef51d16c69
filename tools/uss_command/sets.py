# SPDX-License-Identifier: MIT
"""backup, restore and compare: all parameters of a drive, as a file (`set_file`).

A backup only reads. A restore wants a motor that stands, and writes what differs: back to the same
drive all but what may cut the bus off or change what a setpoint means (--all: that too, last); to
another one also not what belongs to its place on the bus, nor, if it has another rating, its
motor's data.
"""

import os

from tools.uss_command.errors import FAILED, Failure, Misused
from tools.uss_command.facts import DOUBLES, Facts, single
from tools.uss_command.files.set_file import (
    NAME_MAX,
    ParameterSet,
    Row,
    read_whole,
    text_of,
    write_whole,
)
from tools.uss_command.line import Line
from uss import families, pkw
from uss.bus.pkw_errors import error_text

COLUMNS = ("parameter", "here", "there", "unit", "name")
RATINGS = {"mm3": (111, 112)}
USUAL_RATINGS = (206, 207, 208)
ABSENT = (0, 3, 4)  # no such parameter, no such index, no array

# What starts something, or selects a mode: it is no setting.
NEVER = (10, 11, 12, 40, 340, 944, 952, 970, 971, 1900, 1910, 1960, 2111, 3900)
# What another drive keeps, besides what asks first: bus and sources; first and last number.
BUS_AND_SOURCES = (
    (700, 719), (800, 927), (1000, 1000), (1055, 1056), (1070, 1076), (1110, 1113), (1140, 1142),
    (2009, 2051), (2103, 2106),
)  # fmt: skip
# What a drive with another rating keeps: motor and rating.
MOTOR = ((100, 100), (200, 399), (601, 640), (1800, 1825), (1900, 1926), (1960, 1960))
OF_FAMILY = {"mm3": (((6, 7), (91, 95)), ((71, 89), (101, 101)))}
COMMISSIONING = 10  # P0010: 1 while what only changes then is written
NOT_IN_THIS_STATE = 17


def add(commands):
    parser = commands.add_parser("backup", help="all parameters of a drive into a file")
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("--name", default="", help="of the set, %d letters" % NAME_MAX)
    parser.add_argument("--numbers", metavar="LIST", help="only these: 0-1999,2010-2014")
    parser.add_argument("--bare", action="store_true", help="without remarks, for a panel")
    parser.set_defaults(run=backup)
    parser = commands.add_parser("restore", help="write a file into a drive, what differs of it")
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("--all", action="store_true", help="also what may cut the bus off, last")
    parser.add_argument(
        "--eeprom", action="store_true", help="RAM and EEPROM; RAM alone otherwise"
    )
    parser.add_argument("--dry-run", action="store_true", help="only say what would be written")
    parser.set_defaults(run=restore)
    parser = commands.add_parser("compare", help="a file with the drive, or two files")
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("other", nargs="?", metavar="FILE")
    parser.set_defaults(run=compare)


def backup(screen, settings, chosen):
    name = chosen.name or "A%d" % settings.the_address()
    if len(name) > NAME_MAX or not name.isprintable() or "#" in name or not name.isascii():
        raise Misused("--name: at most %d letters of ASCII, no #" % NAME_MAX)
    numbers = ranges(chosen.numbers)
    write_whole(
        chosen.file + ".part", ""
    )  # whether there is room for it, before a minute of reading
    os.unlink(chosen.file + ".part")
    with Line(screen, settings, chosen) as line:
        line.listen()
        node = line.node(settings.the_address())
        one = read_set(screen, line, node, name, numbers)
    if not one.rows:
        raise Failure("drive %d has told no parameter" % node.address)
    write_whole(chosen.file, text_of(one, node.family.name, chosen.bare))
    screen.event(
        "%d values of drive %d (%s) in %s"
        % (len(one.rows), node.address, one.family, chosen.file),
        rows=len(one.rows), address=node.address, family=one.family, file=chosen.file,
    )  # fmt: skip


def compare(screen, settings, chosen):
    """Exit status 0: nothing differs; 1 otherwise."""
    one = read_whole(chosen.file)
    if chosen.other:
        other = read_whole(chosen.other)
        facts = facts_of(one.family)
    else:
        with Line(screen, settings, chosen) as line:
            line.listen()
            node = line.node(settings.the_address())
            facts = node.facts
            check_family(one, node, chosen.file)
            other = ParameterSet(one.family, node.address, "")
            with screen.progress("compare", len(one.rows)) as step:
                for row in one.rows:
                    job = line.ask(node, pkw.read(*row.place))
                    if job.state == pkw.DONE:
                        other.rows.append(row_of(facts, job, row.kind))
                    step()
    return show_differences(screen, facts, one, other)


def restore(screen, settings, chosen):
    one = read_whole(chosen.file)
    with Line(screen, settings, chosen) as line:
        line.listen()
        node = line.node(settings.the_address())
        check_family(one, node, chosen.file)
        check_stands(line, node)
        writer = Writer(screen, line, node, chosen.eeprom)
        todo, left_out = writer.todo(one, chosen.all)
        if chosen.dry_run:
            rows = [difference(node.facts, old, new) for new, old in todo]
            screen.table("would be written", COLUMNS, rows, left_out=len(left_out))
            if not screen.as_json:
                screen.event("%d would be written, %d left out" % (len(todo), len(left_out)))
            return 0
        writer.write_all(todo)
        still = writer.differing(row for row, _ in todo)
    outcome = "%d written, %d left out" % (writer.written, len(left_out))
    if left_out and not chosen.all:
        outcome += " (what belongs to the place on the bus, or may cut it off: --all)"
    rows = writer.refused + [difference(node.facts, old, new) for new, old in still]
    screen.table("not as in the file", COLUMNS + ("error",), rows) if rows else None
    screen.event(outcome, written=writer.written, left_out=len(left_out), differ=len(rows))
    return FAILED if rows else 0


def check_family(one, node, file):
    if one.family != node.facts.catalogue:
        raise Failure(
            "%s is of a %s, drive %d is a %s" % (file, one.family, node.address, node.family.name)
        )


def check_stands(line, node):
    """Failure: its motor runs, or nobody knows."""
    line.see(node)
    if node.zsw is None and not line.standing:
        raise Failure("drive %d does not tell whether it runs: --standing if not" % node.address)
    if node.runs:
        raise Failure("drive %d runs: a set is written to one that stands" % node.address)


def ranges(text):
    """b"0-1999 2010-2014" for the catalogue, None for all. Misused."""
    if not text:
        return None
    parts = text.replace(" ", "").split(",")
    for part in parts:
        first, _, last = part.partition("-")
        if not first.isdigit() or not (last or first).isdigit() or int(last or first) > 32767:
            raise Misused("--numbers: %s is no list such as 0-1999,2010" % text)
    return " ".join(sorted(parts, key=lambda part: int(part.split("-")[0]))).encode()


def facts_of(family):
    return Facts(getattr(families, family.upper(), families.GENERIC))


def read_set(screen, line, node, name, numbers):
    """All that the catalogue says of the family and the drive tells. Failure."""
    facts = node.facts
    if facts.catalogue is None:
        raise Failure(
            "nobody knows what a %s has: say --kind if it is one of a family" % node.family.name
        )
    one = ParameterSet(facts.catalogue, node.address, name)
    for number in RATINGS.get(facts.catalogue, USUAL_RATINGS):
        job = line.ask(node, pkw.read(number))
        if job.state == pkw.DONE:
            one.ratings[number] = job.high if job.width == pkw.DOUBLE else 0, job.low
    asked = [place for place in facts.parameters(numbers) if place[0] not in NEVER]
    with screen.progress("backup of drive %d" % node.address, len(asked)) as step:
        for number, indices in asked:
            for index in range(indices):
                job = line.ask(node, pkw.read(number, index))
                if job.state == pkw.DONE:
                    row = row_of(facts, job)
                    row.remark = remark_of(facts, row)
                    one.rows.append(row)
                elif job.error in ABSENT:
                    break  # it has neither this index nor a higher one
            step()
    return one


def row_of(facts, job, kind=None):
    kind = kind or facts.kind(job)
    return Row(job.number, job.index, kind, job.high if job.width == pkw.DOUBLE else 0, job.low)


def value_of(row):
    """The value of a row, by its type."""
    if row.kind == "Float":
        return single(pkw.words_to_float(row.high, row.low))
    value = row.low if row.kind in ("U16", "I16") else row.high << 16 | row.low
    half = {"I16": 1 << 15, "I32": 1 << 31}.get(row.kind)
    return value - 2 * half if half and value >= half else value


def remark_of(facts, row):
    shown = facts.shown(row.number, value_of(row), row.kind)
    value = " ".join(part for part in (shown, facts.unit(row.number)) if part)
    return ", ".join(part for part in (value, facts.name(row.number)) if part)


def difference(facts, old, new):
    """A row of COLUMNS. old, new: rows, or None."""
    row = old or new
    return {
        "parameter": facts.label(*row.place),
        "here": "-" if new is None else facts.shown(row.number, value_of(new), new.kind),
        "there": "-" if old is None else facts.shown(row.number, value_of(old), old.kind),
        "unit": facts.unit(row.number),
        "name": facts.name(row.number),
    }


def show_differences(screen, facts, one, other):
    here, there = one.by_place(), other.by_place()
    rows = [
        difference(facts, there.get(place), here.get(place))
        for place in sorted(here.keys() | there.keys())
        if place not in here or place not in there or here[place].words != there[place].words
    ]
    screen.table("%d differ" % len(rows), COLUMNS, rows, differ=len(rows))
    if not rows and not screen.as_json:
        screen.event("all %d values are equal" % len(here))
    return FAILED if rows else 0


class Writer:
    """Writes rows of a set that differ. written: how many. refused: rows for people."""

    def __init__(self, screen, line, node, eeprom):
        self._screen = screen
        self._line = line
        self._node = node
        self._eeprom = eeprom
        self.written = 0
        self.refused = []

    def todo(self, one, with_all):
        """[(row, what the drive has)] that are to be written, in order; places left out."""
        node, facts = self._node, self._node.facts
        bus, motor = OF_FAMILY.get(one.family, (BUS_AND_SOURCES, MOTOR))
        is_other = one.address != node.address
        ratings = {}
        for number in one.ratings:
            job = self._line.ask(node, pkw.read(number))
            if job.state == pkw.DONE:
                ratings[number] = job.high if job.width == pkw.DOUBLE else 0, job.low
        is_rated_otherwise = ratings != one.ratings or is_other and not ratings
        usual, last, left_out = [], [], []
        for row, old in self.differing(one.rows):
            number = row.number
            asks = bool(facts.asks(number))
            keeps = is_other and (asks or _within(number, bus))
            if number in NEVER or keeps or is_rated_otherwise and _within(number, motor):
                left_out.append(row.place)
            elif asks and not with_all:
                left_out.append(row.place)
            else:
                (last if asks else usual).append((row, old))
        return usual + last, left_out

    def differing(self, rows):
        """[(row, what the drive has)]; what it lacks counts as equal."""
        rows = list(rows)
        found = []
        with self._screen.progress("compare", len(rows)) as step:
            for row in rows:
                job = self._line.ask(self._node, pkw.read(*row.place))
                if job.state == pkw.DONE:
                    old = row_of(self._node.facts, job, row.kind)
                    if old.words != row.words:
                        found.append((row, old))
                step()
        return found

    def write_all(self, todo):
        """Failure: the drive was lost in the middle, and what it has now."""
        late = []
        try:
            with self._screen.progress("restore", len(todo)) as step:
                for row, old in todo:
                    if not self._write(row, old, late):
                        step()
                if late:
                    self._write_in_commissioning(late, step)
        except Failure as reason:
            raise Failure(
                "%s. %d of %d were written: the drive has a part of the set; restore it again, or "
                "compare" % (reason, self.written, len(todo))
            ) from None

    def _write_in_commissioning(self, late, step):
        node, again = self._node, []
        self._line.do(node, pkw.write_word(COMMISSIONING, 1))
        try:
            for row, old in late:
                self._write(row, old, again)
                step()
        finally:
            self._line.do(node, pkw.write_word(COMMISSIONING, 0))
        for row, old in again:
            self._refuse(row, old, NOT_IN_THIS_STATE)

    def _write(self, row, old, late):
        """Whether it has to wait for the commissioning: then it is in `late`."""
        make = pkw.write_word if row.kind not in DOUBLES + ("?32",) else pkw.write_double
        value = row.low if make is pkw.write_word else row.high << 16 | row.low
        eeprom = self._eeprom and self._node.family.has_eeprom_tasks
        job = self._line.ask(self._node, make(row.number, value, row.index, eeprom))
        if job.state == pkw.DONE:
            self.written += 1
        elif job.error == NOT_IN_THIS_STATE:
            late.append((row, old))
            return True
        else:
            self._refuse(row, old, job.error)
        return False

    def _refuse(self, row, old, error):
        told = difference(self._node.facts, old, row)
        self.refused.append({**told, "error": error_text(error)})


def _within(number, spans):
    return any(first <= number <= last for first, last in spans)
