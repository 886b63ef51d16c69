# SPDX-License-Identifier: MIT
"""What a drive is: by the parameters that it has, and by what they tell."""

from round_bench import framed
from uss import families
from uss.finding.enquiry import NO_CHANNEL, Enquirer, Node, Question, enquiry
from uss.finding.enquiry import layouts as enquiry_layouts
from uss.layout import VARIABLE, Layout
from uss.outside import DONE, TIMED_OUT
from uss.receiver import CUT_OFF, SILENT
from uss.telegram import BAD_BCC, GOOD

ADDRESS = 7
FOUR_AND_TWO = Layout(4, 2)

# A MICROMASTER 4 whose links are both set to 4 PKW and 2 PZD words: P2012, P2013, P2014, P2009.
MM4 = {
    (2013, 0): 4, (2013, 1): 4, (2012, 0): 2, (2012, 1): 2, (2014, 0): 1500, (2014, 1): 700,
    (2009, 0): 0,
}  # fmt: skip


def asked(values, net_count=FOUR_AND_TWO.net_count, everything=True):
    """What is known of a node with so many net characters whose parameters have these values."""
    node = Node(ADDRESS, net_count, False)
    questions = enquiry(node, everything)
    value = None
    try:
        while True:
            _, number, index = questions.send(value)
            assert index in (0, 1), "no drive has a third link"
            has_it = not index or (number, 0) in values
            assert has_it, "who lacks a parameter is asked for a second one of it: %d" % number
            value = values.get((number, index))
    except StopIteration:
        return node


def test_of_two_links_that_are_set_alike_it_is_the_one_with_the_address():
    for addresses, family, off_time_ms in (
        ((ADDRESS, 0), families.MM4, 1500),
        ((0, ADDRESS), families.on_bop(families.MM4), 700),
    ):
        node = asked(MM4 | {(2011, 0): addresses[0], (2011, 1): addresses[1]})
        assert node.family is family and repr(node.layout) == repr(FOUR_AND_TWO), node
        assert node.confirmed and node.off_time_ms == off_time_ms, node.off_time_ms


def test_if_both_have_the_address_it_is_the_one_that_commands_the_drive():
    """P0700: 4 is the BOP link, 5 the COM link; any other source tells nothing."""
    on_bop = families.on_bop(families.MM4)
    for source, family, off_time_ms in (
        (5, families.MM4, 1500),
        (4, on_bop, 700),
        (2, families.MM4, 1500),
        (None, families.MM4, 1500),
    ):
        node = asked(MM4 | {(2011, 0): ADDRESS, (2011, 1): ADDRESS, (700, 0): source})
        assert node.family is family and node.off_time_ms == off_time_ms, (source, node)


def ask(enquirer, state, finding):
    """Ask the next question, which ends like that; answer what it was about."""
    question = enquirer.question()
    question.state, question.finding = state, finding
    assert not enquirer.take(question)
    return question.job.number, question.job.index


def test_a_silence_is_no_answer_before_the_second_one_and_a_late_one_before_the_sixth():
    for finding, times in ((SILENT, 2), (GOOD, 6), (BAD_BCC, 6), (CUT_OFF, 6)):
        enquirer = Enquirer(ADDRESS, FOUR_AND_TWO.net_count, False)
        before = None
        for _ in range(4):
            tried = [ask(enquirer, TIMED_OUT, finding) for _ in range(times)]
            assert tried == times * tried[:1] and tried[0] != before, tried
            before = tried[0]


def test_a_question_that_is_answered_at_the_second_time_leaves_the_next_one_two():
    enquirer = Enquirer(ADDRESS, FOUR_AND_TWO.net_count, False)
    before = None
    for _ in range(4):
        lost, answered = ask(enquirer, TIMED_OUT, SILENT), ask(enquirer, DONE, GOOD)
        assert lost == answered != before
        before = lost


def test_which_layouts_a_length_may_mean_the_most_usual_first():
    for net_count, meant in (
        (2, [(0, 1)]),
        (4, [(0, 2)]),
        (6, [(3, 0), (0, 3)]),
        (8, [(4, 0), (3, 1), (0, 4)]),
        (12, [(4, 2), (3, 3), (0, 6)]),
        (32, [(4, 12), (3, 13), (0, 16)]),
        (34, [(4, 13), (3, 14)]),
        (38, [(4, 15), (3, 16)]),
        (40, [(4, 16)]),
        (42, [(VARIABLE, 2)]),  # of a fixed length none has so many
    ):
        layouts = [(one.pkw_words, one.pzd_words) for one in enquiry_layouts(net_count, False)]
        assert layouts == meant, net_count


def test_a_drive_of_variable_length_is_asked_for_every_number_of_process_data():
    layouts = enquiry_layouts(12, True)
    assert {one.pkw_words for one in layouts} == {VARIABLE}
    words = [one.pzd_words for one in layouts]
    assert words[:3] == [2, 4, 8] and sorted(words) == list(range(17))


def test_a_drive_that_tells_nothing_is_of_no_family_that_is_known():
    node = asked({})
    assert node.family is families.GENERIC and not node.confirmed and node.off_time_ms is None
    assert repr(node) == "<USS drive Layout(4, 2)>" and node.zsw == 0


def test_the_family_is_told_by_the_parameters_that_only_it_has():
    """Four words of parameters and so many process data; with how much time it trips."""
    mm4 = {(2013, 0): 4, (2012, 0): 2, (2014, 0): 1500}
    for values, net_count, family, off_time_ms in (
        (mm4 | {(2009, 0): 0}, 12, families.MM4, 1500),
        (mm4 | {(2009, 0): 1, (2012, 0): 6}, 20, families.MM440, 1500),
        (mm4 | {(2023, 0): 1}, 12, families.V20, 1500),
        (mm4, 12, families.G110, 1500),
        (mm4 | {(2013, 0): 3, (2012, 0): 3, (2009, 0): 0}, 12, families.MM4, 1500),
        (MM4 | {(2013, 0): 3}, 12, families.on_bop(families.MM4), 700),
        (mm4 | {(2012, 0): 14}, 36, families.GENERIC, 1500),
        ({(2023, 0): 4, (2022, 0): 2, (2040, 0): 100}, 12, families.G120, 100),
        ({(93, 0): 2}, 10, families.MM3, 2000),
        ({(93, 0): 0}, 10, families.MM3, 0),
    ):
        node = asked(values, net_count)
        assert node.family is family and node.confirmed, (values, node)
        assert node.off_time_ms == off_time_ms and node.layout.net_count == net_count, node
        if node.family is families.MM4:
            told = node.layout.pkw_words, node.layout.pzd_words
            assert told == (values[2013, 0], values[2012, 0]), node


def test_a_drive_without_a_parameter_channel_has_process_data_alone():
    node = Node(ADDRESS, FOUR_AND_TWO.net_count, False)
    questions = enquiry(node)
    layout, number, _ = next(questions)
    asked_in = [layout]
    while number is not None:
        layout, number, _ = questions.send(NO_CHANNEL)
        if layout is not asked_in[-1]:
            asked_in.append(layout)
    assert [repr(one) for one in asked_in] == ["Layout(4, 2)", "Layout(3, 3)", "Layout(0, 6)"]
    assert node.layout is layout and not node.confirmed and node.family is families.GENERIC


def test_one_that_tells_nothing_has_the_first_layout_in_which_it_has_a_parameter_channel():
    """The last telegram without a task stops it in that; if there is none, in PZD words alone."""
    for net_count, variable, with_channel, words in (
        (12, False, {(4, 2), (3, 3)}, (4, 2)), (12, False, {(3, 3)}, (3, 3)),
        (12, False, {(4, 2)}, (4, 2)), (12, False, set(), (0, 6)), (4, False, set(), (0, 2)),
        (34, False, {(3, 14)}, (3, 14)), (34, False, set(), (4, 13)),
        (10, True, {(VARIABLE, 2), (VARIABLE, 3)}, (VARIABLE, 2)),
        (10, True, {(VARIABLE, 16), (VARIABLE, 3)}, (VARIABLE, 3)),
    ):  # fmt: skip
        node = Node(ADDRESS, net_count, variable)
        questions = enquiry(node)
        layout, number, _ = next(questions)
        while number is not None:
            has_channel = (layout.pkw_words, layout.pzd_words) in with_channel
            layout, number, _ = questions.send(None if has_channel else NO_CHANNEL)
        assert (layout.pkw_words, layout.pzd_words) == words, (net_count, with_channel, layout)
        assert node.layout is layout and not node.confirmed
        assert refused_to_go_on(questions)


def refused_to_go_on(questions):
    try:
        questions.send(None)
    except StopIteration:
        return True
    return False


def test_one_that_does_not_tell_when_it_trips_is_known_all_the_same():
    for told in (None, NO_CHANNEL):
        for number, values in ((2014, {(2013, 0): 4, (2012, 0): 2, (2009, 0): 0}),
                               (2040, {(2023, 0): 4, (2022, 0): 2})):  # fmt: skip
            node = asked(values | {(number, 0): told})
            assert node.confirmed and node.off_time_ms is None, (told, number)
            assert node.family is (families.MM4 if number == 2014 else families.G120)


def test_whoever_wants_the_layout_alone_asks_for_nothing_else():
    enquirer = Enquirer(ADDRESS, 16, False, False)
    for number, value in ((2013, 4), (2012, 4)):
        question = enquirer.question()
        assert (question.job.number, question.job.index) == (number, 0)
        net = bytes((0x10, number - 2000, 0x80, 0, 0, 0, 0, value)) + b"\xfb\x31" + bytes(6)
        question.take(bytearray(framed(ADDRESS, net)), len(net) + 4, 0)
        is_over = enquirer.take(question)
        assert question.state == DONE and is_over == (number == 2012)
    node = enquirer.node
    assert repr(node.layout) == "Layout(4, 4)" and node.confirmed and node.zsw == 0xFB31
    assert node.family is families.GENERIC and node.off_time_ms is None
    node = asked(MM4 | {(2013, 0): 3, (2012, 0): 3, (2013, 1): 3}, everything=False)
    assert repr(node.layout) == "Layout(3, 3)" and node.confirmed and node.off_time_ms is None


def test_whoever_does_not_say_what_he_wants_learns_everything():
    """The layout, which link it is on, the family, and when it trips, in this order."""
    values = MM4 | {(2013, 1): 3}
    enquirer = Enquirer(ADDRESS, FOUR_AND_TWO.net_count, False)
    asked_for, is_over = [], False
    while not is_over:
        question = enquirer.question()
        number, index = question.job.number, question.job.index
        asked_for.append((number, index))
        value = values[number, index]
        net = bytes((0x10, number - 2000, 0x80, index, 0, 0, value >> 8, value & 0xFF))
        question.take(bytearray(framed(ADDRESS, net + b"\xfb\x31\x00\x00")), 16, 0)
        is_over = enquirer.take(question)
    assert asked_for == [(2013, 0), (2012, 0), (2013, 1), (2009, 0), (2014, 0)]
    node = enquirer.node
    assert node.family is families.MM4 and node.off_time_ms == 1500 and node.confirmed
    node = Node(ADDRESS, FOUR_AND_TWO.net_count, False)
    questions, numbers = enquiry(node), []
    try:
        _, number, index = next(questions)
        while True:
            numbers.append((number, index))
            _, number, index = questions.send(values[number, index])
    except StopIteration:
        assert numbers == asked_for and node.family is families.MM4


def test_what_is_not_known_yet_is_taken_for_the_most_usual_layout_of_its_length():
    for net_count, variable, words in (
        (4, False, (0, 2)), (12, False, (4, 2)), (16, False, (4, 4)), (34, False, (4, 13)),
        (10, True, (VARIABLE, 2)),
    ):  # fmt: skip
        node = Node(ADDRESS, net_count, variable)
        assert (node.layout.pkw_words, node.layout.pzd_words) == words, net_count
        assert (node.address, node.net_count, node.variable) == (ADDRESS, net_count, variable)
    # And it stays that where none of the layouts has a parameter channel, and none may lack it.
    node = asked(dict.fromkeys([(number, 0) for number in range(4000)], NO_CHANNEL), 34)
    assert repr(node.layout) == "Layout(4, 13)" and not node.confirmed


def test_a_question_is_an_ordinary_telegram_with_off1_or_with_the_off_that_is_owed():
    """Its task stands in front as in any other telegram, the control word where its layout says,
    and all else is 0."""
    off2 = 0x047D
    for layout, number, index, net in (
        (FOUR_AND_TWO, 2013, 0, b"\x10\x0d\x80\x00\x00\x00\x00\x00STW\x00\x00"),
        (Layout(4, 1), 700, 1, b"\x12\xbc\x00\x01\x00\x00\x00\x00STW"),
        (Layout(3, 3), 93, 0, b"\x10\x5d\x00\x00\x00\x00STW\x00\x00\x00\x00"),
        (Layout(VARIABLE, 2), 2012, 1, b"\x10\x0c\x80\x01\x00\x00STW\x00\x00"),
        (Layout(4, 0), 2013, 0, b"\x10\x0d\x80\x00\x00\x00\x00\x00"),
        (FOUR_AND_TWO, None, 0, bytes(8) + b"STW\x00\x00"),
        (Layout(0, 2), None, 0, b"STW\x00\x00"),
    ):
        for off, stw in (((), b"\x04\x7e"), ((off2,), b"\x04\x7d")):
            question = Question(ADDRESS, layout, number, index, *off)
            assert question.request == framed(ADDRESS, net.replace(b"STW", stw)), (layout, off)
            assert question.address == ADDRESS and question.size == len(question.request)
    enquirer = Enquirer(ADDRESS, FOUR_AND_TWO.net_count, False)
    for off, stw in (((), b"\x04\x7e"), ((off2,), b"\x04\x7d")):
        assert enquirer.question(*off).request[11:13] == stw


def test_the_answer_to_a_question_says_its_value_and_the_status():
    for layout, number, net, value in (
        (FOUR_AND_TWO, 2013, b"\x10\x0d\x80\x00\x00\x00\x00\x03\xfb\x31\x00\x00", 3),
        (Layout(VARIABLE, 2), 2013, b"\x10\x0d\x80\x00\x00\x03\xfb\x31\x00\x00", 3),
        (Layout(127, 2), 2013, b"\x20\x0d\x80\x00\x00\x01\x00\x03\xfb\x31\x00\x00", 65539),
        (Layout(0, 2), None, b"\xfb\x31\x00\x00", None),
    ):
        question = Question(ADDRESS, layout, number)
        assert question.fits(len(net)) and not question.fits(len(net) - 1)
        assert not question.may_reply_alike() and question.zsw == 0
        question.miss(SILENT, 0, 0, 0)
        question.take(bytearray(framed(ADDRESS, net)), len(net) + 4, 0)
        assert question.state == DONE and question.finding == GOOD, net
        assert question.value() == value and question.zsw == 0xFB31, net
    assert Question(ADDRESS, Layout(4, 0), 2013).may_reply_alike()


def test_where_a_status_word_stands_there_is_no_parameter_channel():
    """An AK above 8, or bit 11 of ZSW."""
    for first, value in (
        (0x9000, NO_CHANNEL), (0xF331, NO_CHANNEL), (0x0B31, NO_CHANNEL), (0xFB31, NO_CHANNEL),
        (0x8000, None), (0x8700, None), (0x0000, None),
    ):  # fmt: skip
        question = Question(ADDRESS, FOUR_AND_TWO, 2013)
        net = bytes((first >> 8, first & 0xFF)) + bytes(10)
        question.take(bytearray(framed(ADDRESS, net)), 16, 0)
        assert question.state == TIMED_OUT and question.value() == value, hex(first)
