# SPDX-License-Identifier: MIT
"""What the manuals say is so: links lead somewhere, no key, text, setting or command is missing.

The library's manuals have tests of their own: test_uss_readme.py, test_s7_readme.py.
"""

import json
import re
import subprocess

import pytest

import settings_file as settings
import version
from boards.sim.script import COMMANDS
from page_bench import MANUALS, indented, pattern, prose, section, text
from panel import texts
from panel.pages import splash
from text_bench import named, parts
from tiers import TOP
from tools.live import virtual_panel
from tools.terminal import manuals

INTERPRETERS = "host"

PANEL, TOOLS, PICO = "firmware/panel/README.md", "tools/README.md", "boards/pico/README.md"


# ---- the front page -------------------------------------------------------------------------


def test_the_front_page_is_short_and_says_what_it_must():
    page = text("README.md")
    assert page.count("\n") < 100
    assert "STOP on this panel is not an emergency stop." in page
    assert "MIT" in section("README.md", "Licence") and (TOP / "firmware/LICENSE").exists()


def test_the_four_questions_of_a_newcomer_have_links_at_the_top():
    top = "\n".join(text("README.md").split("\n")[:40])
    asked = dict(
        re.findall(r"\[(What to buy|How to \w+(?: the drive)?|What NO \w+ means)\]\((\S+)\)", top)
    )
    assert asked == {
        "What to buy": "boards/pico/README.md#parts",
        "How to flash": "boards/pico/README.md#the-firmware",
        "How to set the drive": "boards/COMMISSIONING.md",
        "What NO CONTACT means": "firmware/panel/TROUBLESHOOTING.md#no-contact",
    }
    assert "Two commands" in top and "pictures/panel.svg" in top


def rows_of_bench(begin):
    """The figures of the rows of tools/bench.md that begin so, as numbers."""
    rows = re.findall(rf"^\| {re.escape(begin)}.*?\|.*?\| (.*?) \|", text("tools/bench.md"), re.M)
    assert rows, begin
    return [[float(one) for one in re.findall(r"\d+(?:\.\d+)?", row)] for row in rows]


def test_the_figures_of_the_front_page_are_those_that_were_measured():
    told = section("README.md", "Figures")
    exchanges = [
        row[0]
        for begin in (
            "exchanges per second, 115200 baud",
            "exchanges per second, 31 drives, 115200 baud",
        )
        for row in rows_of_bench(begin)
    ]
    s7_1200 = float(re.search(r"115200 baud \(.*?S7-1200 ([\d.]+)\)", text("tools/bench.md"))[1])
    assert min(exchanges) > int(re.search(r"more than (\d+) exchanges", told)[1])
    assert min(exchanges) > 7 * s7_1200 and "seven times as many as an S7-1200" in told
    stops = [
        row[2]
        for drives in ("1 drive", "31 drives")
        for row in rows_of_bench(
            f"STOP pressed to the end of the OFF1 telegram, {drives}, 115200 baud"
        )
    ]
    assert max(stops) < int(re.search(r"within (\d+) ms of the key", told)[1])
    hangs = [row[0] for row in rows_of_bench("main loop hangs in")]
    assert len(hangs) > 3 and max(hangs) < 350 and "0.3 s later" in told


def test_the_figures_of_the_workbench_are_those_that_were_measured():
    """In short, what the last run of tools/bench has written into bench.md."""
    told = section(TOOLS, "Figures")
    exchanges = re.search(r"(\d+) exchanges a second, with or without a parameter task", told)[1]
    both = ("115200 baud (wire", "1 drive, 115200 baud, a parameter task always pending")
    fewer = min(rows_of_bench("exchanges per second, " + one)[0][0] for one in both)
    assert int(fewer) == int(exchanges)
    stop = int(re.search(r"within (\d+) ms of the key", told)[1])
    for drives in ("1 drive", "31 drives"):
        begin = f"STOP pressed to the end of the OFF1 telegram, {drives}, 115200 baud"
        assert rows_of_bench(begin)[0][2] < stop
    for does, row in (
        ("parses a reply", "a reply parsed"),
        ("makes a whole exchange", "an exchange"),
    ):
        times = re.search(rf"{does} ([\d.]+) times", told)[1]
        assert re.search(rf"\| {row}, this library \|.*: {times} times \|", text("tools/bench.md"))


def test_every_manual_is_reached_from_the_front_page():
    reached, waiting = set(), ["README.md"]
    while waiting:
        manual = waiting.pop()
        if manual not in reached:
            reached.add(manual)
            waiting += [path for path, _ in links(manual) if path in MANUALS]
    assert reached == set(MANUALS)


def test_the_first_command_prints_what_the_front_page_shows():
    command, printed = indented(section("README.md", "Two commands"))[:2]
    run = subprocess.run(["bash", "-c", command], cwd=TOP, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    said, shown = run.stdout.splitlines(), printed.splitlines()
    assert len(said) == len(shown)
    for line, expected in zip(said, shown):
        assert line.startswith(expected.removesuffix("...")), line
        assert expected.endswith("...") or line == expected


def test_the_second_command_is_what_the_check_on_a_fresh_clone_calls():
    command = indented(section("README.md", "Two commands"))[2].strip()
    assert command == "./tools/test"
    last = text(".ci/run").rstrip().splitlines()[-1]
    assert last.endswith('exec tools/test --coverage "$@"')


# ---- links ----------------------------------------------------------------------------------


def links(manual):
    """(path from the top, anchor) of every link that does not leave the project."""
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(manual)):
        if "://" not in target:
            path, _, anchor = target.partition("#")
            found = (TOP / manual).parent / path if path else TOP / manual
            yield found.resolve().relative_to(TOP).as_posix(), anchor


def anchors(manual):
    """As the forge makes them: small letters, blanks as hyphens, no other marks."""
    headings = re.findall(r"^#+ (.*)$", prose(manual), re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("manual", MANUALS)
def test_every_link_leads_somewhere(manual):
    for path, anchor in links(manual):
        assert (TOP / path).exists(), path
        assert not anchor or anchor in anchors(path), f"{path}#{anchor}"


def test_every_file_and_folder_that_a_table_names_is_there():
    title = "Where things are"
    tables = section("README.md", title) + section(".github/CONTRIBUTING.md", title)
    named = [name for name in re.findall(r"`([\w./]+)`", tables) if "/" in name]
    assert len(named) > 25
    for name in named:
        assert (TOP / name).exists(), name


# ---- the operator's manual ------------------------------------------------------------------


def test_every_text_of_the_display_is_explained():
    said = section(PANEL, "What the display says")
    found = [text for _, _, value in named() for text in parts(value)]
    found = [row for row in found if row not in splash.SPLASH]
    assert len(found) > 100
    missing = [text for text in found if not re.search(pattern(text), said)]
    assert not missing


def test_the_splash_is_where_it_is_seen_first():
    first = texts.of(splash.SPLASH[0], version.VERSION.encode()).decode()
    second = splash.SPLASH[1].decode()
    assert f"`{first}` / `{second}`" in section(PICO, "First power-on")


def test_the_first_power_on_is_that_of_a_new_panel():
    """Its drives are off, and it has no settings yet."""
    script = "off 1\nwait 3000\nlcd\npress PARAM\nwait 900\nlcd\npress START\nwait 300\nlcd\n"
    run = subprocess.run(
        [TOP / "tools/panel", "--unset", "--drives", "1", "--script", "-"],
        input=script, capture_output=True, text=True,
    )  # fmt: skip
    asked, home, refused = (run.stdout.splitlines()[at + 1] for at in (0, 2, 4))
    assert asked == "|SET=DO  PARAM=NO|"
    assert home in ("|NO CONTACT   A1 |", "|A1 MAY RUN      |")
    assert refused == "|NO: NO CONTACT  |"
    told = section(PICO, "First power-on")
    says = ("FIND DRIVES?", "PARAM", "`NO CONTACT   A1`", "`A1 MAY RUN`", "NO: NO CONTACT")
    places = [told.index(one) for one in says]
    assert places == sorted(places)


def test_what_help_says_of_a_text_needs_no_row_above_it():
    """`:help NOT STARTED` of the live panel shows a row alone, its first cell and its second."""
    rows = [cells[1:3] for source in manuals.HELP for cells in manuals.rows(*source)]
    rows = [row for row in rows if len(row) == 2 and re.search("[A-Z]{2}", row[0])]
    assert len(rows) > 150
    for shown, said in rows:
        assert not re.match(r"(likewise|the same|as above)\b", said), (shown, said)
        assert re.search("[a-z]{3}", said), (shown, said)  # words, and not one more text


def test_every_key_is_explained():
    board = text("boards/pico/board.py")
    keys = re.findall(r'^    \("([A-Z_]+)", \d+\),$', board, re.M)
    assert len(keys) >= 14
    told = section(PANEL, "The keys")
    rows = " ".join(re.findall(r"^\| ([A-Z_, ]+) \|", told, re.M)).replace(",", "").split()
    assert sorted(keys) == sorted(rows)
    wiring = section(PICO, "Pins")
    for key in keys:
        assert re.search(rf"\bkey {key}\b", wiring), key


def test_every_setting_has_its_default_and_its_limits():
    told = {}
    for names, defaults, meaning in re.findall(
        r"^\| (`.*?`) \| (.*?) \| (.*) \|$", section(PANEL, "Settings"), re.M
    ):
        names = re.findall(r"`(\w+)`", names)
        defaults = json.loads(f"[{defaults}]")
        assert len(names) == len(defaults)
        told |= {name: (value, meaning) for name, value in zip(names, defaults)}
    assert {name: value for name, (value, _) in told.items()} == {
        name: list(value) if isinstance(value, tuple) else value
        for name, value in settings.DEFAULTS.items()
    }
    for name in ("reply_timeout_ms", "lost_ms"):
        _, _, lowest, highest, _ = next(row for row in settings.NUMBERS if row[0] == name)
        assert f"{lowest}...{highest}" in told[name][1], name
    for name, _, choices, _ in settings.CHOICES:
        shown = (choices[0], choices[-1]) if name == "baud" else choices
        assert all(str(choice) in told[name][1] for choice in shown), name
    assert f"{settings.SIZE_MAX} bytes" in section(PANEL, "Settings")


# ---- the workbench --------------------------------------------------------------------------


def test_every_command_of_the_scripts_has_a_row():
    table = section(TOOLS, "Scripts")
    told = {
        words.split()[0]
        for cell in re.findall(r"^\| (`.*?`) \|", table, re.M)
        for words in re.findall(r"`(.*?)`", cell)
    }
    assert told == set(COMMANDS)


def test_every_exit_status_of_the_panel_is_explained():
    told = section(TOOLS, "Scripts").partition("Exit status: ")[2]
    statuses = [int(number) for number in re.findall(r"(?:^|; )(\d+)\b", told)]
    panel = virtual_panel
    ours = [panel.FAILED, panel.NOT_UNDERSTOOD, panel.CRASHED, panel.NO_PORT, panel.INTERRUPTED]
    assert sorted(statuses) == sorted([0, 3, *ours])  # 3 is that of the command around it


def test_every_command_has_a_row():
    there = [path.name for path in (TOP / "tools").iterdir() if path.is_file() and not path.suffix]
    assert sorted(re.findall(r"^\| \[`\./tools/([\w-]+)`\]", text(TOOLS), re.M)) == sorted(there)


# ---- the version ----------------------------------------------------------------------------


def test_the_changes_begin_with_this_version():
    assert re.fullmatch(r"\d+\.\d+\.\d+", version.VERSION)
    assert re.findall(r"^## (.*)$", text(".github/CHANGELOG.md"), re.M)[0] == version.VERSION
