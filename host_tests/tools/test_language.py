# SPDX-License-Identifier: MIT
"""The language between a running panel and what shows it: tools/live/README.md."""

import json

from boards.sim.dice import Dice
from conversation_bench import Talk
from tools.live.holds import stop_all
from tools.live.language import FROM_PANEL, LINE_MAX, TO_PANEL, Misunderstood, spoken, understood

INTERPRETERS = "unix64 unix32 cpython"

JOG_ENDS_MS = 400


def refused(line):
    try:
        understood(line)
    except Misunderstood as error:
        return str(error)
    raise AssertionError(line)


# --- what is a message --------------------------------------------------------------------------


def test_a_message_has_an_id_even_if_nobody_said_one():
    assert understood('{"t":"down","key":"STOP"}')["id"] == 0
    assert understood('{"t":"down","key":"STOP","id":7}')["id"] == 7


def test_what_is_no_message_is_refused_and_it_says_why():
    assert "JSON" in refused("down STOP") and "JSON" in refused("") and "JSON" in refused("\x00")
    assert "object" in refused("[1]") and "object" in refused("7")
    assert "no message of this kind" in refused('{"t":"dance"}')
    assert "no message of this kind" in refused('{"t":["down"]}')
    assert "down wants key" in refused('{"t":"down"}')
    assert "down wants key" in refused('{"t":"down","key":7}')
    assert "do wants n" in refused('{"t":"do","n":true,"line":"lcd"}')
    assert "n is a number" in refused('{"t":"do","n":-1,"line":"lcd"}')
    assert "id is a number" in refused('{"t":"alive","id":"me"}')
    assert "id is a number" in refused('{"t":"alive","id":12345678901234567890}')
    assert "%d characters" % LINE_MAX in refused(" " * (LINE_MAX + 1))


def test_what_is_spoken_is_one_line():
    line = spoken("notice", text="two\nlines")
    assert line.count(b"\n") == 1 and json.loads(line.decode())["text"] == "two\nlines"


def test_no_line_ends_the_panel():
    """Damaged messages by the hundred: each is answered or obeyed."""
    talk = Talk()
    talk.say("hello", v=1)
    random = Dice(21).random
    good = [
        '{"t":"down","key":"START","id":3}', '{"t":"do","n":3,"line":"param 1 P1120[0] 5"}',
        '{"t":"speed","x":10}', '{"t":"hello","v":1}', '{"t":"release"}',
    ]  # fmt: skip
    for _ in range(600):
        line = list(good[random(0, len(good) - 1)])
        for _ in range(random(1, 4)):
            line[random(0, len(line) - 1)] = chr(random(1, 255))
        talk.say_line("".join(line))
    talk.say_line("[" * LINE_MAX)
    talk.say_line('{"t":"speed","x":1e400}')
    talk.say_line('{"t":"speed","x":-1}')
    talk.say("speed", x=1)
    talk.say("release", id=3)
    talk.wait(1000)
    talk.say("do", n=9, line="lcd")
    assert talk.last("done")["n"] == 9


# --- what is told -------------------------------------------------------------------------------


def test_a_front_end_is_told_everything():
    talk = Talk(addresses=(1, 2))
    talk.runs()
    assert talk.heard[0]["t"] == "hello"
    hello = talk.last("hello")
    assert hello["v"] == 1 and hello["drives"] == [1, 2] and hello["baud"] == 19200
    assert "STOP" in hello["keys"] and hello["real"] == 0 and "fault" in hello["commands"]
    lcd = talk.last("state")["lcd"]
    assert lcd["text"][1].startswith("RUNNING") and len(lcd["codes"][0]) == 32
    assert bytes(int(lcd["codes"][1][at : at + 2], 16) for at in (0, 2, 4)) == b"RUN"
    drive = talk.last("drives")["drives"][0]
    assert drive["hz"] == drive["set_hz"] == 10 and drive["amps"] > 0 and drive["fault"] is None
    assert talk.last("count")["drives"][0]["good"] > 50
    assert talk.last("broken")["text"] == ""
    telegrams = [message for message in talk.heard if message["t"] == "telegram"]
    assert [message["n"] for message in telegrams] == list(range(len(telegrams)))
    assert any("HSW   20.00 %  ON" in message["text"] for message in telegrams)


def test_every_message_has_the_fields_of_the_table():
    talk = Talk()
    talk.runs()
    talk.say("do", n=1, line="lcd")
    talk.say("nonsense")
    talk.conversation.hand.lonely = False
    talk.alive = []
    talk.wait(2600)
    kinds = set()
    for message in talk.heard:
        kinds.add(message["t"])
        assert sorted(message) == sorted(FROM_PANEL[message["t"]] + ("t",)), message
    assert kinds == set(FROM_PANEL)


def test_nothing_is_said_twice_while_nothing_changes():
    talk = Talk()
    talk.ready()
    talk.wait(3000)
    before = len(talk.heard)
    talk.wait(2000)
    kinds = [message["t"] for message in talk.heard[before:]]
    assert "drives" not in kinds and "hello" not in kinds and 7 <= kinds.count("time") <= 8, kinds


def test_a_second_hello_tells_everything_anew():
    talk = Talk()
    talk.ready()
    before = len(talk.heard)
    talk.say("hello", v=1, id=2)
    kinds = [message["t"] for message in talk.heard[before:]]
    assert kinds[:3] == ["hello", "state", "drives"], kinds


def test_another_version_is_refused():
    talk = Talk()
    talk.say("hello", v=2, id=4)
    error = talk.last("error")
    assert error["id"] == 4 and "version 1" in error["text"]
    assert not talk.conversation.hand.is_there()


def test_a_telegram_that_nobody_takes_says_why():
    talk = Talk()
    talk.ready()
    talk.say("do", n=1, line="babble 100")
    talk.wait(500)
    wrong = [one for one in talk.heard if one["t"] == "telegram" and one["wrong"]]
    assert wrong and any("no STX" in one["text"] for one in wrong), wrong


# --- commands -----------------------------------------------------------------------------------


def test_a_command_answers_what_it_prints():
    talk = Talk()
    talk.ready()
    talk.say("do", n=5, line="param 1 P1120[0]", id=3)
    done = talk.last("done")
    assert (done["n"], done["id"], done["ok"]) == (5, 3, 1) and done["out"] == ["P1120[0]=10.0"]


def test_a_command_that_fails_says_why():
    talk = Talk()
    talk.ready()
    for line, why in (("dance", "unknown command"), ("expect RUNNING", "expected RUNNING")):
        talk.say("do", n=6, line=line)
        done = talk.last("done")
        assert not done["ok"] and why in done["out"][0], done


def test_a_command_that_lets_time_pass_is_done_when_it_is_over():
    talk = Talk()
    talk.ready()
    talk.say("do", n=7, line="wait 1000")
    talk.wait(500)
    assert talk.last("done") is None and talk.last("state")["doing"]["line"] == "wait 1000"
    talk.say("do", n=8, line="wait 1")
    assert "another command" in talk.last("error")["text"] and talk.last("error")["n"] == 8
    talk.wait(600)
    assert talk.last("done")["n"] == 7 and talk.last("state")["doing"] is None


def test_release_ends_a_command_early():
    talk = Talk()
    talk.ready()
    talk.say("do", n=7, line="hold UP 60000")
    talk.wait(200)
    assert talk.down() == ["UP"]
    talk.say("release")
    talk.wait(100)
    assert talk.last("done")["ok"] == 0 and talk.down() == []


def test_time_goes_as_fast_as_it_is_told_and_stands():
    talk = Talk()
    talk.ready()
    for speed in (10, 0, 0.5):
        talk.say("speed", x=speed)
        before_us = talk.world.clock.now_us
        talk.wait(2000)
        passed_ms = (talk.world.clock.now_us - before_us) // 1000
        assert abs(passed_ms - 2000 * speed) <= 50, (speed, passed_ms)
        assert talk.last("time")["wanted"] == speed
    talk.say("speed", x=101)
    assert "0...100" in talk.last("error")["text"]


# --- keys ---------------------------------------------------------------------------------------


def test_a_short_press_is_seen():
    talk = Talk()
    talk.ready()
    talk.tap("UP")
    assert talk.down() == ["UP"]
    talk.wait(200)
    assert talk.down() == [] and talk.lcd()[0].startswith("S: 10.1")


def test_two_short_presses_are_two():
    talk = Talk()
    talk.ready()
    for _ in range(3):
        talk.tap("UP")
    talk.wait(600)
    assert talk.lcd()[0].startswith("S: 10.3")


def test_a_key_does_not_overtake_presses_of_another_one():
    """DOWN three times and SET, faster than the panel looks: it is the third DOWN that is set."""
    talk = Talk()
    talk.ready()
    downs = []
    press = talk.world.down

    def noted(key):
        downs.append((key, talk.world.clock.now_us))
        press(key)

    talk.world.down = noted
    for key in ("DOWN", "DOWN", "DOWN", "SET", "UP"):
        talk.tap(key)
    talk.wait(1500)
    assert [key for key, _ in downs] == ["DOWN", "DOWN", "DOWN", "SET", "UP"], downs
    apart = [after - before for (_, before), (_, after) in zip(downs, downs[1:])]
    assert min(apart) >= 100_000, apart
    talk.tap("UP")
    talk.tap("DOWN")
    talk.tap("STOP")
    assert downs[-1][0] == "STOP", "it waits for nobody"


def test_too_many_presses_are_left_out_and_it_says_so():
    talk = Talk()
    talk.ready()
    for _ in range(20):
        talk.tap("UP")
    assert "too fast" in talk.last("error")["text"]


def test_a_key_that_is_not_there():
    talk = Talk(keys="compact")
    talk.say("hello", v=1)
    talk.say("down", key="JOG_RIGHT", id=2)
    assert "no key JOG_RIGHT: there are START" in talk.last("error")["text"]


def test_a_jog_ends_when_its_front_end_is_not_heard_any_more():
    talk = Talk()
    talk.ready()
    talk.alive = [0, 7]
    talk.say("down", key="JOG_RIGHT", id=7)
    talk.wait(2000)
    assert talk.state() == "running"
    talk.alive = [0]
    talk.wait(JOG_ENDS_MS - 100)
    assert talk.down() == []
    talk.wait(100)
    assert talk.state() in ("stopping", "ready")


def test_a_jog_ends_when_its_front_end_says_that_it_goes():
    talk = Talk()
    talk.ready()
    talk.say("down", key="JOG_RIGHT", id=7)
    talk.say("alive", id=7)
    talk.wait(200)
    talk.say("bye", id=7)
    assert talk.down() == []


def test_a_key_is_down_while_anybody_holds_it():
    talk = Talk()
    talk.ready()
    talk.alive = [1, 2]
    talk.say("down", key="JOG_RIGHT", id=1)
    talk.say("down", key="JOG_RIGHT", id=2)
    talk.wait(500)
    talk.say("up", key="JOG_RIGHT", id=1)
    talk.wait(500)
    assert talk.down() == ["JOG_RIGHT"] and talk.state() == "running"
    talk.say("up", key="JOG_RIGHT", id=2)
    talk.wait(100)
    assert talk.down() == []


def test_stop_wins_from_any_front_end():
    talk = Talk()
    talk.ready()
    talk.alive = [1, 2]
    talk.say("down", key="JOG_RIGHT", id=1)
    talk.wait(1000)
    talk.say("down", key="STOP", id=2)
    assert talk.down() == ["STOP"]
    talk.say("down", key="START", id=1)
    assert "while STOP is held" in talk.last("error")["text"]
    talk.wait(500)
    talk.say("up", key="STOP", id=2)
    talk.wait(3000)
    assert talk.state() == "ready", "the jog does not begin anew by itself"
    talk.say("up", key="JOG_RIGHT", id=1)
    talk.say("down", key="JOG_RIGHT", id=1)
    talk.wait(500)
    assert talk.state() == "running"


def test_stop_ends_a_command_that_holds_a_key():
    talk = Talk()
    talk.ready()
    talk.say("do", n=1, line="hold JOG_RIGHT 60000")
    talk.wait(1000)
    assert talk.state() == "running"
    talk.tap("STOP")
    assert talk.last("done")["ok"] == 0
    talk.wait(3000)
    assert talk.state() == "ready"


def test_a_command_and_a_front_end_may_hold_the_same_key():
    talk = Talk()
    talk.ready()
    talk.say("down", key="JOG_RIGHT")
    talk.say("do", n=1, line="hold JOG_RIGHT 300")
    talk.wait(800)
    assert talk.last("done")["ok"] == 1 and talk.down() == ["JOG_RIGHT"]
    talk.say("up", key="JOG_RIGHT")
    talk.wait(200)
    assert talk.down() == []


def test_a_key_that_a_command_put_down_has_a_lease_too():
    talk = Talk()
    talk.ready()
    talk.say("do", n=1, line="down JOG_RIGHT")
    talk.wait(500)
    assert talk.down() == ["JOG_RIGHT"]
    talk.alive = []
    talk.wait(JOG_ENDS_MS)
    assert talk.down() == []


class Sealed:
    """A world like that of the emulated Pico: nobody can look into the firmware."""

    def __init__(self, world):
        self._world = world
        for name in ("clock", "drives", "down", "up", "run"):
            setattr(self, name, getattr(world, name))


def test_where_nobody_can_look_into_the_firmware_stop_is_held_until_all_drives_stand():
    talk = Talk(addresses=(1, 2))
    talk.ready()
    talk.tap("START")
    talk.wait(3000)
    talk.tap("ADDRESS_UP")
    talk.wait(1500)
    talk.tap("START")
    talk.wait(3000)
    assert talk.state(1) == talk.state(2) == "running"
    stop_all(Sealed(talk.world))
    talk.wait(12_000)
    assert talk.state(1) == talk.state(2) == "ready", talk.world.lcd()
    assert talk.world.reads("READY"), talk.world.lcd()  # STOP is up again
    talk.world.check()


def test_when_nobody_is_heard_the_drives_are_stopped():
    talk = Talk(addresses=(1, 2))
    talk.runs()
    talk.tap("ADDRESS_UP")
    talk.wait(3000)
    talk.tap("START")
    talk.wait(3000)
    assert talk.state(1) == talk.state(2) == "running"
    talk.alive = []
    talk.wait(1800)
    assert talk.state(1) == talk.state(2) == "running"
    talk.wait(600)
    assert talk.state(1) == talk.state(2) == "stopping"
    assert "every drive was sent OFF1" in talk.last("notice")["text"]


def test_one_front_end_of_two_is_enough_to_go_on():
    talk = Talk()
    talk.alive = [0, 1]
    talk.runs()
    talk.say("bye", id=0)
    talk.alive = [1]
    talk.wait(5000)
    assert talk.state() == "running"


def test_no_motor_starts_when_somebody_comes_back():
    talk = Talk()
    talk.runs()
    talk.alive = []
    talk.wait(8000)
    assert talk.state() == "ready"
    talk.alive = [0]
    talk.say("hello", v=1)
    talk.wait(3000)
    assert talk.state() == "ready"
    talk.tap("START")
    talk.wait(1000)
    assert talk.state() == "running", talk.lcd()


def test_the_end_of_all_messages_lets_go_of_every_key():
    talk = Talk()
    talk.ready()
    talk.say("down", key="JOG_RIGHT")
    talk.wait(500)
    talk.conversation.end()
    assert talk.down() == []


def test_the_table_has_a_way_for_each_message():
    talk = Talk()
    for kind, fields in TO_PANEL.items():
        values = {"v": 1, "key": "STOP", "n": 1, "line": "lcd", "x": 1}
        talk.say(kind, **{name: values[name] for name, _ in fields})
    assert talk.last("error") is None


def test_a_setpoint_is_typed_while_time_goes_on():
    talk = Talk()
    talk.ready()
    talk.wait(1500)
    talk.say("do", n=4, line="setpoint 12.5")
    talk.wait(100)
    assert talk.last("state")["doing"]["line"] == "setpoint 12.5"
    talk.wait(3000)
    done = talk.last("done")
    assert (done["n"], done["ok"], done["out"]) == (4, 1, []), done
    assert talk.lcd()[0].startswith("S: 12.5") and not talk.down()


def test_a_setpoint_that_cannot_be_typed_is_refused():
    talk = Talk()
    talk.ready()
    talk.tap("PARAM")
    talk.wait(500)
    talk.say("do", n=5, line="setpoint 12.5")
    talk.wait(2000)
    done = talk.last("done")
    assert (done["n"], done["ok"]) == (5, 0)
    assert done["out"][0].startswith("no setpoint can be typed now, the display shows S: 10.0")


def test_stop_and_release_end_the_typing_and_nothing_takes_effect():
    for kind, fields in (("release", {}), ("down", {"key": "STOP"})):
        talk = Talk()
        talk.runs()
        talk.say("do", n=6, line="setpoint 47.5")
        talk.wait(600)
        talk.say(kind, **fields)
        talk.wait(200)
        assert talk.last("done")["ok"] == 0 and "UP" not in talk.down()
        talk.say("release")
        talk.wait(1000)
        assert talk.lcd()[0].startswith("S: 10.0"), talk.lcd()
        assert talk.state() == ("running" if kind == "release" else "stopping")
