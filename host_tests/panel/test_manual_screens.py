# SPDX-License-Identifier: MIT
"""The screens of the operator's manual are those of the panel: each is made anew and compared.

If you have changed the panel, write them anew: `runner.py unix64 THIS_FILE write_them`.
"""

from manual_bench import made

INTERPRETERS = "unix64"

MANUAL = "firmware/panel/README.md"


def test_every_screen_of_the_manual_is_as_the_panel_shows_it():
    with open(MANUAL, encoding="utf-8") as manual:
        text = manual.read()
    anew, count = made(text)
    assert count > 30, count
    for line, line_anew in zip(text.split("\n"), anew.split("\n")):
        assert line == line_anew, "the manual has %r, the panel shows %r" % (line, line_anew)


def write_them():
    with open(MANUAL, encoding="utf-8") as manual:
        text = manual.read()
    with open(MANUAL, "w", encoding="utf-8") as manual:
        manual.write(made(text)[0])
