# SPDX-License-Identifier: MIT
"""From figures to the table that people read. It measures nothing and knows no row by name.

In use:

    judged = judge(ROWS, {task: figures})
    print(page(judged, versions, "2026-01-31", "./tools/bench", quick=False))
    sys.exit(status(judged))
"""

from typing import NamedTuple

from tools.benching import beside_s7

MET, NOT_MET, NO_BAR, FAILED = "met", "NOT MET", "", "FAILED"

HEAD = ("what", "bar", "figure", "")


class Judged(NamedTuple):
    row: object
    figure: str
    verdict: str


def judge(rows, figures):
    """figures: {task: {name: figure}}, with "error" where there are none."""
    return [judge_row(row, figures[row.task]) for row in rows]


def judge_row(row, figures):
    if "error" in figures:
        return Judged(row, figures["error"], FAILED)
    if row.holds is None:
        return Judged(row, row.show(figures), NO_BAR)
    return Judged(row, row.show(figures), MET if row.holds(figures) else NOT_MET)


def status(judged):
    """0: every bar of the chip holds. 1: one does not, or could not be measured."""
    bad = [line for line in judged if line.row.task.on_chip and line.verdict in (NOT_MET, FAILED)]
    return 1 if bad else 0


def table(judged):
    lines = [HEAD, ("---",) * len(HEAD)]
    for row, figure, verdict in judged:
        lines.append((row.what, row.bar, figure.replace("|", "/"), verdict))
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def page(judged, versions, date, command, quick):
    """All of it, Markdown."""
    chip = [line for line in judged if line.row.task.on_chip]
    parts = ["# What the firmware does, in figures", INTRODUCTION]
    if quick:
        parts.append("QUICK: few samples. What is rare may not have shown itself.")
    parts.append(origin(versions, date, command))
    ours = {line.row.beside: line.figure for line in chip if is_beside(line)}
    if ours:
        parts.append(beside_s7.section(ours))
    if chip:
        parts += ["## On the chip", CHIP, table(chip)]
    return "\n\n".join(parts + host_parts(judged))


def is_beside(line):
    """Whether it stands in the table of `beside_s7`."""
    return line.row.beside and line.verdict != FAILED


def with_host(page_before, judged, versions, date, command, quick):
    """A page of an earlier run, with what was measured on the host in place of what it says."""
    kept = page_before.partition("\n\n" + HOST_HEAD)[0].rstrip()
    head, *parts = host_parts(judged)
    return "\n\n".join([kept, head, origin(versions, date, command), *parts])


def origin(versions, date, command):
    return "%s, `%s`\n\n    %s" % (date, command, "\n    ".join(versions))


def host_parts(judged):
    """The paragraphs about the host, the first of which is the heading; [] if there are none."""
    host = [line for line in judged if not line.row.task.on_chip]
    alone = [line for line in host if not line.row.task.beside]
    beside = [line for line in host if line.row.task.beside]
    parts = [HOST_HEAD] if host else []
    if alone:
        parts.append(table(alone))
    if beside:
        parts += ["### Beside other libraries", BESIDE, table(beside)]
    return parts


INTRODUCTION = "Written by `tools/bench`. A figure that does not reach its bar is shown as it is."

HOST_HEAD = "## On this host"

BESIDE = """\
CPython, one process, in turn; of each the median of seven runs, in the processor's time: what a
library sleeps does not count. Each has a transport in memory that answers at once, and each reply
has ten words: 24 characters of USS (4 PKW and 6 PZD words), 25 of Modbus RTU (ten registers).
Parsed: check the reply, take the words out. An exchange: build a request, hand it over, take the
reply, check it, take the values out. Ours goes through `uss.bus`: each exchange has a parameter's
question and its answer, and keeps the list, the deadlines and the counters of the bus besides.
TurboCtl, the other master of USS, knows one kind of pump, and makes numbers and bits of the
words; MinimalModbus, PyModbus and uModbus talk Modbus. tools/benching/requirements.txt has their
versions."""

CHIP = """\
An emulated Raspberry Pi Pico with the firmware frozen in (`tools/uf2`). The cache through which it
reads its flash is modelled: 16 KiB, two ways, lines of 8 bytes, 60 cycles for one that is not in
it. Computing time is right to 30 %, the wires to the nanosecond. While it is measured, keys are
pressed, the display changes, and garbage is collected every 100 ms, unless the row says otherwise.
What the menu needs comes from the flash, a module in a step of the loop: frozen modules, or files,
for which a step takes the time of the chip's file system.
One drive, telegrams of 16 characters, replies after 2 characters, unless the row says
otherwise."""
