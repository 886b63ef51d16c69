# SPDX-License-Identifier: MIT
"""What a drive is told and when: ON either way, JOG, OFF1, OFF2, OFF3, the acknowledgement.

Control words as in USS.md 4.8 of the protocol notes: r0054 of a MICROMASTER 4.
"""

from master_bench import Bus
from uss import bits, pzd
from uss.drive import Drive

READY, RUNNING, FAULT = 0xFB31, 0xFB34, 0xFB78
EXCHANGE_US = 30_000  # with room: 16 characters each way at 19200


def ready():
    """A bus in contact with its drive."""
    bus = Bus()
    bus.run(200_000)
    assert bus.drives[0].contact
    return bus


def new_stws(bus, us=EXCHANGE_US):
    """The control words sent while `us` microseconds pass."""
    since = len(bus.sent)
    bus.run(us)
    return bus.stws(1, since)


def test_the_whole_words_are_those_of_the_manual():
    words = (
        (pzd.OFF1, ("NO_OFF2", "NO_OFF3", "PULSES", "RAMP_OUTPUT", "RAMP_RUN", "SETPOINT")),
        (pzd.OFF2, ("NO_OFF3", "PULSES", "RAMP_OUTPUT", "RAMP_RUN", "SETPOINT")),
        (pzd.OFF3, ("NO_OFF2", "PULSES", "RAMP_OUTPUT", "RAMP_RUN", "SETPOINT")),
    )
    names = {name: 1 << bit for bit, name, _ in bits.STW_BITS}
    for word, set_bits in words:
        assert word == sum([names[name] for name in set_bits]) + names["CONTROL"], hex(word)
    assert pzd.ON == pzd.OFF1 | names["ON"]
    assert pzd.ON_REVERSE == pzd.ON | names["REVERSE"] == 0x0C7F
    assert pzd.JOG_RIGHT == pzd.OFF1 | names["JOG_RIGHT"] == 0x057E
    assert pzd.JOG_LEFT == pzd.OFF1 | names["JOG_LEFT"] == 0x067E
    assert pzd.STW_RUN == names["ON"] | names["JOG_RIGHT"] | names["JOG_LEFT"]


def test_on_goes_either_way_and_turns_without_a_new_start():
    bus = ready()
    drive = bus.drives[0]
    drive.start(0x0CCD, pzd.ON_REVERSE)
    assert set(new_stws(bus)) == {0x0C7F}
    drive.turn(pzd.ON)
    assert set(new_stws(bus)) == {0x047F}
    drive.stop()
    assert set(new_stws(bus)) == {0x047E}
    drive.turn(pzd.ON_REVERSE)  # a drive that stands is not started by it
    assert set(new_stws(bus)) == {0x047E}


def test_turning_does_not_revive_what_was_taken_back():
    bus = ready()
    drive = bus.drives[0]
    drive.start(0x0CCD)
    bus.run(EXCHANGE_US)
    bus.run(400_000, refresh=False)  # the loop hangs: the dead man takes ON back
    drive.turn(pzd.ON_REVERSE)
    assert set(new_stws(bus)) == {0x047E}


def test_a_jog_carries_no_setpoint_and_ends_in_the_next_telegram():
    bus = ready()
    drive = bus.drives[0]
    for word in (pzd.JOG_RIGHT, pzd.JOG_LEFT):
        drive.start(0x0CCD, word)
        since = len(bus.sent)
        assert set(new_stws(bus)) == {word}
        for _, characters in bus.sent[since:]:
            assert characters[13:15] == b"\x00\x00"
        drive.stop()
        assert set(new_stws(bus)) == {0x047E}


def test_a_jog_is_taken_back_like_on_when_the_loop_hangs_or_the_line_fails():
    bus = ready()
    drive = bus.drives[0]
    drive.start(0, pzd.JOG_LEFT)
    bus.run(EXCHANGE_US)
    bus.run(400_000, refresh=False)
    assert drive.stopped_by_engine() and set(new_stws(bus)) == {0x047E}
    drive.start(0, pzd.JOG_LEFT)
    bus.run(EXCHANGE_US)
    bus.silent.add(1)
    bus.run(1_500_000)
    bus.silent.remove(1)
    bus.run(100_000)
    assert drive.contact and set(new_stws(bus)) == {0x047E}


def test_the_release_of_a_jog_is_repeated_until_it_is_answered():
    bus = Bus(addresses=tuple(range(8)))
    bus.run(1_000_000)
    drive = bus.drives[1]
    drive.start(0, pzd.JOG_RIGHT)
    bus.run(100_000)
    bus.silent.add(1)
    since = len(bus.sent)
    drive.stop()
    bus.run(300_000)
    assert bus.addresses(since)[:6].count(1) >= 3  # every second telegram is its, not every eighth
    assert set(bus.stws(1, since + 1)) == {0x047E}


def test_a_second_stop_stays_until_off1_is_asked_for():
    bus = ready()
    drive = bus.drives[0]
    for word in (pzd.OFF2, pzd.OFF3):
        drive.start(0x0CCD)
        bus.run(EXCHANGE_US)
        drive.stop(word)
        assert set(new_stws(bus, 2 * EXCHANGE_US)) == {word}
        assert drive.answered_stw == word
        assert set(new_stws(bus, 200_000)) == {word}
        drive.stop()
        assert set(new_stws(bus)) == {0x047E}


def test_the_dead_man_does_not_weaken_a_second_stop():
    bus = ready()
    drive = bus.drives[0]
    drive.stop(pzd.OFF3)
    since = len(bus.sent)
    bus.run(1_000_000, refresh=False)
    assert set(bus.stws(1, since)) == {0x047A}


def test_an_acknowledgement_is_one_edge_of_bit_7():
    bus = ready()
    drive = bus.drives[0]
    bus.zsw[1] = FAULT
    bus.run(EXCHANGE_US)
    drive.acknowledge()
    words = new_stws(bus, 300_000)
    assert words.count(0x04FE) == 1 and words[0] == 0x04FE, words
    assert set(words[1:]) == {0x047E}


def test_an_acknowledgement_is_repeated_until_a_reply_confirms_it():
    bus = ready()
    drive = bus.drives[0]
    drive.acknowledge()
    bus.silent.add(1)
    words = new_stws(bus, 300_000)
    assert set(words) == {0x04FE} and len(words) > 3
    bus.silent.remove(1)
    bus.run(EXCHANGE_US)
    assert set(new_stws(bus)) == {0x047E}


def test_two_acknowledgements_are_two_edges():
    bus = ready()
    drive = bus.drives[0]
    drive.acknowledge()
    while drive.acknowledged != drive.acknowledgements:
        bus.run(1_000)
    drive.acknowledge()
    words = new_stws(bus, 300_000)
    assert words[0] == 0x047E or words[1] == 0x047E  # bit 7 must fall before it can rise
    assert words.count(0x04FE) == 1, words


def test_an_acknowledgement_never_goes_with_on_and_never_comes_late():
    bus = ready()
    drive = bus.drives[0]
    drive.acknowledge()
    drive.start(0x0CCD)
    assert set(new_stws(bus)) <= {0x047F, 0x047E}
    drive.stop()
    assert set(new_stws(bus, 100_000)) == {0x047E}
    bus.silent.add(1)
    drive.acknowledge()
    bus.run(1_500_000)
    assert not drive.contact
    bus.silent.remove(1)
    assert set(new_stws(bus, 200_000)) == {0x047E}


def test_a_drive_follows_to_another_address():
    bus = Bus(addresses=(1, 2))
    bus.zsw[5] = READY
    bus.pkw[5] = None
    bus.run(300_000)
    bus.master.turns.readdress(bus.drives[0], 5)
    bus.silent.add(1)
    since = len(bus.sent)
    bus.run(300_000)
    assert set(bus.addresses(since + 1)) == {2, 5} and bus.drives[0].silent == 0
    for address in (2, 32, -1):
        try:
            bus.master.turns.readdress(bus.drives[0], address)
        except ValueError:
            continue
        raise AssertionError(address)


def test_the_longest_round_counts_every_drive_of_the_list():
    one, four = Bus(), Bus(addresses=(1, 2, 3, 4))
    four.master.turns.add(4)
    longest_us = one.master.turns.longest_cycle_us()
    assert four.master.turns.longest_cycle_us() == 5 * longest_us > 5 * EXCHANGE_US


def test_a_second_acknowledgement_has_an_edge_of_its_own():
    """It is wanted in the very moment in which the first one was confirmed."""
    drive, reply = Drive(1, 0x3FFFFFFF), bytearray(16)
    words = []
    for _ in range(4):
        if len(words) in (0, 1):
            drive.acknowledge()
        drive.fill(0)
        words.append(drive.request[11] << 8 | drive.request[12])
        drive.take(reply, 16, 0)
    assert words == [0x04FE, 0x047E, 0x04FE, 0x047E]
