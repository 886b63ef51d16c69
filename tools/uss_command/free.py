# SPDX-License-Identifier: MIT
"""send: a telegram that somebody has written, as it is, and what comes back.

One that turns a motor goes out only with --on. It is repeated until --for is over, and OFF1
follows until the drive stands, or the small program that holds the port sends that.
"""

import time

from uss_serial.port.dead_man import off1

from tools.uss_command.errors import Failure
from tools.uss_command.explanation import CONTROL, FROM_DRIVE, TO_DRIVE, explained, wrongs
from tools.uss_command.files.capture import characters_of
from tools.uss_command.line import Line
from uss import telegram
from uss.layout import PZD_WORDS_MAX
from uss.telegram import BROADCAST, MIRROR, NODE_MAX, SPECIAL, STX

REPEAT_S = 0.1
REPLY_MORE_S = 0.05  # from the last character on
STOP_S = 60.0
RUNNING = 0x0004  # of ZSW
PKW_WORDS = (4, 3, 0)  # of fixed length, the most usual first
ON_BITS = 0x0301


def add(commands):
    parser = commands.add_parser(
        "send", help="a free telegram in hex; the BCC is added if missing"
    )
    parser.add_argument("hex", nargs="+", metavar="HEX")
    parser.add_argument("--on", action="store_true", help="even if it turns a motor; OFF1 follows")
    parser.add_argument("--for", dest="seconds", type=float, default=0.0, metavar="S",
                        help="repeat it for so long")  # fmt: skip
    parser.add_argument("--as-it-is", action="store_true", help="even if it is no telegram")
    parser.set_defaults(run=send)


def send(screen, settings, chosen):
    characters = completed(characters_of(" ".join(chosen.hex)))
    wrong = wrongs(characters)
    if wrong and not chosen.as_it_is:
        raise Failure("no telegram: %s; --as-it-is sends it all the same" % "; ".join(wrong))
    kind = settings.kind(characters[2] & NODE_MAX) if len(characters) > 2 else None
    pzd_words = words_that_turn(characters, kind)
    if pzd_words is not None and wrong:
        raise Failure("it may turn a motor, and is no telegram: %s" % "; ".join(wrong))
    if pzd_words is not None and characters[2] & BROADCAST:
        raise Failure("a broadcast turns no motors here")
    if pzd_words is not None and not chosen.on:
        raise Failure("it turns a motor (ON or JOG in its control word): send --on does it")
    with Line(screen, settings, chosen) as line:
        line.listen()
        talk = Talk(screen, line, kind)
        try:
            answer = talk.repeat(characters, pzd_words, chosen.seconds)
            talk.tell()
        finally:
            if pzd_words is not None:
                talk.stop(off1(characters, pzd_words), pzd_words)
    if not answer and not characters[2] & BROADCAST:
        raise line.no_reply(characters[2] & NODE_MAX)


def completed(characters):
    """With its BCC, if that is all that is missing."""
    if len(characters) > 3 and characters[0] == STX and len(characters) == characters[1] + 1:
        return characters + bytes((telegram.bcc(characters, len(characters)),))
    return characters


def words_that_turn(characters, kind):
    """How many PZD words it has if it turns a motor; None: it turns none, however it is divided.

    kind: (family, layout) of the drive if somebody has told it.
    """
    if len(characters) < 5 or characters[2] & (MIRROR | SPECIAL):
        return None
    count = (len(characters) - 4) // 2
    possible = [count - pkw_words for pkw_words in PKW_WORDS] + list(range(1, count - 2))
    if kind:
        possible = [kind[1].pzd_words]
    for pzd_words in possible:
        at = len(characters) - 1 - 2 * pzd_words
        if 1 <= pzd_words <= PZD_WORDS_MAX and at >= 3:
            word = telegram.get_word(characters, at)
            if word & CONTROL and word & ON_BITS:
                return pzd_words
    return None


class Talk:
    """Telegrams past the engine, which is idle meanwhile."""

    def __init__(self, screen, line, kind):
        self._layout = (kind[1].pkw_words, kind[1].pzd_words) if kind else None
        self._screen = screen
        self._line = line
        self._buffer = bytearray(512)
        self._said = self._latest = self._told = None

    def repeat(self, characters, pzd_words, seconds):
        """Send it until the time is over; the last answer."""
        until_s = time.monotonic() + seconds
        answer = b""
        while True:
            heard = self._exchange(characters, pzd_words)
            answer = heard or answer
            if self._line.link.is_cut:
                raise Failure(self._line.link.notices[-1])
            if time.monotonic() >= until_s:
                return answer
            time.sleep(min(REPEAT_S, max(0, until_s - time.monotonic())))

    def stop(self, telegram_off, pzd_words):
        """OFF1 until the drive says that it does not run."""
        until_s = time.monotonic() + STOP_S
        while time.monotonic() < until_s and not self._line.link.is_cut:
            answer = self._exchange(telegram_off, pzd_words)
            at = len(answer) - 1 - 2 * pzd_words
            if len(answer) >= 5 and at >= 3 and not telegram.get_word(answer, at) & RUNNING:
                return
            time.sleep(REPEAT_S)
        raise Failure("OFF1 was sent, and the drive does not say that it stands")

    def _exchange(self, characters, pzd_words):
        link = self._line.link
        link.send_as(characters, 0 if pzd_words is None else pzd_words)
        sending_s = link.sending_us(0) / 1e6
        until_s = time.monotonic() + sending_s + self._line.settings.reply_timeout_ms / 1000
        answer = b""
        while time.monotonic() < until_s:
            count = link.receive(self._buffer, 0)
            if count:
                answer += self._buffer[:count]
                until_s = time.monotonic() + REPLY_MORE_S
                if len(answer) > 1 and len(answer) >= answer[1] + 2:
                    if answer == characters and not characters[2] & MIRROR:
                        answer = b""  # the line's own echo
                        continue
                    break
            link.clock.sleep_us(500)
        self._note(characters, answer)
        return answer

    def _note(self, sent, answer):
        """Say what is new: another telegram, or another answer but for the actual value."""
        behind = 2 * ((self._layout or (0, 2))[1] - 1) + 1  # the first PZD word, and BCC
        known = sent, answer[: -behind or None]
        self._latest = sent, answer
        if known != self._said:
            self._said = known
            self.tell()

    def tell(self):
        """Say what was sent and answered last, unless that was said."""
        if self._latest == self._told:
            return
        self._told = sent, answer = self._latest
        for way, characters in ((TO_DRIVE, sent), (FROM_DRIVE, answer)):
            told = explained(characters, self._layout, way)
            shown = characters.hex(" ").upper() or "nothing"
            mark = ">" if way == TO_DRIVE else "<"
            self._screen.event(
                "%s %-48s %s" % (mark, shown, told.summary if characters else ""),
                way=way, hex=shown if characters else "", summary=told.summary,
            )  # fmt: skip
