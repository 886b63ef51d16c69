# SPDX-License-Identifier: MIT
"""The page's connection: what happens when it breaks, who is let in, and several pages at once."""

import ipaddress
import json
import subprocess
import time
from urllib import error, parse, request

import pytest

from tiers import TOP
from web_bench import Cable, browsers, servers, swept

INTERPRETERS = "host"

shared = pytest.fixture(scope="module")(servers)
served = pytest.fixture(servers)
chromium = pytest.fixture(scope="module")(browsers)
browser = pytest.fixture(swept)
SERVER = TOP / "build/server/bin/python"
STATE = "[aria-label='Drive A1'] .state"
JOG = "#keys [data-key=JOG_RIGHT]"
JOG_ENDS_S = 0.4
# What the watching page takes to hear of it, on a machine that does other things as well.
HEARS_S = 0.15
ALONE_S = 2
LINK = "{ link: %s, says: %s }"


@pytest.fixture(scope="module")
def panel(shared):
    return shared("--drives", "1,2")


@pytest.fixture
def watcher(panel, browser):
    """A page that looks on."""
    page = browser.open(panel.link)
    page.shows("READY")
    yield page
    page.press("STOP")
    page.shows("READY")
    page.close()


def jogs(page, watcher):
    """The page holds a jog; the watcher notes when it ends."""
    page.shows("READY")
    page.hold(JOG)
    watcher.shows("running", STATE)
    time.sleep(0.3)
    watcher.notes_keys("JOG_RIGHT")


def socket_of(panel, token=None):
    return "%spanel?token=%s" % (panel.base.replace("http", "ws"), token or panel.token)


# --- when the connection breaks -----------------------------------------------------------------


@pytest.mark.parametrize("how", ("close", "reload", "hang", "hide", "goto"))
def test_a_jog_ends_when_its_page_goes(how, browser, panel, watcher):
    page = browser.open(panel.link)
    jogs(page, watcher)
    gone_s = time.time()
    if how == "hide":  # another tab is in front
        page.run(
            """Object.defineProperty(document, "visibilityState", { value: "hidden" });
            document.dispatchEvent(new Event("visibilitychange"))"""
        )
    elif how == "hang":
        page.run("(() => { const end = Date.now() + 1500; while (Date.now() < end); })()")
    elif how == "goto":
        page.goto("about:blank")
    else:
        getattr(page, how)()
    ended_s = watcher.noted()
    print("%s: the key came up after %d ms" % (how, 1000 * (ended_s - gone_s)))
    assert ended_s - gone_s <= JOG_ENDS_S + HEARS_S
    watcher.shows("ready", STATE)
    if how != "close":
        page.close()


def test_a_jog_ends_when_the_network_cable_is_pulled(browser, panel, watcher):
    cable = Cable(panel.base)
    page = browser.open(cable.base + "#" + panel.token)
    jogs(page, watcher)
    gone_s = time.time()
    cable.pull()
    ended_s = watcher.noted()
    print("the key came up after %d ms" % (1000 * (ended_s - gone_s)))
    assert ended_s - gone_s <= JOG_ENDS_S + HEARS_S
    watcher.shows("ready", STATE)
    page.close()
    cable.close()


def test_a_motor_is_stopped_when_nobody_is_left(browser, panel):
    page = browser.open(panel.link)
    page.shows("READY")
    page.press("START")
    page.shows("RUNNING")
    page.close()
    time.sleep(ALONE_S + 1)
    page = browser.open(panel.link)
    page.shows("OFF1", "#telegram-rows")
    page.shows("READY")
    page.close()


def test_a_motor_runs_on_while_somebody_is_left(browser, panel, watcher):
    page = browser.open(panel.link)
    page.shows("READY")
    page.press("START")
    page.shows("RUNNING")
    page.close()
    time.sleep(ALONE_S + 1)
    assert "RUNNING" in watcher.display()


def test_a_page_comes_back_by_itself(browser, served):
    panel = served()
    cable = Cable(panel.base)
    page = browser.open(cable.base + "#" + panel.token)
    page.shows("READY")
    cable.reset()
    page.shows("No connection", "#status")
    page.shows("Connected", "#status")
    page.press("UP")
    page.shows("S: 10.1")
    page.close()
    cable.close()


def test_the_page_says_that_the_panel_has_ended(browser, served):
    panel = served()
    page = browser.open(panel.link)
    page.shows("READY")
    assert panel.ends() == 0
    page.shows("the panel has ended", "#status")
    page.close()


# --- several pages ------------------------------------------------------------------------------


def test_stop_works_from_any_page(browser, panel, watcher):
    page = browser.open(panel.link, "phone")
    page.shows("READY")
    watcher.press("START")
    page.shows("RUNNING")
    page.tap("#stop")
    watcher.shows("READY")
    page.hold(JOG)
    watcher.shows("running", STATE)
    watcher.press("STOP")
    page.shows("ready", STATE)
    page.letGo()
    page.close()


def test_an_answer_goes_to_the_page_that_asked(browser, panel, watcher):
    page = browser.open(panel.link)
    page.shows("READY")
    page.does("param 1 P1120")
    page.shows("P1120[0]", "#said")
    assert "P1120[0]" not in (watcher.text("#said") or "")
    page.close()


# What waits for a page that has not read for a while, in which another one has come.
WAITING = """
import asyncio
from tools.web.server import Outbox

async def main():
    outbox = Outbox()
    for kind in ("drives", "done", "hello", "state", "drives"):
        outbox.put({"t": kind})
    print(*(message["t"] for message in await outbox.get()))

asyncio.run(main())
"""


def test_a_page_hears_which_drives_there_are_before_how_they_are(panel):
    told = subprocess.check_output([SERVER, "-B", "-c", WAITING], cwd=TOP, text=True)
    assert told.split() == ["hello", "state", "drives", "done"]


# --- who is let in ------------------------------------------------------------------------------


def test_a_telephone_gets_an_address_and_no_name(served):
    """Nobody in the network but this machine knows its name."""
    host = parse.urlsplit(served("--bind", "0.0.0.0").link).hostname
    assert not ipaddress.ip_address(host).is_unspecified


def test_a_wrong_token_is_refused(browser, panel):
    page = browser.open(panel.base + "#wrong")
    for _ in range(3):  # it does not become another reason while the page tries again
        page.shows("does not let this page in", "#status")
        time.sleep(0.5)
    assert "does not let this page in" in page.text("#status")
    page.close()


def test_another_origin_is_refused(browser, panel, served):
    page = browser.open(served().link)
    page.goto("about:blank")  # which forbids nothing of its own
    heard, code = page.hears(LINK % (json.dumps(socket_of(panel)), "[]"))
    assert not heard and code == 1006
    page.close()


@pytest.mark.parametrize(
    "headers, why",
    (
        ({}, "from another site"),
        ({"Origin": "http://example.com"}, "from another site"),
        ({"Origin": "null"}, "from another site"),
        ({"Host": "example.com", "Origin": "http://example.com"}, "from another site"),
        ({"Origin": "BASE", "token": "wrong"}, "a wrong token"),
        ({"Origin": "BASE", "token": ""}, "a wrong token"),
    ),
)
def test_who_is_refused_and_why(headers, why, panel):
    headers = {name: value.replace("BASE", panel.base[:-1]) for name, value in headers.items()}
    token = headers.pop("token", panel.token)
    asked = request.Request(
        panel.base + "panel?token=" + token,
        headers={
            "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
            "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", **headers,
        },
    )  # fmt: skip
    with pytest.raises(error.HTTPError) as refusal:
        request.urlopen(asked)
    assert refusal.value.code == 403 and why in refusal.value.read().decode()


def test_a_name_that_somebody_has_pointed_here_gets_no_page(panel):
    with pytest.raises(error.HTTPError) as refusal:
        request.urlopen(request.Request(panel.base, headers={"Host": "example.com"}))
    assert refusal.value.code == 403


def test_nothing_but_the_page_is_handed_out(panel):
    for name in ("../server.py", "..%2fserver.py", "page/", "server.py", ".npmrc"):
        with pytest.raises(error.HTTPError) as refusal:
            request.urlopen(panel.base + name)
        assert refusal.value.code == 404, name


@pytest.mark.parametrize(
    "says, errors, code",
    (
        ("['down STOP', '[1]', '7']", ["no message of this kind"] * 3, 0),
        (
            """['{"t":"down"}', '{"t":"down","key":"NOPE"}']""",
            ["down wants key", "no key NOPE"],
            0,
        ),
        ("[new Uint8Array(9)]", [], 1000),
        ("['x'.repeat(100000)]", [], (1009, 1006)),  # the rest of it may find the door closed
        ("Array(1000).fill('{}')", None, 1008),
    ),
)
def test_whatever_a_page_says_the_panel_runs_on(says, errors, code, panel, watcher):
    heard, closed = watcher.hears(LINK % (json.dumps(socket_of(panel)), says))
    assert closed in (code if isinstance(code, tuple) else (code,))
    if errors is not None:
        assert len(heard) == len(errors), heard
        for text, why in zip(heard, errors, strict=True):
            assert why in text
    watcher.press("UP")
    watcher.shows("S: 10.1")
    watcher.press("DOWN")
    watcher.shows("S: 10.0")
