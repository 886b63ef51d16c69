# SPDX-License-Identifier: MIT
"""The screens of the panel's manuals are those of the panel: each is made anew and compared.

If you have changed the panel, write them anew: `runner.py unix64 THIS_FILE write_them`.
"""

from manual_bench import made

INTERPRETERS = "unix64"

MANUALS = {"firmware/panel/README.md": 30, "firmware/panel/TROUBLESHOOTING.md": 12}  # screens


def read(manual):
    with open(manual, encoding="utf-8") as file:
        return file.read()


def test_every_screen_of_the_manuals_is_as_the_panel_shows_it():
    for manual, at_least in MANUALS.items():
        text = read(manual)
        anew, count = made(text)
        assert count > at_least, (manual, count)
        for line, line_anew in zip(text.split("\n"), anew.split("\n")):
            assert line == line_anew, "%s has %r, the panel shows %r" % (manual, line, line_anew)


def write_them():
    for manual in MANUALS:
        text = made(read(manual))[0]
        with open(manual, "w", encoding="utf-8") as file:
            file.write(text)
