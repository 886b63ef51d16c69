# SPDX-License-Identifier: MIT
"""Which lines of the firmware ran: what is noted is what a tracer sees, and changes nothing.

The tracer is that of the library `coverage`, which costs three times as much.
"""

import json
import subprocess
import sys

import pytest

from line_coverage import LineCoverage
from tiers import TOP

INTERPRETERS = "host"

# Every kind of statement, some of which do not run.
SOURCE = '''"""Text."""
import sys
from os import (
    path,
)


def decorate(function):
    return function


@decorate
@decorate
def never(
    a,
):
    """Text."""
    return a


def values(upto):
    for value in range(upto):
        yield value
    else:
        yield -1


class Kind:
    """Text."""

    rate: int = 3
    __private = 4

    def method(self):
        if self.rate == 4:
            return 1
        elif self.rate == 3:
            __private = self.__private
        else:
            return 2
        while True: break
        return (
            __private
        )


class Empty:
    pass


def caught(action):
    global last
    last = 0
    try:
        action()
    except (KeyError, IndexError) as error:
        last = error
    except ValueError:
        last = 2
        raise
    except:
        last = 3
    else:
        last = 4
    finally:
        last = [last]
    return last


def thrown(error):
    def throw():
        nonlocal error
        raise error
        error = None
    return throw


def nothing(): return None


caught(thrown(IndexError))
caught(nothing)
caught(thrown(TypeError))
with open(path.devnull) as first, \\
        open(path.devnull) as second:
    assert first
    del first
list(values(3))
text = [
    Kind().method(),
    (lambda:
        3),
]
'''

# What runs two lines more.
MORE = """
try:
    caught(thrown(ValueError))
except Exception: pass
"""

# Imports `it` and tells which lines ran, by either means.
BOTH = """
import json, sys
sys.path[:0] = ["firmware", sys.argv[2]]
if sys.argv[1] == "noted":
    import line_notes
    line_notes.begin()
    import it
    seen = {path: list(numbers) for path, numbers in line_notes.seen()}
else:
    from coverage import Coverage
    coverage = Coverage(None, config_file=False, source=["firmware"])
    coverage.start()
    import it
    coverage.stop()
    data = coverage.get_data()
    seen = {"firmware/it.py": data.lines(data.measured_files().pop())}
print(json.dumps(seen))
"""


@pytest.fixture
def table(tmp_path):
    """The table of a source, by either means."""

    def made(how, source):
        (tmp_path / "firmware").mkdir(exist_ok=True)
        (tmp_path / "firmware" / "it.py").write_text(source)
        command = [sys.executable, "-B", "-c", BOTH, how, TOP / "host_tests" / "cpython"]
        told = subprocess.check_output(command, cwd=tmp_path, text=True)
        coverage = LineCoverage(tmp_path)
        for path, numbers in json.loads(told).items():
            coverage.note(path, numbers)
        return coverage.report()

    return made


@pytest.mark.parametrize("more, missing", [("", "18, 36, 40, 59-60"), (MORE, "18, 36, 40")])
def test_what_is_noted_is_what_a_tracer_sees(table, more, missing):
    noted = table("noted", SOURCE + more)
    assert noted == table("traced", SOURCE + more)
    assert noted[2].endswith("%   " + missing)


# The panel throws modules away and imports them again, and they are themselves each time.
AGAIN = """
import sys, traceback
sys.path[:0] = ["firmware", sys.argv[1]]
import line_notes
line_notes.begin()
for upto in range(2):
    import it
    it.run(upto)
    del sys.modules["it"]
assert sorted(name for name in dir(it) if name[:2] != "__") == ["run"]
assert it.__doc__ == "Text."
print(*line_notes.seen())
try:
    it.run(2)
except ZeroDivisionError as error:
    print(traceback.extract_tb(error.__traceback__)[-1].line)
"""


def test_a_module_is_the_same_with_notes_and_is_noted_each_time(tmp_path):
    (tmp_path / "firmware").mkdir()
    (tmp_path / "firmware" / "it.py").write_text(
        '"""Text."""\ndef run(n):\n if n == 0:\n  return 1\n if n == 2:\n  1 / 0\n return 3\n'
    )
    command = [sys.executable, "-B", "-c", AGAIN, TOP / "host_tests" / "cpython"]
    told = subprocess.check_output(command, cwd=tmp_path, text=True)
    assert told == "('firmware/it.py', {2, 3, 4, 5, 7})\n1 / 0\n"


# A copy of the process runs what this one does not.
IN_A_TWIN = """
import sys
sys.path[:0] = ["firmware", *sys.argv[1:]]
import line_notes
line_notes.begin()
from twin import twin
import it
twin(it.run, 0)
print(*line_notes.seen())
"""


def test_what_a_twin_runs_is_noted(tmp_path):
    (tmp_path / "firmware").mkdir()
    (tmp_path / "firmware" / "it.py").write_text(
        "def run(n):\n if n == 0:\n  return 1\n return 2\n"
    )
    places = [TOP / "host_tests" / name for name in ("cpython", "benches")]
    command = [sys.executable, "-B", "-c", IN_A_TWIN, *places]
    told = subprocess.check_output(command, cwd=tmp_path, text=True)
    assert told == "('firmware/it.py', {1, 2, 3})\n"
