# SPDX-License-Identifier: MIT
"""On a chip with little memory a page is loaded when it is shown, and leaves the memory again."""

import sys

import on_demand
from lookup_bench import choose, go_to
from panel.pages.table import PAGES, PARAMETER
from panel_bench import panel, row_2, starts, wait_until_known

PAGE, WRITER, QUESTION = "panel.pages.parameters", "panel.writer", "panel.pages.question"


def cramped():
    """A panel with no room to keep what it does not need."""
    world = panel()
    on_demand.keep()
    for name in (PAGE, WRITER, QUESTION, "panel.pages.risk"):
        on_demand.drop(name)
    wait_until_known(world)
    return world


def test_a_page_comes_and_goes():
    world = cramped()
    for _ in range(3):
        assert PAGE not in sys.modules
        world.press("PARAM")
        world.run(1000)
        assert row_2(world) == "P0700:     5 A1" and PAGE in sys.modules, world.lcd()
        world.press("PARAM")
        world.run(300)
        assert row_2(world) == "READY        A1"
    world.check()


def test_a_parameter_is_written_all_the_same():
    world = cramped()
    world.press("PARAM")
    world.press("NEXT")
    world.run(1000)
    world.press("EDIT")
    world.press("DOWN")
    world.press("SET")
    world.run(300)
    assert QUESTION in sys.modules
    world.press("SET")
    world.run(1000)
    assert world.drives[1].read(1000) == 4
    world.run(2000)
    assert WRITER not in sys.modules and QUESTION not in sys.modules
    world.check()


def test_what_is_kept_is_loaded_at_once():
    world = panel()
    assert PAGE in sys.modules and WRITER in sys.modules
    world.press("PARAM")
    world.press("PARAM")
    assert PAGE in sys.modules


class NoMemory:
    """No module can be loaded meanwhile, or none of these. tries: how often one was asked for."""

    def __init__(self, *names):
        self._names = names
        self.tries = 0

    def __enter__(self):
        self._load = on_demand.load
        on_demand.load = self._fail
        return self

    def __exit__(self, *_):
        on_demand.load = self._load

    def _fail(self, name):
        if self._names and name not in self._names:
            return self._load(name)
        self.tries += 1
        raise MemoryError("no memory")


def test_a_page_that_finds_no_memory_is_not_shown():
    world = cramped()
    with NoMemory():
        world.press("PARAM")
        world.run(300)
        assert row_2(world) == "NO MEMORY LEFT", world.lcd()
        world.press("START")
        world.run(3000)
        assert starts(world) == 1
    world.run(3000)
    assert row_2(world) == "RUNNING      A1"


def test_a_list_of_the_menu_that_finds_no_memory_is_not_shown():
    world = panel()
    world.press("PARAM", 1500)
    world.run(1000)
    assert row_2(world) == ">DRIVES", world.lcd()
    with NoMemory():
        world.press("SET")
        world.run(300)
        assert row_2(world) == "NO MEMORY LEFT", world.lcd()
    world.run(3000)
    assert row_2(world) == ">DRIVES", world.lcd()
    world.press("SET")
    world.run(1000)
    assert row_2(world) == ">A1  READY", world.lcd()


def modules():
    """What belongs to a menu, of what is in memory."""
    return {name for name in sys.modules if name.startswith(("panel.menu.", "uss.finding"))}


def test_a_menu_that_finds_no_memory_is_not_opened():
    """Neither the menu itself nor its first list, and what had come of it leaves again."""
    for name in ("panel.menu.engine", "panel.menu.main"):
        world = cramped()
        for module in modules():
            on_demand.drop(module)
        with NoMemory(name):
            world.press("PARAM", 1100)
            world.run(300)
            assert row_2(world) == "NO MEMORY LEFT", (name, world.lcd())
            world.run(3500)
            assert row_2(world) == "READY        A1", (name, world.lcd())
            world.press("DOWN")
            assert world.lcd()[0].startswith("S:  9.9"), (name, world.lcd())
        assert modules() == set(), (name, modules())
        world.press("PARAM", 1500)
        world.run(1000)
        assert row_2(world) == ">DRIVES", (name, world.lcd())
        world.check()


def test_a_list_that_finds_no_memory_leaves_nothing_of_what_had_come_for_it():
    world = cramped()
    world.press("PARAM", 1500)
    world.run(1000)
    before = modules()
    for _ in range(3):  # over ABOUT and EVENTS
        world.press("UP")
    assert row_2(world) == ">FAULT MEMORY", world.lcd()
    kept = set(sys.modules)
    with NoMemory("panel.lookup.memory"):
        world.press("SET")
        world.run(1000)
        assert row_2(world) == "NO MEMORY LEFT", world.lcd()
    assert modules() == before and set(sys.modules) == kept, set(sys.modules) - kept


def test_a_menu_that_closes_while_it_is_coming_does_not_come():
    world = cramped()
    for module in modules():
        on_demand.drop(module)
    front = world.app.panel
    for entries in (0, 1):
        world.press("PARAM", 1100)
        if entries:
            world.run(1000)
            assert row_2(world) == ">DRIVES", world.lcd()
        has_time = front.has_time
        front.has_time = lambda: False
        if entries:
            world.press("SET")
        else:
            world.run(100)
        front.close_menu()
        front.has_time = has_time
        world.run(1000)
        assert row_2(world) == "READY        A1" and modules() == set(), (entries, modules())
    world.check()


def test_of_a_list_that_was_coming_when_the_menu_closed_nothing_stays_in_memory():
    world = cramped()
    world.press("PARAM", 1500)
    world.run(1000)
    for _ in range(3):
        world.press("UP")
    assert row_2(world) == ">FAULT MEMORY", world.lcd()
    front, before = world.app.panel, set(sys.modules)
    has_time, turns = front.has_time, [True, True]
    front.has_time = lambda: bool(turns) and turns.pop()
    world.press("SET")
    world.run(200)
    assert set(sys.modules) - before, "none of its modules has come"
    front.close_menu()
    front.has_time = has_time
    world.run(1000)
    assert row_2(world) == "READY        A1", world.lcd()
    assert not set(sys.modules) - before, set(sys.modules) - before


def of_lists():
    """What lists and pages have loaded, of what is in memory."""
    return {name for name in sys.modules if name.startswith(("panel.", "uss.", "catalogue"))}


def test_a_list_that_is_left_takes_what_no_list_above_it_needs_out_of_memory():
    """And a menu that closes takes all of it, however deep it is."""
    world = cramped()
    for module in modules():
        on_demand.drop(module)
    home = of_lists()
    for way in (("DIAGNOSIS", "BUS TIMES"), ("SETS", "SAVE"), ("PARAMETERS",)):
        for closes in (False, True):
            go_to(world)
            world.run(500)
            before = []
            for entry in way:
                before.append(of_lists())
                choose(world, entry)
                world.run(2500)
            assert len(of_lists()) > len(before[-1]) > len(home), way
            if closes:
                world.app.panel.close_menu()
            else:
                while before:
                    world.press("PARAM")
                    world.run(200)
                    assert of_lists() == before.pop(), (way, world.lcd())
                world.press("PARAM")
            world.run(200)
            assert of_lists() == home and not row_2(world).startswith(">"), (way, world.lcd())
    world.check()


def test_a_page_that_has_come_while_its_list_was_shown_stays_when_the_menu_closes():
    """It is not loaded a second time, which takes long."""
    world = cramped()
    go_to(world, "PARAMETERS")
    world.run(3000)
    assert not [name for name in PAGES[PARAMETER][2] if name not in sys.modules]
    loaded, load = [], on_demand.load

    def load_and_note(name):
        if name not in sys.modules:
            loaded.append(name)
        return load(name)

    on_demand.load = load_and_note
    try:
        choose(world, "BY NUM")
        world.run(500)
    finally:
        on_demand.load = load
    assert row_2(world).startswith("P0"), world.lcd()
    assert not [name for name in PAGES[PARAMETER][2] if name in loaded], loaded
    assert modules() == set(), modules()
    world.check()


def test_a_search_that_finds_no_memory_says_so_and_may_be_tried_again():
    world = panel(addresses=(1, 2), settings={"drives": [1]})
    world.press("PARAM", 1500)
    world.run(1000)
    for wanted in (">FIND DRIVES", ">AT THIS RATE"):
        while row_2(world) != wanted:
            world.press("DOWN")
            world.run(200)
        world.press("SET")
        world.run(300)
    with NoMemory("uss.finding.scan"):
        world.press("SET")
        world.run(300)
        assert row_2(world) == "NO MEMORY LEFT", world.lcd()
    world.run(3000)
    assert world.lcd() == ("STOPS FOUND     ", ">SET=BEGIN      "), world.lcd()
    world.press("SET")
    world.run(1000)
    assert world.lcd()[0].startswith("SEARCH "), world.lcd()
    left = [name for name in modules() if name.startswith("uss.finding.")]
    assert "uss.finding.scan" not in left and "uss.finding.enquiry" not in left, left
    world.check()


def test_a_log_that_finds_no_memory_is_switched_off_and_says_so():
    world = panel()
    with NoMemory("log"):
        world.app.settings.change("log", "JSON")
        world.run(500)
        assert row_2(world) == "NO MEMORY LEFT" and world.app.settings.log == "none", world.lcd()
        world.run(3500)
    assert row_2(world) == "READY        A1" and not world.usb.heard, world.lcd()
    world.app.settings.change("log", "JSON")
    world.run(3000)
    assert world.usb.heard
    world.check()


def test_a_log_that_is_switched_off_leaves_the_memory():
    world = cramped()
    for log in ("JSON", "none"):
        world.app.settings.change("log", log)
        world.run(1000)
        assert ("log" in sys.modules) == (log == "JSON"), log


def test_the_list_of_groups_that_finds_no_memory_for_its_page_is_a_list_all_the_same():
    """It tries once to have the page at hand; whoever goes there is told."""
    world = panel()
    wait_until_known(world)
    go_to(world)
    for _ in range(40):
        if row_2(world) == ">PARAMETERS":
            break
        world.press("DOWN")
        world.run(200)
    world.press("SET", 40)
    for _ in range(400):
        if row_2(world).startswith(">BY NUM"):
            break
        world.run(5)
    with NoMemory() as memory:
        world.run(2000)
        assert memory.tries == 1 and world.lcd()[1] == ">BY NUMBER      ", world.lcd()
    world.press("SET")
    world.run(1000)
    assert row_2(world).startswith("P0"), world.lcd()
    world.check()


def test_what_takes_long_waits_for_the_line_and_the_step_and_not_without_an_end():
    """The line: a moment in which no telegram interrupts it. The step: one that has just begun."""
    front = panel().app.panel
    for undisturbed, late, turns in (
        (True, False, 1), (True, True, 1), (False, False, 8), (False, True, 16)
    ):  # fmt: skip
        front.is_undisturbed = lambda for_us: undisturbed
        front.has_taken = lambda us: late
        answers = [front.has_time() for _ in range(turns)]
        assert answers == [False] * (turns - 1) + [True], (undisturbed, late, answers)


def test_a_step_that_was_interrupted_is_too_late_for_what_takes_long():
    front = panel().app.panel
    front.bus.is_undisturbed = lambda until_us: True
    for late in (False, True):
        front.has_taken = lambda us: late
        assert front.is_undisturbed() == (not late)


def test_a_question_of_start_is_asked_all_the_same():
    world = cramped()
    world.drives[1].write(2014, 0, 0)
    world.run(3000)
    world.press("START")
    world.run(1500)
    assert world.lcd()[1] == "SET=FIX START=GO", world.lcd()
    world.press("SET")
    world.run(1000)
    assert world.drives[1].read(2014) >= 1000 and QUESTION not in sys.modules
