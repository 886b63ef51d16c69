# SPDX-License-Identifier: MIT
"""The names that a panel as files has on the chip: tools/deploying/names.py."""

import ast

from tiers import TOP
from tools.deploying.image import MAIN, STAY_SOURCE, Firmware
from tools.deploying.names import short_names, shortened

INTERPRETERS = "host"

INVERTER = b"""
from micropython import const

_READY = const(1)

class Inverter:
    _count = 0

    def __init__(self):
        self._zsw = _READY

    def _trips(self):
        global _last
        _last = self
        self._count += 1
"""


def test_what_two_files_have_for_themselves_is_called_alike_on_the_chip():
    made = shortened({"drive.py": b"_turns = 1\n", "bus.py": b"_addresses = 2\n"})
    assert made == {"drive.py": b"_a = 1\n", "bus.py": b"_a = 2\n"}


def test_each_place_of_a_name_has_the_short_one():
    source = shortened({"inverter.py": INVERTER})["inverter.py"]
    for name in (b"_READY", b"_zsw", b"_count", b"_last", b"_trips"):
        assert name not in source
    ran = {}
    exec(source.replace(b"from micropython import const", b"const = int"), ran)
    inverter = ran["Inverter"]()
    short = short_names({"inverter.py": INVERTER})["inverter.py"]
    getattr(inverter, short["_trips"])()
    assert getattr(inverter, short["_zsw"]) == getattr(inverter, short["_count"]) == 1
    assert ran[short["_last"]] is inverter


def test_an_exchange_of_two_values_makes_no_tuple_on_the_chip():
    """With parentheses MicroPython would make one, and an interrupt has no memory for it."""
    for line in (b"a, b = _row, a", b"a.b, a[1] = f(_row, 1), (a, b)", b"a, b = f(_row)"):
        source = b"_row = 1\n" + line + b"\n"
        assert shortened({"x.py": source})["x.py"] == source.replace(b"_row", b"_a")
    firmware = Firmware.read(TOP, "pico")
    exchanges = 0
    for path, source in shortened(firmware.programs(), STAY_SOURCE).items():
        text = source.decode()
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Tuple):
                if isinstance(node.targets[0], ast.Tuple):
                    first = node.value.elts[0]
                    assert node.value.col_offset == first.col_offset, (path, node.lineno)
                    exchanges += 1
    assert exchanges > 10


def test_names_for_others_stay():
    name = b"_one"
    sources = {
        "public.py": b"turns = STATES = 1\n",
        "of_two.py": b"%s = 1\n" % name,
        "too.py": b"import of_two\nof_two.%s\n" % name,
        "by_text.py": b"_spoken = 1\nglobals()['_spoken']\n",
        "interpreter.py": b"import sys\nsys.implementation.%s\n" % b"_machine",
        "taken.py": b"from machine import _pin\n_pin()\n",
        "given.py": b"def mark(drive):\n    drive.%s = 1\n" % b"_mark",
    }
    assert shortened(sources) == sources


def test_a_file_that_lies_on_the_chip_as_it_is_keeps_its_names_for_all():
    sources = {"board.py": b"_pin = 1\n", "chip.py": b"_pin = 2\n"}
    assert shortened(sources, ("board.py",)) == sources


def test_a_class_and_what_inherits_from_it_share_no_short_name():
    """Both write into the same object."""
    short = short_names(
        {
            "page.py": b"class Page:\n    def __init__(self):\n        self._row = 1\n",
            "home.py": b"import page\nclass Home(page.Page):\n    _frequency = 2\n",
            "last.py": b"from home import Home\nclass Last(Home):\n    _what = 3\n",
        }
    )
    assert sorted(name for of in short.values() for name in of.values()) == ["_a", "_b", "_c"]


def test_a_board_file_may_make_a_class_of_anything():
    sources = {"board.py": b"class Pins(type(print)):\n    _led = 25\n"}
    assert shortened(sources, ("board.py",)) == sources
    assert shortened(sources)["board.py"] == b"class Pins(type(print)):\n    _a = 25\n"


def test_a_short_name_is_none_that_the_firmware_has():
    assert shortened({"x.py": b"_row = 1\n", "y.py": b"_a = 2\n", "z.py": b"_a\n"})["x.py"] == (
        b"_b = 1\n"
    )


def test_the_firmware_has_six_hundred_names_fewer_and_main_is_untouched():
    firmware = Firmware.read(TOP, "pico")
    programs = firmware.programs()
    short = short_names(programs, STAY_SOURCE)
    names = [name for of in short.values() for name in of]
    assert len(names) == len(set(names))
    assert len(names) - len({name for of in short.values() for name in of.values()}) > 600
    assert shortened(programs, STAY_SOURCE)[MAIN] == programs[MAIN]
    for path, source in shortened(programs, STAY_SOURCE).items():
        compile(source, path, "exec")
