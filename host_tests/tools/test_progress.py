# SPDX-License-Identifier: MIT
"""Long work says how far it is: n of N, and the time that is left."""

import os
import pty
import re
import subprocess

import pytest

from deploy_bench import FLASH, NEWER, FakeChip, deploy, firmware
from tiers import TOP
from tools.progress import Progress, shown

INTERPRETERS = "host"


class Clock:
    now = 100.0

    def __call__(self):
        return self.now


def test_what_is_left_takes_as_long_as_what_is_done():
    clock = Clock()
    progress = Progress(20, clock)
    assert progress.line(0) == "0 of 20"
    clock.now += 1
    assert progress.line(1) == "1 of 20"  # too soon to tell
    clock.now += 9
    assert progress.line(4) == "4 of 20, 40 s left"
    assert progress.line(4, part=1) == "4 of 20, 30 s left"
    assert progress.line(20) == "20 of 20"


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.4, "0 s"), (59.4, "59 s"), (60, "1:00 min"), (3599, "59:59 min"), (3660, "1:01 h")],
)
def test_a_time_is_told_as_a_person_says_it(seconds, text):
    assert shown(seconds) == text


def test_deploy_counts_its_files():
    FLASH.clear()
    said = deploy(FakeChip(), firmware(NEWER)).splitlines()
    told = [line for line in said if line.startswith("copy") and " of " in line]
    count = len(told)
    assert count >= 5
    for number, line in enumerate(told, 1):
        assert re.fullmatch(rf"copy    \S+  \d+ bytes, {number} of {count}", line), line


# ---- what the shell fetches and builds --------------------------------------------------------


def quietly(log, work, terminal):
    """What `quietly` says of this work in the words of bash, and its status."""
    script = f'top=$0; . "$top/tools/fetch/folder.sh"; work() {{ {work}; }}; quietly "$1" work'
    ours, theirs = pty.openpty()
    error = theirs if terminal else subprocess.PIPE
    run = subprocess.Popen(["bash", "-c", script, TOP, log], stderr=error)
    os.close(theirs)
    said = b""
    if terminal:
        try:
            while piece := os.read(ours, 1000):
                said += piece
        except OSError:
            pass  # all of them have closed it
    else:
        said = run.stderr.read()
        run.stderr.close()
    os.close(ours)
    return said.decode(), run.wait()


def test_a_build_that_counts_tells_how_far_it_is_and_a_line_is_left_clean(tmp_path):
    work = "for n in 1 2 3; do echo [$n/4] Building; sleep 1; done"
    said, status = quietly(tmp_path / "log", work, terminal=True)
    assert status == 0
    assert re.search(r"\r\x1b\[K    [12] of 4, \d s left", said), said
    assert said.endswith("\r\x1b[K")


def test_what_does_not_count_tells_how_long_it_has_taken(tmp_path):
    said, status = quietly(tmp_path / "log", "sleep 2.5; echo why; false", terminal=True)
    assert status == 1
    assert re.search(r"\r\x1b\[K    [12] s\r", said), said  # bash counts in whole seconds
    assert said.replace("\r\n", "\n").endswith("\r\x1b[K    that failed:\n    why\n"), said


def test_into_a_file_nothing_of_that_is_written(tmp_path):
    said, status = quietly(tmp_path / "log", "echo [1/4] Building; sleep 1.2", terminal=False)
    assert (said, status) == ("", 0)
