# SPDX-License-Identifier: MIT
"""A setpoint that is typed: `setpoint 12.5`, with the keys of the panel and by its display."""

import main
from boards.sim.script import Script, ScriptError
from boards.sim.setpoint import centihertz
from boards.sim.world import World


class Desk:
    """A panel whose drive is known, and what it is told."""

    def __init__(self, **options):
        self.world = World(main.start, **options)
        self.script = Script(self.world)
        self.do("wait 2500")

    def do(self, *lines):
        self.script.run(lines)

    def refused(self, line):
        try:
            self.do(line)
        except ScriptError as error:
            return str(error)
        raise AssertionError("%r was done" % line)

    def drive(self):
        return self.world.drives[1]


def test_it_takes_effect_at_once_or_with_the_next_start():
    for keys in ("direct", "compact"):
        desk = Desk(keys=keys)
        desk.do("setpoint 17.55")
        assert desk.world.lcd() == ("S: 17.6 F:  0.00", "READY        A1 "), desk.world.lcd()
        desk.do("press START", "wait 5000")
        assert abs(desk.drive().hz() - 17.55) < 0.01
        desk.do("setpoint 9", "wait 5000")
        assert abs(desk.drive().hz() - 9) < 0.01 and desk.drive().starts == 1
        desk.world.check()


def test_a_negative_one_turns_to_the_left():
    desk = Desk()
    desk.do("setpoint -12.5")
    assert desk.world.lcd()[0].startswith("S:-12.5")
    desk.do("press START", "wait 5000")
    assert abs(desk.drive().hz() + 12.5) < 0.01
    desk.do("setpoint -20", "wait 3000")
    assert abs(desk.drive().hz() + 20) < 0.01
    desk.do("setpoint 5", "wait 8000")
    assert abs(desk.drive().hz() - 5) < 0.01


def test_the_motor_never_turns_faster_than_both_setpoints():
    desk = Desk()
    desk.do("setpoint 40", "press START", "wait 10000", "setpoint -10")
    fastest = 0
    for _ in range(100):
        desk.do("wait 100")
        fastest = min(fastest, desk.drive().hz())
    assert -10.01 < fastest < -9.9


def test_a_limit_stands_in_its_place():
    desk = Desk()
    desk.do("setpoint 99", "wait 100")
    assert desk.world.lcd()[1].startswith("LIMIT: 50.00"), desk.world.lcd()
    desk.do("wait 5000")
    assert desk.world.lcd()[0].startswith("S: 50.0")


def test_where_none_can_be_typed_that_is_said_and_nothing_changes():
    for keys in (("press PARAM",), ("hold PARAM 1500",)):
        desk = Desk()
        desk.do(*keys)
        said = desk.refused("setpoint 20")
        assert "no setpoint can be typed now, the display shows" in said, said
        assert desk.drive().hz() == 0 and desk.drive().starts == 0


def test_who_spoils_the_digits_meanwhile_spoils_only_that():
    desk = Desk()
    down = desk.world.down

    def two_hands(key):
        down(key)
        if key == "UP":
            down("DOWN")
            desk.world.run(50)
            desk.world.up("DOWN")

    desk.world.down = two_hands
    assert "the setpoint is as it was" in desk.refused("setpoint 12.5")
    desk.do("wait 31000")
    assert desk.world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")


def test_it_speaks_no_language():
    desk = Desk(settings={"language": "de"})
    assert desk.world.lcd()[1].startswith("BEREIT")
    desk.do("setpoint 33.3")
    assert desk.world.lcd()[0].startswith("S: 33.3"), desk.world.lcd()


def test_what_is_a_setpoint():
    for text, value in (("12.5", 1250), ("-30", -3000), ("0", 0), ("7.05", 705), ("12.", 1200),
                        ("650", 65_000), ("-0.1", -10)):  # fmt: skip
        assert centihertz(text) == value, text
    for text in ("", "-", "x", "1.234", "1000", "650.01", "1e2", "--1", "1.x", "+5", ".5"):
        try:
            centihertz(text)
        except ValueError as error:
            assert text in error.args[0]
        else:
            raise AssertionError(text)
