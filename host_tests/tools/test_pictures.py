# SPDX-License-Identifier: MIT
"""The pictures of the manuals: each is as panel and tables make it now, and can be read."""

import functools
import operator
import re
import xml.etree.ElementTree

import pytest

from boards.sim.board import COMPACT_KEYS, KEYS
from panel.keys.compact import FUNCTIONS
from panel.menu.main import LISTS
from tiers import TOP
from tools.benching import beside_s7
from tools.drawing.layouts import LAYOUTS
from tools.drawing.picture import picture as drawn
from tools.pictures import bus, exchange, pages, running
from tools.pictures.__main__ import FOLDER, files
from tools.pictures.lcd import ACROSS, DOWN, PITCH, ROW_PITCH
from tools.pictures.svg import COLOURS, DEPTH, HEIGHT, Picture, width, wrapped
from uss.timing import Timing

INTERPRETERS = "host"

PHONE = 358  # pixels that a manual has for a picture on a phone
SMALLEST = 8  # pixels of a font there
SVG = "{http://www.w3.org/2000/svg}"


PICTURES = {
    **files(),
    **{f"boards/{board}/pins.svg": functools.partial(drawn, board) for board in LAYOUTS},
}


@functools.cache
def made(path):
    return PICTURES[path]()


def named(name):
    return made(f"{FOLDER}/{name}.svg")


def words(picture):
    return [box.text for box in picture.texts]


@pytest.mark.parametrize("path", PICTURES)
def test_what_is_there_is_what_the_panel_and_the_tables_make(path):
    tool = "drawing" if path.startswith("boards/") else "pictures"
    assert (TOP / path).read_text() == made(path).svg(), f"python3 tools/{tool} makes it anew"


def test_there_is_no_picture_that_nobody_makes():
    folders = (TOP / FOLDER, TOP / "boards")
    there = [path.relative_to(TOP).as_posix() for at in folders for path in at.rglob("*.svg")]
    assert sorted(there) == sorted(PICTURES)


@pytest.mark.parametrize("path", PICTURES)
def test_no_text_overlaps_another_and_none_leaves_the_picture(path):
    picture = made(path)
    for at, box in enumerate(picture.texts):
        assert box.left >= 0 and box.right <= picture.across, box
        assert box.top >= 0 and box.bottom <= picture.down, box
        for other in picture.texts[:at]:
            assert not box.overlaps(other), (box, other)


@pytest.mark.parametrize("path", PICTURES)
def test_the_texts_can_be_read_on_a_phone(path):
    picture = made(path)
    for box in picture.texts:
        font = (box.bottom - box.top) / (HEIGHT + DEPTH)
        assert font * min(1, PHONE / picture.across) >= SMALLEST, box


@pytest.mark.parametrize("path", PICTURES)
def test_it_says_what_it_is_and_needs_nothing_from_elsewhere(path):
    root = xml.etree.ElementTree.fromstring((TOP / path).read_text())
    assert len(root.find(SVG + "title").text) > 5
    assert len(root.find(SVG + "desc").text) > 40
    for part in root.iter():
        assert part.tag in {SVG + name for name in (
            "svg", "title", "desc", "style", "defs", "rect", "path", "text", "g", "use"
        )}  # fmt: skip
        for name, value in part.attrib.items():
            assert name != "href" or value.startswith("#"), value
            assert "url(" not in value


@pytest.mark.parametrize("path", PICTURES)
def test_each_colour_has_another_one_for_the_dark(path):
    text = (TOP / path).read_text()
    style = text[text.index("<style>") : text.index("</style>")]
    light, dark = style.split("@media (prefers-color-scheme: dark)")
    classes = set(re.findall(r"^\.([\w-]+){", light, re.M))
    assert classes == set(re.findall(r"^\.([\w-]+){", dark, re.M))
    used = {name for names in re.findall(r' class="([^"]*)"', text) for name in names.split()}
    assert used == classes


def brightness(colour):
    """Of sRGB, as WCAG has it."""
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    red, green, blue = (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


@pytest.mark.parametrize(
    "letters, paper",
    [
        *((name, "paper") for name in ("ink", "pale", "blue", "green", "orange", "violet", "red")),
        *((name, "box") for name in ("ink", "pale", "blue", "green", "orange", "violet", "red")),
        ("on cap", "cap"), ("on plate", "plate"), ("white", "go"), ("white", "stop"),
        ("dot", "cell"), ("white", "circuit"), ("on circuit", "circuit"), ("white", "module"),
    ],
)  # fmt: skip
def test_what_is_written_stands_out_by_day_and_by_night(letters, paper):
    for at in (0, 1):
        low, high = sorted(brightness(COLOURS[name][at]) for name in (letters, paper))
        assert (high + 0.05) / (low + 0.05) >= 4.2, at


# --- what is to be seen -------------------------------------------------------------------------


def test_the_front_has_the_keys_of_the_board_each_once():
    assert sorted(words(named("panel"))) == sorted(KEYS)


def test_the_front_with_eight_keys_says_what_each_is_behind_fn():
    shown = words(named("panel_eight_keys"))
    assert [word for word in shown if word in COMPACT_KEYS] == list(COMPACT_KEYS)
    behind = [name for row in FUNCTIONS.values() for name in row[1:] if name]
    assert len(behind) == 6
    assert sorted(word.lstrip("^ ") for word in shown if "^" in word) == sorted(behind)
    assert "^ SET" in shown and "^^ EDIT" in shown


def test_the_menu_has_every_list_and_the_manual_has_what_is_seen_there():
    shown = words(named("menu"))
    assert all(text.decode() in shown for text, _ in LISTS) and len(LISTS) > 10
    manual = (TOP / "firmware" / "panel" / "README.md").read_text()
    for tile in pages.lists():
        _, entry = pages.seen(tile).rows
        assert entry.startswith(">") and entry[1:].strip() in manual, entry


def test_the_pages_show_what_they_are_called():
    rows = {tile.name: pages.seen(tile).rows for tile in pages.PAGES}
    assert rows["Home page"] == ("S: 10.0 F:  0.00", "READY        A1 ")
    assert rows["A jog, as long as its key is held"][1] == "JOG RIGHT    A1 "
    assert rows["START asks"] == ("P2014=0: IT RUNS", "SET=FIX START=GO")
    assert rows["A drive is lost while it runs"] == ("NO CONTACT,     ", "MAY RUN      A1 ")
    assert rows["A value is being changed"][1] == "P1000:     6↕A1 "


def test_the_dots_of_a_display_are_those_of_its_characters():
    """Put together again from the file: where each is drawn, and what."""
    root = xml.etree.ElementTree.fromstring((TOP / FOLDER / "panel.svg").read_text())
    drawn = root.findall(f".//{SVG}use[@x]")
    placed = {
        (round(float(use.get("x")) / PITCH), round(float(use.get("y")) / ROW_PITCH)): chr(
            int(use.get("href")[2:], 16)
        )
        for use in drawn
        if use.get("href") != "#cells"
    }
    rows = ["".join(placed.get((x, y), " ") for x in range(ACROSS)) for y in range(DOWN)]
    assert rows == ["S: 10.0 F:  0.00", "READY        A1 "]
    colon = next(path for path in root.iter(SVG + "path") if path.get("id") == "c3A")
    assert colon.get("d").count("M") == 8  # a colon has two squares of four dots


def test_the_times_of_an_exchange_are_those_of_the_line():
    shown = words(named("exchange"))
    each, all_us = exchange.times(19200)
    assert sum(each.values()) == all_us == Timing(19200).exchange_us(12, 1146)
    assert list(each.values()) == [1146, 9167, 1146, 9167]
    for text in ("1.15 ms", "9.17 ms", "20.63 ms", "2.29 ms", "115200", "291", "187500"):
        assert text in shown, text
    heard = exchange.telegrams()
    for kind, data in heard.items():
        assert len(data) == 16 and functools.reduce(operator.xor, data) == 0
        assert shown.count(data[-1:].hex().upper()) >= 1, kind
    assert {"STX", "LGE", "ADR", "PKE", "IND", "PWE", "STW", "HSW", "ZSW", "HIW"} < set(shown)
    assert "04 7F" in shown  # ON


def test_the_line_of_the_virtual_board_keeps_these_times():
    world = running.panel()
    each, _ = exchange.times(19200)
    heard = world.wire.log.last(30)
    intervals = [
        (reply_us - request_us, request)
        for (request_us, asks, request), (reply_us, answers, _) in zip(heard, heard[1:])
        if asks and not answers
    ]
    assert len(intervals) > 10
    for interval_us, request in intervals:
        assert interval_us >= each[exchange.REQUEST] + each[exchange.DELAY] or len(request) != 16


def test_the_bars_are_as_long_as_their_figures():
    page = (TOP / "tools" / "bench.md").read_text()
    shown = words(named("bench"))
    root = xml.etree.ElementTree.fromstring((TOP / FOLDER / "bench.svg").read_text())
    bars = [float(rect.get("width")) for rect in root.findall(SVG + "rect")][1:]
    rows = beside_s7.rows_of(page)
    wanted = []
    for row in rows:
        limit = row.rates[beside_s7.WIRE]
        assert f"{row.baud} baud" in shown and f"{beside_s7.WIRE} {limit}" in shown
        for name, rate in row.rates.items():
            if name != beside_s7.WIRE:
                assert name in shown and str(rate) in shown
                wanted += [1, rate / limit]
    assert [bar / max(bars) for bar in bars] == pytest.approx(wanted, abs=0.001)


def test_the_line_has_every_drive_whose_terminals_the_manual_has():
    shown = " ".join(words(named("bus")))
    listed = {drive.name: drive.terminals for drive in bus.drives()}
    assert listed["MICROMASTER 420"] == ("14", "15", "2")
    assert listed["SINAMICS V20"] == ("6", "7", "5") and len(listed) >= 6
    for name, terminals in listed.items():
        assert name in shown and " ".join(terminals) in shown
    assert shown.count("120 ohm at its two ends") == 1 and shown.count("120 ohm") == 3


# --- how texts are measured ---------------------------------------------------------------------


def test_a_text_is_as_wide_as_its_characters():
    assert width("Wi", 10) == pytest.approx(9.44 + 2.22)
    assert width("Wi", 10, bold=True) == pytest.approx(9.44 + 2.78)
    assert width("Wi", 10, mono=True) == pytest.approx(12)
    with pytest.raises(KeyError):
        width("é", 10)


def test_a_long_text_is_wrapped_between_words():
    assert wrapped("START or STOP or JOG", 60, 10) == ["START or", "STOP or", "JOG"]
    assert wrapped("unbreakable", 10, 10) == ["unbreakable"]


def test_two_texts_in_one_place_are_found():
    picture = Picture(100, "", "")
    for y in (20, 24, 40):
        picture.text(10, y, "START")
    first, second, third = picture.texts
    assert first.overlaps(second) and second.overlaps(first)
    assert not first.overlaps(third)


def test_text_is_written_as_text():
    picture = Picture(100, "a < b", 'c & "d"')
    picture.text(10, 20, "a<b & c", anchor="middle")
    root = xml.etree.ElementTree.fromstring(picture.svg())
    assert root.find(SVG + "title").text == "a < b"
    assert root.find(SVG + "text").text == "a<b & c"
