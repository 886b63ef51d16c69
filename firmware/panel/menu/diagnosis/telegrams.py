# SPDX-License-Identifier: MIT
"""The last telegrams to a drive and from it, in words and in hexadecimal. SET holds them.

A4 SENT      1/16       the task, PWE, STW and HSW, then all characters, seven to a row
>READ P2024[0]

A4 HEARD     8/16       what the receiver found, and if that is good: reply, PWE, ZSW and HIW
>NO REPLY
"""

from micropython import const

from panel import texts
from panel.menu import Entries
from panel.menu.diagnosis import words
from uss import pkw, pzd
from uss.telegram import BAD_LENGTH, GOOD, NET, get_word
from uss.finding.witness import KEPT, Witness

_ROW = const(7)  # characters in hexadecimal
_PKE, _PWE, _CONTROL, _MAIN = const(0), const(1), const(2), const(3)  # of the words
_NUMBER = const(0x7FF)
_STWS = (pzd.OFF1, pzd.OFF2, pzd.OFF3, pzd.ON, pzd.ON_REVERSE, pzd.JOG_RIGHT, pzd.JOG_LEFT)
_WRITES = const(1 << 2 | 1 << 3 | 1 << 7 | 1 << 8)  # tasks that write
_REFUSED, _NO_RIGHTS = const(7), const(8)  # replies


class List(Entries):
    """argument: the `Control` of a drive."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        bus = panel.bus
        self._witness = Witness(bus.timing.character_us, panel.mask, argument.drive.address)
        bus.witness = self._witness

    def count(self):
        return len(self._entries())

    def heading(self, position):
        entries = self._entries()
        is_reply = entries[min(position, len(entries) - 1)][0]
        text = words.HEARD if is_reply else words.SENT
        if self._witness.is_held:
            text = words.HELD
        return texts.of(text, self.argument.drive.address)

    def words(self, position):
        witness = self._witness
        if witness.finding < 0:
            return texts.of(words.NONE_YET)
        entries = self._entries()
        is_reply, word, at = entries[min(position, len(entries) - 1)]
        data, count = witness.request, witness.request_count
        if is_reply:
            data, count = witness.reply, witness.reply_count
        if at >= 0:
            count = min(count, KEPT, at + _ROW)
            return b"".join([b"%02X" % data[index] for index in range(at, count)])
        if word < 0:
            text = words.FINDINGS[witness.finding]
            if witness.finding == BAD_LENGTH:
                return texts.of(text, count)
            return texts.of(text)
        return self._word(data, count, is_reply, word)

    def control_at(self, position):
        return self.argument

    def choose(self, position, now_ms):
        self._witness.is_held = not self._witness.is_held

    def end(self):
        self.panel.bus.witness = None

    def _entries(self):
        """(whether of the reply, word or -1, first character in hexadecimal or -1) of each."""
        witness, layout = self._witness, self.argument.drive.layout
        told = [word for word in (_PKE, _PWE) if layout.pkw_words]
        told += [word for word in (_CONTROL, _MAIN)[: layout.pzd_words]]
        entries = [(False, word, -1) for word in told]
        entries += [(False, -1, at) for at in range(0, min(witness.request_count, KEPT), _ROW)]
        entries.append((True, -1, -1))
        if witness.finding == GOOD:
            entries += [(True, word, -1) for word in told]
        return entries + [(True, -1, at) for at in range(0, min(witness.reply_count, KEPT), _ROW)]

    def _word(self, data, count, is_reply, word):
        """A part of a telegram in words."""
        layout = self.argument.drive.layout
        at = count - 1 - layout.pzd_count
        if word == _PKE or word == _PWE:
            if at == NET:  # a short telegram
                return texts.of(words.NO_TASK)
            first, second = get_word(data, NET + 4), get_word(data, NET + 6)
            if word == _PWE:
                return texts.of(words.PWE, first, second if at >= NET + 8 else 0)
            error = second if layout.pkw_words == 4 else first
            return _task(get_word(data, NET), get_word(data, NET + 2), error, is_reply)
        if at + 4 > KEPT:  # a long text goes before it
            return b"..."
        if word == _CONTROL:
            value = get_word(data, at)
            if is_reply:
                state = texts.of(texts.FOUND_STATES[pzd.state(value)])
                return texts.of(words.ZSW, value, state)
            meant = b""
            if value in _STWS:
                meant = texts.of(words.COMMANDS[_STWS.index(value)])
            return texts.of(words.STW, value, meant)
        value = get_word(data, at + 2)
        percent = (pzd.signed(value) * 200 // pzd.FULL_SCALE + 1) // 2
        return texts.of(words.HIW if is_reply else words.HSW, value, percent)


def _task(pke, ind, error, is_reply):
    """A task or a reply, and its parameter. error: the number, if it is an error."""
    code = pke >> 12
    if not code:
        return texts.of(words.NO_TASK)
    if is_reply and code == _REFUSED:
        return texts.of(words.REFUSES, error)
    if is_reply and code == _NO_RIGHTS:
        return texts.of(words.NO_RIGHTS)
    page = ind >> 15 | ind >> 11 & 0x0E | ind >> 6 & 0x30
    text = words.READS
    if is_reply:
        text = words.TELLS
    elif _WRITES >> code & 1:
        text = words.WRITES
    elif pkw.FIRST_PERMANENT <= code < pkw.TEXT:
        text = words.STORES
    row = texts.of(text, (pke & _NUMBER) + page * pkw.PNU_PER_PAGE, ind & 0xFF)
    if len(row) > texts.ROW_WIDTH - 1:  # cut at its end, it would tell another index
        row = row[: row.index(b"[")] + b".."
    return row
