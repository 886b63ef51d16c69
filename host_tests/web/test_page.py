# SPDX-License-Identifier: MIT
"""The page in a real browser: what a person does there, and sees."""

import time

import pytest

import web_bench
from web_bench import browsers, servers, swept

INTERPRETERS = "host"

shared = pytest.fixture(scope="module")(servers)
served = pytest.fixture(servers)
chromium = pytest.fixture(scope="module")(browsers)
browser = pytest.fixture(swept)
SIZES = ("desktop", "phone")
STATE = "[aria-label='Drive A1'] .state"
# Of the shaft of the first motor, in degrees: each time that it stands elsewhere, for a while.
ANGLES = """
    new Promise((resolve) => {
      const shaft = document.querySelector(".shaft");
      const seen = [];
      new MutationObserver(() => {
        const angle = parseFloat(shaft.getAttribute("transform").slice("rotate(".length));
        if (angle !== seen.at(-1)) seen.push(angle);
        if (seen.length === 20) resolve(seen);
      }).observe(shaft, { attributes: true });
    })
"""


@pytest.fixture(scope="module")
def panel(shared):
    return shared("--drives", "1,2")


@pytest.fixture
def opens(panel, browser):
    """Opens pages. When the test is over, none may have complained; and the motor is stopped."""
    pages = []

    def open_one(*how):
        pages.append(browser.open(panel.link, *how))
        pages[-1].shows("READY")
        return pages[-1]

    yield open_one
    complaints = [page.complaints() for page in pages]
    for page in pages:
        page.press("STOP")
        page.close()
    assert not any(complaints)


@pytest.fixture
def page(opens, request):
    """At the size that the test asks for."""
    return opens(getattr(request, "param", "desktop"))


at_every_size = pytest.mark.parametrize("page", SIZES, indirect=True)


@at_every_size
def test_a_motor_is_started_set_and_stopped(page):
    page.press("START")
    page.shows("RUNNING")
    page.shows("10.00 Hz right", STATE)
    for _ in range(3):
        page.press("UP")
    page.shows("10.30 Hz right", STATE)
    page.press("REVERSE")
    page.shows("Hz left", STATE)
    page.press("REVERSE")
    for _ in range(3):
        page.press("DOWN")
    page.press("STOP")
    page.shows("READY")
    page.shows("ready · 0.00 Hz", STATE)


def test_a_motor_turns_to_its_side(opens):
    page = opens("desktop", None)
    page.press("START")
    page.shows("RUNNING")
    seen = page.run(ANGLES)
    steps = [(later - before) % 360 for before, later in zip(seen, seen[1:], strict=False)]
    assert all(0 < step < 180 for step in steps), seen


@at_every_size
def test_a_fault_is_shown_and_acknowledged(page):
    page.press("START")
    page.shows("RUNNING")
    page.click("[aria-label='A1: Trip']")
    page.shows("FAULT F0001")
    page.shows("F0001", STATE)
    time.sleep(1)  # somebody reads it
    page.press("STOP")
    page.shows("READY")
    page.shows("ready", STATE)  # the state comes a little after the display
    assert "F0001" not in page.text(STATE)


@at_every_size
def test_stop_is_always_on_the_screen(page):
    for place in ("0", "document.body.scrollHeight / 2", "document.body.scrollHeight"):
        page.run(f"window.scrollTo(0, {place})")
        is_there = page.run(
            """(() => {
              const box = document.getElementById("stop").getBoundingClientRect();
              const there = document.elementFromPoint(box.x + box.width / 2, box.y + 9);
              return there?.id === "stop";
            })()"""
        )
        assert is_there, place
        seen = page.run(
            """(() => {
              const { top, bottom } = document.getElementById("display").getBoundingClientRect();
              return top >= 0 && bottom <= innerHeight;
            })()"""
        )
        assert seen, "the display is in sight wherever START and JOG are"


@at_every_size
def test_nothing_hinders_anybody(page):
    page.press("START")
    page.shows("RUNNING")
    assert page.axe() == []


@at_every_size
def test_the_page_is_not_wider_than_the_screen(page):
    assert page.run("document.documentElement.scrollWidth <= innerWidth")


def test_a_jog_lasts_as_long_as_its_key_is_held(page):
    for begin, end in (
        (lambda: page.hold("#keys [data-key=JOG_RIGHT]"), page.letGo),
        (lambda: page.keyDown("l"), lambda: page.keyUp("l")),
    ):
        begin()
        page.shows("running", STATE)
        time.sleep(0.7)
        assert "running" in page.text(STATE)
        end()
        page.shows("ready", STATE)


def test_the_keyboard_types_keys_and_space_is_stop(page):
    page.type("s")
    page.shows("RUNNING")
    page.type("ArrowUp")
    page.shows("S: 10.1")
    page.type("ArrowDown")
    page.type(" ")
    page.shows("READY")


def test_what_is_typed_as_text_is_no_key(page):
    page.click("#command")
    for letter in "s s":
        page.type(letter)
    time.sleep(0.3)
    assert (
        "READY" in page.display() and page.run("document.querySelector('#command').value") == "s s"
    )
    page.does("load 1 80")
    page.shows("> load 1 80", "#said")


def test_a_window_that_loses_the_keyboard_lets_go(page):
    page.keyDown("l")
    page.shows("running", STATE)
    page.run("window.dispatchEvent(new Event('blur'))")
    page.shows("ready", STATE)
    page.keyUp("l")


def test_the_cable_is_pulled_and_put_back(page):
    page.click("[aria-label='A1: Pull the cable']")
    page.shows("NO CONTACT")
    page.shows("unplugged", STATE)
    page.click("[aria-label='A1: Plug it in']")
    page.shows("READY")


def test_noise_shows_in_the_counters(page):
    page.click("[data-do='line flip 0.01']")
    page.shows("bcc", "#counts")
    page.click("[data-do='line calm']")
    page.shows("READY")


def test_telegrams_are_told_in_words_and_can_be_paused(page):
    page.shows("read P", "#telegram-rows")
    page.shows(" x", "#telegram-rows td")
    page.click("#hold-telegrams")
    before = page.text("#telegram-rows")
    time.sleep(0.5)
    assert page.text("#telegram-rows") == before
    page.click("#hold-telegrams")


def test_time_stands_and_goes_on(page):
    page.choose("#speed", "0")
    page.shows("true x 0.0", "#true-speed")
    before = page.text("#clock")
    time.sleep(0.5)
    assert page.text("#clock") == before
    page.choose("#speed", "1")
    page.shows("true x 1.0", "#true-speed")


def test_two_fingers_hold_two_keys(opens):
    page = opens("phone")
    page.touch("#keys [data-key=JOG_RIGHT]")
    page.shows("running", STATE)
    page.touch("#keys [data-key=JOG_RIGHT]", "#stop")
    page.shows("STOP", "#keys .down")
    page.shows("ready", STATE)
    page.touch()


def test_a_parameter_is_edited_by_keys(browser, served):
    page = browser.open(served("--drives", "1,2").link)
    page.plays("parameter.txt")
    page.does("param 1 P1120")
    page.shows("P1120[0]=2.5", "#said")
    page.close()


def test_a_set_is_copied_from_drive_to_drive(browser, served):
    page = browser.open(served("--drives", "1=mm440,2=mm440").link, "phone")
    page.plays("parameter_set.txt")
    page.does("param 2 P1120")
    page.shows("P1120[0]=2.5", "#said")
    page.close()


def test_a_panel_with_eight_keys(browser, served):
    page = browser.open(served("--keys", "compact").link, "phone")
    page.shows("READY")
    assert page.run("document.querySelectorAll('#keys .key').length") == 8
    page.press("JOG", 0.5)
    page.press("START")
    page.shows("RUNNING")
    page.press("STOP")
    page.shows("READY")
    page.close()


def test_without_chromium_it_says_what_helps(monkeypatch):
    monkeypatch.setenv("PATH", "/nonexistent")
    assert "apt-get install chromium" in web_bench.missing()
    for name in ("CI", "USS_STRICT"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(pytest.skip.Exception):
        web_bench.require()
    monkeypatch.setenv("USS_STRICT", "1")
    with pytest.raises(pytest.fail.Exception):
        web_bench.require()
