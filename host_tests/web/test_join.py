# SPDX-License-Identifier: MIT
"""Two pages and a terminal at one panel: each shows the same display, and STOP works from any."""

import json
import subprocess

import pytest

from program_bench import PANEL, PATIENCE_S
from terminal_bench import terminals
from web_bench import browsers, servers, swept

INTERPRETERS = "host"

served = pytest.fixture(servers)
chromium = pytest.fixture(scope="module")(browsers)
browser = pytest.fixture(swept)
terminal = pytest.fixture(terminals)

SUPERVISED = "param 1 P2014[0] 1000"  # START does not ask first


def test_two_pages_and_a_terminal_show_one_panel_and_each_stops_its_motor(
    served, browser, terminal
):
    panel = served()
    first, second = browser.open(panel.link), browser.open(panel.link, "phone")
    console = terminal("--join", panel.link)
    fronts = (first, second, console)
    console.shows("READY        A1")
    first.does(SUPERVISED)
    stops = (
        lambda: console.type(" "),
        lambda: first.press("STOP"),
        lambda: second.press("STOP"),
    )
    for stop in stops:
        first.press("START")
        for front in fronts:
            front.shows("RUNNING      A1")
        stop()
        for front in fronts:
            front.shows("READY        A1")
    console.type("q")
    assert console.ends() == 0 and console.is_as_before()
    assert "USS panel: left; it goes on." in console.screen.text()
    first.press("START")
    second.shows("RUNNING      A1")
    first.press("STOP")
    second.shows("READY        A1")


def joined(*options):
    return subprocess.Popen(
        [PANEL, "--join", *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def test_a_program_of_your_own_joins_with_lines(served):
    other = joined(served().link, "--lines")
    other.stdin.write('{"t":"hello","v":1}\n')
    other.stdin.flush()
    told = {}
    while told.get("t") != "hello":
        told = json.loads(other.stdout.readline())
    assert told["joined"] == 1
    other.stdin.close()
    assert other.wait(PATIENCE_S) == 0
    other.stdout.close()
    other.stderr.close()


@pytest.mark.parametrize(
    "link, status, why",
    (
        ("http://127.0.0.1:1/#token", 1, "no panel is there"),
        ("nonsense", 2, "the link that --web prints"),
        ("http://127.0.0.1:1/", 2, "the link that --web prints"),
    ),
)
def test_a_link_to_nowhere_is_told(link, status, why):
    other = joined(link)
    *_, said = other.communicate(timeout=PATIENCE_S)[1].splitlines()  # behind what is fetched
    assert other.returncode == status and said.startswith("panel: ") and why in said, said


def test_a_wrong_token_is_told(served):
    other = joined(served().base + "#wrong")
    said = other.communicate(timeout=PATIENCE_S)[1]
    assert other.returncode == 1 and "take the link that it has printed" in said, said


def test_a_program_that_does_not_listen_any_more_ends_without_a_traceback(served):
    other = joined(served().link, "--lines")
    assert json.loads(other.stdout.readline())
    other.stdout.close()
    assert other.wait(PATIENCE_S) == 1
    assert "Traceback" not in (said := other.stderr.read()), said
    other.stdin.close()
    other.stderr.close()


def test_the_end_of_the_panel_is_told(served):
    panel = served("--drives", "2")
    other = joined(panel.link)
    assert json.loads(other.stdout.readline())
    panel.ends()
    said = other.communicate(timeout=PATIENCE_S)[1]
    assert other.returncode == 1 and "has ended" in said, said
