# SPDX-License-Identifier: MIT
"""Stops the drives of a panel, or a program, that has fallen silent because it hangs, was killed,
or is suspended.

It knows only what the panel has sent. If the last control word to a drive turns its motor, it owes
the drive an OFF1, which is that telegram without its commands. A panel that hung may go on in the
middle of an ON. Therefore a drive that was stopped here gets no ON until the panel itself has sent
it a telegram that does not turn the motor. The time is an argument.

    dead_man = DeadMan(19200)
    if dead_man.heard(data, now_s):     # for everything that the panel sends
        ...                             # send it on the line
    telegram = dead_man.due(now_s)      # to send in the panel's place, or None
    dead_man.over(now_s)                # the panel has ended, and sends nothing any more

A telegram does not tell how many words of process data stand at its end. Whoever knows says it
with `heard`; else it is two, behind the usual parameter words.
"""

STX = 0x02
NODE_MAX = 31
NET = 3  # the first of the net characters
BCC = 1  # characters behind them
PZD_WORDS = 2
SIZES = (8, 14, 16)  # of telegrams with that behind 0, 3 or 4 words of a parameter
COMMANDS_HIGH, COMMANDS_LOW = 0x03, 0x01  # JOG_LEFT, JOG_RIGHT; ON
CHARACTER_BITS = 11

PATIENCE_S = 1.0  # and an exchange: a panel that works is never silent for so long
REPLY_S = 0.1  # for the drive to answer, before the next telegram
ROUNDS = 3  # of OFF1 to each, because it does not check whether one has arrived


def telegrams(data):
    """`data` divided into what claims to be a telegram; what is left over counts as one."""
    found = []
    while data:
        size = data[1] + 2 if len(data) > 1 and data[0] == STX else len(data)
        found.append(data[:size])
        data = data[size:]
    return found


def stw_place(telegram, pzd_words=None):
    """Where the control word of a telegram to a single drive stands, high byte first; None: there
    is none, or nobody knows.
    """
    size = len(telegram)
    if size <= NET + BCC or telegram[0] != STX or telegram[2] > NODE_MAX:
        return None
    if pzd_words is None:
        pzd_words = PZD_WORDS if size in SIZES else 0
    at = size - BCC - 2 * pzd_words
    return at if pzd_words and at >= NET else None


def turns(telegram, pzd_words=None):
    """Whether it is a telegram to a single drive that turns its motor."""
    at = stw_place(telegram, pzd_words)
    return at is not None and bool(telegram[at] & COMMANDS_HIGH or telegram[at + 1] & COMMANDS_LOW)


def off1(telegram, pzd_words=None):
    """The same telegram as OFF1, without a parameter task."""
    at = stw_place(telegram, pzd_words)
    changed = bytearray(telegram)
    changed[NET:at] = bytes(at - NET)
    changed[at] &= ~COMMANDS_HIGH
    changed[at + 1] &= ~COMMANDS_LOW
    changed[-1] = 0
    for character in changed[:-1]:
        changed[-1] ^= character
    return bytes(changed)


class DeadMan:
    """patience_s: who is silent for so long, and for an exchange, hangs.

    stopped: the addresses that were sent OFF1 in the panel's place, ever.
    """

    def __init__(self, baud, patience_s=PATIENCE_S):
        self.stopped = set()
        self._turning = {}  # address: the OFF1 that a drive is owed whose last telegram turns it
        self._owed = []
        self._barred = set()  # addresses stopped here that the panel has not sent OFF since
        self._beyond_s = patience_s
        self._next_s = None  # when it is to be taken for dead, or the next OFF1 is due
        self.change_baud(baud)

    def change_baud(self, baud):
        exchange_s = 2 * SIZES[-1] * CHARACTER_BITS / baud
        self._pace_s = exchange_s + REPLY_S
        self._patience_s = exchange_s + self._beyond_s

    def alive(self, now_s):
        """The panel works, although it has nothing to send."""
        if self._next_s is not None and not self._owed:
            self._next_s = now_s + self._patience_s

    def heard(self, data, now_s, pzd_words=None):
        """The panel is alive, and looks after the drives that it talks to. Return whether to send
        this on the line: False if it would turn a drive that was stopped here.
        """
        self._next_s = now_s + self._patience_s
        may_pass = True
        for telegram in telegrams(data):
            address = telegram[2] if stw_place(telegram, pzd_words) is not None else None
            is_turning = turns(telegram, pzd_words)
            if address in self._barred and is_turning:
                may_pass = False
                continue
            self._barred.discard(address)
            self._turning.pop(address, None)
            self._owed = [owed for owed in self._owed if owed[2] != address]
            if is_turning:
                self._turning[address] = off1(telegram, pzd_words)
        return may_pass

    def over(self, now_s):
        """It sends nothing any more; a drive may still be answering."""
        self._next_s = now_s + self._pace_s

    def due(self, now_s):
        """The OFF1 that is to be sent now, or None."""
        if self._next_s is None or now_s < self._next_s:
            return None
        if self._turning:
            self._owed += ROUNDS * list(self._turning.values())
            self._turning = {}
        if not self._owed:
            return None
        self._next_s = now_s + self._pace_s
        telegram = self._owed.pop(0)
        self.stopped.add(telegram[2])
        self._barred.add(telegram[2])
        return telegram

    def wait_s(self, now_s, longest_s):
        """How long `due` has nothing to say, `longest_s` at the most."""
        if self._next_s is None or not (self._turning or self._owed):
            return longest_s
        return max(0, min(self._next_s - now_s, longest_s))

    def is_done(self):
        """Whether no drive is owed an OFF1."""
        return not (self._turning or self._owed)
