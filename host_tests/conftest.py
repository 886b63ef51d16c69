# SPDX-License-Identifier: MIT
"""Lets pytest run the test files on every interpreter that the firmware has to work on.

A test file is plain Python that runs on MicroPython: functions `test_*` without arguments that
use bare `assert`. It runs on each tier (tiers.py), one process for a file and a tier, and every
function is a pytest item of its own: `uss/test_telegram.py::unix32::test_bcc_counts_stx`. So
`-k`, `-x`, node ids and the summary work as ever. A file that is not for every tier says so at
module level:

    INTERPRETERS = "unix64 unix32"      # a part of: unix64 unix32 cpython
    INTERPRETERS = "unix32|unix64"      # one of them is enough, the first that is here
    INTERPRETERS = "pico"               # beside an emulated Pico: tools/emulator/world.py
    INTERPRETERS = "pico pico_again"    # ... whose UART behaves in either way the documents allow
    INTERPRETERS = "pico_hard"          # ... on the build with hard timers
    INTERPRETERS = "pico pico_hard_again"  # each build and each behaviour has its turn
    INTERPRETERS = "host"               # an ordinary pytest file, with fixtures and all

With --coverage the lines of the firmware that run on CPython are noted (cpython/line_notes.py),
and what takes long runs once (shares.py).
-k passes over files that it cannot mean (selection.py).
"""

import ast
import gc
import os
import signal
import time
from collections import defaultdict
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from threading import Lock
from types import SimpleNamespace
from typing import NamedTuple

import pytest

from compiled import use_compiled
from line_coverage import LineCoverage
from ordinary import OrdinaryRun, Teller
from runner import COVERAGE
from selection import Selection, files_of
from shares import NotHere, shares
from tiers import ENVIRONMENT, OR, TIERS, TOP, FileRun, Survey, interpreters, survey

SURVEY = pytest.StashKey()
SELECTION = pytest.StashKey()
POOL = pytest.StashKey()


# ---- what pytest calls ----------------------------------------------------------------------


def pytest_addoption(parser):
    parser.addini("function_timeout_s", "a test function without a verdict for so long is hung")
    only = "runs this test and tells of it: so the pool runs ordinary files (ordinary.py)"
    parser.addoption("--only", action="append", metavar="NODEID", help=only)
    lines = "shows which lines of firmware/ ran on CPython; runs once what takes long (shares.py)"
    parser.addoption("--coverage", action="store_true", help=lines)


def pytest_configure(config):
    gc.disable()  # while tests are collected: they stay to the end
    only = config.option.only
    if only:
        config.pluginmanager.register(Teller(config, only))
    if config.option.coverage:
        ENVIRONMENT[COVERAGE] = "1"  # of the processes that run the tests
    if not config.pluginmanager.list_plugin_distinfo():  # none: no other pytest has to look again
        ENVIRONMENT["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    config.stash[SELECTION] = selection(config)
    config.stash[SURVEY] = Survey({}, {}) if only else survey(tiers_that_may_run(config))
    use_compiled(config.stash[SURVEY].versions)
    config.stash[POOL] = Pool(config)


def selection(config):
    """By what -k says; None where nothing is passed over: the tiers all have to be there, or
    somebody wants to see what is not chosen as well.
    """
    if strict() or not config.option.keyword:
        return None
    try:
        return Selection(config.option.keyword)
    except ValueError:
        return None  # pytest says what is wrong


def tiers_that_may_run(config):
    chosen = config.stash[SELECTION]
    if chosen is None:
        return TIERS
    return {tier for path in files_of(config.args) for tier in chosen.tiers(path)}


def pytest_ignore_collect(collection_path, config):
    """A file whose tests -k cannot mean is not read. One that is named is. With --only that is
    all: pytest would read each file of its folder.
    """
    chosen = config.stash[SELECTION]
    if collection_path.suffix != ".py" or _is_named(collection_path, config):
        return None
    if config.option.only:
        return True
    return chosen is not None and not chosen.may_run(collection_path) or None


def _is_named(path, config):
    return any(Path(word.partition("::")[0]).resolve() == path for word in config.args)


def pytest_report_header(config):
    found = config.stash[SURVEY]
    return [f"{tier}: {version}" for tier, version in found.versions.items()]


def pytest_pycollect_makemodule(module_path, parent):
    try:
        tree = ast.parse(module_path.read_bytes(), filename=str(module_path))
    except SyntaxError:
        return None  # pytest shows it best
    names = interpreters(tree, module_path)
    if names == ["host"]:
        return None  # an ordinary pytest file
    return MicroPythonFile.from_parent(parent, path=module_path, tree=tree, interpreters=names)


@pytest.hookimpl(trylast=True)  # after -k and the like have taken their pick
def pytest_collection_modifyitems(session, items):
    gc.freeze()  # at its end pytest has all that is left looked through, twice
    gc.enable()
    session.config.stash[POOL].sort(items)
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
        pool.start(session.items)
    try:
        return (yield)
    finally:
        pool.stop()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item):
    """What another pytest has run is only reported here."""
    pool = item.config.stash[POOL]
    if isinstance(item, Function) or item not in pool.verdicts:
        return None  # pytest runs it
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for report in pool.reports(item):
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


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


class MicroPythonFile(pytest.File):
    def __init__(self, *, tree, interpreters, **others):
        super().__init__(**others)
        self.tree = tree
        self.interpreters = interpreters

    def collect(self):
        functions = self.functions()
        found = dict.fromkeys(self.tiers(), functions)
        if self.config.option.coverage:
            here = self.config.stash[SURVEY].versions
            try:
                found = shares(self.path, self.tree, functions, found, here)
            except NotHere as error:
                raise self.CollectError(str(error)) from None
        for tier, names in found.items():
            share = {name: line for name, line in functions.items() if name in names}
            yield TierOfFile.from_parent(self, name=tier, functions=share)

    def tiers(self):
        """Those on which it runs, of those that are here."""
        here = self.config.stash[SURVEY].versions
        for word in self.interpreters:
            names = word.split(OR)
            for name in names:
                if name not in TIERS:
                    raise self.CollectError(f"INTERPRETERS names {name!r}, which is not a tier")
            yield from [name for name in names if name in here][:1]

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

ORDINARY = "host"  # what an ordinary file has in place of a tier
# In pytest's cache: a job -> how long each of its tests took, what part of that it computed.
LASTED, BUSY = "uss/seconds_a_test", "uss/busy"
USUAL_S, USUAL_BESIDE_A_CHIP_S = 0.1, 5  # of one that never ran


class Job(NamedTuple):
    """What one process runs."""

    path: Path
    tier: str

    def __str__(self):
        return f"{self.path}::{self.tier}"


def jobs_of(items):
    """Job -> its items."""
    jobs = defaultdict(list)
    for item in items:
        if not isinstance(item, MissingTier):
            tier = item.parent.name if isinstance(item, Function) else ORDINARY
            jobs[Job(item.path, tier)].append(item)
    return jobs


def once(work):
    """The same work, for whoever comes first."""
    free = Lock()
    return lambda: work() if free.acquire(blocking=False) else None


class Pool:
    """Runs the files ahead of pytest, which asks for verdict after verdict in the same order.

    Of the files that only compute as many run at a time as there are processors. They stand back
    (tiers.py) for what has to be in time: half as many ordinary files run beside them, those first
    that wait most of their time, for a page, a terminal, a serial port. When the files that only
    compute are done, more ordinary ones run at a time, now those first that compute: so all
    processors are busy to the end. Else the longest come first, as far as the last run can tell.

    Ordinary files end last, so pytest asks for them last: else it had all others to report then.
    """

    def __init__(self, config):
        self.config = config
        self.timeout_s = float(config.getini("function_timeout_s") or 120)
        self.coverage = LineCoverage(TOP)
        processors = os.cpu_count() or 1
        self.ordinary = ThreadPoolExecutor(max(1, processors // 2))
        self.others = ThreadPoolExecutor(processors)
        self.verdicts = {}  # item -> future of its Verdict, of an ordinary test: of what was Told
        self.runs = []
        self.lasted_s, self.busy = {}, {}

    def sort(self, items):
        """Job after job, in the order in which they are to run."""
        jobs = jobs_of(items)
        self.lasted_s, self.busy = self._cached(LASTED), self._cached(BUSY)

        def rank(job):
            is_ordinary = job.tier == ORDINARY
            usual_s = (
                USUAL_S if is_ordinary or TIERS[job.tier].everywhere else USUAL_BESIDE_A_CHIP_S
            )
            lasts_s = len(jobs[job]) * self.lasted_s.get(str(job), usual_s)
            return is_ordinary, self._computes(job), -lasts_s

        items[:] = [item for job in sorted(jobs, key=rank) for item in jobs[job]]

    def _computes(self, job):
        """An ordinary one, most of its time."""
        return self.busy.get(str(job), 0) > 0.5

    def start(self, items):
        computing, waiting = [], []
        for job, chosen in jobs_of(items).items():
            if job.tier != ORDINARY:
                work = self._work(job, {item.name: item for item in chosen}, self._on_tier)
                self.others.submit(work)
            elif self._runs_ordinary_files():
                work = self._work(job, {item.nodeid: item for item in chosen}, self._in_a_pytest)
                work = once(work)
                (computing if self._computes(job) else waiting).append(work)
                self.ordinary.submit(work)
        for work in computing + waiting:  # who has done all the others takes from these
            self.others.submit(work)

    def verdict(self, item):
        return self.verdicts[item].result()

    def reports(self, item):
        """What pytest reports of an ordinary test."""
        told = self.verdicts[item].result()
        hook = self.config.hook
        for data in told.reports:
            report = hook.pytest_report_from_serializable(config=self.config, data=data)
            if report.failed or not told.death:
                yield report
        if told.death:
            failure = Failure(told.death)
            yield pytest.TestReport(item.nodeid, item.location, {}, "failed", failure, "call")

    def stop(self):
        for executor in (self.ordinary, self.others):
            executor.shutdown(wait=False, cancel_futures=True)
        for run in self.runs:
            run.stop()
        for run in self.runs:
            run.wait()
        if hasattr(self.config, "cache"):
            self.config.cache.set(LASTED, self.lasted_s)
            self.config.cache.set(BUSY, self.busy)

    def _cached(self, what):
        return self.config.cache.get(what, {}) if hasattr(self.config, "cache") else {}

    def _runs_ordinary_files(self):
        """Not where it was started to run them, or where somebody wants to have a hand in it."""
        option = self.config.option
        by_hand = option.usepdb or option.trace or option.setupshow or option.capture == "no"
        return not option.only and not by_hand

    def _work(self, job, by_name, make_run):
        futures = {name: Future() for name in by_name}
        self.verdicts.update((item, futures[name]) for name, item in by_name.items())
        run = make_run(job, by_name, lambda name, verdict: futures[name].set_result(verdict))

        def work():
            began = time.monotonic()
            try:
                run.run()
                lasted_s = time.monotonic() - began
                self.lasted_s[str(job)] = lasted_s / len(futures)
                if job.tier == ORDINARY:
                    self.busy[str(job)] = run.busy_s / lasted_s
            except BaseException as error:  # pytest would wait for ever
                for future in futures.values():
                    if not future.done():
                        future.set_exception(error)

        self.runs.append(run)
        return work

    def _on_tier(self, job, names, publish):
        note = self.coverage.note
        return FileRun(TIERS[job.tier], job.path, names, self.timeout_s, publish, note)

    def _in_a_pytest(self, job, names, publish):
        return OrdinaryRun(self.config, job.path, names, self.timeout_s, publish)
