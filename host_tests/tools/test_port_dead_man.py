# SPDX-License-Identifier: MIT
"""Data sheet of what stops the drives of a panel that hangs or has died. Times are in seconds."""

from tools.port.dead_man import ROUNDS, DeadMan, off1, telegrams

INTERPRETERS = "host"

HSW = b"\x0c\xcd"


def telegram(address, stw, task=bytes(8)):
    characters = b"\x02\x0e" + bytes((address,)) + task + stw.to_bytes(2, "big") + HSW
    bcc = 0
    for character in characters:
        bcc ^= character
    return characters + bytes((bcc,))


STOP, RUN, REVERSE, JOG = 0x047E, 0x047F, 0x0C7F, 0x057E
EXCHANGE_S = 2 * 16 * 11 / 19200
HUNG_S = 1.0 + EXCHANGE_S


def sent(dead_man, from_s, to_s):
    """What it says in that time: [(when, telegram)]."""
    found = []
    for now_s in (from_s + i / 1000 for i in range(int((to_s - from_s) * 1000))):
        due = dead_man.due(now_s)
        if due:
            found.append((now_s, due))
    return found


def test_a_panel_that_talks_is_left_alone():
    dead_man = DeadMan(19200)
    for turn in range(20):
        dead_man.heard(telegram(1, RUN), turn / 2)
        assert sent(dead_man, turn / 2, turn / 2 + 0.5) == []
    assert dead_man.stopped == set()


def test_one_that_falls_silent_has_its_drives_stopped_and_no_others():
    dead_man = DeadMan(19200)
    for address, stw in ((1, RUN), (2, STOP), (3, REVERSE), (4, JOG), (5, RUN), (5, STOP)):
        dead_man.heard(telegram(address, stw), 10.0)
    said = sent(dead_man, 10.0, 20.0)
    assert said[0][0] >= 10.0 + HUNG_S
    stopping = [telegram(1, STOP), telegram(3, 0x0C7E), telegram(4, STOP)]
    assert [one for _, one in said] == ROUNDS * stopping
    assert min(b[0] - a[0] for a, b in zip(said, said[1:])) > EXCHANGE_S
    assert dead_man.stopped == {1, 3, 4}


def test_what_the_panel_wrote_is_not_written_again():
    write = telegram(1, RUN, b"\x24\x4e\x00\x00\x00\x00\x00\x05")
    assert off1(write) == telegram(1, STOP)


def test_a_panel_that_comes_back_is_trusted_again():
    dead_man = DeadMan(19200)
    dead_man.heard(telegram(1, RUN), 0.0)
    assert len(sent(dead_man, 0.0, HUNG_S + 0.01)) == 1
    dead_man.heard(telegram(1, STOP), HUNG_S + 0.02)
    assert sent(dead_man, HUNG_S + 0.02, 10.0) == []


def test_one_that_comes_back_in_the_middle_of_an_on_starts_nothing():
    dead_man = DeadMan(19200)
    assert dead_man.heard(telegram(1, RUN), 0.0)
    assert len(sent(dead_man, 0.0, 5.0)) == ROUNDS
    for stw in (RUN, REVERSE, JOG):
        assert not dead_man.heard(telegram(1, stw), 5.0)
    assert dead_man.heard(telegram(2, RUN), 5.0), "that one was not stopped here"
    assert dead_man.heard(telegram(1, STOP), 5.1)
    assert dead_man.heard(telegram(1, RUN), 5.2)


def test_a_drive_that_it_does_not_talk_to_is_owed_its_off1_still():
    dead_man = DeadMan(19200)
    dead_man.heard(telegram(1, RUN), 0.0)
    dead_man.heard(telegram(2, RUN), 0.0)
    assert [one for _, one in sent(dead_man, 0.0, HUNG_S + 0.01)] == [telegram(1, STOP)]
    dead_man.heard(telegram(1, RUN), HUNG_S + 0.02)  # it goes on, and hangs again at once
    rest = [one for _, one in sent(dead_man, HUNG_S + 0.02, 10.0)]
    assert rest.count(telegram(2, STOP)) == ROUNDS


def test_one_that_has_ended_owes_no_patience():
    dead_man = DeadMan(19200)
    dead_man.heard(telegram(1, RUN), 0.0)
    assert not dead_man.is_done()
    dead_man.over(0.1)
    assert len(sent(dead_man, 0.1, 0.9)) == ROUNDS and dead_man.is_done()


def test_one_that_ended_as_it_should_leaves_nothing_to_do():
    dead_man = DeadMan(19200)
    dead_man.heard(telegram(1, RUN) + telegram(1, STOP), 0.0)
    assert dead_man.is_done() and dead_man.wait_s(0.0, 7.0) == 7.0


def test_characters_are_divided_into_telegrams():
    run, stop = telegram(1, RUN), telegram(2, STOP)
    assert telegrams(run + stop) == [run, stop]
    assert telegrams(run[:5]) == [run[:5]]
    assert telegrams(b"\x55" + run) == [b"\x55" + run]
    assert telegrams(b"") == []
