# SPDX-License-Identifier: MIT
"""The window of the live panel without a terminal: Textual's pilot types and points, and a panel
in the same process answers, in real time that passes when a test says so.

    @in_window(addresses=(1, 2))
    async def test_it(desk):
        await desk.type("s")
        await desk.wait(3000)
        assert desk.state() == "running" and desk.shows("running")
"""

import asyncio
import functools
import os
import subprocess
import sys

import pytest

from conftest import strict
from conversation_bench import FRAME_MS, Talk
from tiers import TOP

FETCH = """set -eu; top=$0
for part in folder packages pytest textual; do . "$top/tools/fetch/$part.sh"; done
get_textual"""
SLICE_MS = 200  # a tap is over by then
LONG_S = 60.0  # for a machine that does other things as well
SETTLE_S = 0.15  # until a stroke is taken, and the picture is drawn

if subprocess.run(["bash", "-c", FETCH, str(TOP)]).returncode and not strict():
    pytest.skip("Textual cannot be had", allow_module_level=True)
sys.path += [str(path) for path in (TOP / "build/textual/lib").glob("python*/site-packages")]

from tools.terminal.app import PanelApp  # noqa: E402
from tools.terminal.told import Told  # noqa: E402


class Panel:
    """As `tools.terminal.child.Child`, around a `Talk`."""

    is_over = False

    def __init__(self, **options):
        self.talk = Talk(**options)
        self.talk.alive = [1]
        self._taken = 0
        self._ready, self._bell = os.pipe()
        self._errors, self._nobody = os.pipe()
        self.sent = []
        self.send("hello", v=1)

    def fileno(self):
        return self._ready

    def errors(self):
        return self._errors

    def hear(self):
        return False

    def send(self, kind, **fields):
        self.sent.append((kind, fields))
        self.talk.say(kind, id=1, **fields)
        self.ring()

    def ring(self):
        os.write(self._bell, b"!")

    def read(self):
        os.read(self._ready, 65536)
        messages = self.talk.heard[self._taken :]
        self._taken = len(self.talk.heard)
        return messages

    def close(self):
        for descriptor in (self._ready, self._bell, self._errors, self._nobody):
            os.close(descriptor)


class Desk:
    """A person at the window. app, pilot: Textual's. talk: the panel's side."""

    def __init__(self, app, pilot, panel):
        self.app, self.pilot, self.panel, self.talk = app, pilot, panel, panel.talk

    async def wait(self, ms):
        """Let so much of the panel's time pass."""
        for at_ms in range(0, ms, SLICE_MS):
            self.talk.wait(min(SLICE_MS, ms - at_ms))
            self.panel.ring()
            await asyncio.sleep(0.001)
        await self.pilot.pause(SETTLE_S)

    async def type(self, *keys):
        """Strokes, by Textual's names, one after the other, before a panel that answers."""
        for key in keys:
            self.talk.wait(FRAME_MS)
            self.panel.ring()
            await self.pilot.press(key)
        await self.pilot.pause(SETTLE_S)

    async def command(self, text):
        """Typed after `:`, and back to the keys."""
        await self.type("colon", *map(name_of, text), "enter")
        await self.type("escape")

    async def hold(self, key, down):
        """The mouse button on a key."""
        await (self.pilot.mouse_down if down else self.pilot.mouse_up)("#key_" + key)
        await self.pilot.pause(SETTLE_S)

    def lines(self):
        """The window as a person reads it."""
        return [
            "".join(segment.text for segment in strip).rstrip()
            for strip in self.app.screen._compositor.render_strips()
        ]

    def shows(self, text):
        return any(text in line for line in self.lines())

    def state(self, address=1):
        return self.talk.state(address)

    def starts(self):
        return self.talk.world.drives[1].starts


def name_of(character):
    return {" ": "space", "[": "left_square_bracket", "]": "right_square_bracket"}.get(
        character, character
    )


def in_window(size=(80, 24), **options):
    """Run a test, which is a coroutine, at a window of so many columns and rows."""

    def decorate(test):
        @functools.wraps(test)
        def run():
            asyncio.run(at_window(test, size, options))

        del run.__wrapped__  # pytest would ask for a fixture `desk`
        return run

    return decorate


async def at_window(test, size, options):
    is_real = options.pop("is_real", False)
    panel = Panel(**options)
    try:
        panel.talk.wait(1500)
        if is_real:  # what counts as a real line
            panel.talk.world.port = "a port"
        told = Told()
        for message in panel.read():
            told.take(message)
        if is_real:
            told.hello["real"] = 1
        app = PanelApp(panel, told)
        app.heard_s = app.armed_s = LONG_S
        async with app.run_test(size=size) as pilot:
            await test(Desk(app, pilot, panel))
    finally:
        panel.close()
