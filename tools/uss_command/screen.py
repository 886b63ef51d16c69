# SPDX-License-Identifier: MIT
"""What is shown: tables, progress and live pictures for people (`rich`), JSON for programs.

screen.table("title", ("number", "value"), [{"number": "P0700[0]", "value": 5}])
with screen.progress("backup", 200) as step: step()
with screen.live() as show: show("title", columns, rows)
screen.event("running", hertz=25.0)         # one line, or one JSON object in a line
"""

import json
import sys
from contextlib import contextmanager


class Screen:
    """as_json: for programs."""

    def __init__(self, as_json):
        self.as_json = as_json
        self.is_terminal = not as_json and sys.stdout.isatty()
        self._console = None

    def table(self, title, columns, rows, **more):
        """rows: dictionaries. more: what JSON says besides."""
        if self.as_json:
            self._print({**more, "rows": rows})
        elif rows:
            self.console.print(title, markup=False)
            self.console.print(self._table(None, columns, rows))

    def event(self, text, **facts):
        """Something that happened."""
        if self.as_json:
            self._print(facts or {"text": text})
        else:
            print(text, flush=True)

    def confirms(self, question):
        """Whether somebody at a terminal says yes; False where nobody can be asked."""
        if not (self.is_terminal and sys.stdin and sys.stdin.isatty()):
            return False
        try:
            return input(question + " [y/N] ").strip().lower() in ("y", "yes")
        except EOFError:
            return False

    @contextmanager
    def progress(self, title, whole):
        """Yields a function, to be called for each of `whole` steps."""
        if not self.is_terminal:
            yield lambda: None
            return
        from rich.progress import Progress

        with Progress(console=self.console, transient=True) as progress:
            task = progress.add_task(title, total=whole)
            yield lambda: progress.advance(task)

    @contextmanager
    def live(self):
        """Yields show(title, columns, rows): a picture that changes; elsewhere, a line a row."""
        if not self.is_terminal:
            yield self._show_lines
            return
        from rich.live import Live

        with Live(console=self.console, auto_refresh=False) as live:
            yield lambda title, columns, rows: live.update(
                self._table(title, columns, rows), refresh=True
            )

    @property
    def console(self):
        if self._console is None:
            from rich.console import Console

            width = None if sys.stdout.isatty() else 200
            self._console = Console(width=width, highlight=False)
        return self._console

    def _show_lines(self, title, columns, rows):
        for row in rows:
            if self.as_json:
                self._print(row)
            else:
                print("  ".join("%s" % row.get(column, "") for column in columns), flush=True)

    def _table(self, title, columns, rows):
        from rich import box
        from rich.table import Table
        from rich.text import Text

        table = Table(title=title, box=box.SIMPLE, title_justify="left", pad_edge=False)
        for column in columns:
            table.add_column(column, overflow="fold")
        for row in rows:
            cells = [row.get(column) for column in columns]
            table.add_row(*(Text("" if cell is None else str(cell)) for cell in cells))
        return table

    def _print(self, thing):
        print(json.dumps(thing, ensure_ascii=False), flush=True)
