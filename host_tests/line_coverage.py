# SPDX-License-Identifier: MIT
"""Line coverage of firmware/, from the lines that the coverage tier saw run.

MicroPython names only the lines it ran; which lines there are to run is read from the source
here. A statement counts as run when any line of it was seen, up to the statements inside it:
MicroPython gives a statement of several lines now the first of them, now the last.
"""

import ast
from collections import defaultdict
from fnmatch import fnmatch
from pathlib import Path

# Where no line is ever seen, and why.
UNSEEN = (
    ("firmware/hal/*/rp2_*.py", "runs on the chip alone: tier pico"),
    ("firmware/uss/fast/viper.py", "machine code"),
)


class LineCoverage:
    def __init__(self, top: Path):
        self.top = top
        self.seen = defaultdict(set)  # file, from the top of the tree -> line numbers

    def note(self, file, numbers):
        self.seen[file].update(numbers)

    def report(self):
        """Yields the lines of the table, the total last."""
        row = "{:40} {:>5} {:>5} {:>6}  {}".format
        yield row("file", "lines", "run", "", "not run").rstrip()
        all_lines = all_run = 0
        for path in sorted((self.top / "firmware").rglob("*.py")):
            file = str(path.relative_to(self.top))
            if reason := why_unseen(file):
                yield row(file, "", "", "-", reason)
                continue
            lines = statements(path.read_text())
            run = {first for first, last in lines.items() if self._ran(file, first, last)}
            missing = ranges(sorted(lines), run)
            yield row(file, len(lines), len(run), percent(len(run), len(lines)), missing).rstrip()
            all_lines += len(lines)
            all_run += len(run)
        yield row("total", all_lines, all_run, percent(all_run, all_lines), "").rstrip()

    def _ran(self, file, first, last):
        return not self.seen[file].isdisjoint(range(first, last + 1))


def why_unseen(file):
    return next((reason for pattern, reason in UNSEEN if fnmatch(file, pattern)), "")


def statements(source: str) -> dict[int, int]:
    """The first line of every statement that leaves code behind -> its last line.

    Of a statement with a body only the head counts, since the body has statements of its own.
    """
    lines = {}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.stmt) and not leaves_no_code(node):
            decorators = getattr(node, "decorator_list", [])
            first = min([node.lineno, *(decorator.lineno for decorator in decorators)])
            body = getattr(node, "body", None)
            last = max(first, body[0].lineno - 1) if body else node.end_lineno
            lines[first] = max(last, lines.get(first, last))
    return lines


def leaves_no_code(node):
    """Docstrings, declarations, and loops and branches whose condition the compiler knows."""
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    if isinstance(node, (ast.While, ast.If)):
        return isinstance(node.test, ast.Constant)
    if isinstance(node, ast.AnnAssign):
        return node.value is None
    return isinstance(node, (ast.Global, ast.Nonlocal, ast.Pass))


def ranges(lines, run):
    """The lines that did not run, in short: "12, 20-23". Lines without code join neighbours."""
    runs_of_missing = []
    previous_ran = True
    for line in lines:
        if line not in run:
            if previous_ran:
                runs_of_missing.append([line, line])
            runs_of_missing[-1][1] = line
        previous_ran = line in run
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in runs_of_missing)


def percent(part, whole):
    """Rounded down, so that only a whole is 100 %."""
    return f"{part * 100 // whole} %" if whole else "-"
