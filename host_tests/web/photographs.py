# SPDX-License-Identifier: MIT
"""Photographs the panel in a browser and in a terminal, for the manuals, in a real Chromium.

    build/pytest/bin/python -B host_tests/web/photographs.py

writes .github/pictures/browser.png and terminal.png. Look at them before you commit them.
"""

import asyncio
import base64
import re
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
PATHS = (TOP, TOP / "firmware", HERE.parent, HERE.parent / "benches", HERE.parent / "cpython")
sys.path[:0] = map(str, PATHS)

from web_bench import Browser, Served, missing  # noqa: E402
from window_bench import at_window  # noqa: E402

PICTURES = TOP / ".github" / "pictures"
DRIVES = (1, 2, 3)
COMMAND = "./tools/panel --drives 1,2,3"
LOOKS_S = 1  # a person at the display
RUNS_S = 12  # until the curves show something
SIZE = (80, 24)
FONT = re.compile(r"@font-face\s*{.*?}", re.DOTALL)  # Rich would fetch one from elsewhere
FRAMED = '<body style="margin:0"><img style="width:1280px;display:block" src="data:%s;base64,%s">'


def browser(chromium):
    served = Served("--drives", ",".join(map(str, DRIVES)))
    try:
        page = chromium.open(served.link, "desktop", None)
        page.shows("READY")
        page.press("START")
        page.shows("RUNNING")
        page.press("ADDRESS_UP")
        page.shows("A2")
        time.sleep(LOOKS_S)
        page.press("REVERSE")
        time.sleep(LOOKS_S)
        page.press("START")
        page.does("fault 3 F0001")
        time.sleep(RUNS_S)
        page.run("scrollTo(0, 0)")
        time.sleep(LOOKS_S)
        page.shot(str(PICTURES / "browser.png"), False)
    finally:
        served.ends()


def terminal(chromium):
    drawn = []

    async def photographed(desk):
        await desk.type("s")
        await desk.wait(3_000)
        await desk.type("a", "r", "s")
        await desk.command("fault 3 F0001")
        await desk.wait(3_000)
        drawn.append(FONT.sub("", desk.app.export_screenshot(title=COMMAND)))

    asyncio.run(at_window(photographed, SIZE, {"addresses": DRIVES}))
    picture = base64.b64encode(drawn[0].encode()).decode()
    framed = FRAMED % ("image/svg+xml", picture)
    page = chromium.open("data:text/html;base64," + base64.b64encode(framed.encode()).decode())
    page.shot(str(PICTURES / "terminal.png"), True)


def main():
    if missing():
        sys.exit(missing())
    chromium = Browser()
    try:
        browser(chromium)
        terminal(chromium)
    finally:
        chromium.close()


if __name__ == "__main__":
    main()
