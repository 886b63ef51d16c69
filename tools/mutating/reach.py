# SPDX-License-Identifier: MIT
"""Which test functions run a line of the firmware.

    reach = Reach(tree, room)     # room: a folder for a copy, and for what is known already
    reach.learn(jobs, tell)       # runs each test file that has changed since, once
    reach.functions("firmware/app.py", 120)

A copy of the firmware notes its lines (host_tests/cpython/line_notes.py), on CPython, which is
faster, or on MicroPython for the files that want it. What a function has run is kept, and holds as
long as firmware, boards, benches and its own file stay the same.
"""

import ast
import hashlib
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import NamedTuple

from line_notes import Noting

from tiers import OR, TIERS, interpreters
from tools.deploying.names import source_of
from tools.mutating.noting import MARK, NOTES
from tools.mutating.scratch import scratch

GROUND = (
    "firmware", "boards", "host_tests/benches", "host_tests/runner.py",
    "host_tests/cpython/line_notes.py",
)  # fmt: skip
TIERS_TRIED = ("unix64", "cpython")  # a test file runs on the first of these that it has
NOTING = Path(__file__).parent / "noting.py"
COMMANDS = {  # by the first of these tiers that a file has; noting.py finds the modules
    "cpython": (sys.executable, "-s", "-X", "utf8"),
    "unix64": TIERS["unix64"].command,
}
FILE_TIMEOUT_S = 900
MACHINE_CODE = ("micropython.viper", "micropython.native", "rp2.asm_pio")


class Function(NamedTuple):
    """A test function. nearness: how much of the firmware that it runs is the file asked for."""

    path: str
    name: str
    seconds: float
    nearness: float


class _Noting(Noting):
    """For MicroPython, whose lists cannot be asked for a method that sets an item."""

    def visit_ExceptHandler(self, node):
        self.generic_visit(node)
        node.body.insert(0, self.noting("{}[{}] = True", node.lineno))
        return node

    def visit_FunctionDef(self, node):
        if any(ast.unparse(one).startswith(MACHINE_CODE) for one in node.decorator_list):
            return node
        return self.generic_visit(node)


class Reach:
    def __init__(self, tree, room):
        self.tree = tree
        self.room = room
        self.kept = room / "reach"  # a file for each test file
        self.places = []  # path, line numbers: of each note
        self.noted = {}  # path -> syntax tree, with notes
        self._in_file = {}  # path -> its statements, as bits
        for path in sorted((tree / "firmware").rglob("*.py")):
            name, first = str(path.relative_to(tree)), len(self.places)
            noting = _Noting(name, self.places, NOTES)
            self.noted[name] = noting.visit(ast.parse(path.read_bytes()))
            self._in_file[name] = (1 << len(self.places)) - (1 << first)
        self.ground = digest(tree, [file for one in GROUND for file in _files(tree / one)])
        self.known = {}  # path of a test file -> {function: (seconds, passed, statements as bits)}
        inside = set(self._inside())
        self._outside = self._bits(lambda path, lines: (path, lines[0]) not in inside)

    def files(self):
        """The test files that this is about, from the top of the tree."""
        return sorted(
            str(path.relative_to(self.tree)) for path in tests_of(self.tree, TIERS_TRIED)
        )

    def learn(self, jobs, tell):
        """Run what is not known. tell(done, count) is called as it goes on."""
        self.kept.mkdir(parents=True, exist_ok=True)
        unknown = []
        for path in self.files():
            self.known[path] = self._kept(path)
            if self.known[path] is None:
                unknown.append(path)
        if not unknown:
            return
        copy = scratch(self.tree, self.room / "noting")
        for path, noted in self.noted.items():
            (copy / path).write_text(source_of(noted) + "\n", encoding="utf-8")
        tell(0, len(unknown))
        with ThreadPoolExecutor(jobs) as pool:
            runs = {pool.submit(self._run, copy, path): path for path in unknown}
            for done, run in enumerate(as_completed(runs), 1):
                path = runs[run]
                self.known[path] = run.result()
                self._keep(path, self.known[path])
                tell(done, len(unknown))

    def functions(self, path, line):
        """The test functions that run a line, the best first: those that take little time, and
        most of it with this file. Where nobody is known to run it, the test files of the same name
        take part as well: machine code notes nothing, and other code may run on MicroPython than
        on CPython."""
        wanted, is_noted = self._statement(path, line)
        is_known = is_noted and self._ran() & wanted
        names = {"test_%s.py" % word for word in path.removesuffix(".py").split("/")[-2:]}
        found = []
        for test, functions in self.known.items():
            once = functions.get("import", (0, 1, 0))[2]  # what ran when the file was imported
            # A module is imported by the first function that wants it, for all of its file.
            for _, _, bits in functions.values():
                once |= bits & self._outside
            is_namesake = not is_known and test.rpartition("/")[2] in names
            for name, (seconds, _, bits) in functions.items():
                bits |= once
                if name != "import" and (bits & wanted or is_namesake):
                    here = (bits & self._in_file[path]).bit_count()
                    nearness = 1 if is_namesake else here / bits.bit_count()
                    found.append(Function(test, name, seconds, nearness))
        return sorted(found, key=lambda one: (one.seconds + 0.05) / one.nearness)

    def is_for_the_chip(self, path, line):
        """Whether no test here runs that line; a file whose functions do not run is only imported.
        Machine code notes nothing, so that nobody knows."""
        wanted, is_noted = self._statement(path, line)
        ran = self._ran()
        return not (is_noted and ran & wanted and ran & self._in_file[path] & ~self._outside)

    def _ran(self):
        """All that any function runs."""
        ran = 0
        for functions in self.known.values():
            for _, _, bits in functions.values():
                ran |= bits
        return ran

    def _statement(self, path, line):
        """The innermost noted statement with that line, as bits; whether it is the innermost."""
        tree = ast.parse((self.tree / path).read_bytes())
        around = [
            node
            for node in ast.walk(tree)
            if isinstance(node, ast.stmt) and node.lineno <= line <= node.end_lineno
        ]
        for node in sorted(around, key=lambda node: node.lineno, reverse=True):
            at = path, node.lineno
            bits = self._bits(lambda path, lines, at=at: at[0] == path and at[1] in lines)
            if bits:
                return bits, node.lineno == max(one.lineno for one in around)
        return 0, True

    def longest_s(self, path):
        """How long the longest function of a test file takes."""
        return max(seconds for seconds, _, _ in self.known[path].values())

    def failing(self):
        """(file, function) that failed while their lines were noted."""
        return [
            (path, name)
            for path, functions in self.known.items()
            for name, (_, passed, _) in functions.items()
            if not passed
        ]

    def _bits(self, is_wanted):
        """The statements at certain places, as bits."""
        return int("".join("01"[is_wanted(*place)] for place in reversed(self.places)) or "0", 2)

    def _inside(self):
        """The places within functions."""
        for path in self.noted:
            for node in ast.walk(ast.parse((self.tree / path).read_bytes())):
                if isinstance(node, ast.FunctionDef):
                    last = node.body[-1].end_lineno
                    yield from ((path, line) for line in range(node.body[0].lineno, last + 1))

    def _run(self, copy, path):
        """What noting.py tells of a file. Functions that came to no end have run nothing."""
        command = COMMANDS[tier_of(self.tree / path, COMMANDS)]
        command = [*command, str(NOTING), path, str(len(self.places))]
        try:
            done = subprocess.run(
                command, cwd=copy, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, timeout=FILE_TIMEOUT_S,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return {}
        functions = {}
        for part in done.stdout.decode("utf-8", "replace").split(MARK + " ")[1:]:
            name, took_ms, passed, rest = part.split(" ", 3)
            notes = rest[: len(self.places)]
            bits = int(notes.translate({0: "0", 1: "1"})[::-1], 2)
            functions[name] = (int(took_ms) / 1000, int(passed), bits)
        return functions

    def _kept(self, path):
        """What is known of a test file, or None."""
        try:
            kept = json.loads(self._file(path).read_text())
        except (OSError, ValueError):
            return None
        if kept["made of"] != self._made_of(path):
            return None
        return {name: (s, passed, int(bits, 16)) for name, s, passed, bits in kept["functions"]}

    def _keep(self, path, functions):
        rows = [(name, s, passed, "%x" % bits) for name, (s, passed, bits) in functions.items()]
        kept = {"made of": self._made_of(path), "functions": rows}
        self._file(path).write_text(json.dumps(kept))

    def _file(self, path):
        return self.kept / (path.replace("/", ".") + ".json")

    def _made_of(self, path):
        return digest(self.tree, [self.tree / path]) + self.ground


def tests_of(tree, tiers):
    """The test files that run on one of these tiers."""
    for path in sorted((tree / "host_tests").rglob("test_*.py")):
        if tier_of(path, tiers):
            yield path


def tier_of(path, tiers):
    """The first of these tiers that a test file runs on, or None."""
    words = interpreters(ast.parse(path.read_bytes()), path)
    has = [name for word in words for name in word.split(OR)]
    return next((tier for tier in tiers if tier in has), None)


def digest(tree, files):
    """One word for names and contents."""
    told = hashlib.sha256()
    for file in files:
        told.update(str(file.relative_to(tree)).encode() + b"\0" + file.read_bytes() + b"\0")
    return told.hexdigest()


def _files(path):
    """The sources at a path."""
    if path.is_file():
        return [path]
    return sorted(file for file in path.rglob("*") if file.suffix in (".py", ".tsv"))
