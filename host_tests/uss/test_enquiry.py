# SPDX-License-Identifier: MIT
"""What a drive is: by the parameters that it has, and by what they tell."""

from uss import families
from uss.finding.enquiry import Node, enquiry
from uss.layout import Layout

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
