# SPDX-License-Identifier: MIT
"""pyrefly, which reads code for mistakes, as tools/fetch/pyrefly.sh has fetched it."""

import json
import subprocess
import sys

import pytest

from conftest import strict
from tiers import TOP

PYREFLY = TOP / "build/pyrefly/bin/pyrefly"


def errors(*arguments, folder=TOP):
    """What it finds in `folder`: dictionaries with path, line and description.

    Skips the test where pyrefly is not, if it need not be.
    """
    if not PYREFLY.exists() and not strict():
        pytest.skip("no pyrefly is here: tools/test with USS_STRICT=1 fetches it")
    # With the packages of this Python, whatever the one of the machine has.
    command = [PYREFLY, "check", "--output-format", "json", *arguments]
    command += ["--python-interpreter-path", sys.executable]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=60)
    assert run.stdout, run.stderr
    return json.loads(run.stdout)["errors"]
