# SPDX-License-Identifier: MIT
"""The operator's manual, eight keys in place of fourteen: START STOP REVERSE JOG UP DOWN P FN.

FN gives the next key its second function, FN twice its third; ^ or ^^ on the display says so.
"""

from boards.sim.board import COMPACT_KEYS
from panel.keys import NAMES, Keys, keys_of, unknown
from panel.keys.compact import FUNCTIONS
from panel.texts import REFUSED_FN
from panel_bench import LOOP_US, OFF1, ON, panel, row_1, row_2, starts, telegrams, wait_until_known

MASK = 0x3FFFFFFF
JOG_RIGHT, JOG_LEFT = 0x057E, 0x067E

# How each of the fourteen is reached.
WAYS = {
    "START": ("START",),
    "STOP": ("STOP",),
    "REVERSE": ("REVERSE",),
    "JOG_RIGHT": ("JOG",),
    "JOG_LEFT": ("REVERSE", "JOG"),
    "UP": ("UP",),
    "DOWN": ("DOWN",),
    "PARAM": ("P",),
    "SET": ("FN", "P"),
    "EDIT": ("FN", "FN", "P"),
    "NEXT": ("FN", "UP"),
    "PREVIOUS": ("FN", "DOWN"),
    "ADDRESS_UP": ("FN", "FN", "UP"),
    "ADDRESS_DOWN": ("FN", "FN", "DOWN"),
}


def ready(**options):
    world = panel(keys="compact", **options)
    wait_until_known(world)
    return world


def press(world, *functions):
    """Use functions of the fourteen."""
    for function in functions:
        for key in WAYS[function]:
            world.press(key)
        world.run(150)


def hold(world, function, ms):
    for key in WAYS[function][:-1]:
        world.press(key)
    world.press(WAYS[function][-1], ms)


def stops_at_once(world):
    """STOP, and OFF1 is on the wire."""
    pressed_us = world.clock.now_us
    world.press("STOP")
    sent = telegrams(world, pressed_us, 1)
    assert any(stw == OFF1 and at_us - pressed_us < 40_000 for at_us, stw in sent), sent
    world.run(5000)
    assert world.drives[1].hz() == 0


# --- the fourteen functions ----------------------------------------------------------------------


def test_each_of_the_fourteen_has_a_way():
    assert sorted(WAYS) == sorted(NAMES) and not unknown(COMPACT_KEYS)
    for function, keys in WAYS.items():
        if function != "JOG_LEFT":
            row = FUNCTIONS.get(keys[-1], (keys[-1],) * 3)
            assert row[len(keys) - 1] == function
    assert sorted({key for keys in WAYS.values() for key in keys}) == sorted(COMPACT_KEYS)


def test_run_reverse_and_stop():
    world = ready()
    press(world, "START")
    world.run(4000)
    assert row_2(world) == "RUNNING      A1" and abs(world.drives[1].hz() - 10) < 0.01
    press(world, "REVERSE")
    world.run(4000)
    assert row_1(world) == "S:-10.0 F:-10.00"
    stops_at_once(world)
    assert row_2(world) == "READY        A1" and starts(world) == 1
    world.check()


def test_the_setpoint_goes_up_and_down_and_repeats():
    world = ready()
    press(world, "UP", "UP", "DOWN")
    assert row_1(world).startswith("S: 10.1 ")
    hold(world, "UP", 3000)
    assert float(row_1(world)[2:7]) > 12, world.lcd()
    hold(world, "DOWN", 6000)
    assert float(row_1(world)[2:7]) < 10, world.lcd()
    world.check()


def test_jog_turns_to_the_side_that_reverse_has_chosen_while_it_is_held():
    world = ready(loop_us=LOOP_US)
    for function, stw, sign in (("JOG_RIGHT", JOG_RIGHT, 1), ("JOG_LEFT", JOG_LEFT, -1)):
        for key in WAYS[function][:-1]:
            world.press(key)
        since_us = world.clock.now_us
        world.down("JOG")
        world.run(2000)
        assert sign * world.drives[1].hz() > 1, (function, world.lcd())
        assert row_2(world) == ("JOG RIGHT    A1" if sign > 0 else "JOG LEFT     A1")
        assert {word for _, word in telegrams(world, since_us, 1)} & {JOG_RIGHT, JOG_LEFT} == {stw}
        world.up("JOG")
        world.run(2000)
        assert world.drives[1].hz() == 0 and row_2(world) == "READY        A1"
    world.check()


def test_a_jog_that_is_held_does_not_change_its_side():
    world = ready(loop_us=LOOP_US)
    world.down("JOG")
    world.run(1000)
    world.press("REVERSE")
    assert row_2(world) == "NO: JOG IS DOWN"
    world.run(1000)
    assert world.drives[1].hz() > 0
    world.up("JOG")
    world.run(2000)
    assert world.drives[1].hz() == 0
    world.check()


def test_a_jog_is_stopped_by_stop():
    world = ready(loop_us=LOOP_US)
    world.down("JOG")
    world.run(1500)
    assert world.drives[1].hz() > 0
    stops_at_once(world)
    assert world.drives[1].hz() == 0
    world.up("JOG")
    world.check()


def test_stop_held_is_the_second_stop_and_then_all():
    world = ready(addresses=(1, 2))
    press(world, "START", "ADDRESS_UP")
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    world.down("STOP")
    world.run(1800)
    assert row_2(world) == "OFF3, HOLD: ALL"
    world.run(2500)
    assert row_2(world) == "ALL DRIVES: STOP"
    world.up("STOP")
    world.run(4000)
    assert world.drives[1].hz() == 0 == world.drives[2].hz()
    world.check()


def test_the_address_goes_up_and_down_and_any_address_is_reached():
    world = ready(addresses=(1, 2, 3))
    press(world, "ADDRESS_UP")
    assert row_2(world).endswith("A2"), world.lcd()
    press(world, "ADDRESS_DOWN", "ADDRESS_DOWN")
    assert row_2(world).endswith("A3"), world.lcd()
    hold(world, "ADDRESS_UP", 1800)
    assert row_1(world).startswith("ANY ADDRESS"), world.lcd()
    at = row_2(world)
    press(world, "ADDRESS_UP")
    assert row_2(world) != at and row_1(world).startswith("ANY ADDRESS"), world.lcd()
    press(world, "PARAM")
    wait_until_known(world)
    world.check()


def test_parameters_are_read_edited_and_written():
    world = ready()
    press(world, "PARAM")
    world.run(300)
    assert row_2(world) == "P0700:     5 A1"
    press(world, "NEXT")
    world.run(300)
    assert row_2(world) == "P1000:     5 A1"
    press(world, "PREVIOUS", "PREVIOUS", "PREVIOUS")
    world.run(300)
    assert row_2(world).startswith("r2024"), world.lcd()
    press(world, "NEXT", "NEXT", "NEXT")
    press(world, "EDIT", "UP", "SET")
    world.run(300)
    assert row_2(world) == "SET=DO  PARAM=NO" and world.drives[1].read(1000) == 5, world.lcd()
    press(world, "SET")
    world.run(500)
    assert world.drives[1].read(1000) == 6
    press(world, "EDIT", "DOWN", "SET")
    world.run(200)
    press(world, "PARAM")  # no
    world.run(500)
    assert world.drives[1].read(1000) == 6
    stops_at_once(world)
    press(world, "PARAM")
    world.run(300)
    assert row_2(world).endswith("A1") and not row_2(world).startswith("P"), world.lcd()
    world.check()


def test_set_that_is_held_writes_into_the_eeprom():
    world = ready()
    press(world, "PARAM", "NEXT")
    world.run(300)
    press(world, "EDIT", "SET")
    world.run(200)
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    hold(world, "SET", 2500)
    world.run(500)
    assert row_2(world) == "WRITTEN (EEPROM)", world.lcd()
    world.check()


def test_the_menu_and_the_question_of_the_search():
    world = ready()
    hold(world, "PARAM", 1500)
    world.run(200)
    assert row_1(world).startswith("MENU") and row_2(world) == ">DRIVES"
    press(world, "DOWN")
    assert row_2(world) == ">ANY ADDRESS"
    press(world, "UP", "UP", "SET")
    assert row_1(world).startswith("ABOUT"), world.lcd()
    press(world, "PARAM")
    assert row_1(world).startswith("MENU")
    for _ in range(20):
        if row_2(world) == ">FIND DRIVES":
            break
        press(world, "UP")
    assert row_2(world) == ">FIND DRIVES", world.lcd()
    press(world, "SET")
    assert row_2(world) == ">AT THIS RATE", world.lcd()
    press(world, "DOWN", "SET")
    world.run(300)
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    press(world, "PARAM")
    world.run(300)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_the_search_itself():
    world = ready()
    hold(world, "PARAM", 1500)
    world.run(200)
    press(world, "DOWN", "DOWN", "SET", "DOWN", "SET", "SET")
    world.run(1000)
    assert row_1(world) == "FIND DRIVES  24s", world.lcd()
    world.press("FN")
    world.run(200)
    assert row_1(world) == "^IND DRIVES  24s", world.lcd()
    world.press("P")
    world.run(500)
    assert "BAUD" in row_1(world), world.lcd()
    world.press("STOP")
    world.run(500)
    assert "BAUD" not in row_1(world), world.lcd()


def test_values_and_digits():
    world = ready()
    press(world, "NEXT")
    world.run(300)
    assert row_1(world) == "S: 10.0   0.0%  "
    press(world, "PREVIOUS")
    world.run(300)
    assert row_1(world) == "S: 10.0 F:  0.00"
    press(world, "EDIT", "UP", "NEXT", "UP", "UP", "SET")
    assert row_1(world).startswith("S: 11.2"), world.lcd()
    press(world, "EDIT", "UP", "PARAM")
    assert row_1(world).startswith("S: 11.2"), world.lcd()
    press(world, "EDIT", "UP", "START")
    assert row_2(world) == "NO: SET OR PARAM" and starts(world) == 0
    press(world, "EDIT", "START")
    world.run(4000)
    assert abs(world.drives[1].hz() - 11.2) < 0.01
    world.check()


# --- FN ------------------------------------------------------------------------------------------


def test_fn_is_shown_and_ends_after_three_seconds():
    world = ready()
    for presses, mark in ((1, "^: 10.0 F:  0.00"), (2, "^^ 10.0 F:  0.00"), (3, None)):
        for _ in range(presses):
            world.press("FN")
        world.run(100)
        assert row_1(world) == (mark or "S: 10.0 F:  0.00"), (presses, world.lcd())
        if mark:
            world.run(2400)
            assert row_1(world) == mark
            world.run(700)
        assert row_1(world) == "S: 10.0 F:  0.00"
    world.press("UP")
    world.run(100)
    assert row_1(world).startswith("S: 10.1")  # UP is UP again
    world.check()


def test_fn_is_for_one_key_alone():
    world = ready()
    press(world, "NEXT")
    world.press("UP")
    world.run(300)
    assert row_1(world) == "S: 10.1   0.0%  ", world.lcd()


def test_a_key_that_is_held_behind_fn_repeats_its_second_function():
    world = ready()
    press(world, "PARAM")
    world.run(300)
    world.press("FN")
    world.down("UP")
    seen = set()
    for _ in range(100):
        world.run(20)
        seen.add(row_2(world)[:5])
    world.up("UP")
    assert len(seen) >= 5 and row_1(world).startswith("S: 10.0"), seen
    world.check()


def test_stop_is_stop_behind_fn_and_ends_it():
    for presses in (1, 2):
        world = ready()
        press(world, "START")
        world.run(4000)
        for _ in range(presses):
            world.press("FN")
        stops_at_once(world)
        assert row_1(world).startswith("S:"), world.lcd()
        for _ in range(presses):
            world.press("FN")
        world.press("STOP")
        world.press("UP")
        world.run(100)
        assert row_1(world).startswith("S: 10.1"), world.lcd()
        world.check()


def test_nothing_behind_fn_moves_a_motor():
    for key in ("START", "REVERSE", "JOG"):
        for presses in (1, 2):
            world = ready()
            for _ in range(presses):
                world.press("FN")
            since_us = world.clock.now_us
            world.down(key)
            world.run(300)
            assert row_2(world) == "NO: FN IS ON", (key, world.lcd())
            world.run(2000)
            world.up(key)
            assert not {stw for _, stw in telegrams(world, since_us)} & {ON, JOG_RIGHT, JOG_LEFT}
            assert row_1(world) == "S: 10.0 F:  0.00" and starts(world) == 0
            world.check()


def test_start_behind_fn_does_not_start_but_the_next_one_does():
    world = ready()
    world.press("FN")
    world.press("START")
    world.run(1000)
    assert starts(world) == 0
    world.press("START")
    world.run(3000)
    assert starts(world) == 1
    world.check()


def test_stop_that_is_held_beats_start_and_jog():
    world = ready()
    world.down("STOP")
    world.run(100)
    for key in ("START", "JOG"):
        world.press(key)
        world.run(300)
    world.run(2000)
    assert starts(world) == 0 and world.drives[1].hz() == 0
    world.up("STOP")
    world.check()


def test_a_jammed_start_key_starts_nothing():
    world = panel(keys="compact")
    world.down("START")
    world.down("JOG")
    world.reset()
    world.run(6000)
    assert starts(world) == 0 and world.drives[1].hz() == 0
    world.check()


def test_the_full_keypad_loads_nothing_of_this():
    import sys

    sys.modules.pop("panel.keys.compact", None)
    panel()
    assert "panel.keys.compact" not in sys.modules
    panel(keys="compact")
    assert "panel.keys.compact" in sys.modules


def test_a_key_that_has_just_moved_is_unsettled_and_one_that_rests_is_not():
    keys = keys_of(COMPACT_KEYS, MASK, (), None)
    now_ms = 0
    for raw in (0, 1 << COMPACT_KEYS.index("UP")):
        keys.update(raw, now_ms)
        assert keys.unsettled, raw
        for _ in range(100):
            now_ms += 1
            keys.update(raw, now_ms)
        assert not keys.unsettled, raw


def test_before_the_first_reading_nothing_is_known_of_any_of_the_eight():
    keys = keys_of(COMPACT_KEYS, MASK)
    assert (keys.down, keys.pressed, keys.repeated, keys.repeats, keys.shift) == (0, 0, 0, 0, 0)
    assert not keys.at_rest and keys.unsettled == (1 << len(COMPACT_KEYS)) - 1
    keys.update(1 << COMPACT_KEYS.index("STOP"), 5_000)
    assert keys.down == keys.bit("STOP") and not keys.pressed
    for name in ("START", "UP", "JOG"):  # jammed from the beginning
        keys = keys_of(COMPACT_KEYS, MASK)
        for now_ms in range(100):
            keys.update(1 << COMPACT_KEYS.index(name), now_ms)
        assert keys.down == keys.bit({"JOG": "JOG_RIGHT"}.get(name, name)), name
        assert not keys.pressed and not keys.at_rest, name


def test_there_is_something_to_do_with_each_press_and_while_a_key_that_is_held_is_down():
    """FN as well, which ends three seconds after it went down; then all keys rest."""
    for key, does, shifts, rests in (
        ("UP", [121, 521], [], 551),
        ("FN", [121], list(range(121, 3_121)), 3_121),
        ("JOG", list(range(121, 551)), [], 551),  # until it has gone up, and then once more
    ):
        keys = keys_of(COMPACT_KEYS, MASK, held=("JOG_RIGHT",))
        bit = 1 << COMPACT_KEYS.index(key)
        told, shifted, resting = [], [], []
        for now_ms in range(3_200):
            if keys.update(bit if 101 <= now_ms < 530 else 0, now_ms):
                told.append(now_ms)
            if keys.shift:
                shifted.append(now_ms)
            if keys.at_rest and now_ms > 101:
                resting.append(now_ms)
        assert (told, shifted, resting[0]) == (does, shifts, rests), (key, told, resting[0])


def test_a_key_that_is_withheld_repeats_nothing_any_more():
    for others in (False, True):
        keys = keys_of(COMPACT_KEYS, MASK, (), None)
        up, now_ms = keys.bit("UP"), 0
        for down_ms, raw in ((100, 0), (600, 1 << COMPACT_KEYS.index("UP"))):
            for _ in range(down_ms):
                if not keys.repeated:
                    keys.update(raw, now_ms)
                    now_ms += 1
        assert keys.repeated == up
        keys.withhold(~up if others else up)
        assert keys.repeated == (up if others else 0), others


def test_of_keys_that_were_pressed_together_only_those_are_withheld_that_are_meant():
    keys = keys_of(COMPACT_KEYS, MASK, (), None)
    both = sum([1 << COMPACT_KEYS.index(name) for name in ("START", "UP")])
    for now_ms in range(200):
        if not keys.pressed:
            keys.update(both if now_ms >= 100 else 0, now_ms)
    assert keys.pressed == keys.bits(("START", "UP"))
    keys.withhold(~keys.bit("UP"))
    assert keys.pressed == keys.bit("UP")


def test_in_the_dark_fn_only_makes_light():
    world = ready(settings={"light_minutes": 1})
    world.run(62_000)
    assert world.app.panel.guard.dark
    world.press("FN")
    world.run(100)
    assert not world.app.panel.guard.dark and row_1(world).startswith("S: 10.0")
    press(world, "UP")
    assert row_1(world).startswith("S: 10.1")
    world.run(62_000)
    for key in ("JOG", "START", "P"):
        world.press(key, 1500)
        assert starts(world) == 0 and world.drives[1].hz() == 0
        assert row_2(world) == "READY        A1", world.lcd()
        world.run(62_000)
    world.check()


def test_behind_a_closed_lock_the_setpoint_can_be_typed_in():
    world = ready(settings={"lock_code": 123})
    press(world, "EDIT", "UP", "SET")
    assert row_1(world).startswith("S: 11.0"), world.lcd()
    world.press("JOG", 1000)
    assert row_2(world) == "LOCK: HOLD PARAM" and world.drives[1].hz() == 0
    stops_at_once(world)
    world.check()


# --- by themselves: to the millisecond -----------------------------------------------------------


class Told:
    """A panel whose drive turns to the left, or to the right; what it says."""

    reversed = False

    def __init__(self):
        self.selected = self
        self.said = []

    def say(self, now_ms, text):
        self.said.append((now_ms, text))


class Hand:
    """Presses keys, each for 60 ms, and notes what comes of it."""

    def __init__(self, panel=None, begin_ms=0):
        self.keys = keys_of(COMPACT_KEYS, MASK, (), panel)
        self.now_ms = begin_ms
        self.wait(100)

    def wait(self, ms, *down):
        raw, pressed = sum([1 << COMPACT_KEYS.index(name) for name in down]), 0
        for _ in range(ms):
            self.keys.update(raw, self.now_ms & MASK)
            pressed |= self.keys.pressed
            self.now_ms += 1
        return pressed

    def press(self, *keys):
        pressed = self.wait(60, *keys)
        self.wait(60)
        return pressed


def test_each_key_has_its_functions_behind_fn_and_one_without_says_so():
    panel = Told()
    hand = Hand(panel)
    bit = hand.keys.bit
    for key in COMPACT_KEYS:
        functions = FUNCTIONS.get(key, (key,) * 3)
        for shifts in range(3) if key != "FN" else ():
            for _ in range(shifts):
                assert hand.press("FN") == 0
            assert hand.keys.shift == shifts
            del panel.said[:]
            pressed_ms = hand.now_ms
            function = functions[shifts]
            assert hand.press(key) == (bit(function) if function else 0), (key, shifts)
            assert hand.keys.shift == 0
            assert [text for _, text in panel.said] == ([] if function else [REFUSED_FN])
            assert all([pressed_ms < at_ms < pressed_ms + 60 for at_ms, _ in panel.said])
    hand = Hand()  # no panel is there yet, to which it could be said
    assert hand.press("FN") == 0 and hand.press("START") == 0 and hand.keys.shift == 0


def test_jog_has_the_side_that_it_had_when_it_went_down():
    panel = Told()
    hand = Hand(panel)
    right, left = hand.keys.bit("JOG_RIGHT"), hand.keys.bit("JOG_LEFT")
    assert right and left and right != left
    for turns, side in ((False, right), (True, left)):
        panel.reversed = turns
        assert hand.wait(60, "JOG") == side
        panel.reversed = not turns
        hand.wait(60, "JOG")
        assert hand.keys.down == side
        panel.reversed = turns
        assert hand.press("UP") == hand.keys.bit("UP")  # the other keys have one side
        hand.wait(60)
    assert Hand().press("JOG") == right


def test_fn_ends_three_seconds_after_its_last_press_though_the_clock_begins_anew():
    for begin_ms in (0, MASK - 1_500):
        hand = Hand(begin_ms=begin_ms)
        hand.press("FN")
        hand.wait(1_000)
        while hand.keys.shift < 2:
            pressed_ms = hand.now_ms
            hand.wait(1, "FN")
        while hand.keys.shift:
            assert hand.keys.shift == 2 and not hand.keys.at_rest
            ended_ms = hand.now_ms
            hand.wait(1)
        assert ended_ms - pressed_ms == 3_000 and hand.keys.at_rest


def test_a_key_that_is_held_repeats_as_the_settings_say():
    for delay_ms, repeat_ms, repeats_in_a_second in ((400, 120, 6), (250, 50, 16)):
        hand = Hand()
        hand.keys.pace(delay_ms, repeat_ms)
        assert hand.keys.held_repeats == repeats_in_a_second
        repeated, down_ms = [], None
        for _ in range(delay_ms + 3 * repeat_ms + 60):
            if hand.wait(1, "UP"):
                down_ms = hand.now_ms
            if hand.keys.repeated:
                assert hand.keys.repeated == hand.keys.bit("UP")
                repeated.append(hand.now_ms - down_ms)
                assert hand.keys.repeats == len(repeated)
        assert repeated == [delay_ms + repeat_ms * at for at in range(len(repeated))], repeated
        assert len(repeated) >= 3


def test_what_is_withheld_repeats_nothing_and_what_is_left_goes_on():
    """STOP that makes light goes on to the second stop; FN is as good as not pressed."""
    for key, goes_on in (("STOP", True), ("UP", False), ("FN", False)):
        hand = Hand()
        while not hand.wait(1, key) and not hand.keys.shift:
            pass
        hand.keys.withhold(~hand.keys.bit("STOP"))
        assert hand.keys.shift == 0 and hand.keys.pressed == (hand.keys.bit(key) if goes_on else 0)
        repeats = 0
        for _ in range(1_500):
            hand.wait(1, key)
            repeats += hand.keys.repeated != 0
        assert (repeats > 0) == goes_on, key
        hand.wait(60)
        assert hand.press("UP") == hand.keys.bit("UP")


# --- a board with other keys ---------------------------------------------------------------------


def test_a_board_may_have_further_keys_besides():
    names = ("STOP", "UP", "FN", "EDIT")
    keys = keys_of(names, MASK)
    assert isinstance(keys_of(("STOP", "UP"), MASK), Keys) and not isinstance(keys, Keys)
    assert keys.bit("EDIT") and keys.bit("ADDRESS_UP") and not keys.bit("SET")
    now_ms = 0

    def tap(*down):
        nonlocal now_ms
        raw = sum(1 << names.index(name) for name in down)
        pressed = 0
        for level in (raw, 0):
            for _ in range(6):
                now_ms += 10
                keys.update(level, now_ms)
                pressed |= keys.pressed
        return pressed

    tap()
    assert tap("EDIT") == keys.bit("EDIT") and tap("UP") == keys.bit("UP")
    assert tap("FN") == 0 and tap("EDIT") == keys.bit("EDIT") and tap("UP") == keys.bit("UP")
    assert tap("FN") == 0 and tap("UP") == keys.bit("NEXT")
    assert tap("FN") == tap("FN") == 0 and tap("UP") == keys.bit("ADDRESS_UP")
    assert tap("FN", "UP") == keys.bit("UP")  # at once: FN is for the next one
    assert keys.shift == 1


def test_a_key_that_cannot_be_told_is_up():
    keys = keys_of(COMPACT_KEYS, MASK)
    up = 1 << COMPACT_KEYS.index("UP")
    for now_ms in range(0, 100, 10):
        keys.update(0, now_ms)
    for now_ms in range(100, 200, 10):
        keys.update(up, now_ms)
    assert keys.down == keys.bit("UP")
    keys.update(0, 210, up)
    assert keys.down == 0
    keys.update(up, 220)
    assert not keys.pressed and not keys.at_rest
