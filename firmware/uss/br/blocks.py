# SPDX-License-Identifier: MIT
"""The blocks of the B&R project that make and read telegrams: TxCreatePZD, TxCompose, RxDecompose,
RxCreatePZD. DriveController needs none of them; they are for telegrams of your own.

A block is called once a scan. The rising edge of Cmd.Create makes it do its work, in that scan.
An error stays until Cmd.ErrorAcknowledge, and with it the block does nothing.

    create, compose = TxCreatePZD(pzd, telegram), TxCompose(telegram, buffer)
    create.Cmd.Create = compose.Cmd.Create = True
    create(); compose()
    if compose.Status.Done: uart.write(buffer[: telegram.Frame.LGE + 2])
"""

from uss import pzd
from uss.bits import bit
from uss.br import codes
from uss.br.structures import PZD_MAX
from uss.layout import PKW_WORDS, VARIABLE
from uss.pzd import FULL_SCALE, HSW_MAX, HSW_MIN, signed
from uss.telegram import BAD_BCC, NET, NODE_MAX, STX, get_word, judge, put_word, seal

REFERENCE_HZ = (1, 650)
PERCENT_MAX = 200
_STEP = 100 / FULL_SCALE  # percent; 200 % itself is beyond the largest word
_VARIABLE_PKW_MIN = 3
_LGE_MIN, _LGE_MAX = 0x03, 0xFE
_WORD_MAX = 0xFFFF

# Bits of the control word by the member that sets them; the others are those of OFF1 (table 2.1).
_BITS = (
    ("Run", pzd.STW_ON),
    ("FaultAcknowledge", pzd.STW_ACKNOWLEDGE),
    ("JOGRight", bit("JOG_RIGHT", "STW_BITS")),
    ("JOGLeft", bit("JOG_LEFT", "STW_BITS")),
    ("Reverse", pzd.STW_REVERSE),
)

# What TxCompose says of the lengths, in the codes of RxDecompose.
_RECEIVED = {
    codes.PKW_LENGTH: codes.PKW_LENGTH_RECEIVED,
    codes.PZD_LENGTH: codes.PZD_LENGTH_RECEIVED,
    codes.LGE_SENT: codes.LGE_RECEIVED,
}


class Cmd:
    """Of each block. Create: its rising edge begins. Reset: the block is as at first."""

    def __init__(self):
        self.Create = False
        self.Reset = False
        self.ErrorAcknowledge = False


class Status:
    """Of each block. ErrorID: a code of `codes`."""

    def __init__(self):
        self.clear()

    def clear(self):
        """Ready for work."""
        self.Ready = True
        self.Busy = self.Done = self.Error = False
        self.ErrorID = codes.NO_ERROR

    def fail(self, code):
        """Stay so until the error is acknowledged."""
        self.Ready = self.Busy = self.Done = False
        self.Error = True
        self.ErrorID = code


class Block:
    """What the blocks share. `_create` does the work, and answers a code of `codes`."""

    def __init__(self):
        self.Cmd = Cmd()
        self.Status = Status()
        self._was_created = False

    def __call__(self):
        command, status = self.Cmd, self.Status
        rises = command.Create and not self._was_created
        self._was_created = bool(command.Create)
        if command.Reset or command.ErrorAcknowledge and status.Error:
            status.clear()
        elif rises and not status.Error:
            code = self._create()
            if code == codes.NO_ERROR:
                status.Done = True
                status.Ready = False
            else:
                status.fail(code)

    def _create(self):
        return codes.NO_ERROR


class TxCreatePZD(Block):
    """From TxPZD.Par, the words PZD1 and PZD2 of the telegram; and ControlWord, MainSetpoint."""

    def __init__(self, tx_pzd, telegram):
        super().__init__()
        self._pzd = tx_pzd
        self._telegram = telegram

    def _create(self):
        wanted, telegram = self._pzd.Par, self._telegram
        code = check_frequency(wanted)
        if code:
            return code
        word = pzd.OFF1
        for name, mask in _BITS:
            if getattr(wanted, name):
                word |= mask
        self._pzd.ControlWord = telegram.Body.PZD[1] = word
        self._pzd.MainSetpoint.Percent = 100 * wanted.Freq / wanted.RefFreq
        telegram.Body.PZD[2] = setpoint(wanted)
        return codes.NO_ERROR


class TxCompose(Block):
    """From the telegram, its characters in TxBuffer, a bytearray of 256. Frame.LGE + 2 of them
    count. With PKW_lengh 127 the telegram has three PKW words, those of a telegram without a task.
    """

    def __init__(self, telegram, tx_buffer):
        super().__init__()
        self._telegram = telegram
        self._buffer = tx_buffer

    def _create(self):
        telegram = self._telegram
        setup, frame = telegram.Par, telegram.Frame
        code = check_lengths(setup)
        if code == codes.NO_ERROR and frame.STX != STX:
            code = codes.STX_SENT
        if code == codes.NO_ERROR and not is_word(setup.ADR, NODE_MAX):
            code = codes.ADDRESS
        if code:
            return code
        at = NET
        for words, count, wrong in _parts(telegram, _VARIABLE_PKW_MIN):
            for word in words[1 : count + 1]:
                if not is_word(word, _WORD_MAX):
                    return wrong
                put_word(self._buffer, at, word)
                at += 2
        size = seal(self._buffer, setup.ADR, at - NET)
        frame.LGE = size - 2
        frame.ADR = setup.ADR
        frame.BCC = self._buffer[size - 1]
        return codes.NO_ERROR


class RxDecompose(Block):
    """From the characters in RxBuffer, the telegram `received`. `sent`: the one that it answers.

    With PKW_lengh 127 the answer may be longer or shorter than what was sent: in the source it may
    not, and such a drive could answer no task.
    """

    def __init__(self, rx_buffer, received, sent):
        super().__init__()
        self._buffer = rx_buffer
        self._received = received
        self._sent = sent

    def _create(self):
        buffer, telegram, sent = self._buffer, self._received, self._sent
        setup, frame = telegram.Par, telegram.Frame
        code = check_lengths(setup)
        if code:
            return _RECEIVED[code]
        if buffer[0] != STX:
            return codes.STX_RECEIVED
        if not _LGE_MIN <= buffer[1] <= _LGE_MAX:
            return codes.LGE_RECEIVED
        pkw_words = (buffer[1] - 2) // 2 - setup.PZD_lengh
        is_variable = setup.PKW_lengh == VARIABLE and pkw_words >= _VARIABLE_PKW_MIN
        if buffer[1] & 1 or not is_variable and buffer[1] != sent.Frame.LGE:
            return codes.LGE_DIFFERS
        if judge(buffer, buffer[1] + 2, None, None) == BAD_BCC:
            return codes.BCC_RECEIVED
        if buffer[2] > NODE_MAX:
            return codes.ADDRESS_RECEIVED
        if buffer[2] != sent.Frame.ADR:
            return codes.ADDRESS_DIFFERS
        frame.STX, frame.LGE, frame.ADR = buffer[0], buffer[1], buffer[2]
        frame.BCC = buffer[buffer[1] + 1]
        at = NET
        for words, count, _ in _parts(telegram, pkw_words):
            for place in range(1, count + 1):
                words[place] = get_word(buffer, at)
                at += 2
        return codes.NO_ERROR


class RxCreatePZD(Block):
    """From the words PZD1 and PZD2 of the telegram, the bits and the speed in RxPZD."""

    def __init__(self, telegram, rx_pzd):
        super().__init__()
        self._telegram = telegram
        self._pzd = rx_pzd

    def _create(self):
        words, reference = self._telegram.Body.PZD, self._telegram.Par.RefFreq
        if not is_reference(reference):
            return codes.REFERENCE_RECEIVED
        if not is_word(words[1], _WORD_MAX) or not is_word(words[2], _WORD_MAX):
            return codes.PZD_RECEIVED
        self._pzd.StatusWord.take(words[1])
        take_speed(self._pzd.ActualValue, words[2], signed(words[2]), reference)
        return codes.NO_ERROR


# --- what DriveController uses as well ----------------------------------------------------------


def is_number(value):
    """Whether it is an int or a float, and no NaN or infinity."""
    return isinstance(value, (int, float)) and value - value == 0


def is_word(value, most):
    """Whether it is an integer from 0 to `most`."""
    return isinstance(value, int) and 0 <= value <= most


def is_reference(hertz):
    """Whether a reference frequency may be this one."""
    return is_number(hertz) and REFERENCE_HZ[0] <= hertz <= REFERENCE_HZ[1]


def check_frequency(wanted):
    """The code of what is wrong with RefFreq or Freq of these `Commands`."""
    if not is_reference(wanted.RefFreq):
        return codes.REFERENCE
    if not is_number(wanted.Freq):
        return codes.FREQUENCY
    percent = 100 * wanted.Freq / wanted.RefFreq
    if not -PERCENT_MAX <= percent <= PERCENT_MAX - _STEP / 2:
        return codes.FREQUENCY
    return codes.NO_ERROR


def check_lengths(lengths):
    """The code of what is wrong with PKW_lengh, PZD_lengh, or both."""
    if not isinstance(lengths.PKW_lengh, int) or lengths.PKW_lengh not in PKW_WORDS:
        return codes.PKW_LENGTH
    if not is_word(lengths.PZD_lengh, PZD_MAX):
        return codes.PZD_LENGTH
    if not lengths.PKW_lengh + lengths.PZD_lengh:
        return codes.LGE_SENT  # a telegram without words would have an LGE of 2
    return codes.NO_ERROR


def setpoint(wanted):
    """The word for Freq, with its sign; the source's formulas 2.2 and 2.3 come near it."""
    count = round(wanted.Freq * FULL_SCALE / wanted.RefFreq)
    return max(HSW_MIN, min(HSW_MAX, count)) & 0xFFFF


def take_speed(actual, hiw, count, reference):
    """Set an `ActualValue`. count: HIW as a number with a sign."""
    actual.HEX = hiw
    actual.Percent = 100 * count / FULL_SCALE
    actual.Freq = count * reference / FULL_SCALE


def _parts(telegram, variable_count):
    """PKW and PZD of a telegram: the words, how many of them there are, and the code of a wrong
    one."""
    setup, body = telegram.Par, telegram.Body
    pkw_words = variable_count if setup.PKW_lengh == VARIABLE else setup.PKW_lengh
    return (
        (body.PKW, pkw_words, codes.PKW_WORD),
        (body.PZD, setup.PZD_lengh, codes.PZD_WORD),
    )
