# SPDX-License-Identifier: MIT
"""From bursts to a telegram: start interval, response delay, residual run time, stray characters.

Specification A-5.1.2 (start interval), A-5.2.1.1 (response delay), A-6.3 (residual run time).
"""

from receiver_bench import LINE, MASK, REPLY, SENT_AT, TCH, Line, Link
from uss import bus, receiver, telegram
from uss.drive import Drive
from uss.layout import STANDARD, VARIABLE, Layout
from uss.receiver import CUT_OFF, GARBLED, SILENT, WAITING
from uss.telegram import BAD_ADDRESS, BAD_BCC, BAD_LENGTH, BAD_START, GOOD


def test_a_reply_after_three_characters_is_taken():
    """As an MM420 answers."""
    line = Line()
    assert line.come(REPLY, 3 * TCH) == GOOD
    assert bytes(line.receiver.buffer[: line.receiver.count]) == REPLY


def test_a_reply_may_come_from_two_characters_to_twenty_milliseconds_later():
    assert Line().come(REPLY, LINE.start_interval_us) == GOOD
    assert Line().come(REPLY, 19_900) == GOOD


def test_a_reply_that_comes_too_early_is_none():
    """1.9 characters after the request: STX without a start interval is data."""
    line = Line()
    assert line.come(REPLY, LINE.start_interval_us * 95 // 100) == WAITING
    assert line.silence(25_000) == BAD_START


def echo_of(line):
    """What the line brings back of the request."""
    return bytes(line.drive.request[: line.drive.size])


def come_with_the_echo(line, characters, pause_us):
    """The echo of the request, a pause, and these characters: all of it in one burst."""
    echo = echo_of(line)
    return line.come(echo + characters, pause_us - len(echo) * TCH)


def test_a_reply_in_one_burst_with_the_echo_needs_its_start_interval_as_well():
    for pause_us, finding in (
        (LINE.start_interval_us, GOOD),
        (LINE.start_interval_us * 95 // 100, WAITING),
    ):
        line = Line()
        assert come_with_the_echo(line, REPLY, pause_us) == finding, pause_us
        assert finding != GOOD or bytes(line.receiver.buffer[: line.receiver.count]) == REPLY
    assert line.silence(25_000) == BAD_START


def test_a_start_interval_is_long_enough_to_the_microsecond():
    """No reply is refused because two instants and the time of a character were rounded."""
    rounded_us = len(REPLY) * TCH - Line().receiver.sixteen_us + receiver.ROUNDING_US
    least_us = LINE.start_interval_us - rounded_us
    for pause_us, finding in ((least_us, GOOD), (least_us - 1, WAITING)):
        assert Line().come(REPLY, pause_us) == finding, pause_us
        assert come_with_the_echo(Line(), REPLY, pause_us) == finding, pause_us


def test_a_link_that_looks_late_is_believed_about_a_reply_behind_the_echo_too():
    for pause_us, finding in (
        (LINE.start_interval_us - TCH // 4, GOOD),
        (LINE.start_interval_us - TCH, WAITING),
    ):
        assert come_with_the_echo(Line(polled_us=TCH // 2), REPLY, pause_us) == finding, pause_us


def test_what_was_sent_is_a_reply_only_if_there_certainly_was_a_start_interval():
    """Else it is its echo. How late a link may have looked counts against the reply."""
    for polled_us in (0, TCH // 2, 5 * TCH):
        rounded_us = len(REPLY) * TCH - Line().receiver.sixteen_us
        least_us = LINE.start_interval_us + polled_us - rounded_us
        for pause_us, finding in ((least_us, GOOD), (least_us - 1, WAITING)):
            line = Line(polled_us=polled_us)
            assert line.come(echo_of(line), pause_us) == finding, (polled_us, pause_us)
            assert line.receiver.echo == (finding == WAITING)


def test_a_reply_that_begins_in_one_burst_with_the_echo_is_put_together():
    """And it has its residual run time from its own first character on."""
    for cut in range(1, 16):
        line = Line()
        assert come_with_the_echo(line, REPLY[:cut], 3 * TCH) == WAITING
        assert line.come(REPLY[cut:], 0) == GOOD, cut
        assert bytes(line.receiver.buffer[: line.receiver.count]) == REPLY, cut
        line = Line()  # the echo comes in pieces as well, and ends with the request
        echo = echo_of(line)
        assert line.come(echo[:cut], -len(echo) * TCH) == WAITING
        assert line.come(echo[cut:] + REPLY, (3 + cut - len(echo)) * TCH) == GOOD, cut
        assert line.receiver.echo and not line.receiver.stray
    line = Line()
    line.drive = Drive(1, MASK, layout=Layout(3, 2))
    line.drive.fill(0)
    telegram.seal(line.drive.request, 1, 10)
    line.receiver.open(line.drive, SENT_AT)
    reply = bytearray(REPLY[:3] + REPLY[5:])  # of another length as well
    reply[1], reply[-1] = 12, reply[-1] ^ 14 ^ 12
    assert come_with_the_echo(line, bytes(reply), 3 * TCH) == GOOD
    assert line.receiver.buffer[: line.receiver.count] == reply
    for gap_us, finding in ((15 * TCH // 2 - TCH, GOOD), (15 * TCH // 2 + TCH, CUT_OFF)):
        line = Line()
        come_with_the_echo(line, REPLY[:7], 3 * TCH)
        assert line.come(REPLY[7:], gap_us) == finding, gap_us


def test_silence_is_noticed_when_the_response_delay_is_over():
    line = Line()
    assert line.receiver.window_us == 20_000 + TCH + 2  # two instants are rounded
    assert line.silence(20_000) == WAITING  # its first character may be under way
    assert line.silence(20_000 + TCH + 3) == SILENT


def test_a_reply_in_pieces_is_put_together():
    """As a link without interrupts delivers it."""
    for cut in range(1, 16):
        line = Line()
        assert line.come(REPLY[:cut], 3 * TCH) == WAITING
        assert line.come(REPLY[cut:], 0) == GOOD, cut
    line = Line()
    for character in REPLY[:-1]:
        assert line.come(bytes((character,)), 3 * TCH if not line.receiver.count else 0) == WAITING
    assert line.come(REPLY[-1:], 0) == GOOD


def test_a_gap_inside_the_telegram_is_no_error():
    """The receiver need not watch single gaps, only the residual run time (A-6.3)."""
    for gap in (19, 21, 60):
        line = Line()
        line.come(REPLY[:7], 3 * TCH)
        assert line.come(REPLY[7:], gap * TCH // 10) == GOOD, gap


def test_gaps_of_half_the_telegram_are_allowed_and_no_more():
    compressed_us = 15 * TCH
    line = Line()
    line.come(REPLY[:7], 3 * TCH)
    assert line.come(REPLY[7:], compressed_us // 2 - TCH // 2) == GOOD
    line = Line()
    line.come(REPLY[:7], 3 * TCH)
    assert line.come(REPLY[7:], compressed_us // 2 + TCH) == CUT_OFF


def test_a_reply_that_breaks_off_is_given_up_after_the_residual_time():
    line = Line()
    line.come(REPLY[:15], 3 * TCH)
    began_us = 3 * TCH
    assert line.silence(began_us + LINE.residual_us(12)) == WAITING
    assert line.silence(began_us + LINE.residual_us(12) + 12) == CUT_OFF


def test_until_its_length_has_come_a_reply_may_take_as_long_as_one_that_is_awaited():
    """With a variable length as the longest (A-5.2.1.2), else as one of the request's length."""
    for layout, net_count in ((STANDARD, 12), (Layout(3, 2), 10), (Layout(VARIABLE, 2), 252)):
        line = Line()
        line.drive = Drive(1, MASK, layout=layout)
        line.drive.fill(0)
        line.receiver.open(line.drive, SENT_AT)
        line.come(REPLY[:1], 3 * TCH)
        longest_us = 3 * TCH + LINE.residual_us(net_count)
        assert line.silence(longest_us) == WAITING, layout
        assert line.receiver.due_us(line.link, SENT_AT + longest_us) in (1, 2)
        assert line.silence(longest_us + 2) == CUT_OFF, layout


def test_every_other_error_is_found():
    """Also by a link that cannot tell by the pause whether an echo may have come."""
    other = bytearray(REPLY)
    other[2], other[15] = 2, other[15] ^ 3
    for spoilt, finding in (
        (REPLY[:-1] + b"\x00", BAD_BCC),
        (bytes(other), BAD_ADDRESS),
        (b"\x02\x06\x01\xfb\x34\x20\x00\xea", BAD_LENGTH),
        (REPLY + b"\x00", GARBLED),
    ):
        for polled_us in (0, 2 * TCH):
            assert Line(polled_us=polled_us).come(spoilt, 3 * TCH) == finding, polled_us


def test_a_whole_telegram_of_another_length_is_told_from_noise():
    """Shorter, longer, in one burst or in pieces; noise that begins like one is none."""
    shorter = b"\x02\x06\x01\xfb\x34\x20\x00\xea"
    longer = b"\x02\x12\x01" + bytes(16)
    longer += bytes((telegram.bcc(longer, len(longer)),))
    for whole in (shorter, longer):
        assert Line().come(whole, 3 * TCH) == BAD_LENGTH
        for cut in range(2, len(whole)):
            line = Line()
            assert line.come(whole[:cut], 3 * TCH) == WAITING
            assert line.come(whole[cut:], 0) == BAD_LENGTH, cut
            line = Line()
            line.come(whole[:cut], 3 * TCH)
            left_us = line.receiver.due_us(line.link, line.receiver.heard_at)
            assert 2 * TCH <= left_us <= 3 * TCH  # nobody waits for the rest of it for long
            now = line.receiver.heard_at + left_us
            for late_us, finding in ((-1, WAITING), (0, GARBLED), (1, GARBLED)):
                assert line.receiver.take(line.link, now + late_us) == finding, (cut, late_us)
        assert Line().come(whole[:-1] + b"\x55", 3 * TCH) == GARBLED
        assert Line().come(whole + b"\x00", 3 * TCH) == GARBLED
    for net_count in (1, 252):  # the shortest and the longest that there are
        whole = bytes((2, net_count + 2, 1)) + bytes(net_count)
        whole += bytes((telegram.bcc(whole, len(whole)),))
        assert Line().come(whole, 3 * TCH) == BAD_LENGTH
    for length in (0, 1, 2, 255):
        for more in (b"", b"\x01\x00\x00"):  # its second character has said it
            assert Line().come(bytes((2, length)) + more, 3 * TCH) == GARBLED, length


def test_a_whole_telegram_of_another_length_and_address_is_somebody_elses():
    assert Line().come(b"\x02\x06\x02\xfb\x34\x20\x00\xe9", 3 * TCH) == BAD_ADDRESS


def test_a_stray_character_does_not_hide_the_reply_that_follows():
    """A spike when the line turns round, then the reply after its start interval."""
    for stray in (b"\x00", b"\xff", b"\x00\xff\x55"):
        line = Line()
        assert line.come(stray, 10) == WAITING
        assert line.receiver.stray
        assert line.come(REPLY, 3 * TCH) == GOOD, stray


def test_a_telegram_that_follows_a_stray_character_without_a_pause_is_data():
    line = Line()
    assert line.come(b"\x00" + REPLY, 3 * TCH) == WAITING
    assert line.silence(25_000) == BAD_START
    line = Line()
    line.come(b"\x00", 3 * TCH)
    assert line.receiver.heard_at == SENT_AT + 4 * TCH
    assert line.come(REPLY, TCH) == WAITING


def test_behind_the_echo_as_well_a_stray_character_must_be_followed_by_a_pause():
    for pause_us, finding in ((TCH, WAITING), (3 * TCH, GOOD)):
        line = Line()
        echo = echo_of(line)
        assert line.come(echo, -len(echo) * TCH) == WAITING and line.receiver.echo
        assert line.come(b"\x00", 3 * TCH) == WAITING and line.receiver.stray
        assert line.come(REPLY, pause_us) == finding, pause_us


def test_a_02h_inside_the_data_starts_nothing():
    """A foreign telegram full of 02h, one character a burst, without pauses."""
    line = Line()
    for character in b"\x00" + b"\x02" * 30:
        assert line.come(bytes((character,)), 0) == WAITING
    assert line.receiver.count == 0


def test_nothing_is_kept_from_one_request_to_the_next():
    """The panel of 8051 days hung for good here."""
    line = Line()
    line.come(REPLY[:9], 3 * TCH)
    line.sent_at += 50_000
    line.receiver.open(line.drive, line.sent_at)
    assert line.come(REPLY, 3 * TCH) == GOOD


def test_a_link_that_looks_late_is_believed_as_far_as_it_knows():
    """A polled link does not know the pause exactly: what may have been right is taken."""
    line = Line(polled_us=5_000)
    assert line.come(REPLY, 100) == GOOD
    line = Line(polled_us=5_000)
    assert line.come(REPLY, 3 * TCH, after_us=4_000) == GOOD


def test_a_link_that_looks_late_is_believed_about_the_end_of_a_reply_too():
    """The residual run time may have been kept, and a telegram of another length may go on."""
    polled_us = 2_000
    longest_us = LINE.residual_us(12) + polled_us
    for passed_us, finding in ((longest_us, GOOD), (longest_us + 1, CUT_OFF)):
        line = Line(polled_us=polled_us)
        line.come(REPLY[:7], 3 * TCH)
        began_at = line.receiver.heard_at - (7 * line.receiver.sixteen_us >> 4)
        gap_us = began_at + passed_us - line.receiver.heard_at - 9 * TCH
        assert line.come(REPLY[7:], gap_us) == finding, passed_us
        line = Line(polled_us=polled_us)
        line.come(REPLY[:7], 3 * TCH)
        now = line.receiver.heard_at
        due_us = line.receiver.due_us(line.link, now)
        assert due_us == began_at + longest_us + 1 - now
        now += due_us + passed_us - longest_us - 1
        finding = WAITING if finding == GOOD else CUT_OFF
        assert line.receiver.take(line.link, now) == finding, passed_us
    line = Line(polled_us=polled_us)
    line.come(b"\x02\x06\x01", 3 * TCH)
    due_us = line.receiver.due_us(line.link, line.receiver.heard_at)
    assert due_us == LINE.start_interval_us + polled_us + 1
    for now, finding in ((due_us - 1, WAITING), (due_us, GARBLED)):
        assert line.receiver.take(line.link, line.receiver.heard_at + now) == finding


def test_a_link_without_interrupts_is_looked_at_when_the_reply_may_be_complete():
    """And then every millisecond, up to the end of the response delay."""
    line = Line()
    line.link.interrupts = False
    earliest_us = LINE.start_interval_us + line.receiver.sixteen_us  # of 16 characters
    window_us = line.receiver.window_us
    for passed_us, due_us in (
        (0, earliest_us),
        (earliest_us - 1_001, 1_001),
        (earliest_us - 999, 1_000),
        (earliest_us + 50, 1_000),
        (window_us - 400, 400),
        (window_us + 400, 1),
    ):
        assert line.receiver.due_us(line.link, SENT_AT + passed_us) == due_us, passed_us
    line.link.interrupts = True
    assert line.receiver.due_us(line.link, SENT_AT) == window_us


def test_the_counter_may_wrap_anywhere_in_an_exchange():
    for bits in (24, 30):
        mask = (1 << bits) - 1
        for before_us in range(0, 12_000, 97):
            line = Line(mask, mask - before_us)
            assert line.come(REPLY, 3 * TCH) == GOOD, before_us
            line = Line(mask, mask - before_us)
            assert come_with_the_echo(line, REPLY, 3 * TCH) == GOOD, before_us
            line = Line(mask, mask - before_us)
            assert line.silence(20_000) == WAITING
            assert line.silence(21_000) == SILENT


def test_noise_of_any_kind_is_survived_and_the_next_reply_taken():
    """Seeded bursts of any content and length, then a request and its reply."""
    seed = 1994
    print("seed", seed)
    state = seed
    for _ in range(2000):
        line = Line()
        for _ in range(3):
            state = (state * 1103 + 12345) & 0xFFFFFF
            length = 1 + (state >> 8) % 40
            noise = bytes((state >> (index % 17)) & 0xFF for index in range(length))
            finding = line.come(noise, (state >> 4) % 3000)
            assert finding in range(WAITING, GARBLED + 1) and finding != GOOD
            if finding != WAITING:
                line.receiver.open(line.drive, line.receiver.heard_at)
        line.receiver.open(line.drive, line.receiver.heard_at)
        assert line.come(REPLY, 3 * TCH) == GOOD


def test_every_finding_has_a_name():
    assert len(receiver.FINDINGS) == len(receiver.TROUBLES) == GARBLED + 1
    assert receiver.FINDINGS[: len(telegram.FINDINGS)] == telegram.FINDINGS


def test_every_trouble_is_said_in_words():
    for trouble, words in (
        (receiver.SILENCE, "does not answer"),
        (receiver.NOISE, "is noise"),
        (receiver.OTHER_LENGTH, "of another length"),
        (receiver.OTHER_ADDRESS, "another address"),
        (receiver.WRONG_CHECK, "a wrong check character"),
    ):
        assert words in bus.TROUBLES[trouble], words


# --- a link that announces the end of what is coming --------------------------------------------


class Coming(Link):
    """Characters are coming in; to take them before their end is announced would be too early."""

    def receive(self, buffer, at):
        return Link.receive(self, buffer, at) or receiver.COMING


def coming():
    line = Line()
    line.link = Coming()
    return line


def test_a_reply_that_is_coming_in_is_waited_for_beyond_the_response_delay():
    line = coming()
    assert line.silence(line.receiver.window_us + 1) == WAITING
    due_us = line.receiver.due_us(line.link, SENT_AT + line.receiver.window_us + 1)
    assert due_us == LINE.residual_us(12) - 1
    assert line.come(REPLY, line.receiver.window_us - TCH) == GOOD
    line.silence(line.receiver.window_us + 1)
    line.receiver.open(line.drive, SENT_AT + 50_000)  # nothing has come of the next one so far
    assert line.receiver.due_us(line.link, SENT_AT + 50_000) == line.receiver.window_us


def test_what_comes_in_without_end_is_not_waited_for_longer_than_a_reply_takes():
    line = coming()
    last_us = line.receiver.window_us + LINE.residual_us(12)
    assert line.silence(last_us - 1) == WAITING
    assert line.silence(last_us) == BAD_START
    line = coming()
    line.link.resolution_us = 2_000
    assert line.silence(last_us + 1_999) == WAITING
    due_us = line.receiver.due_us(line.link, SENT_AT + last_us)
    assert due_us == 2_000
    assert line.silence(last_us + 2_000) == BAD_START


def test_what_is_still_coming_when_a_reply_is_given_up_keeps_the_line_from_being_silent():
    """The silence before the next telegram begins only when it is over."""
    line = coming()
    line.come(REPLY[:5], 3 * TCH)
    given_up_us = 3 * TCH + LINE.residual_us(12) + 2
    assert line.silence(given_up_us) == CUT_OFF
    assert line.receiver.heard_at == SENT_AT + given_up_us


def test_a_telegram_of_another_length_that_is_still_coming_is_waited_for_as_long_as_it_may_take():
    line = coming()
    line.come(b"\x02\x06\x01", 3 * TCH)
    receiver = line.receiver
    last = receiver.heard_at - (3 * receiver.sixteen_us >> 4) + LINE.residual_us(4)
    behind = receiver.heard_at + 3 * TCH  # over, if the link did not say that more is coming
    assert receiver.take(line.link, behind) == WAITING
    assert receiver.due_us(line.link, behind) == last + 1 - behind
    assert receiver.take(line.link, last) == WAITING
    assert receiver.take(line.link, last + 1) == GARBLED and receiver.heard_at == last + 1


def test_a_reply_that_the_link_has_judged_by_itself_counts_as_taken():
    line = Line()
    line.receiver.accept(len(REPLY), SENT_AT + 20 * TCH)
    assert line.receiver.count == len(REPLY)
    assert line.receiver.heard_at == SENT_AT + 20 * TCH


def test_what_was_heard_before_the_request_had_left_is_no_reply_to_it():
    """The late reply to the request before it, say: taken only now, and not a word of it true."""
    for before_us in (1, TCH, 100 * TCH):
        line = Line(polled_us=2 * TCH)
        line.link.burst = REPLY
        line.link.received_at = (SENT_AT - before_us) & MASK
        assert line.receiver.take(line.link, SENT_AT + 1) == WAITING
        assert line.receiver.heard_at == SENT_AT
        assert line.come(REPLY, 3 * TCH) == GOOD  # the one that belongs to it
