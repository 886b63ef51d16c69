# SPDX-License-Identifier: MIT
"""firmware/uss/REFERENCE.md is what the docstrings say, and has all that the library offers."""

import runpy

from tiers import TOP
from tools.reference.page import markdown
from tools.reference.source import Module

INTERPRETERS = "host"

TOOL = runpy.run_path(str(TOP / "tools/reference/__main__.py"))


def test_the_page_is_not_stale():
    page = (TOP / TOOL["PAGE"]).read_text(encoding="utf-8")
    assert page == TOOL["page"](), "run: python3 tools/reference"


def test_every_module_that_the_package_lists_is_there_or_is_for_the_engine_alone():
    own = {"channel", "fast", "going_on", "leave", "silence", "survey", "telegram_count"}
    listed = {
        line.split()[0]
        for line in Module("uss", TOP / "firmware/uss/__init__.py").text.split("\n")
        if line.startswith("    ") and line[4] != " "
    }
    there = {name.split(".")[1] for name in TOOL["MODULES"]}
    assert listed - there == own, listed - there


def test_every_verb_of_a_face_says_what_it_does():
    for name in ("uss.bus", "uss.scaling", "uss.finding.scan", "uss.s7", "uss.br"):
        for item in TOOL["module"](name).items:
            silent = [one.name for one in (item, *item.items) if not one.text]
            assert not silent, (name, silent)


def test_what_a_module_offers_is_read_from_its_source(tmp_path):
    (tmp_path / "one.py").write_text(
        '"""Two things."""\n'
        "from micropython import const\n"
        "MOST = const(3)  # of them\n"
        "# Above.\nNAMES = ('a',)\n_OWN = 1\n"
        'class Thing(Base):\n    """It has\n\n    a     two\n          lines\n    """\n'
        "    size = 4  # words\n"
        '    def __init__(self, a, b=2):\n        """"""\n'
        '    @property\n    def name(self):\n        """Its *name*."""\n'
        "    def _own(self):\n        pass\n"
    )
    module = Module("one", tmp_path / "one.py")
    assert [(one.name, one.written, one.remark) for one in module.values] == [
        ("MOST", "3", "of them"),
        ("NAMES", "('a',)", "Above."),
    ]
    (thing,) = module.items
    assert thing.signature == "Thing(a, b=2), a Base" and thing.values[0].remark == "words"
    assert [(one.signature, one.kind) for one in thing.items] == [("name", "property")]
    assert markdown(thing.text) == "It has\n\n* `a`: two\n  lines"
    assert markdown(thing.items[0].text) == "Its \\*name\\*."
