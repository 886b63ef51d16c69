# SPDX-License-Identifier: MIT
"""The Python end of the pipe to the emulated chip: the protocol, and nothing of what it is for.

It is no chip and no world: it writes records, lets the chip run, and hands over what it answers.
README.md has the table of the records. Runs on the Unix port, started by launch.py.

    chip = connection()                     # the one of this process; its time goes on and on
    chip.tell(chip.now_ns, "P", 13, 0)      # START is held down
    chip.run(chip.now_ns + 1_000_000, take) # take(at_ns, kind, a, b, content) for every answer
"""

import json
import os
import struct

RECORD = "<QBBH"
RECORD_BYTES = 12
KIND_AT, HEARD = 8, ord("C")
CONTENT_MAX = 0xFFFF

# Kinds of record that have a content behind them, of b bytes.
WITH_CONTENT = "NUF!"

# How chips of this process are modelled where nobody says anything: {setting: value} of the table
# in README.md. Empty: as it says there.
usual = {}


class EmulatorError(Exception):
    """The emulator failed, or has ended. Text: what it said."""


class Chip:
    """reader, writer: binary files, to the emulator and from it.

    now_ns    how far the chip has come
    """

    def __init__(self, reader, writer):
        self.now_ns = 0
        self._reader = reader
        self._writer = writer
        self._whole = True  # no answer was broken off, as by Ctrl-C
        self._waiting = []  # (at_ns, record and content), in the order of time
        self._heard_until_ns = None  # what was to be received later was taken back

    def begin(
        self,
        program,
        watch,
        baud,
        flash=None,
        keep=False,
        usb=True,
        i2c=(),
        model=None,
        jumpers=(),
    ):
        """A new chip in place of the old one; power comes now.

        program: path of a UF2 file. watch: GPIOs whose output is told ("E"). baud: of the line.
        flash: path of a flash image to begin with; keep: and the program in it stays. i2c:
        addresses that acknowledge. model: what is modelled otherwise than `usual` says. jumpers:
        (from, to) of the wires that join a GPIO to another one.
        """
        self.take_back(self.now_ns)  # what the old one was to hear
        self._waiting = []
        wanted = {
            "uf2": program,
            "flash": flash,
            "keep": keep,
            "usb": usb,
            "baud": baud,
            "watch": list(watch),
            "i2c": list(i2c),
            "model": dict(usual),
            "jumpers": [list(jumper) for jumper in jumpers],
        }
        wanted["model"].update(model or {})
        self.tell(self.now_ns, "N", content=json.dumps(wanted).encode())

    def tell(self, at_ns, kind, a=0, b=0, content=None):
        """Something happens to the chip at `at_ns`; what should have happened before, now."""
        at_ns = max(at_ns, self.now_ns)
        if content is not None:
            if len(content) > CONTENT_MAX:
                raise ValueError("a record holds %d bytes" % CONTENT_MAX)
            b = len(content)
        record = struct.pack(RECORD, at_ns, ord(kind), a, b) + (content or b"")
        waiting = self._waiting
        place = len(waiting)
        while place and waiting[place - 1][0] > at_ns:
            place -= 1
        waiting.insert(place, (at_ns, record))

    def take_back(self, after_ns):
        """Characters that were to be received later than `after_ns` do not come."""
        waiting = self._waiting
        self._waiting = [one for one in waiting if one[0] <= after_ns or one[1][KIND_AT] != HEARD]
        earlier_ns = self._heard_until_ns
        self._heard_until_ns = after_ns if earlier_ns is None else min(after_ns, earlier_ns)

    def run(self, until_ns, take, goes_on_percent=0):
        """Let the chip run until `until_ns`, or until it stops early; `now_ns` says how far.

        take(at_ns, kind, a, b, content) is called for everything that the chip did meanwhile.
        goes_on_percent: of a bit, from the beginning of a character that the chip sends with its
        driver on to where it stops; the next character moves that. 0: it stops at each.
        """
        if not self._whole:
            raise EmulatorError("the emulator was interrupted in the middle of an answer")
        self._whole = False
        told = []
        if self._heard_until_ns is not None:
            told.append(struct.pack(RECORD, self._heard_until_ns, ord("W"), 0, 0))
            self._heard_until_ns = None
        waiting = self._waiting
        while waiting and waiting[0][0] <= until_ns:
            told.append(waiting.pop(0)[1])
        told.append(struct.pack(RECORD, until_ns, ord("R"), 0, goes_on_percent))
        self._writer.write(b"".join(told))
        reached_ns, _, high, low = struct.unpack(RECORD, self._read(RECORD_BYTES))
        failure = self._hand_over(self._read(high << 16 | low), take)
        self.now_ns = reached_ns
        self._whole = True
        if failure:
            raise EmulatorError(failure)

    @staticmethod
    def _hand_over(answer, take):
        """Give an answer's records to `take`. Answers what the emulator failed at, or None."""
        failure = None
        at = 0
        while at < len(answer):
            at_ns, kind, a, b = struct.unpack_from(RECORD, answer, at)
            at += RECORD_BYTES
            content = None
            kind = chr(kind)
            if kind in WITH_CONTENT:
                content = answer[at : at + b]
                at += b
            if kind == "!":
                failure = failure or content.decode()
            else:
                take(at_ns, kind, a, b, content)
        return failure

    def _read(self, count):
        content = self._reader.read(count) if count else b""
        if len(content) != count:
            raise EmulatorError("the emulator has ended")
        return content


_connection = []


def connection():
    """The chip that launch.py has put beside this process. EmulatorError: there is none."""
    if not _connection:
        ends = [os.getenv(name) for name in ("USS_PICO_READ", "USS_PICO_WRITE")]
        if None in ends:
            raise EmulatorError("no chip: start this by tools/emulator/launch.py")
        _connection.append(Chip(open(int(ends[0]), "rb"), open(int(ends[1]), "wb")))
    return _connection[0]
