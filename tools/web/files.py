# SPDX-License-Identifier: MIT
"""Which files are the page, and where they lie."""

from pathlib import Path

HERE = Path(__file__).resolve().parent
FOLDER = HERE / "page"
PAGE = "index.html"
ROM = "rom_a00.json"
ELSEWHERE = {ROM: HERE.parent / "pictures" / ROM}
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
}


def page_files():
    """{name that a browser asks for: path}."""
    found = {path.name: path for path in FOLDER.iterdir() if path.suffix in TYPES}
    return {**found, **ELSEWHERE}


def served(name):
    """The path of a file, or None."""
    return page_files().get(name)
