# SPDX-License-Identifier: MIT
"""The page without a server: ./tools/panel --web --static, handed out by somebody else."""

import functools
import http.server
import subprocess
import threading

import pytest

import web_bench
from program_bench import PANEL
from tiers import TOP
from web_bench import browsers, swept

INTERPRETERS = "host"

chromium = pytest.fixture(scope="module")(browsers)
browser = pytest.fixture(swept)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def written(folder, *options):
    return subprocess.run(
        [PANEL, "--web", "--static", folder, *options], capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Where the page is."""
    web_bench.require()
    folder = tmp_path_factory.mktemp("static") / "page"
    run = written(folder, "--drives", "1,2")
    assert run.returncode == 0, run.stderr
    handler = functools.partial(Quiet, directory=folder)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield "http://127.0.0.1:%d/" % server.server_port
    server.shutdown()


def test_the_panel_runs_in_the_browser_itself(browser, address):
    page = browser.open(address, "phone")
    page.shows("READY")
    page.press("START")
    page.shows("RUNNING")
    page.shows("10.00 Hz right", ".drive .state")
    page.click("[aria-label='A1: Trip']")
    page.shows("FAULT F0001")
    page.press("STOP")
    page.does("drive 2")
    page.shows("address=2 state=ready", "#said")
    assert page.complaints() == [] and page.axe() == []
    page.close()


def test_the_address_says_what_panel_it_is(browser, address):
    page = browser.open(address + "?drives=4=g110&keys=compact")
    page.shows("READY        A4")
    assert page.run("document.querySelectorAll('#keys .key').length") == 8
    page.close()


def test_an_address_that_makes_no_sense_says_so(browser, address):
    page = browser.open(address + "?drives=99")
    page.shows("has failed", "#status")
    page.close()


def test_a_jog_ends_when_the_page_is_frozen(browser, address):
    """The worker goes on without it."""
    page = browser.open(address)
    page.shows("READY")
    page.hold("#keys [data-key=JOG_RIGHT]")
    page.shows("running", ".drive .state")
    page.run("(() => { const end = Date.now() + 900; while (Date.now() < end); })()")
    page.shows("ready", ".drive .state")
    page.shows("READY")
    page.letGo()
    page.close()


def test_what_needs_more_than_a_browser_is_refused(tmp_path):
    for options, why in (
        (("--port", "/dev/ttyUSB0"), "--port is not for --static"),
        (("--bind", "0.0.0.0"), "--bind is for a server"),
        (("--script", "-"), "--script is not for --web"),
        (("--drives", "99"), "--drives"),
    ):
        run = written(tmp_path / "page", *options)
        assert run.returncode == 2 and why in run.stderr, run.stderr
        assert not (tmp_path / "page").exists()


def test_a_folder_of_somebody_else_stays_as_it_is(tmp_path):
    (tmp_path / "letter.txt").write_text("mine")
    run = written(tmp_path)
    assert run.returncode == 2 and "something else in it" in run.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


def test_a_page_is_written_anew(tmp_path):
    folder = tmp_path / "page"
    for _ in range(2):
        assert written(folder).returncode == 0
    names = {path.name for path in folder.iterdir()}
    assert {"index.html", "worker.js", "firmware.json", "micropython.wasm"} <= names
    assert 'content="worker"' in (folder / "index.html").read_text()
    assert str(TOP) not in (folder / "firmware.json").read_text()
