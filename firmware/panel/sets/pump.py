# SPDX-License-Identifier: MIT
"""Parameter tasks for one drive, one after the other.

    for _ in run(drive, tasks, take): ...       # each time a step of the loop has passed

tasks: an iterator of (what a `pkw.Job` aims at, tag), or None where a step is over. take(job, tag)
is told each that has ended, in order, and answers whether it is to be tried again.

Two readings are on their way at a time, so that every telegram carries one. But only one write is:
another one that waits would be carried out when a silent drive answers again, which may be long
after somebody has given up.
"""

from panel.sets.set_file import DOUBLES
from uss import pkw


def run(drive, tasks, take, jobs=2):
    idle = [pkw.read(0) for _ in range(jobs)]
    asked = []  # (job, tag), the first one was asked first
    is_over = is_long = False
    while asked or not is_over:
        has_taken = False
        while asked and asked[0][0].state != pkw.PENDING and not drive.channel.is_full():
            job, tag = asked[0]
            has_taken = True
            if take(job, tag):
                drive.ask(job)
            else:
                idle.append(asked.pop(0)[0])
        # What comes behind None takes long: a step of its own.
        while idle and not (is_over or is_long and has_taken or drive.channel.is_full()):
            is_long = False
            try:
                task = next(tasks)
            except StopIteration:
                is_over = True
                break
            if task is None:
                is_long = True
                break
            job = idle.pop()
            job.aim(*task[0])
            drive.ask(job)
            asked.append((job, task[1]))
        yield


def reads(family, number, index):
    """What a job aims at that reads an element."""
    is_element = index and family.has_array_tasks
    return pkw.READ_ELEMENT if is_element else pkw.READ, number, index


def writes(family, row, eeprom):
    """What a job aims at that writes a row of `set_file`."""
    _, number, index, kind, high, low = row
    eeprom = family.has_eeprom_tasks and (eeprom or number in family.permanent)
    tasks = _ELEMENT_TASKS if index and family.has_array_tasks else _TASKS
    return tasks[2 * eeprom + (kind in DOUBLES)], number, index, high, low


_TASKS = (pkw.WRITE_WORD, pkw.WRITE_DOUBLE, pkw.WRITE_WORD_EEPROM, pkw.WRITE_DOUBLE_EEPROM)
_ELEMENT_TASKS = (
    pkw.WRITE_ELEMENT_WORD, pkw.WRITE_ELEMENT_DOUBLE,
    pkw.WRITE_ELEMENT_WORD_EEPROM, pkw.WRITE_ELEMENT_DOUBLE_EEPROM,
)  # fmt: skip
