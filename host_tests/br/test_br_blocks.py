# SPDX-License-Identifier: MIT
"""The blocks that make and read telegrams, held against the telegrams that the source prints."""

from uss.br import codes
from uss.br.blocks import (
    Block,
    RxCreatePZD,
    RxDecompose,
    TxCompose,
    TxCreatePZD,
    check_frequency,
)
from uss.br.structures import (
    ADDRESSES,
    BUFFER,
    RESTART,
    STATUS_WORD,
    DriveData,
    DriveSequence,
    RxPZD,
    Telegram,
    TxPZD,
)


class Bench:
    """All four, with their structures, as for a drive of 0 + 2 words at address 0."""

    def __init__(self, pkw_words=0, pzd_words=2, address=0):
        self.tx_pzd, self.rx_pzd = TxPZD(), RxPZD()
        self.sent, self.received = Telegram(), Telegram()
        self.tx_buffer, self.rx_buffer = bytearray(BUFFER), bytearray(BUFFER)
        for telegram in (self.sent, self.received):
            telegram.Par.PKW_lengh = pkw_words
            telegram.Par.PZD_lengh = pzd_words
        self.sent.Par.ADR = address
        self.create = TxCreatePZD(self.tx_pzd, self.sent)
        self.compose = TxCompose(self.sent, self.tx_buffer)
        self.decompose = RxDecompose(self.rx_buffer, self.received, self.sent)
        self.read = RxCreatePZD(self.received, self.rx_pzd)

    def carry_out(self, block):
        """The code with which the block ends."""
        block.Cmd.Create = False
        block()
        block.Cmd.Create = True
        block()
        status = block.Status
        assert status.Done != status.Error and not status.Ready and not status.Busy
        return status.ErrorID

    def send(self):
        assert self.carry_out(self.create) == 0
        assert self.carry_out(self.compose) == 0
        return bytes(self.tx_buffer[: self.sent.Frame.LGE + 2])

    def receive(self, characters):
        self.rx_buffer[: len(characters)] = characters
        self.decompose.Cmd.ErrorAcknowledge = True
        self.decompose()
        self.decompose.Cmd.ErrorAcknowledge = False
        return self.carry_out(self.decompose)


def test_the_telegrams_of_the_source():
    """Figure 4.3: 0 + 2 words, OFF1 and then ON with a setpoint of 0."""
    bench = Bench()
    assert bench.send() == bytes.fromhex("020600047e00007e")
    bench.tx_pzd.Par.Run = True
    assert bench.send() == bytes.fromhex("020600047f00007f")
    frame = bench.sent.Frame
    assert (frame.STX, frame.LGE, frame.ADR, frame.BCC) == (0x02, 0x06, 0x00, 0x7F)


def test_a_telegram_is_at_first_that_of_a_drive_of_the_source_and_empty():
    telegram, wanted, data = Telegram(), TxPZD(), DriveData()
    frame, setup = telegram.Frame, telegram.Par
    assert (frame.STX, frame.LGE, frame.BCC, frame.ADR) == (0x02, 0, 0, 0)
    assert (setup.PKW_lengh, setup.PZD_lengh, setup.ADR, setup.RefFreq) == (127, 2, 0, 50.0)
    assert telegram.Body.PKW == [0] * 127 and telegram.Body.PZD == [0] * 17
    assert (wanted.ControlWord, wanted.MainSetpoint.Percent, wanted.Par.Freq) == (0, 0.0, 0.0)
    assert wanted.Par.RefFreq == 50.0 and not any(
        [wanted.Par.Run, wanted.Par.FaultAcknowledge, wanted.Par.Reverse]
        + [wanted.Par.JOGRight, wanted.Par.JOGLeft]
    )
    actual = data.ActualValue
    assert (actual.HEX, actual.Percent, actual.Freq) == (0, 0.0, 0.0)
    assert (data.Status.Receive, data.Status.ErrorID) == (False, 0)
    assert not any([getattr(data.StatusWord, name) for name in STATUS_WORD])


def test_a_sequence_has_255_entries_and_is_at_first_empty():
    """Place 0, which nobody uses, besides."""
    sequence = DriveSequence()
    assert sequence.ControllSequence == [255] * 256 and RESTART == 255 and sequence.ADDR == 0
    assert BUFFER == 256 and ADDRESSES == 32  # the longest telegram, and 0...31


def test_a_name_of_a_code_stands_for_the_number_of_the_source():
    for name, number in (
        ("NO_ERROR", 0), ("CONTROL_WORD", 100), ("REFERENCE", 101), ("FREQUENCY", 102),
        ("PERCENT", 103), ("STX_SENT", 200), ("PKW_LENGTH", 201), ("PZD_LENGTH", 202),
        ("LGE_SENT", 203), ("ADDRESS", 204), ("PKW_WORD", 206), ("PZD_WORD", 209),
        ("TOO_LONG", 211), ("STX_RECEIVED", 300), ("LGE_RECEIVED", 301), ("LGE_DIFFERS", 302),
        ("ADDRESS_RECEIVED", 303), ("PKW_LENGTH_RECEIVED", 304), ("PZD_LENGTH_RECEIVED", 305),
        ("BCC_RECEIVED", 308), ("ADDRESS_DIFFERS", 310), ("REFERENCE_RECEIVED", 400),
        ("PZD_RECEIVED", 401), ("READ_FAILED", 507), ("NO_MESSAGE", 600),
    ):  # fmt: skip
        assert getattr(codes, name) == number, name


def test_each_member_sets_its_bit():
    for members, word in (
        ("", 0x047E), ("Run", 0x047F), ("FaultAcknowledge", 0x04FE), ("JOGRight", 0x057E),
        ("JOGLeft", 0x067E), ("Run Reverse", 0x0C7F),
    ):  # fmt: skip
        bench = Bench()
        for name in members.split():
            setattr(bench.tx_pzd.Par, name, True)
        assert bench.carry_out(bench.create) == 0
        assert bench.tx_pzd.ControlWord == bench.sent.Body.PZD[1] == word


def test_the_setpoint_is_a_fraction_of_the_reference():
    for freq, reference, word in (
        (50.0, 50.0, 0x4000), (25.0, 50.0, 0x2000), (-50.0, 50.0, 0xC000), (-100.0, 50.0, 0x8000),
        (99.997, 50.0, 0x7FFF), (1.0, 650.0, 0x0019), (0, 1, 0), (10.0, 50.0, 0x0CCD),
        (-10.0, 50.0, 0xF333),
    ):  # fmt: skip
        bench = Bench()
        bench.tx_pzd.Par.Freq, bench.tx_pzd.Par.RefFreq = freq, reference
        assert bench.carry_out(bench.create) == 0, freq
        assert bench.sent.Body.PZD[2] == word, (freq, "%04X" % bench.sent.Body.PZD[2])
        assert abs(bench.tx_pzd.MainSetpoint.Percent - 100 * freq / reference) < 1e-3


def test_wrong_frequencies():
    for freq, reference, code in (
        (0.0, 0.9, 101), (0.0, 651, 101), (0.0, None, 101), (0.0, "50", 101), (100.0, 50.0, 102),
        (-100.1, 50.0, 102), (None, 50.0, 102), (float("inf"), 50.0, 102), (99.9988, 50.0, 102),
    ):  # fmt: skip
        bench = Bench()
        bench.tx_pzd.Par.Freq, bench.tx_pzd.Par.RefFreq = freq, reference
        assert bench.carry_out(bench.create) == code, (freq, reference)
        assert check_frequency(bench.tx_pzd.Par) == code
    assert check_frequency(TxPZD().Par) == codes.NO_ERROR


def test_what_cannot_be_composed():
    for change, code in (
        (lambda one: setattr(one.Frame, "STX", 3), 200),
        (lambda one: setattr(one.Frame, "STX", 1), 200),
        (lambda one: setattr(one.Par, "PKW_lengh", 2), 201),
        (lambda one: setattr(one.Par, "PZD_lengh", 17), 202),
        (lambda one: (setattr(one.Par, "PKW_lengh", 0), setattr(one.Par, "PZD_lengh", 0)), 203),
        (lambda one: setattr(one.Par, "ADR", 32), 204),
        (lambda one: one.Body.PKW.insert(4, 0x10000), 206),
        (lambda one: one.Body.PZD.insert(1, -1), 209),
        (lambda one: one.Body.PZD.insert(2, 1.5), 209),
    ):
        bench = Bench(pkw_words=4)
        assert bench.carry_out(bench.compose) == 0
        change(bench.sent)
        assert bench.carry_out(bench.compose) == code, code
        assert codes.text(code)


def test_the_largest_words_and_the_highest_address_are_sent():
    """Also where both areas are equally long."""
    for pkw_words, pzd_words in ((4, 16), (4, 4), (3, 3), (0, 1), (4, 0)):
        bench = Bench(pkw_words, pzd_words, 31)
        for words, count in (
            (bench.sent.Body.PKW, pkw_words),
            (bench.sent.Body.PZD, pzd_words),
        ):
            words[1 : count + 1] = [0xFFFF] * count
        assert bench.carry_out(bench.compose) == 0, (pkw_words, pzd_words)
        count = 2 * (pkw_words + pzd_words)
        wanted = bytes((2, count + 2, 31)) + b"\xff" * count + bytes((2 ^ count + 2 ^ 31,))
        assert bytes(bench.tx_buffer[: count + 4]) == wanted
        assert (bench.sent.Frame.ADR, bench.sent.Frame.BCC) == (31, wanted[-1])
        assert bench.receive(wanted) == 0 and bench.received.Frame.BCC == wanted[-1]
        assert bench.received.Body.PZD[1 : pzd_words + 1] == [0xFFFF] * pzd_words
        assert pzd_words < 2 or bench.carry_out(bench.read) == 0


def test_of_several_things_that_are_wrong_the_first_is_told():
    bench = Bench()
    for part, name, wrong, code in (
        (bench.sent.Par, "ADR", 32, 204),
        (bench.sent.Frame, "STX", 3, 200),
        (bench.sent.Par, "PKW_lengh", 2, 201),
    ):
        setattr(part, name, wrong)
        assert bench.carry_out(bench.compose) == code, name
        bench.compose.Cmd.ErrorAcknowledge = True
        bench.compose()
        bench.compose.Cmd.ErrorAcknowledge = False


def test_a_reply_is_taken_apart():
    bench = Bench()
    bench.send()
    assert bench.receive(bytes.fromhex("0206 00 fb34 2000 eb".replace(" ", ""))) == 0
    assert bench.received.Body.PZD[1:3] == [0xFB34, 0x2000]
    assert (bench.received.Frame.STX, bench.received.Frame.LGE) == (2, 6)
    assert (bench.received.Frame.ADR, bench.received.Frame.BCC) == (0, 0xEB)
    assert bench.carry_out(bench.read) == 0
    status, actual = bench.rx_pzd.StatusWord, bench.rx_pzd.ActualValue
    assert status.DriveRunning and status.MotorRunsRight and not status.DriveReady
    assert (actual.HEX, actual.Percent, actual.Freq) == (0x2000, 50.0, 25.0)
    for hiw, percent, hertz in ((0x1111, 26.666, 13.333), (0xEEEF, -26.666, -13.333)):
        bench.received.Body.PZD[2] = hiw
        assert bench.carry_out(bench.read) == 0 and actual.HEX == hiw
        assert abs(actual.Percent - percent) < 0.01 and abs(actual.Freq - hertz) < 0.01


def test_what_comes_back_wrong():
    for text, code in (
        ("0306 00 fb34 2000 ea", 300),
        ("0106 00 fb34 2000 e8", 300),
        ("0202 00 fb34 2000 ef", 301),
        ("02ff 00 fb34 2000 12", 301),
        ("0203 00 fb34 2000 ee", 302),
        ("0204 00 fb34 2000 e9", 302),
        ("0208 00 fb34 2000 e5", 302),
        ("0280 00 fb34 2000 6d", 302),
        ("02fe 00 fb34 2000 13", 302),
        ("0206 20 fb34 2000 cb", 303),
        ("0206 00 fb34 2000 ec", 308),
        ("0206 01 fb34 2000 ea", 310),
    ):
        bench = Bench()
        bench.send()
        assert bench.receive(bytes.fromhex(text.replace(" ", ""))) == code, text
    for member, value, code in (("PKW_lengh", 1, 304), ("PZD_lengh", 99, 305)):
        bench = Bench()
        setattr(bench.received.Par, member, value)
        assert bench.receive(bytes(8)) == code
    bench = Bench()
    bench.received.Par.RefFreq = 0
    assert bench.carry_out(bench.read) == 400
    for place in (1, 2):
        for wrong in (0x10000, -1, None):
            bench = Bench()
            bench.received.Body.PZD[place] = wrong
            assert bench.carry_out(bench.read) == 401, (place, wrong)


def test_a_reply_is_from_the_drive_that_was_asked():
    for address in (0, 1, 30, 31):
        bench = Bench(address=address)
        bench.send()
        for answers in (0, 1, 30, 31):
            reply = bytearray((0x02, 0x06, answers, 0xFB, 0x31, 0x00, 0x00, 0xCE ^ answers))
            assert bench.receive(reply) == (0 if answers == address else 310), (address, answers)
        bench.sent.Par.ADR = 7  # of the next telegram
        reply = bytes((0x02, 0x06, address, 0xFB, 0x31, 0x00, 0x00, 0xCE ^ address))
        assert bench.receive(reply) == 0


def test_with_variable_length_a_reply_has_a_task_at_least_and_whole_words():
    """It may be shorter than its request, if that was made by hand."""
    bench = Bench(pkw_words=127, address=3)
    bench.send()
    bench.sent.Frame.LGE = 20
    for words, code in ((2, 302), (3, 0), (4, 0), (12, 0)):
        reply = bytearray((0x02, 2 + 2 * (words + 2), 3)) + bytes(range(1, 2 * words + 1))
        reply += bytes((0xFB, 0x31, 0x20, 0x00))
        check = 0
        for character in reply:
            check ^= character
        assert bench.receive(reply + bytes((check,))) == code, words
        if not code:
            assert bench.received.Body.PKW[words] == (2 * words - 1) << 8 | 2 * words
            assert bench.received.Body.PZD[1:3] == [0xFB31, 0x2000]
    assert bench.receive(bytes((0x02, 13, 3)) + bytes(11) + bytes((0x02 ^ 13 ^ 3,))) == 302


def test_with_variable_length_a_reply_may_be_longer_than_its_request():
    bench = Bench(pkw_words=127, address=3)
    assert len(bench.send()) == 14
    request = Bench(pkw_words=4, address=3)
    request.sent.Body.PKW[1:5] = [0x2457, 0, 0x4248, 0]
    request.sent.Body.PZD[1:3] = [0xFB31, 0]
    assert request.carry_out(request.compose) == 0
    assert bench.receive(request.tx_buffer[:16]) == 0
    assert bench.received.Body.PKW[1:5] == [0x2457, 0, 0x4248, 0]
    assert bench.received.Body.PZD[1:3] == [0xFB31, 0]
    fixed = Bench(pkw_words=3, address=3)
    fixed.send()
    assert fixed.receive(request.tx_buffer[:16]) == 302


def test_a_block_of_your_own_that_has_nothing_to_do_is_done():
    block = Block()
    block.Cmd.Create = True
    block()
    assert block.Status.Done and not block.Status.Ready and not block.Status.Error


def test_a_block_works_by_its_edge_and_an_error_stays_until_it_is_acknowledged():
    bench = Bench()
    create, status = bench.create, bench.create.Status
    create()
    assert status.Ready and not status.Done
    bench.tx_pzd.Par.RefFreq = 0
    create.Cmd.Create = True
    create()
    assert status.Error and status.ErrorID == 101
    bench.tx_pzd.Par.RefFreq = 50.0
    for level in (True, False, True):
        create.Cmd.Create = level
        create()
        assert status.Error and status.ErrorID == 101 and not status.Done
        assert bench.sent.Body.PZD[1] == 0  # it does nothing meanwhile
    create.Cmd.ErrorAcknowledge = True
    create()
    assert not status.Error and status.Ready and not status.Done
    create.Cmd.ErrorAcknowledge = create.Cmd.Create = False
    create()
    create.Cmd.Create = True
    create()
    assert status.Done and bench.sent.Body.PZD[2] == 0
    bench.tx_pzd.Par.Freq = 25.0
    for _ in range(3):
        create()
        assert bench.sent.Body.PZD[2] == 0  # it is still the same edge
    create.Cmd.ErrorAcknowledge = True
    create()
    assert status.Done  # there was no error
    create.Cmd.Create = False
    create()
    create.Cmd.Create = True
    create()
    assert status.Done and bench.sent.Body.PZD[2] == 0x2000
    create.Cmd.Reset = True
    create()
    assert status.Ready and not status.Done


def test_reset_takes_an_error_back_and_uses_up_the_edge():
    bench = Bench()
    create, status = bench.create, bench.create.Status
    bench.tx_pzd.Par.RefFreq = 0
    assert bench.carry_out(create) == 101
    create.Cmd.Reset = True
    create()
    assert (status.Ready, status.Error, status.ErrorID) == (True, False, 0)
    bench.tx_pzd.Par.RefFreq = 50.0
    for level in (False, True):
        create.Cmd.Create = level
        create()
    create.Cmd.Reset = False
    create()
    assert status.Ready and not status.Done and bench.sent.Body.PZD[1] == 0
