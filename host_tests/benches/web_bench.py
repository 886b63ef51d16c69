# SPDX-License-Identifier: MIT
"""A real Chromium before the page of ./tools/panel --web.

In use:

    served = pytest.fixture(servers)      # a panel lasts as long as its test
    chromium = pytest.fixture(scope="module")(browsers)
    browser = pytest.fixture(swept)

    def test_it(served, browser):
        page = browser.open(served("--drives", "1,2").link, "phone")
        page.shows("READY")                     # on the display; gives up after a while
        page.press("START")
"""

import json
import shutil
import signal
import socket
import subprocess
import threading
import time

import pytest

from conftest import strict
from program_bench import PANEL, PATIENCE_S, as_in_a_terminal
from tiers import TOP

NODE = TOP / "build/node/node"
PACKAGES = TOP / "build/browser"
DRIVER = TOP / "host_tests/web/driver.mjs"
# The first that is there: the one without windows takes three quarters of the processor's time.
CHROMIUMS = (
    "chromium-headless-shell", "chromium", "chromium-browser", "google-chrome-stable",
    "google-chrome",
)  # fmt: skip
PRESS_S = 0.06
DISPLAY = "#display-text"
FASTEST, LONG_MS = 20, 30_000
A_WHILE_MS = 1_000  # nobody looks for what the display showed before that
SLOWLY_S = 15  # a busy machine passes some seconds more than it was to, and menus close by time
LONGER = 1.4  # than a key has to be held
SPEED = 5  # at which scripts are played: the shortest press with the mouse is no longer than a tap
NOTE_KEYS = """
    window.noted = 0;
    const button = document.querySelector(`#keys [data-key=${%s}]`);
    new MutationObserver(() => {
      if (!button.classList.contains("down")) window.noted ||= Date.now();
    }).observe(button, { attributes: true });
"""
# What the display shows from now on, and what it shows now. At high speed a message stands there
# for 0.4 s, in which a busy machine may not look.
NOTE_DISPLAY = """
    const display = document.querySelector(%s);
    const note = () => window.seen.push(display.textContent);
    window.seen = [];
    note();
    window.looks ||= new MutationObserver(note);
    window.looks.observe(display, { characterData: true, childList: true, subtree: true });
"""
# Opens a connection, and then says what there is to say: [what came, how it was closed].
HEARD = """
    (async () => {
      const { link, says } = %s;
      const socket = new WebSocket(link);
      const heard = [];
      const closed = new Promise((resolve) => {
        socket.onclose = (event) => resolve(event.code);
      });
      socket.onmessage = ({ data }) => {
        data.split("\\n").forEach((line) => heard.push(JSON.parse(line)));
      };
      await new Promise((resolve) => { socket.onopen = socket.onerror = resolve; });
      if (socket.readyState === WebSocket.OPEN) says.forEach((one) => socket.send(one));
      const late = new Promise((resolve) => setTimeout(resolve, 1500, 0));
      const code = await Promise.race([closed, late]);
      socket.close();
      return [heard.filter((one) => one.t === "error").map((one) => one.text), code];
    })()
"""


def missing():
    """What the tests in a browser lack; "" if nothing."""
    if chromium() is None:
        return "there is no Chromium:  apt-get install chromium"
    if not (PACKAGES / "node_modules").is_dir():
        return "build/browser lacks playwright-core:  tools/test fetches it where Chromium is"
    return ""


def chromium():
    return next(filter(None, map(shutil.which, CHROMIUMS)), None)


def require():
    """Skips the test, or fails it where nothing may be missing."""
    lack = missing()
    if lack and strict():
        pytest.fail(lack)
    if lack:
        pytest.skip(lack)


class Served:
    """./tools/panel --web. link: what it has printed."""

    def __init__(self, *options):
        self.process = subprocess.Popen(
            [PANEL, "--web", *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=as_in_a_terminal,
        )
        said = self.process.stdout.readline()
        assert "http://" in said, said + self.process.stderr.read()
        self.link = said.split(": ", 1)[1].strip()
        self.base, _, self.token = self.link.partition("#")

    def ends(self, number=signal.SIGINT):
        self.process.send_signal(number)
        return self.process.wait(PATIENCE_S)


class Browser:
    """Chromium, and pages in it, each in a window of its own."""

    def __init__(self):
        self.process = subprocess.Popen(
            [NODE, DRIVER, chromium(), PACKAGES],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def open(self, link, size="desktop", motion="reduce"):
        """motion: "reduce", or None: motors turn, which costs much of a processor."""
        return Page(self, self.call(None, "open", link, size, motion))

    def call(self, page, deed, *values):
        line = json.dumps({"page": page, "do": deed, "with": values})
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        assert "error" not in answer, (deed, values, answer["error"])
        return answer["value"]

    def close(self):
        self.process.stdin.close()
        self.process.wait(PATIENCE_S)


class Page:
    def __init__(self, browser, number):
        self.browser = browser
        self.number = number

    def __getattr__(self, deed):
        """A deed of driver.mjs."""
        return lambda *values: self.browser.call(self.number, deed, *values)

    def shows(self, text, where=DISPLAY, patience_s=PATIENCE_S):
        try:
            self.browser.call(self.number, "shows", where, text, int(patience_s * 1000))
        except AssertionError:
            raise AssertionError((text, self.text(where))) from None

    def press(self, key, s=PRESS_S):
        """A press with the mouse, as short as a person makes one."""
        self.hold(f"#keys [data-key={key}]")
        time.sleep(s)
        self.letGo()

    def plays(self, script):
        """Do what a script of tools/examples does, with the mouse, at high speed."""
        self.choose("#speed", str(SPEED))
        self._notes_display()
        for line in (TOP / "tools/examples" / script).read_text().splitlines():
            word, _, rest = line.partition("#")[0].strip().partition(" ")
            if word == "press":
                self._notes_display()
                self.choose("#speed", "1")
                self.press(rest, 0)
                self.choose("#speed", str(SPEED))
            elif word == "hold":
                self._notes_display()
                key, ms = rest.split()
                self._holds(key, int(ms))
            elif word == "wait":
                self._waits(int(rest))
            elif word == "expect":
                self._has_shown(rest)
            elif word not in ("", "lcd", "drive"):
                self.does(line)
        self.choose("#speed", "1")

    def _has_shown(self, text):
        """Since the last key, or the last wait that was not a short one."""
        deadline = time.monotonic() + PATIENCE_S
        while not any(text in each or text in " ".join(each.split()) for each in self._seen()):
            assert time.monotonic() < deadline, (text, self._seen())
            time.sleep(0.05)

    def _notes_display(self):
        self.run(NOTE_DISPLAY % json.dumps(DISPLAY))

    def _seen(self):
        return self.run("window.seen")

    def _holds(self, key, ms):
        """So long by the panel's clock: on a busy machine its time passes more slowly."""
        self.hold(f"#keys [data-key={key}]")
        self._waits_until(self._clock_s() + ms / 1000 * LONGER)
        self.letGo()

    def _waits(self, ms):
        """So much of the panel's time; a long one passes faster."""
        if ms < LONG_MS:
            time.sleep(ms / 1000 / SPEED)
            if ms >= A_WHILE_MS:
                self._notes_display()
            return
        end_s = self._clock_s() + ms / 1000
        for speed, until_s in ((FASTEST, end_s - SLOWLY_S), (SPEED, end_s)):
            self.choose("#speed", str(speed))
            self._waits_until(until_s, speed)
        self._notes_display()

    def _waits_until(self, clock_s, speed=SPEED):
        """Looks at the clock when it may be time, for each look keeps the whole browser busy."""
        deadline = time.monotonic() + PATIENCE_S
        while (left_s := clock_s - self._clock_s()) > 0:
            assert time.monotonic() < deadline, self.text("#clock")
            time.sleep(max(0.03, left_s / speed))

    def _clock_s(self):
        """The panel's time, as the page shows it: hours, minutes, seconds."""
        hours, minutes, seconds = map(float, self.text("#clock").split(":"))
        return 3600 * hours + 60 * minutes + seconds

    def notes_keys(self, key):
        """From now on `noted` tells when this key came up, whoever held it."""
        self.run(NOTE_KEYS % json.dumps(key))

    def noted(self):
        """Seconds since 1970."""
        deadline = time.monotonic() + PATIENCE_S
        while not (ms := self.run("window.noted")):
            assert time.monotonic() < deadline
            time.sleep(0.02)
        return ms / 1000

    def hears(self, source):
        """What became of a connection of its own that this page opened: `HEARD`."""
        return self.run(HEARD % source)

    def type(self, letter):
        self.keyDown(letter)
        time.sleep(PRESS_S)
        self.keyUp(letter)

    def does(self, command):
        """A command of the script language."""
        self.fill("#command", command)
        self.click("#command-form button")

    def display(self):
        return self.text(DISPLAY)


def servers():
    """A fixture: makes `Served`, and ends them."""
    require()
    made = []

    def make(*options):
        made.append(Served(*options))
        return made[-1]

    yield make
    for one in made:
        if one.process.poll() is None:
            one.ends()


def browsers():
    """A fixture: a `Browser`, for all tests of a file."""
    require()
    browser = Browser()
    yield browser
    browser.close()


def swept(chromium):
    """A fixture: that one; what a test leaves open is closed."""
    yield chromium
    chromium.call(None, "sweep")


class Cable:
    """Between a browser and a server: what it carries, until somebody pulls it."""

    def __init__(self, base):
        self._far = ("127.0.0.1", int(base.rstrip("/").rpartition(":")[2]))
        self._is_pulled = False
        self._ends = []
        self._near = socket.create_server(("127.0.0.1", 0))
        self.base = "http://127.0.0.1:%d/" % self._near.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def pull(self):
        """Nothing passes any more, and nobody is told."""
        self._is_pulled = True

    def reset(self):
        """Ends the connections that there are; new ones are carried."""
        for one in self._ends:
            one.close()

    def close(self):
        self._near.close()

    def _accept(self):
        while True:
            try:
                one, _ = self._near.accept()
            except OSError:
                return
            other = socket.create_connection(self._far)
            self._ends += [one, other]
            for way in ((one, other), (other, one)):
                threading.Thread(target=self._carry, args=way, daemon=True).start()

    def _carry(self, source, sink):
        try:
            while data := source.recv(65_536):
                if not self._is_pulled:
                    sink.sendall(data)
            sink.shutdown(socket.SHUT_WR)
        except OSError:
            pass
