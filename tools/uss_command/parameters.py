# SPDX-License-Identifier: MIT
"""read and write: the parameters of a drive, by number and index."""

from tools.uss_command.errors import FAILED, Failure
from tools.uss_command.facts import DOUBLES, TYPES, number_of, parameter
from tools.uss_command.line import Line
from uss import pkw
from uss.bus.pkw_errors import error_text

COLUMNS = ("parameter", "value", "unit", "name", "type")
ASKS = {
    "C": "%s may take drive %d away from this bus",
    "R": "%s changes what a setpoint means",
}
KINDS = {"word": ("U16", "I16"), "dword": ("U32", "I32", "BICO", "?32"), "float": ("Float", "?32")}
SAID = {"U16": "a word", "I16": "a word", "Float": "a float"}  # others are double words
RANGES = {"U16": (-0x8000, 0xFFFF), "U32": (-0x80000000, 0xFFFFFFFF)}


def add(commands):
    parser = commands.add_parser("read", help="read parameters: P0700 P1082 r0021[0]")
    parser.add_argument("parameters", nargs="+", metavar="P0700")
    add_type(parser)
    parser.set_defaults(run=read)
    parser = commands.add_parser("write", help="write a parameter: P1082 40.5")
    parser.add_argument("parameters", nargs=1, metavar="P1082")
    parser.add_argument("value", metavar="VALUE", help="40.5, 0x1F, or a connector 52:3")
    parser.add_argument(
        "--eeprom", action="store_true", help="RAM and EEPROM; RAM alone otherwise"
    )
    parser.add_argument("--sure", action="store_true", help="also what may cut the bus off")
    add_type(parser)
    parser.set_defaults(run=write)


def add_type(parser):
    parser.add_argument("--type", choices=TYPES, help="say what it is; a wrong one is refused")


def read(screen, settings, chosen):
    asked = [parameter(word) for word in chosen.parameters]
    rows, status = [], 0
    with Line(screen, settings, chosen) as line:
        line.listen()
        node = line.node(settings.the_address())
        for number, index in asked:
            job = line.ask(node, pkw.read(number, index))
            if job.state == pkw.REFUSED:
                status = FAILED
                label = node.facts.label(number, index)
                rows.append({"parameter": label, "value": None, "error": error_text(job.error),
                             "name": node.facts.name(number)})  # fmt: skip
            else:
                rows.append(row_of(node, job, checked_type(node, job, chosen.type)))
        show(screen, "drive %d" % node.address, rows)
    return status


def write(screen, settings, chosen):
    ((number, index),) = [parameter(word) for word in chosen.parameters]
    with Line(screen, settings, chosen) as line:
        line.listen()
        node = line.node(settings.the_address())
        job = line.do(node, pkw.read(number, index))
        kind = checked_type(node, job, chosen.type)
        value = number_of(chosen.value, kind)
        why = ASKS.get(node.facts.asks(number)[:1])
        if why and not chosen.sure:
            label = node.facts.label(number, index)
            what = why % ((label, node.address) if "%d" in why else label)
            raise Failure("%s; --sure writes it all the same" % what)
        if number == node.family.address_number:
            line.see(node)
            if node.runs:
                raise Failure(
                    "drive %d runs: stop it before it gets another address" % node.address
                )
        before = node.facts.of_words(kind, job)
        job = line.do(node, writing(node, number, index, value, kind, chosen.eeprom))
        row = {**row_of(node, job, kind), "before": before}
        show(screen, "drive %d, %s" % (node.address, "EEPROM" if chosen.eeprom else "RAM"), [row])


def show(screen, title, rows):
    columns = COLUMNS
    if any("error" in row for row in rows):
        columns = ("parameter", "value", "error", "name")
    if not screen.as_json:
        rows = [{**row, "value": row.get("shown", row["value"])} for row in rows]
    screen.table(title, columns, rows)


def checked_type(node, job, said):
    """The type of what was read. Failure: it is not what somebody has said."""
    kind = node.facts.kind(job)
    if said is None:
        return kind
    if kind not in KINDS[said]:
        label = node.facts.label(job.number, job.index)
        raise Failure("%s is %s, not of type %s" % (label, SAID.get(kind, "a double word"), said))
    return {"float": "Float", "dword": "U32" if kind == "?32" else kind}.get(said, kind)


def row_of(node, job, kind):
    facts = node.facts
    value = facts.of_words(kind, job)
    return {
        "parameter": facts.label(job.number, job.index),
        "value": value,
        "shown": facts.shown(job.number, value, kind),
        "unit": facts.unit(job.number),
        "name": facts.name(job.number),
        "type": kind,
    }


def writing(node, number, index, value, kind, eeprom=False):
    """The job that writes it. Failure: it does not fit, or the drive has no such task."""
    if eeprom and not node.family.has_eeprom_tasks:
        raise Failure("a %s writes no EEPROM by a task: P0971 = 1 afterwards" % node.family.name)
    if kind == "Float":
        try:
            return pkw.write_float(number, value, index, eeprom)
        except OverflowError:
            raise Failure("%s is no single-precision number" % value) from None
    least, most = RANGES["U32" if kind in DOUBLES or kind == "?32" else "U16"]
    if not least <= value <= most:
        raise Failure("%d is not within %d...%d" % (value, least, most))
    make = pkw.write_double if most > 0xFFFF else pkw.write_word
    return make(number, value, index, eeprom)
