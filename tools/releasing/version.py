# SPDX-License-Identifier: MIT
"""The version of the panel, and what the changes say of it."""

import re
from pathlib import Path

VERSION = re.compile(r'^VERSION = "(.*)"$', re.MULTILINE)


def version(top):
    return VERSION.search((Path(top) / "firmware/version.py").read_text())[1]


def changes(top):
    """(version, text) of the newest part of the changes."""
    text = (Path(top) / ".github/CHANGELOG.md").read_text(encoding="utf-8")
    heading = re.search(r"^## (.*)$", text, re.MULTILINE)
    rest = text[heading.end() :]
    end = re.search(r"^## ", rest, re.MULTILINE)
    return heading[1], (rest[: end.start()] if end else rest).strip() + "\n"
