# SPDX-License-Identifier: MIT
"""sniff: listens to another master and its drives, and sends nothing."""

import time

from tools.uss_command.errors import Failure
from tools.uss_command.explanation import CONTROL, REQUESTED
from tools.uss_command.files.capture import Capture
from tools.uss_command.line import Line
from uss import bits, pzd, telegram
from uss.bus import STATES
from uss.telegram import NODE_MAX, STX

COLUMNS = (
    "address",
    "asked_per_s",
    "answered_per_s",
    "silent",
    "stw",
    "zsw",
    "state",
    "bits",
    "net",
)
FRESH_S = 1.0  # between two pictures
APART_US = 50_000  # what is so far apart is not of one telegram
UNCLEAR = CONTROL | REQUESTED


def add(commands):
    parser = commands.add_parser("sniff", help="listen only: who talks, how fast, STW and ZSW")
    parser.add_argument("--save", metavar="FILE", help="for decode --capture")
    parser.add_argument("--for", dest="seconds", type=float, metavar="S", help="until Ctrl-C else")
    parser.set_defaults(run=sniff)


def sniff(screen, settings, chosen):
    ear = Ear(settings)
    wrong = 0
    began_s = time.monotonic()
    try:
        with Line(screen, settings, chosen, ear.hear) as line, screen.live() as show:
            line.bus.off()  # from now on the bus swallows all and sends nothing
            ear.capture = Capture(chosen.save)
            until_s = None if chosen.seconds is None else began_s + chosen.seconds
            while until_s is None or time.monotonic() < until_s:
                left_s = FRESH_S if until_s is None else until_s - time.monotonic()
                line.bus.wait(max(min(FRESH_S, left_s), 0))
                wrong = line.link.parity_errors + line.link.frame_errors
                if screen.is_terminal:
                    show(ear.title(), COLUMNS, ear.rows())
                if line.link.is_cut:
                    raise Failure(line.link.notices[-1])
    except KeyboardInterrupt:
        pass
    finally:
        if ear.capture:
            ear.capture.close()
    if not screen.is_terminal:
        screen.table(ear.title(), COLUMNS, ear.rows(), errors=ear.errors, telegrams=ear.telegrams,
                     parity_errors=wrong)  # fmt: skip
    if not ear.telegrams:
        if ear.errors or wrong:
            raise Failure(
                "%d characters, and no telegram: another rate than %d baud, or not 8E1?"
                % (ear.errors + wrong, settings.baud)
            )
        raise Failure("nobody talks at all")


class Heard:
    """What was heard of an address."""

    def __init__(self):
        self.asked = self.answered = 0
        self.stw = self.zsw = None
        self.net = 0


class Ear:
    """Divides what is heard into telegrams, and these into requests and replies."""

    def __init__(self, settings):
        self._settings = settings
        self._rest = b""
        self._last_us = self._first_us = None
        self._asked = None  # the address of a request that has no reply yet
        self.heard = {}
        self.errors = 0  # characters that are of no telegram
        self.telegrams = 0
        self.capture = None

    def hear(self, is_sent, characters, at_us):
        """A watch of the link."""
        self._first_us = self._first_us or at_us
        if self._last_us is not None and at_us - self._last_us > APART_US:
            self.errors += len(self._rest)
            self._rest = b""
        self._last_us = at_us
        self._rest += characters
        while self._rest:
            size = self._rest[1] + 2 if len(self._rest) > 1 else 2
            if self._rest[0] == STX and len(self._rest) < size:
                return  # more may come
            whole = self._rest[:size]
            if self._rest[0] != STX or telegram.judge(whole, len(whole), None, None):
                self._rest = self._rest[1:]
                self.errors += 1
                continue
            self._rest = self._rest[size:]
            self._take(whole, at_us)

    def _take(self, whole, at_us):
        self.telegrams += 1
        address = whole[2]
        heard = self.heard.setdefault(address & NODE_MAX, Heard())
        word = self._process_word(whole, address & NODE_MAX)
        is_reply = self._asked == address
        if word is not None and word & UNCLEAR in (CONTROL, REQUESTED):
            is_reply = word & UNCLEAR == REQUESTED
        if is_reply:
            self._asked = None
            heard.answered += 1
            heard.zsw = word
        else:
            self._asked = address
            heard.asked += 1
            heard.stw = word
            heard.net = len(whole) - 4
        if self.capture:
            self.capture(not is_reply, whole, at_us)

    def _process_word(self, whole, address):
        """PZD1: by the kind that somebody has told, else of two PZD words; None: there is none."""
        told = self._settings.kind(address)
        pzd_words = told[1].pzd_words if told else 2
        at = len(whole) - 1 - 2 * pzd_words
        return telegram.get_word(whole, at) if pzd_words and at >= 3 else None

    def title(self):
        return "%d telegrams, %d characters of none" % (self.telegrams, self.errors)

    def rows(self):
        """Of the table."""
        return list(self._rows())

    def _rows(self):
        span_s = max(((self._last_us or 0) - (self._first_us or 0)) / 1e6, 0.001)
        for address in sorted(self.heard):
            heard = self.heard[address]
            row = {
                "address": address,
                "asked_per_s": round(heard.asked / span_s, 1),
                "answered_per_s": round(heard.answered / span_s, 1),
                "silent": heard.asked - heard.answered,
                "net": heard.net,
            }
            if heard.stw is not None:
                row["stw"] = "%04X" % heard.stw
            if heard.zsw is not None:
                row["zsw"] = "%04X" % heard.zsw
                row["state"] = STATES[pzd.state(heard.zsw)]
                row["bits"] = " ".join(bits.names(heard.zsw, bits.ZSW_BITS))
            yield row
