# SPDX-License-Identifier: MIT
"""Lets pytest run the test files on every interpreter that the firmware has to work on.

A test file is plain Python that runs on MicroPython: functions `test_*` without arguments that
use bare `assert`. It runs on each tier (tiers.py), one process for a file and a tier, and every
function is a pytest item of its own: `uss/test_telegram.py::unix32::test_bcc_counts_stx`. So
`-k`, `-x`, node ids and the summary work as ever. A file that is not for every tier says so at
module level:

    INTERPRETERS = "unix64 unix32"      # a part of: unix64 unix32 cpython
    INTERPRETERS = "pico"               # beside an emulated Pico: tools/emulator/world.py
    INTERPRETERS = "pico pico_again"    # ... whose UART behaves in either way the documents allow
    INTERPRETERS = "pico pico_hard"     # ... on both builds: with soft timers and with hard ones
    INTERPRETERS = "host"               # an ordinary pytest file, with fixtures and all

On CPython the lines of the firmware that run are noted (cpython/line_notes.py).
"""

import ast
import os
import signal
from collections import defaultdict
from concurrent.futures import Future, ThreadPoolExecutor
from types import SimpleNamespace

import pytest

from line_coverage import LineCoverage
from tiers import TIERS, TOP, FileRun, survey

SURVEY = pytest.StashKey()
POOL = pytest.StashKey()


# ---- what pytest calls ----------------------------------------------------------------------


def pytest_addoption(parser):
    parser.addini("function_timeout_s", "a test function without a verdict for so long is hung")


def pytest_configure(config):
    config.stash[SURVEY] = survey()
    config.stash[POOL] = Pool(float(config.getini("function_timeout_s") or 120))


def pytest_report_header(config):
    found = config.stash[SURVEY]
    return [f"{tier}: {version}" for tier, version in found.versions.items()]


def pytest_pycollect_makemodule(module_path, parent):
    try:
        tree = ast.parse(module_path.read_bytes(), filename=str(module_path))
    except SyntaxError:
        return None  # pytest shows it best
    names = interpreters(tree)
    if names == ["host"]:
        return None  # an ordinary pytest file
    return MicroPythonFile.from_parent(parent, path=module_path, tree=tree, interpreters=names)


@pytest.hookimpl(trylast=True)  # after -k and the like have taken their pick
def pytest_collection_modifyitems(session, items):
    # pytest runs the ordinary files itself: first, while the pool runs the others.
    items.sort(key=lambda item: isinstance(item, Function))
    if strict():
        for tier, reason in session.config.stash[SURVEY].missing.items():
            if TIERS[tier].required:
                items.append(MissingTier.from_parent(session, name=f"tier {tier}", reason=reason))


@pytest.hookimpl(wrapper=True)
def pytest_runtestloop(session):
    pool = session.config.stash[POOL]
    # Whoever ends pytest (a time limit, say) ends the interpreters with it, as Ctrl-C does.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if not session.config.option.collectonly and not session.testsfailed:
        pool.start([item for item in session.items if isinstance(item, Function)])
    try:
        return (yield)
    finally:
        pool.stop()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """An ordinary pytest test is given up after the same time; the pool sees to the others."""
    if isinstance(item, Function):
        return (yield)
    timeout_s = item.config.stash[POOL].timeout_s

    def give_up(*_):
        raise TestFailed(f"The test hung and was given up after {timeout_s:g} s.")

    previous = signal.signal(signal.SIGALRM, give_up)
    # Again and again: what a `__del__` raises is lost, and so is a signal just before a wait.
    signal.setitimer(signal.ITIMER_REAL, timeout_s, 1)
    try:
        return (yield)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if call.when == "call" and isinstance(item, Function) and item.verdict:
        report.duration = item.verdict.seconds  # not how long pytest waited for it
    return report


def pytest_terminal_summary(terminalreporter, config):
    coverage = config.stash[POOL].coverage
    if coverage.seen:
        terminalreporter.section("line coverage of firmware/ by the tests that ran")
        for line in coverage.report():
            terminalreporter.write_line(line)
    for tier, reason in config.stash[SURVEY].missing.items():
        terminalreporter.write_line(f"Not run: {absence(tier, reason)}", yellow=True)


def strict():
    """Whether a tier that is missing is a failure."""
    return any(os.environ.get(name, "") in ("1", "true") for name in ("CI", "USS_STRICT"))


def absence(tier, reason):
    return f"tier {tier} ({reason}). What helps: {TIERS[tier].remedy}; then tools/test."


# ---- from files to items --------------------------------------------------------------------


def interpreters(tree):
    """The names in the INTERPRETERS of a test file; the tiers for every file where it has none."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "INTERPRETERS":
            return ast.literal_eval(node.value).split()
    return [name for name in TIERS if TIERS[name].everywhere]


class MicroPythonFile(pytest.File):
    def __init__(self, *, tree, interpreters, **others):
        super().__init__(**others)
        self.tree = tree
        self.interpreters = interpreters

    def collect(self):
        functions = self.functions()
        unknown = [name for name in self.interpreters if name not in TIERS]
        if unknown:
            raise self.CollectError(f"INTERPRETERS names {unknown[0]!r}, which is not a tier")
        for name in self.interpreters:
            if name in self.config.stash[SURVEY].versions:
                yield TierOfFile.from_parent(self, name=name, functions=functions)

    def functions(self):
        """Name -> line. What would silently not run as a test is refused."""
        found = {}
        for node in self.tree.body:
            name = getattr(node, "name", "")
            if not name.startswith("test_"):
                continue
            if name in found:
                raise self.CollectError(f"there are two functions {name}")
            if not isinstance(node, ast.FunctionDef) or ast.unparse(node.args):
                raise self.CollectError(f"{name} is not a plain function without arguments")
            found[name] = node.lineno
        return found


class TierOfFile(pytest.Collector):
    def __init__(self, *, functions, **others):
        super().__init__(**others)
        self.functions = functions

    def collect(self):
        for name, line in self.functions.items():
            yield Function.from_parent(self, name=name, line=line)


class Function(pytest.Item):
    def __init__(self, *, line, **others):
        super().__init__(**others)
        self.line = line
        self.verdict = None

    def runtest(self):
        self.verdict = self.config.stash[POOL].verdict(self)
        if self.verdict.output:
            self.add_report_section("call", "stdout", self.verdict.output)
        if not self.verdict.passed:
            raise TestFailed(self.verdict.reason)

    def repr_failure(self, excinfo):
        if isinstance(excinfo.value, TestFailed):
            return Failure(str(excinfo.value))
        return super().repr_failure(excinfo)

    def reportinfo(self):
        return self.path, self.line - 1, f"{self.parent.name} {self.name}"


class MissingTier(pytest.Item):
    """Stands for all that could not run; it exists only where everything has to run."""

    def __init__(self, *, reason, **others):
        super().__init__(**others)
        self.reason = reason

    def runtest(self):
        fetched = TOP / "build/fetched.log"  # tools/test has written there what it tried
        tried = fetched.read_text() if fetched.exists() else ""
        raise TestFailed(tried + absence(self.name.split()[1], self.reason))

    def repr_failure(self, excinfo):
        return Failure(str(excinfo.value))

    def reportinfo(self):
        return self.path, None, self.name


class TestFailed(Exception):
    """Carries the traceback of the other interpreter, or says what became of the test."""


class Failure:
    """What pytest shows of a failure: the text, and one line of it in the short summary."""

    def __init__(self, text):
        self.text = text.strip("\n")
        *_, line_before, last_line = ["", *self.text.splitlines()]
        if last_line.startswith("AssertionError"):  # the source, which stands before it, says more
            last_line = line_before
        self.reprcrash = SimpleNamespace(message=last_line.strip())

    def toterminal(self, writer):
        for line in self.text.splitlines():
            writer.line(line)

    def __str__(self):
        return self.text


# ---- running them ---------------------------------------------------------------------------


class Pool:
    """Runs the files ahead of pytest, as many at a time as there are processors.

    pytest runs the ordinary files meanwhile. Then it asks for verdict after verdict, in the order
    in which the files are run.
    """

    def __init__(self, timeout_s):
        self.timeout_s = timeout_s
        self.coverage = LineCoverage(TOP)
        self.executor = ThreadPoolExecutor(max_workers=os.cpu_count() or 1)
        self.verdicts = {}  # item -> future of its verdict
        self.runs = []

    def start(self, items):
        files = defaultdict(dict)
        for item in items:
            files[item.path, item.parent.name][item.name] = self.verdicts[item] = Future()
        for (path, tier), futures in files.items():
            self._submit(path, tier, futures)

    def verdict(self, item):
        return self.verdicts[item].result()

    def stop(self):
        self.executor.shutdown(wait=False, cancel_futures=True)
        for run in self.runs:
            run.stop()

    def _submit(self, path, tier, futures):
        def publish(name, verdict):
            futures[name].set_result(verdict)

        def work():
            try:
                run.run()
            except BaseException as error:  # pytest would wait for ever
                for future in futures.values():
                    if not future.done():
                        future.set_exception(error)

        run = FileRun(TIERS[tier], path, futures, self.timeout_s, publish, self.coverage.note)
        self.runs.append(run)
        self.executor.submit(work)
