# SPDX-License-Identifier: MIT
"""Process data: what the control and status words say, and the scaling of PZD2."""

import golden
from uss import pzd

# Status words seen on real drives, or given by the manuals, and what they say.
SEEN = (
    (0xFB31, pzd.READY),  # MM420, stopped
    (0xFA31, pzd.READY),  # MM420, stopped with a setpoint waiting
    (0xBB31, pzd.READY),  # G110
    (0xFB34, pzd.RUNNING),  # MM420, turns right
    (0xBB34, pzd.RUNNING),  # turns left
    (0xFBC1, pzd.INHIBITED),  # MM440 after power-up, OFF2 and OFF3 still in force
    (0x0731, pzd.READY),  # another MM440, bits 11-15 differ
    (0xEB31, pzd.READY),  # G120
    (0xEF37, pzd.RUNNING),  # G120, bits 0-2 are cumulative there
    (0xFB78, pzd.FAULT),
    (0xFB0C, pzd.FAULT),  # a fault outranks running
    (0xFB71, pzd.INHIBITED),
    (0xFB32, pzd.NOT_READY),  # pulses off
    (0x0000, pzd.NOT_READY),
)


def test_status_words_are_read_as_seen_on_real_drives():
    for zsw, said in SEEN:
        assert pzd.state(zsw) == said, hex(zsw)


def test_control_words_are_those_of_the_manuals():
    assert pzd.OFF1 == 0x047E and pzd.ON == 0x047F
    assert pzd.ON == pzd.OFF1 | pzd.STW_ON
    for word in (pzd.OFF1, pzd.ON):
        assert word & 1 << 10, "bit 10, control, is never 0"


def test_4000h_is_the_reference_frequency():
    """Percent of P2000 and the word (G110 and MICROMASTER 440 operating instructions)."""
    scaling = pzd.Scaling(5000, False)
    for centihertz, word in (
        (5000, 0x4000), (2500, 0x2000), (1250, 0x1000), (500, 0x0666), (1000, 0x0CCD),
        (-500, 0xF99A), (-2500, 0xE000), (-5000, 0xC000), (-10000, 0x8000), (0, 0),
    ):  # fmt: skip
        assert scaling.hsw(centihertz) == word, centihertz
        assert abs(scaling.centihertz(word) - centihertz) <= 1, centihertz


def test_p2009_makes_it_hundredths_of_a_hertz():
    scaling = pzd.Scaling(5000, True)
    assert scaling.hsw(1000) == 0x03E8  # as seen on a live MM420
    assert scaling.hsw(-1000) == 0xFC18
    assert scaling.centihertz(0xFC18) == -1000
    assert scaling.hsw(65000) == 0x7FFF  # a word holds 327.67 Hz


def test_no_frequency_leaves_the_range_of_the_word():
    scaling = pzd.Scaling(5000, False)
    assert scaling.hsw(10000) == 0x7FFF
    assert scaling.hsw(65000) == 0x7FFF
    assert scaling.hsw(-65000) == 0x8000


def test_every_frequency_survives_to_half_a_step():
    for reference in (100, 5000, 6000, 32500, 65000):
        scaling = pzd.Scaling(reference, False)
        step = reference / 16384
        for centihertz in range(0, min(2 * reference, 65000), 37):
            for signed in (centihertz, -centihertz):
                back = scaling.centihertz(scaling.hsw(signed))
                assert abs(back - signed) <= step + 1, (reference, signed, back)


def test_a_reference_that_no_drive_has_is_refused():
    for reference in (0, 99, 65001, -5000):
        try:
            pzd.Scaling(reference, False)
        except ValueError:
            continue
        raise AssertionError(reference)


def test_golden_replies_mean_what_their_documents_say():
    by_id = {example.id: example for example in golden.VALID}
    running = by_id["S4-4"].words()
    assert pzd.state(running[4]) == pzd.RUNNING
    assert pzd.Scaling(5000, True).centihertz(running[5]) == 1000
    half = by_id["S2-2"].words()
    assert pzd.Scaling(5000, False).centihertz(half[1]) == 2500


def test_a_fault_outranks_all_and_the_inhibit_all_but_a_fault():
    for others in range(0x80):
        assert pzd.state(others | pzd.ZSW_FAULT) == pzd.FAULT
        without_fault = others & ~pzd.ZSW_FAULT
        assert pzd.state(without_fault | pzd.ZSW_INHIBIT) == pzd.INHIBITED
        free = without_fault & ~pzd.ZSW_INHIBIT
        assert pzd.state(free | pzd.ZSW_RUNNING) == pzd.RUNNING
        is_ready = others & pzd.ZSW_READY == pzd.ZSW_READY
        assert pzd.state(free & ~pzd.ZSW_RUNNING) == (pzd.READY if is_ready else pzd.NOT_READY)
    assert pzd.ZSW_READY == 0x31 and pzd.ZSW_WARNING == 0x80


def test_a_scaling_says_what_it_is_of_and_how_far_it_goes():
    relative, absolute = pzd.Scaling(5000, False), pzd.Scaling(5000, True)
    assert relative.full_scale() == 0x4000 and absolute.full_scale() == 5000
    assert relative.limit_centihertz() == 9999 and absolute.limit_centihertz() == 32767
    assert relative.hsw(-1) == 0xFFFD and absolute.hsw(-1) == 0xFFFF and relative.hsw(1) == 3
    for scaling, other in ((relative, absolute), (absolute, relative)):
        assert scaling.is_of(5000, scaling.absolute) and not scaling.is_of(5000, other.absolute)
        assert not scaling.is_of(4999, scaling.absolute)
        assert not scaling.is_of(5001, scaling.absolute)
    assert pzd.BEYOND == (0x7FFF, 0x8000)
