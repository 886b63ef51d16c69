# SPDX-License-Identifier: MIT
"""What a drive is: by the parameters that it has, and by what they tell."""

from uss import families
from uss.finding.enquiry import SILENCES, TRIES, Enquirer, Node, enquiry
from uss.layout import Layout
from uss.outside import DONE, TIMED_OUT
from uss.receiver import SILENT
from uss.telegram import GOOD

ADDRESS = 7
FOUR_AND_TWO = Layout(4, 2)

# A MICROMASTER 4 whose links are both set to 4 PKW and 2 PZD words: P2012, P2013, P2014, P2009.
MM4 = {
    (2013, 0): 4, (2013, 1): 4, (2012, 0): 2, (2012, 1): 2, (2014, 0): 1500, (2014, 1): 700,
    (2009, 0): 0,
}  # fmt: skip


def asked(values):
    """What is known of a node with 12 net characters whose parameters have these values."""
    node = Node(ADDRESS, FOUR_AND_TWO.net_count, False)
    questions = enquiry(node)
    value = None
    try:
        while True:
            _, number, index = questions.send(value)
            assert index in (0, 1), "no drive has a third link"
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
    for finding, times in ((SILENT, SILENCES), (GOOD, TRIES)):
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
