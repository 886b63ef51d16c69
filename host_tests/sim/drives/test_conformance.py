# SPDX-License-Identifier: MIT
"""The drives that tools/drive serves, tried by a USS master of its own: telegrams and addresses.

The master (conformance/) speaks to them over a pseudo terminal with pyserial, and shares no code
with them nor with the panel. The parameter channel is tried in test_conformance_parameters.py, the
process data in test_conformance_process.py, and what happens between the characters in
test_conformance_timing.py. Sections are those of the USS specification.
"""

import ast

import pytest

from conformance.kinds import KINDS
from conformance.master import VARIABLE
from conformance.program import Drives
from conformance.telegrams import BROADCAST, MIRROR, SPECIAL, framed
from tiers import TOP

INTERPRETERS = "host"

OFF1, RUN, HALF = 0x047E, 0x047F, 0x2000
RUNNING = 0x0004

# r2024 ... r2031.
GOOD, REJECTED, FRAME, OVERRUN, PARITY, START, BCC, LENGTH = range(8)


@pytest.fixture(scope="module")
def drives():
    with Drives(KINDS) as drives:
        yield drives


@pytest.fixture
def node(request, drives):
    """The drive that the test is parametrized with, after a power-up and two telegrams."""
    node = drives.ready(request.param)
    node.exchange(node.no_task())
    yield node
    drives.leave(node)


def on(*names):
    return pytest.mark.parametrize("node", names, ids=names, indirect=True)


def counters(node):
    """r2024 ... r2031, before the telegram that asks for the first one was counted."""
    return [node.task(1, number)[1][0] for number in range(2024, 2032)]


def counted(node, *kinds):
    """What was counted since the power-up, besides good telegrams: so many of each kind."""
    values = counters(node)
    wanted = [0] * 8
    for kind in kinds:
        wanted[kind] += 1
        wanted[REJECTED] += 1
    return values[REJECTED:] == wanted[REJECTED:]


def request(node, stw=RUN, hsw=HALF):
    """A telegram that would start the motor, with no parameter task."""
    return bytearray(framed(node.address, node.no_task() + [stw, hsw]))


def stands(node):
    """Whether the drive still answers, is ready, and does not run; it is told nothing by that."""
    return node.control(0)[0] & 0x007F == 0x0031


# ---- who answers, and with what, A-4 ---------------------------------------------------


@on(*KINDS)
def test_every_layout_is_answered_in_its_own(node):
    # Fixed: request and reply have the same length (C-4.1.1). Variable: PZD stay as agreed.
    pkw, pzd = node.exchange(node.no_task())
    assert len(pzd) == node.pzd_words
    assert pkw == node.no_task()


@on("mm420 4+2", "mm440 4+8", "g110 0+2", "mm3 3+2", "generic 4+16", "v20 4+2")
def test_a_telegram_of_another_length_is_not_answered_where_the_length_is_fixed(node):
    count = node.pkw_words + node.pzd_words
    lengths = [n for n in (1, count - 1, count + 1, count + 4) if n != count]
    assert node.master.is_silent(*[framed(node.address, [0] * n) for n in lengths])
    assert len(node.exchange(node.no_task())[1]) == node.pzd_words
    if node.pkw_words == 4:
        assert counted(node, *[LENGTH] * len(lengths))


@on("mm420 variable+2", "mm440 variable+4", "g120 variable+2", "generic variable+0")
def test_variable_length_takes_any_number_of_parameter_words(node):
    for count in (3, 4, 8, 24):
        pkw, pzd = node.exchange(node.no_task() + [0] * (count - 3))
        assert (len(pkw), len(pzd)) == (3, node.pzd_words)


@on("mm440 variable+4")
def test_variable_length_needs_all_process_data_words(node):
    assert node.master.is_silent(framed(node.address, [0] * (node.pzd_words - 1)))


def test_only_the_address_that_is_meant_answers(drives):
    for name in KINDS:
        node = drives.ready(name)
        node.exchange(node.no_task())  # words_of() looks at ADR
    free = set(range(32)) - {kind.address for kind in KINDS.values()}
    for master in drives.masters:
        assert master.is_silent(*[framed(adr, [0] * 6) for adr in sorted(free)])


# ---- what is wrong meets silence, and does nothing: A-5.2.2 -----------------------------------


@on("mm420 4+2")
def test_a_wrong_bcc_meets_silence_and_is_counted(node):
    node.control(OFF1)
    bad = []
    for place in range(3, 16):
        telegram = request(node)
        telegram[place] ^= 1 << place % 8
        bad.append(telegram)
    assert node.master.is_silent(*bad)
    assert stands(node) and counted(node, *[BCC] * len(bad))


@on("mm420 4+2", "mm440 variable+4", "g110 0+2", "v20 4+2", "mm3 3+2", "g120 variable+2")
def test_a_bcc_without_the_stx_meets_silence(node):
    # The mistake seen most in the field: counts the STX.
    telegram = bytearray(framed(node.address, node.no_task() + [RUN] * node.pzd_words))
    telegram[-1] ^= 2
    assert node.master.is_silent(telegram)
    assert stands(node)


@on("mm420 4+2")
def test_a_wrong_lge_meets_silence_and_is_counted(node):
    wrong = (0, 1, 2, 3, 12, 13, 15, 16, 254, 255)
    bad = []
    for lge in wrong:
        telegram = request(node)
        telegram[-1] ^= telegram[1] ^ lge  # the BCC is right
        telegram[1] = lge
        bad.append(telegram)
    assert node.master.is_silent(*bad)
    assert stands(node) and counted(node, *[LENGTH] * len(wrong))


@on("mm420 variable+2")
def test_an_lge_that_no_telegram_has_meets_silence_in_variable_length(node):
    wrong = (0, 1, 2, 4, 11, 255)  # the least is 6 with two process data words
    bad = []
    for lge in wrong:
        telegram = request(node)
        telegram[-1] ^= telegram[1] ^ lge
        telegram[1] = lge
        bad.append(telegram)
    assert node.master.is_silent(*bad)
    assert stands(node) and counted(node, *[LENGTH] * len(wrong))


@on("mm420 4+2")
def test_a_telegram_that_does_not_begin_with_stx_meets_silence_and_is_counted(node):
    bad = []
    for first in (0x00, 0x03, 0x82, 0xFF):
        telegram = request(node)
        telegram[-1] ^= telegram[0] ^ first
        telegram[0] = first
        bad.append(telegram)
    assert node.master.is_silent(*bad)
    assert stands(node) and counted(node, *[START] * len(bad))


@on("mm420 4+2")
def test_a_telegram_for_somebody_else_is_not_counted(node):
    # The specification leaves that open; these drives count what is theirs.
    free = sorted(set(range(32)) - {kind.address for kind in KINDS.values()})
    others = []
    for adr in free[:4]:
        telegram = request(node)
        telegram[-1] ^= telegram[2] ^ adr
        telegram[2] = adr
        others.append(telegram)
    before = counters(node)
    assert node.master.is_silent(*others)
    after = counters(node)
    assert after[REJECTED:] == before[REJECTED:] and stands(node)


@on("mm420 4+2", "v20 4+2")
def test_good_telegrams_are_counted(node):
    first = node.exchange(node.request(1, 2024))[0][-1]
    for _ in range(5):
        node.exchange(node.no_task())
    assert node.exchange(node.request(1, 2024))[0][-1] == first + 6


@on("mm420 4+2", "mm440 variable+4")
def test_after_any_error_the_next_good_telegram_is_accepted(node):
    good = framed(node.address, node.no_task() + node.pzd)
    mistakes = [
        good[:1], good[:5], good[:-1], good + b"\x00", b"\x00" + good, good[1:], b"\xff" * 20,
        good + good, b"\x02" * 16,
    ]  # fmt: skip
    for bad in mistakes:
        node.master.send(bad)
        node.master.settle()
        node.exchange(node.no_task())


@on("mm420 4+2")
def test_the_last_process_data_stay_in_force_after_a_telegram_that_was_rejected(node):
    node.control(OFF1)
    node.control(RUN, HALF)
    bad = request(node, OFF1, 0)
    bad[-1] ^= 1
    assert node.master.is_silent(bad)
    assert node.task(1, 2036) == (1, [RUN])
    assert node.exchange(node.no_task())[1][0] & RUNNING
    node.control(0x047C)


@on("mm420 4+2")
def test_a_telegram_inside_the_data_of_another_one_is_not_seen(node):
    # 02h may stand anywhere, only the pause before it makes it a start.
    inner = request(node)
    words = [inner[i] << 8 | inner[i + 1] for i in range(0, 16, 2)]
    assert node.master.is_silent(framed(29, words))
    assert stands(node)


# ---- mirror, A-5.3 ---------------------------------------------------------------------


@on(*KINDS)
def test_a_mirror_telegram_comes_back_unchanged_and_does_nothing(node):
    node.exchange(node.no_task())
    content = [0x22BC, 0, 0, 1][: len(node.no_task())]  # would write P0700
    if node.pzd:
        node.pzd[0] = RUN
    assert node.is_mirror(content)
    if node.pzd:
        assert stands(node)
    if node.pkw_words == 4:
        assert node.task(1, 700) == (1, [5])


def test_a_mirror_telegram_for_nobody_meets_silence(drives):
    for master in drives.masters:
        assert master.is_silent(framed(MIRROR | 29, [0] * 6), framed(MIRROR | 28, [0] * 5))


# ---- special and undefined addresses: A-4.3 ---------------------------------------------------


@on("mm420 4+2", "mm440 variable+4", "g110 0+2", "v20 4+2", "mm3 3+2", "g120 variable+2")
@pytest.mark.parametrize(
    "bits",
    [SPECIAL, SPECIAL | BROADCAST, MIRROR | BROADCAST, SPECIAL | MIRROR,
     SPECIAL | MIRROR | BROADCAST],
    ids=lambda bits: "%02X" % bits,
)  # fmt: skip
def test_special_and_undefined_addresses_meet_silence_and_do_nothing(node, bits):
    node.control(OFF1)
    words = node.no_task() + [RUN] + [0] * (node.pzd_words - 1)
    assert node.master.is_silent(framed(bits | node.address, words))
    assert stands(node)


# ---- broadcast: A-3, C-5.2.3, appendix --------------------------------------------------------

# Enable array a, b, c, d; PZD1 and PZD2; what the drive has then.
BROADCASTS = {
    "the main setpoint for all": ((0x0005, 0, 0, 0), 0x0000, 0x2000, (0x047E, 0x2000)),
    "not without the flag a.0": ((0x0006, 0xFFFF, 0, 0), 0x047F, 0x3000, (0x047E, 0x1000)),
    "nothing enabled": ((0x0000, 0, 0, 0), 0x047F, 0x3000, (0x047E, 0x1000)),
    "a flag alone enables nothing": ((0x0001, 0xFFFF, 0, 0), 0x047F, 0x3000, (0x047E, 0x1000)),
    "control word and setpoint": ((0x0007, 0xFFFF, 0, 0), 0x047F, 0x3000, (0x047F, 0x3000)),
    "ramps held": ((0x0003, 0x0020, 0, 0), 0x0400, 0x0000, (0x045E, 0x1000)),
    "OFF2": ((0x0003, 0x0002, 0, 0), 0x047C, 0x0000, (0x047C, 0x1000)),
    "no bit of PZD1 is enabled": ((0x0003, 0x0000, 0, 0), 0x047F, 0x0000, (0x047E, 0x1000)),
}


@on("mm420 4+2", "v20 4+2", "mm440 4+8", "generic 4+16")
@pytest.mark.parametrize("name", BROADCASTS)
def test_a_broadcast_changes_what_its_enable_array_names_and_is_not_answered(node, name):
    enable, stw, hsw, wanted = BROADCASTS[name]
    node.control(OFF1, 0x1000)
    words = [stw, hsw] + [0] * (node.pzd_words - 2)
    assert node.master.is_silent(framed(BROADCAST, [*enable, *words]))
    assert received(node, 2) == list(wanted)


def received(node, count):
    """r2018: the process data in force; read without sending any that count."""
    node.pzd[0] = 0
    array = 1 if node.pzd_words == 16 else 0
    return [node.task(6, 2018, i + array)[1][0] for i in range(count)]


@on("generic 4+16")
def test_a_broadcast_masks_words_4_and_5_bit_by_bit_and_never_has_word_16(node):
    node.control(OFF1, *[0x1111] * 15)
    words = [OFF1] + [0xFFFF] * 15
    assert node.master.is_silent(framed(BROADCAST, [0xFFFF, 0, 0x00FF, 0xF000, *words]))
    assert received(node, 16) == (
        [OFF1, 0xFFFF, 0xFFFF, 0x11FF, 0xF111] + [0xFFFF] * 10 + [0x1111]
    )


@on("mm420 4+2", "v20 4+2")
def test_a_broadcast_is_never_a_parameter_task(node):
    # Its parameter words would write P0700.
    assert node.master.is_silent(framed(BROADCAST, [0x22BD, 0, 0, 2, OFF1, 0]))
    assert node.exchange(node.no_task())[0] == node.no_task()
    assert node.task(1, 700) == (1, [5])


@on("mm420 4+2")
def test_the_address_bits_of_a_broadcast_do_not_matter(node):
    node.control(OFF1, 0x1000)
    words = [0x0005, 0, 0, 0, 0, 0x2000]
    assert node.master.is_silent(framed(BROADCAST | 29, words))
    assert received(node, 2) == [OFF1, 0x2000]


@on("mm420 3+2", "g110 0+2", "mm3 3+2", "mm440 variable+4")
def test_a_broadcast_needs_parameter_words_of_four(node):
    node.control(OFF1)
    pkw = [0x0007, 0xFFFF, 0][: node.pkw_words]
    telegram = framed(BROADCAST, pkw + [RUN] + [HALF] * (node.pzd_words - 1))
    assert node.master.is_silent(telegram)
    assert stands(node)


@on("g120 variable+2")
def test_a_family_without_broadcast_takes_none(node):
    node.control(OFF1)
    assert node.master.is_silent(framed(BROADCAST, [0x0007, 0xFFFF, 0, 0, RUN, HALF]))
    assert stands(node)


@on("mm420 4+2")
def test_a_broadcast_without_bit_10_is_not_valid(node):
    node.control(OFF1, 0x1000)
    assert node.master.is_silent(framed(BROADCAST, [0x0007, 0xFFFF, 0, 0, 0x007F, 0x2000]))
    assert received(node, 2) == [OFF1, 0x1000]


# ---- the master itself ------------------------------------------------------------------------


def test_the_master_shares_no_code_with_what_it_tries():
    folder = TOP / "host_tests/benches/conformance"
    allowed = {"conformance", "serial", "os", "select", "struct", "subprocess", "time", "typing"}
    for path in folder.glob("*.py"):
        for tree in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(tree, ast.Import):
                names = [alias.name for alias in tree.names]
            elif isinstance(tree, ast.ImportFrom):
                names = [tree.module]
            else:
                continue
            assert {name.split(".")[0] for name in names} <= allowed, path


def test_the_master_builds_the_examples_of_the_specification():
    for adr, words, telegram in (
        (0x01, [0x047F, 0x2000], "02 06 01 04 7F 20 00 5E"),
        (0x01, [0x1034, 0, 0, 0x047E, 0], "02 0C 01 10 34 00 00 00 00 04 7E 00 00 51"),
        (0x01, [0x8004, 0x0002, 0x4000, 0], "02 0A 01 80 04 00 02 40 00 00 00 CF"),
        (0x20, [5, 0, 0, 0, 0, 0x2000], "02 0E 20 00 05 00 00 00 00 00 00 00 00 20 00 09"),
    ):
        assert framed(adr, words) == bytes.fromhex(telegram)


def test_the_numbers_of_pages_are_those_of_the_manuals():
    from conformance.master import page_bits

    for number, high_byte in (
        (700, 0x00), (2010, 0x80), (4000, 0x10), (6000, 0x90), (8820, 0x20), (10000, 0xA0),
        (12000, 0x30), (14000, 0xB0), (16000, 0x40), (20000, 0x50), (30000, 0xF0), (32000, 0x04),
        (60000, 0x74), (64000, 0x08),
    ):  # fmt: skip
        assert page_bits(number // 2000) == high_byte << 8, number


def test_variable_is_what_p2013_says():
    assert VARIABLE == 127
