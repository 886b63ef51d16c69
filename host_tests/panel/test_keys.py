# SPDX-License-Identifier: MIT
"""Keys: debounced, repeated, and deaf to what was down when the panel was switched on."""

from boards.sim.board import KEYS
from panel.keys import NAMES as ALL
from panel.keys import Acts, Keys, unknown

NAMES = ("START", "STOP", "UP")
START, STOP, UP = 1, 2, 4
MASK = (1 << 30) - 1


class Hand:
    """Holds keys down and counts what the panel makes of it, a millisecond at a time."""

    def __init__(self, at_ms=0, down=0):
        self.keys = Keys(NAMES, MASK)
        self.at_ms = at_ms
        self.pressed = []
        self.repeated = []
        self.hold(down, 100 if not down else 1)

    def hold(self, raw, ms):
        for _ in range(ms):
            self.keys.update(raw, self.at_ms & MASK)
            if self.keys.pressed:
                self.pressed.append((self.at_ms, self.keys.pressed))
            if self.keys.repeated:
                self.repeated.append((self.at_ms, self.keys.repeated))
            self.at_ms += 1
        return self


def test_keys_have_the_bits_of_their_names():
    keys = Keys(NAMES, MASK)
    assert (keys.bit("START"), keys.bit("STOP"), keys.bit("UP")) == (START, STOP, UP)
    assert keys.bit("JOG_LEFT") == 0  # not on this board


def test_the_names_of_keys_are_those_of_one_table():
    assert set(KEYS) == set(ALL) and not unknown(ALL)
    assert unknown(("STOP", "ADRESS_UP")) == ["ADRESS_UP"]


def test_a_key_counts_after_twenty_milliseconds_and_once():
    hand = Hand()
    hand.hold(START, 100).hold(0, 100)
    assert hand.pressed == [(120, START)]
    assert hand.keys.down == 0


def test_a_contact_that_bounces_counts_once_it_is_still():
    hand = Hand()
    for _ in range(10):
        hand.hold(START, 5).hold(0, 5)
    assert hand.pressed == []
    hand.hold(START, 300)
    assert hand.pressed == [(220, START)]


def test_a_spike_is_no_key():
    hand = Hand()
    hand.hold(START, 19).hold(0, 100).hold(STOP, 1).hold(0, 100)
    assert hand.pressed == []


def test_stop_counts_at_the_second_reading_and_is_let_go_after_twenty_milliseconds():
    hand = Hand()
    hand.hold(STOP, 3).hold(0, 19)
    assert hand.pressed == [(101, STOP)] and hand.keys.down == STOP
    hand.hold(0, 2)
    assert hand.keys.down == 0


def test_a_stop_that_chatters_counts_once():
    hand = Hand()
    for _ in range(100):
        hand.hold(STOP, 14).hold(0, 6)
    assert hand.pressed == [(101, STOP)]


def test_a_stop_is_not_lost_to_a_loop_that_is_slow():
    """One step of the loop takes 23 ms of a tap of 40."""
    keys = Keys(NAMES, MASK)
    pressed = 0
    for now_ms, raw in ((0, 0), (50, 0), (100, 0), (123, STOP), (125, STOP), (141, 0), (170, 0)):
        keys.update(raw, now_ms)
        pressed |= keys.pressed
    assert pressed == STOP


def test_one_bad_contact_does_not_make_the_others_deaf():
    """START chatters all the time; STOP is heard all the same."""
    hand = Hand()
    for step in range(100):
        hand.hold(STOP | (START if step & 1 else 0), 3)
    assert hand.pressed == [(101, STOP)]


def test_a_key_down_at_power_on_does_not_count_before_it_was_up():
    hand = Hand(down=START)
    hand.hold(START, 3000)
    assert hand.pressed == [] and hand.repeated == []
    hand.hold(0, 50).hold(START, 50)
    assert [bit for _, bit in hand.pressed] == [START]


def test_a_held_key_repeats_after_400_ms_and_then_every_120():
    hand = Hand()
    hand.hold(UP, 900)
    at = hand.pressed[0][0]
    assert [when - at for when, _ in hand.repeated] == [400, 520, 640, 760]
    hand.hold(0, 100)
    assert hand.keys.repeated == 0
    hand.hold(UP, 100)
    assert hand.keys.repeats == 0


def test_a_key_is_held_once_with_its_first_repeat_after_a_second():
    for delay_ms, repeat_ms in ((400, 120), (200, 50), (300, 300), (900, 60), (500, 500)):
        hand = Hand()
        hand.keys.pace(delay_ms, repeat_ms)
        acts = Acts(hand.keys)
        held = []
        for _ in range(3_000):
            hand.hold(UP, 1)
            acts.note()
            if acts.is_held(UP):
                held.append(hand.repeated[-1][0] - hand.pressed[0][0])
            assert not acts.is_held(START)
        (at_ms,) = held
        assert 1_000 <= at_ms < 1_000 + repeat_ms, (delay_ms, repeat_ms, at_ms)


def test_the_key_pressed_last_is_the_one_that_repeats():
    hand = Hand()
    hand.hold(UP, 200).hold(UP | STOP, 500)
    assert [bit for _, bit in hand.repeated] == [STOP]
    hand.hold(UP, 1000)
    assert [bit for _, bit in hand.repeated] == [STOP]


def test_keys_pressed_in_the_same_moment_all_count():
    hand = Hand()
    hand.hold(START | UP, 50)
    assert hand.pressed == [(120, START | UP)]


def test_the_clock_may_wrap_while_a_key_is_down():
    hand = Hand(at_ms=MASK - 350)
    hand.hold(UP, 900)
    assert [when - hand.pressed[0][0] for when, _ in hand.repeated] == [400, 520, 640, 760]


def test_a_key_that_could_not_be_told_for_a_moment_must_be_seen_up_before_it_counts_again():
    """In a matrix a third key may make all of them ambiguous: that is no letting go."""
    keys = Keys(("STOP", "JOG_RIGHT", "UP"), MASK)
    jog = keys.bit("JOG_RIGHT")
    unclear = jog | keys.bit("UP")
    for now_ms in range(0, 100, 2):
        keys.update(0, now_ms)
    for now_ms in range(100, 200, 2):
        keys.update(jog, now_ms)
    assert keys.down == jog
    for now_ms in range(200, 300, 2):
        keys.update(0, now_ms, unclear)
        assert keys.down == 0
    for now_ms in range(300, 800, 2):
        keys.update(jog, now_ms)
        assert not keys.pressed and not keys.repeated
    assert keys.down == jog
    for now_ms in range(800, 900, 2):
        keys.update(0, now_ms)
    pressed = 0
    for now_ms in range(900, 1000, 2):
        keys.update(jog, now_ms)
        pressed |= keys.pressed
    assert pressed == jog


def test_a_key_that_cannot_be_told_repeats_nothing():
    """The others do, whatever cannot be told of this one."""
    for unclear, repeats in ((UP, 0), (STOP, 3), (UP | STOP, 0)):
        hand = Hand().hold(UP, 538)  # two milliseconds before it repeats again
        assert len(hand.repeated) == 1
        repeated = []
        for _ in range(300):
            hand.keys.update(UP, hand.at_ms, unclear)
            assert hand.keys.down == UP & ~unclear
            repeated += [hand.keys.repeated] if hand.keys.repeated else []
            hand.at_ms += 1
        assert repeated == [UP] * repeats, (unclear, repeated)


def test_a_key_that_is_withheld_repeats_nothing_any_more_and_the_others_do():
    for withheld, repeats in ((UP, False), (~STOP, False), (START | STOP, True), (~UP, True)):
        hand = Hand()
        while not hand.keys.repeated:
            hand.hold(UP, 1)
        hand.keys.withhold(withheld)
        assert hand.keys.repeated == (UP if repeats else 0), withheld
        hand.hold(UP, 500)
        assert (len(hand.repeated) > 1) == repeats, (withheld, hand.repeated)


def test_of_keys_that_were_pressed_together_only_those_are_withheld_that_are_meant():
    hand = Hand()
    while not hand.keys.pressed:
        hand.hold(START | UP, 1)
    hand.keys.withhold(~UP)
    assert hand.keys.pressed == UP


def test_keys_at_rest_are_all_up_and_were_all_seen_up():
    hand = Hand()
    assert hand.keys.at_rest
    hand.hold(START, 5)
    assert not hand.keys.at_rest  # it may bounce
    hand.hold(START, 100)
    assert not hand.keys.at_rest
    hand.hold(0, 19)
    assert not hand.keys.at_rest
    hand.hold(0, 10)
    assert hand.keys.at_rest
    jammed = Hand(down=UP).hold(UP, 100)
    assert not jammed.keys.at_rest


def test_before_the_first_reading_nothing_is_known_of_any_key():
    keys = Keys(NAMES, MASK)
    acts = Acts(keys)
    for seen in (keys, acts):
        assert (seen.pressed, seen.repeated, seen.repeats) == (0, 0, 0)
    assert not keys.at_rest and keys.unsettled == START | STOP | UP
    assert (keys.down, keys.shift) == (0, 0)


def test_the_first_reading_is_no_change_and_up_is_what_was_so_for_20_ms():
    """Whenever that is by the clock. A STOP that is down then is down at once."""
    keys = Keys(NAMES, MASK)
    keys.update(STOP | UP, 5_000)
    assert keys.down == STOP and not keys.pressed
    keys = Keys(NAMES, MASK)
    rests = []
    for now_ms in range(5_000, 5_025):
        keys.update(0, now_ms)
        rests.append(keys.at_rest)
    assert rests == [False] * 21 + [True] * 4, rests


def test_there_is_something_to_do_when_a_key_goes_down_or_repeats_and_while_one_is_held():
    for key, does in (
        (START, [121, 521]),
        (UP, list(range(121, 551))),  # until it has gone up, and then once more
    ):
        keys = Keys(NAMES, MASK, held=("UP",))
        told = [ms for ms in range(600) if keys.update(key if 101 <= ms < 530 else 0, ms)]
        assert told == does, (key, told)


def test_what_was_pressed_can_be_taken_up_later():
    hand = Hand().hold(UP, 21)
    acts = Acts(hand.keys)
    acts.note()
    hand.hold(UP, 10)
    assert hand.keys.pressed == 0 and acts.pressed == UP
    assert acts.direction("UP", "START") == 1 and acts.direction("START", "UP") == -1
    assert acts.has("UP") and not acts.has("START") and acts.pace() == 1
    hand.hold(UP, 400 + 8 * 120 - 10)
    acts.note()
    assert acts.pressed == 0 and acts.repeated == UP and acts.repeats == 9
    assert acts.pace() == 10 and acts.pace(1) == 1


def test_a_key_that_repeats_goes_its_own_way_alone():
    hand = Hand()
    while not hand.keys.repeated:
        hand.hold(START, 1)
    acts = Acts(hand.keys)
    ways = [acts.direction(*keys) for keys in (("START", "UP"), ("UP", "START"), ("UP", "STOP"))]
    assert ways == [1, -1, 0], ways
    hand.keys.forget()  # and it has to be pressed anew
    seen = len(hand.repeated)
    hand.hold(START, 500)
    assert len(hand.repeated) == seen, hand.repeated


def test_a_value_moves_the_faster_the_longer_its_key_is_held_up_to_the_pace_that_it_bears():
    hand = Hand().hold(UP, 21)
    acts = Acts(hand.keys)
    paces = []
    for repeats in range(20):
        acts.note()
        assert acts.repeats == repeats and (acts.repeated == UP) == (repeats > 0)
        paces.append((acts.pace(1), acts.pace(), acts.pace(100)))
        hand.hold(UP, 120 if repeats else 400)
    assert paces == [(1, 1, 1)] * 9 + [(1, 10, 10)] * 8 + [(1, 10, 100)] * 3, paces
