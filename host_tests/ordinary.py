# SPDX-License-Identifier: MIT
"""Runs the tests of one ordinary pytest file in a pytest of its own, so that several files run at
once, and a crash or a hang takes only one test with it.

`OrdinaryRun` stands in the pytest that people start. It starts another one with the option --only
for each test. There `Teller` reports as runner.py does: what began, each report of pytest, and
what ended.
"""

import ast
import os
import resource
import signal
import subprocess
import sys
from typing import NamedTuple

from runner import MARK
from tiers import CACHES, reports, start

# That pytest gives its tests up after the time limit; when it does not, it has hung itself.
GRACE_S = 30
STOP_S = 10  # so long it may take to end what its tests have started
ALL_RAN = (0, 1)  # exit status: all passed, or some failed


class Told(NamedTuple):
    """What became of a test."""

    reports: list[dict]  # of pytest, in the form in which they are sent
    death: str  # what the process ended of, in it or after it


class OrdinaryRun:
    """The run of tests of one file: in one process or, after a crash, in more.

    `publish(nodeid, told)` is called once for every test. `run` is for a thread; `stop` and then
    `wait` may come from another. busy_s: of a processor, which it has taken.
    """

    def __init__(self, config, path, nodeids, timeout_s, publish):
        option = config.option
        self.command = [sys.executable, "-X", CACHES, "-m", "pytest", "-q", "--no-header"]
        self.command += ["-c", config.inipath, "--rootdir", config.rootpath, path]
        self.command += ["--tb", option.tbstyle, *(["--showlocals"] if option.showlocals else [])]
        for name in option.plugins or ():
            self.command += ["-p", name]
        for setting in option.override_ini or ():
            self.command += ["-o", setting]
        self.folder = config.invocation_params.dir
        # Folders of tests stand in one for all of them, of which pytest keeps the last three.
        self.temporary = config._tmp_path_factory.getbasetemp() / path.stem
        self.left = list(nodeids)
        self.limit_s = timeout_s + GRACE_S
        self.publish = publish
        self.process = None
        self.stopped = False
        self.busy_s = 0.0

    def run(self):
        while self.left and not self.stopped:
            self._run_process()

    def stop(self):
        """Ends it as Ctrl-C would, so that fixtures put away what they have started."""
        self.stopped = True
        if self.process:
            self.process.terminate()

    def wait(self):
        """Until it has ended after `stop`, well or not."""
        if self.process:
            try:
                self.process.wait(STOP_S)
            except subprocess.TimeoutExpired:
                _kill_all(self.process)

    def _run_process(self):
        """Runs what is left until the process ends; at least one test is published."""
        nodeid, told = "", []
        parts = [f"--only={each}" for each in self.left]
        parts += [f"--basetemp={self.temporary}-{len(self.left)}"]
        # A session of its own, which can be killed with all that is in it.
        self.process = start([*self.command, *parts], cwd=self.folder, start_new_session=True)
        if self.stopped:  # while it was being started
            self.process.terminate()
        for text, word, argument in reports(self.process, self.limit_s, good=ALL_RAN):
            if word == "began":
                if nodeid:
                    self._conclude(nodeid, told)
                nodeid, told = argument, []
            elif word == "report":
                told.append(ast.literal_eval(argument))
            elif word == "busy":
                self.busy_s += float(argument)
            elif word == "ended" and not self.stopped:
                self._conclude_process(nodeid, told, text, argument)
        _kill_all(self.process)

    def _conclude(self, nodeid, told, death=""):
        self.left.remove(nodeid)
        self.publish(nodeid, Told(told, death))

    def _conclude_process(self, nodeid, told, output, death):
        if not nodeid:  # most likely the file cannot even be imported
            reason = f"{output}\nNo test of this file could be run: {death or 'pytest ended'}."
            for nodeid in list(self.left):
                self._conclude(nodeid, [], reason)
        elif death:
            self._conclude(nodeid, told, f"{output}\nIn or after this test {death}.")
        else:
            self._conclude(nodeid, told)


def _kill_all(process):
    """What a test has started and left as well."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


class Teller:
    """A plugin of the pytest that runs the tests: picks them, and tells of each."""

    def __init__(self, config, nodeids):
        self.config = config
        self.nodeids = nodeids

    def pytest_collection_modifyitems(self, items):
        items[:] = [item for item in items if item.nodeid in self.nodeids]

    def pytest_runtest_logstart(self, nodeid):
        self._tell("began", nodeid)

    def pytest_runtest_logreport(self, report):
        hook = self.config.hook
        data = hook.pytest_report_to_serializable(config=self.config, report=report)
        self._tell("report", repr(data))  # as a text a tuple is still a tuple

    def pytest_sessionfinish(self):
        both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        used = [seconds for who in both for seconds in resource.getrusage(who)[:2]]
        self._tell("busy", sum(used))

    def _tell(self, word, argument):
        print(f"{MARK}{word} {argument}", flush=True)
