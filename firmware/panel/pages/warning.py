# SPDX-License-Identifier: MIT
"""A warning of the drive shown, which takes turns with what a page has in row 2.

What it draws:

    WARN A0501   A1
"""

from panel import texts
from panel.reports.fault import draw_number


def draw(screen, panel):
    """Draw it, if there is one and its turn has come; answers whether it did."""
    report = panel.warning
    if not (report.active and panel.announcer.page_turns & 1):
        return False
    words = texts.of(texts.WARNING)
    screen.put(1, 0, texts.STATE_WIDTH + 1, words)
    draw_number(screen, 1, len(words) + 1, texts.WARNING_LETTER, report)
    return True
