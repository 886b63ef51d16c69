# SPDX-License-Identifier: MIT
"""The telegram: STX LGE ADR net BCC (specification A-4), built and judged."""

import golden
from uss import telegram

REASONS = {"length": telegram.BAD_LENGTH, "BCC": telegram.BAD_BCC}


def built(net, address):
    buffer = bytearray(telegram.SIZE_MAX)
    buffer[telegram.NET : telegram.NET + len(net)] = net
    count = telegram.seal(buffer, address, len(net))
    return bytes(buffer[:count])


def test_every_valid_golden_telegram_is_built_from_its_net_data():
    for example in golden.VALID:
        assert built(example.net, example.address()) == example.characters, example.id
    assert len(golden.VALID) == 60 + 67


def test_every_valid_golden_telegram_is_received():
    for example in golden.VALID:
        count, address = len(example.characters), example.address()
        net_count = 2 * (example.pkw_words + example.pzd_words)
        finding = telegram.judge(example.characters, count, address, net_count)
        assert finding == telegram.GOOD, example.id
        assert telegram.judge(example.characters, count, None, None) == telegram.GOOD, example.id


def test_every_misprinted_golden_telegram_is_refused_for_its_reason():
    for example in golden.INVALID:
        finding = telegram.judge(example.characters, len(example.characters), None, None)
        assert finding == REASONS[example.wrong], (example.id, telegram.FINDINGS[finding])
    assert len(golden.INVALID) == 8


def test_every_single_bit_error_is_refused():
    """One flipped bit, anywhere in any valid telegram, with the layout and address agreed."""
    for example in golden.VALID:
        count, address = len(example.characters), example.characters[2]
        for position in range(count):
            for bit in range(8):
                received = bytearray(example.characters)
                received[position] ^= 1 << bit
                finding = telegram.judge(received, count, address, count - 4)
                assert finding != telegram.GOOD, (example.id, position, bit)


def test_a_telegram_cut_short_or_followed_by_a_character_is_refused():
    for example in golden.VALID:
        whole = example.characters + b"\x00"
        for count in range(len(whole) + 1):
            if count != len(example.characters):
                finding = telegram.judge(whole, count, None, None)
                assert finding != telegram.GOOD, (example.id, count)


def test_bcc_counts_stx():
    """The unit test of the specification: 00, with 02 it is 02, with D6 it is D4."""
    assert telegram.bcc(b"\x02\xd6", 1) == 0x02
    assert telegram.bcc(b"\x02\xd6", 2) == 0xD4


def test_a_bcc_without_stx_is_refused():
    """The most frequent mistake in the field."""
    received = bytearray(golden.VALID[0].characters)
    received[-1] ^= telegram.STX
    assert telegram.judge(received, len(received), None, None) == telegram.BAD_BCC


def test_the_first_character_must_be_stx():
    assert telegram.judge(b"\x03\x06\x01\x04\x7f\x20\x00\x5f", 8, 1, 4) == telegram.BAD_START
    assert telegram.judge(b"", 0, 1, 4) == telegram.BAD_START


def test_lge_below_3_holds_no_net_data():
    """LGE counts ADR, net data and BCC (specification A-4.2)."""
    for lge in range(3):
        received = bytes((2, lge, 1, 0, 0))
        for count in range(6):
            assert telegram.judge(received, count, None, None) != telegram.GOOD


def test_a_reply_of_another_layout_or_address_is_refused():
    eight = built(b"\xfb\x34\x20\x00", 1)
    assert telegram.judge(eight, 8, 1, 12) == telegram.BAD_LENGTH
    assert telegram.judge(eight, 8, 2, 4) == telegram.BAD_ADDRESS
    mirrored = built(b"\xfb\x34\x20\x00", 1 | telegram.MIRROR)
    assert telegram.judge(mirrored, 8, 1, 4) == telegram.BAD_ADDRESS


def test_the_longest_telegram_has_256_characters():
    longest = built(bytes(252), 1)
    assert len(longest) == telegram.SIZE_MAX and longest[1] == 0xFE
    assert telegram.judge(longest, 256, 1, 252) == telegram.GOOD


def test_net_data_that_do_not_fit_are_refused():
    for net_count in (0, 253, -1):
        try:
            telegram.seal(bytearray(300), 1, net_count)
        except ValueError:
            continue
        raise AssertionError("%d net characters were accepted" % net_count)


def test_words_travel_high_byte_first():
    buffer = bytearray(4)
    telegram.put_word(buffer, 1, 0x047F)
    assert buffer == b"\x00\x04\x7f\x00"
    assert telegram.get_word(buffer, 1) == 0x047F


def test_a_few_characters_are_no_telegram_and_one_net_character_is_enough():
    for characters in (b"\x02", b"\x02\x00", b"\x02\x01\x03", b"\x02\x02\x01\x01"):
        assert telegram.judge(characters, len(characters), None, None) == telegram.BAD_LENGTH
    shortest = built(b"\x5a", 31)
    assert shortest == b"\x02\x03\x1f\x5a\x44"
    assert telegram.judge(shortest, 5, telegram.NODE_MAX, 1) == telegram.GOOD
    findings = telegram.GOOD, telegram.BAD_START, telegram.BAD_LENGTH, telegram.BAD_BCC
    assert findings + (telegram.BAD_ADDRESS,) == tuple(range(len(telegram.FINDINGS)))
    assert (telegram.BROADCAST, telegram.MIRROR, telegram.SPECIAL) == (32, 64, 128)
