# SPDX-License-Identifier: MIT
"""tools/bench: its command line, and that a figure which does not hold is shown and told.

What it measures is measured on the emulated chip, by tools/bench itself: no test repeats it.
"""

import ast
import json
import subprocess
import sys

import pytest

from conftest import strict
from tiers import TOP
from tools.benching import beside_s7, report, rows

INTERPRETERS = "host"

BENCH = TOP / "tools" / "benching"


ON_CHIP = rows.Task(("line", "9600"))
ON_HOST = rows.Task(("codec",), on_chip=False)
LOW = rows.Row(ON_CHIP, "a duration", "<= 5", lambda f: "%d" % f["it"], lambda f: f["it"] <= 5)
PLAIN = rows.Row(ON_CHIP, "a number", "", lambda f: "%d" % f["it"], None)
HOST = rows.Row(ON_HOST, "a speed", ">= 5", lambda f: "%d" % f["it"], lambda f: f["it"] >= 5)


def judged(chip, host=None):
    return report.judge([LOW, PLAIN, HOST], {ON_CHIP: chip, ON_HOST: host or {"it": 9}})


def bench(*arguments):
    done = subprocess.run(
        [sys.executable, "-I", "-B", str(BENCH), "--check", *arguments],
        capture_output=True,
        text=True,
    )
    return done.returncode, done.stderr


def test_bars_that_hold_are_told_as_met():
    lines = judged({"it": 5})
    assert [line.verdict for line in lines] == ["met", "", "met"]
    assert report.status(lines) == 0


def test_a_bar_of_the_chip_that_does_not_hold_is_shown_and_is_status_1():
    lines = judged({"it": 6})
    assert report.status(lines) == 1
    assert "| a duration | <= 5 | 6 | NOT MET |" in report.table(lines)


def test_a_bar_of_the_host_is_shown_and_changes_no_status():
    lines = judged({"it": 5}, {"it": 1})
    assert report.status(lines) == 0
    assert "| a speed | >= 5 | 1 | NOT MET |" in report.table(lines)


def test_a_measurement_that_failed_says_why_and_is_status_1():
    lines = judged({"error": "no | reply (status 1)"})
    assert report.status(lines) == 1
    assert "| a duration | <= 5 | no / reply (status 1) | FAILED |" in report.table(lines)


def test_the_page_says_what_was_measured_when_and_how_and_that_it_was_quick():
    page = report.page(judged({"it": 5}), ["micropython 1"], "2026-01-31", "./tools/bench", False)
    for text in ("2026-01-31", "`./tools/bench`", "micropython 1", "## On the chip", "a speed"):
        assert text in page, text
    assert "QUICK" not in page
    quick = report.page(judged({"it": 5}), [], "2026-01-31", "./tools/bench --quick", True)
    assert "QUICK" in quick


def test_every_task_is_a_measurement_that_exists_and_has_a_row():
    tree = ast.parse((BENCH / "measurements.py").read_text(encoding="utf-8"))
    arguments = {
        node.name: len(node.args.args) for node in tree.body if isinstance(node, ast.FunctionDef)
    }
    for task in rows.TASKS:
        if not task.beside:
            assert arguments[task.name] == len(task.command), task  # quick stands for the name
        assert [row for row in rows.ROWS if row.task == task], task
    assert {row.task for row in rows.ROWS} == set(rows.TASKS)


def test_a_run_on_the_host_alone_leaves_what_was_measured_on_the_chip():
    first = report.page(judged({"it": 5}), ["old"], "2026-01-31", "./tools/bench", False)
    host = report.judge([HOST], {ON_HOST: {"it": 77}})
    later = report.with_host(first, host, ["new"], "2026-02-01", "./tools/bench --host", False)
    assert later.count("## On the chip") == later.count("## On this host") == 1
    assert "| a duration | <= 5 | 5 | met |" in later
    assert "| a speed | >= 5 | 77 | met |" in later and "| 9 |" not in later
    assert later.index("2026-01-31") < later.index("On this host") < later.index("2026-02-01")
    again = report.with_host(later, host, ["new"], "2026-02-01", "./tools/bench --host", False)
    assert again == later


def test_the_rates_stand_beside_those_of_an_s7_and_what_the_wire_allows():
    rated = [row for row in rows.ROWS if row.beside]
    assert [row.beside for row in rated] == list(rows.BAUDS)
    figures = {row.task: {"rate": float(row.beside) / 1000} for row in rated}
    page = report.page(report.judge(rated, figures), [], "", "", False)
    assert "| 9600 | 8.6 | 20.0 | 9.6 | 24.2 | 40 % |" in page
    assert "| 187500 | - | - | 187.5 | 473.5 | 40 % |" in page
    found = {row.baud: row.rates for row in beside_s7.rows_of(page)}
    assert list(found) == list(rows.BAUDS)
    assert found[115200] == {
        "S7-1200": 35.6, "S7-200": 40.0, beside_s7.OURS: 115.2, beside_s7.WIRE: 290.9
    }  # fmt: skip
    assert found[187500] == {beside_s7.OURS: 187.5, beside_s7.WIRE: 473.5}


def test_a_rate_that_could_not_be_measured_is_not_in_the_table():
    rated = [row for row in rows.ROWS if row.beside]
    figures = {row.task: {"rate": 20.0} for row in rated}
    figures[rated[0].task] = {"error": "no reply"}
    page = report.page(report.judge(rated, figures), [], "", "", False)
    assert [row.baud for row in beside_s7.rows_of(page)] == list(rows.BAUDS[1:])


def test_the_table_of_the_last_run_is_that_of_its_rows():
    page = (TOP / "tools" / "bench.md").read_text(encoding="utf-8")
    found = {row.baud: row.rates[beside_s7.OURS] for row in beside_s7.rows_of(page)}
    assert set(found) == set(rows.BAUDS)
    for row in rows.ROWS:
        if row.beside:
            (line,) = [line for line in page.split("\n") if line.startswith("| %s |" % row.what)]
            assert line.split("|")[3].strip() == "%.1f" % found[row.beside], line
    section = beside_s7.section({baud: "%.1f" % rate for baud, rate in found.items()})
    assert section in page


def library_figures(exchange_us, fastest_us):
    figures = {name: {"parse_us": 30.0, "exchange_us": 90.0} for name in rows.OTHERS}
    figures["UModbus"]["exchange_us"] = fastest_us
    figures["Uss"] = {"parse_us": 10.0, "exchange_us": exchange_us}
    return figures


def test_the_library_is_held_against_the_fastest_of_the_others():
    for exchange_us, fastest_us, verdict in ((10.0, 30.0, "met"), (10.0, 29.9, "NOT MET")):
        figures = {rows.LIBRARIES: library_figures(exchange_us, fastest_us)}
        lines = report.judge([row for row in rows.ROWS if row.task.beside], figures)
        told = {line.row.what: line for line in lines}
        assert told["an exchange, this library"].verdict == verdict
        assert told["a reply parsed, this library"].verdict == "met"
        assert told["an exchange, PyModbus"].figure == "90.0 us: 9.0 times ours"
        assert report.status(lines) == 0
        assert "### Beside other libraries" in report.page(lines, [], "", "", False)


def test_the_library_can_be_measured_beside_the_others():
    """Each reads the right values, and none from a spoilt reply, or this ends with an error."""
    interpreter = TOP / "build" / "libraries" / "bin" / "python"
    if not interpreter.exists() and not strict():
        pytest.skip("the other libraries are not here: tools/bench --host fetches them")
    measure = [interpreter, "-I", "-B", BENCH / "libraries.py", "quick", "libraries"]
    done = subprocess.run(measure, cwd=TOP, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures.keys() == {"Uss", *rows.OTHERS}
    for name, told in figures.items():
        assert told["parse_us"] > 0 and told["exchange_us"] > 0, name


def test_what_is_measured_on_the_host_alone_can_be_measured():
    """A quick look: the figures are there. How large they are is none of a test's business."""
    interpreter = TOP / "build" / "unix64" / "micropython"
    measure = [interpreter, "-X", "heapsize=32M", BENCH / "measurements.py", "quick", "codec"]
    done = subprocess.run(measure, cwd=TOP, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures["receiver"] > 0 and figures["builder"] > 0


def line_figures(**changed):
    figures = {
        "rate": 270.0,
        "idle_ns": [1, 240_000, 1_000_000, 1_000_000, 10_000],
        "release_ns": [1_000, 1_100, 1_100, 1_200, 10_000],
        "lead_ns": [1_000, 1_100, 1_100, 1_200, 10_000],
        "steps_us": [1_000, 1_500, 1_900, 1_000],
        "character_ns": 95_486,
        "complaints": [],
        "restarts": [],
    }
    figures.update(changed)
    return figures


def missed(figures):
    """What is NOT MET of the rows at 115200 baud."""
    task = rows.LINES[115200]
    lines = report.judge([row for row in rows.ROWS if row.task == task], {task: figures})
    return [line.row.what.split(",")[0] for line in lines if line.verdict == report.NOT_MET]


def test_the_bars_of_the_line_are_where_the_design_puts_them():
    release = "driver off after the last stop bit"
    idle = "reply to next start bit beyond the start interval"
    for changed, wanted in (
        ({}, []),
        ({"rate": 259.9}, ["exchanges per second"]),
        ({"idle_ns": [1, 250_000, 1_100_000, 9_999_999, 10_000]}, []),
        ({"idle_ns": [1, 250_001, 1_000_000, 1_400_000, 10_000]}, [idle]),
        ({"idle_ns": [1, 200_000, 1_100_001, 1_800_000, 10_000]}, [idle]),
        ({"release_ns": [0, 1, 1, 95_486, 10_000]}, []),
        ({"release_ns": [-1, 1, 1, 95_486, 10_000]}, [release]),
        ({"release_ns": [0, 1, 1, 95_487, 10_000]}, [release]),
        ({"release_ns": [0, 1, 1, 1, 9_999]}, [release]),
        ({"lead_ns": [0, 1, 1, 95_487, 10_000]}, ["driver on before the first start bit"]),
        ({"steps_us": [1_000, 1_500, 4_001, 9]}, ["a step of the main loop"]),
        ({"complaints": ["at 1: a gap"]}, ["rules of line and display broken"]),
        ({"restarts": ["watchdog at 1"]}, ["rules of line and display broken"]),
    ):
        assert missed(line_figures(**changed)) == wanted, changed


def test_a_command_line_that_cannot_be_understood_is_status_2():
    assert bench() == (0, "")
    assert bench("--quick", "--only", "stop", "--only", "boot") == (0, "")
    assert bench("--host", "--only", "libraries") == (0, "")
    for arguments in (
        ("--host", "--only", "stop"),
        ("--only",),
        ("--only", "coffee"),
        ("--fast",),
        ("stop",),
    ):
        status, said = bench(*arguments)
        assert status == 2 and said.startswith("tools/bench: "), arguments
        assert said.count("\n") == 1
