# SPDX-License-Identifier: MIT
"""Measures the page in a real Chromium: how soon it is there, how soon a key is on the display,
and whether its time is the real one, with five drives at 19200 baud.

    build/pytest/bin/python host_tests/web/figures.py [--runs 5] [--seconds 60] [--static]

Exit status 1: the median of the runs misses a bar.
"""

import argparse
import functools
import http.server
import statistics
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "benches")]

from program_bench import PANEL  # noqa: E402
from web_bench import Browser, Served, missing  # noqa: E402

DRIVES = "1,2,3,4,5"
PRESSES = 20
# What is measured, in which unit, and its bar.
BARS = (("drawn", "ms", 2000), ("key to display", "ms", 150), ("error of time", "%", 1))

# Until the display shows something, since somebody asked for the page.
DRAWN = """new Promise((resolve) => {
  const text = document.getElementById("display-text");
  const look = () => (text.textContent.trim() ? resolve(performance.now()) : setTimeout(look, 5));
  look();
})"""
# From a key that goes down to another picture on the display, again and again.
KEY = """(async () => {
  const text = document.getElementById("display-text");
  const button = document.querySelector("#keys [data-key=UP]");
  const tell = (kind) => button.dispatchEvent(new PointerEvent(kind, { pointerId: 1 }));
  button.setPointerCapture = () => {}; // a finger of a script cannot be captured
  const found = [];
  for (let press = 0; press < %d; press += 1) {
    await new Promise((resolve) => setTimeout(resolve, 300 + 37 * (press %% 7)));
    const before = text.textContent;
    const began = performance.now();
    tell("pointerdown");
    while (text.textContent === before) await new Promise(requestAnimationFrame);
    found.push(performance.now() - began);
    tell("pointerup");
  }
  return found;
})()"""
# The panel's time against the real one, in percent: from one change of the clock to another.
TIME = """(async () => {
  const clock = document.getElementById("clock");
  const seconds = () => clock.textContent.split(":").reduce((sum, part) => 60 * sum + +part, 0);
  const change = () => new Promise((resolve) => {
    const seen = new MutationObserver(() => {
      seen.disconnect();
      resolve([performance.now() / 1000, seconds()]);
    });
    seen.observe(clock, { childList: true });
  });
  const [began, first] = await change();
  await new Promise((resolve) => setTimeout(resolve, %d * 1000));
  const [ended, last] = await change();
  return 100 * Math.abs((last - first) / (ended - began) - 1);
})()"""


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Static:
    """The page without a server of ours."""

    def __init__(self, *options):
        self._folder = tempfile.TemporaryDirectory()
        folder = self._folder.name + "/page"
        subprocess.run(
            [PANEL, "--web", "--static", folder, *options], check=True, stdout=subprocess.DEVNULL
        )
        handler = functools.partial(Quiet, directory=folder)
        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        self.link = "http://127.0.0.1:%d/" % self._server.server_port

    def ends(self):
        self._server.shutdown()
        self._folder.cleanup()


def measured(kind, seconds):
    """The figures of one run, in the order of BARS."""
    panel, browser = kind("--drives", DRIVES), Browser()
    try:
        page = browser.open(panel.link, "desktop", None)
        drawn_ms = page.run(DRAWN)
        page.shows("READY")
        keys_ms = page.run(KEY % PRESSES)
        page.press("START")
        page.shows("RUNNING")
        error = page.run(TIME % seconds)
        page.press("STOP")
        return drawn_ms, statistics.median(keys_ms), error or 0.0
    finally:
        browser.close()
        panel.ends()


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--static", action="store_true", help="the page without a server")
    chosen = parser.parse_args()
    if missing():
        sys.exit(missing())
    kind = Static if chosen.static else Served
    runs = []
    for run in range(chosen.runs):
        runs.append(measured(kind, chosen.seconds))
        told = (f"{name} {value:.2f} {unit}" for (name, unit, _), value in zip(BARS, runs[-1]))
        print(f"run {run + 1}: " + ", ".join(told), flush=True)
    missed = False
    for (name, unit, bar), values in zip(BARS, zip(*runs)):
        median = statistics.median(values)
        missed = missed or median > bar
        verdict = "MISSED" if median > bar else "held"
        print(f"{name}: median {median:.2f} {unit}, bar {bar} {unit}: {verdict}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
