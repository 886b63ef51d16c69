# SPDX-License-Identifier: MIT
"""tools/bench: measures, prints one table, writes it into tools/bench.md, and draws its bars.

    python3 tools/benching [--host] [--only NAME ...] [--quick]

Every measurement is a separate process (measurements.py, libraries.py); two run at a
time. This program knows no chip, and leaves the judging to rows.py. Standard library only, CPython
3.11 or newer.
"""

import argparse
import concurrent.futures
import datetime
import json
import os
import platform
import signal
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.benching import beside_s7, report  # noqa: E402
from tools.benching.rows import ROWS, TASKS, names  # noqa: E402
from tools.command_line import Parser  # noqa: E402
from tools.pictures.bench import bench  # noqa: E402
from tools.progress import Progress  # noqa: E402

LAUNCH = [sys.executable, "-I", "-B", "tools/emulator/launch.py"]
MICROPYTHON = ["build/unix64/micropython", "-X"]
HEAPS = {True: "heapsize=64M", False: "heapsize=16M"}  # beside a chip; alone, as tools/panel
PROGRAM = "tools/benching/measurements.py"
LIBRARIES = ["build/libraries/bin/python", "-I", "-B", "tools/benching/libraries.py"]
OUTPUT = TOP / "tools" / "bench.md"
PICTURE = TOP / ".github" / "pictures" / beside_s7.PICTURE
AT_A_TIME = 2
TIMEOUT_S = 900  # of one measurement; the longest takes five minutes on a slow machine


def parser():
    arguments = Parser(
        prog="tools/bench",
        description="Measures the firmware on the emulated Pico, and the host.",
        epilog="Exit status: 0 all bars of the chip hold, 1 one does not, 2 wrong arguments.",
    )
    arguments.add_argument(
        "--host",
        action="store_true",
        help="only what needs no Pico: the host alone, and the library beside others",
    )
    arguments.add_argument(
        "--only", metavar="NAME", action="append", choices=names(), help=" ".join(names())
    )
    arguments.add_argument(
        "--quick", action="store_true", help="fewer samples, and no tools/bench.md"
    )
    arguments.add_argument("--check", action="store_true", help=argparse.SUPPRESS)
    return arguments


def program_of(task):
    """What measures it; how exactly, and which task, comes after that."""
    if task.beside:
        return LIBRARIES
    return [*(LAUNCH if task.on_chip else []), *MICROPYTHON, HEAPS[task.on_chip], PROGRAM]


def measure(task, quick):
    """The figures of one task, or {"error": text}."""
    command = [*program_of(task), "quick" if quick else "full", *task.command]
    environment = {name: value for name, value in os.environ.items() if name != "MICROPYPATH"}
    process = subprocess.Popen(
        command,
        cwd=TOP,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    try:
        said = process.communicate(timeout=TIMEOUT_S)[0]
    except subprocess.TimeoutExpired:
        return {"error": "took longer than %d s" % TIMEOUT_S}
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    return understood(said, process.returncode)


def understood(said, status):
    """What a measurement printed: its last line is the figures, when it came to its end."""
    lines = said.strip().splitlines() or [""]
    if status == 0:
        try:
            return json.loads(lines[-1])
        except ValueError:
            pass
    return {"error": "%s (status %d)" % (lines[-1], status), "said": said}


def measure_all(tasks, quick):
    """{task: figures}; runs the long tasks first. Tells errors at once."""
    figures = {}
    progress = Progress(len(tasks))
    with concurrent.futures.ThreadPoolExecutor(AT_A_TIME) as pool:
        running = {pool.submit(measure, task, quick): task for task in tasks}
        for done in concurrent.futures.as_completed(running):
            task = running[done]
            figures[task] = done.result()
            line = f"    {' '.join(task.command)}  {progress.line(len(figures))}"
            print(line, file=sys.stderr, flush=True)
            if "error" in figures[task]:
                print(figures[task].get("said", figures[task]["error"]), file=sys.stderr)
    return figures


def versions():
    """What was measured, and with which versions."""

    def read(path):
        try:
            return (TOP / path).read_text(encoding="utf-8")
        except OSError:
            return ""

    built = [line for line in read("build/pico/panel.made_of").splitlines()[1:] if line]
    package = read("build/emulator/node_modules/rp2040js/package.json")
    emulator = "rp2040js " + json.loads(package)["version"] if package else "no rp2040js"
    cpython = platform.python_version()
    host = "host: %s, %s CPUs, CPython %s" % (platform.machine(), os.cpu_count(), cpython)
    return [*built, emulator, host]


def main(arguments):
    options = parser().parse_args(arguments)
    tasks = [
        task
        for task in TASKS
        if (not options.only or task.name in options.only) and not (options.host and task.on_chip)
    ]
    if not tasks:
        parser().error("nothing of that is measured on the host alone")
    if options.check:
        return 0
    figures = measure_all(tasks, options.quick)
    judged = report.judge([row for row in ROWS if row.task in figures], figures)
    command = " ".join(["./tools/bench", *arguments])
    today = datetime.date.today().isoformat()
    made = [versions(), today, command, options.quick]
    text = report.page(judged, *made)
    print(text)
    if not options.quick and not options.only:
        if options.host:
            text = report.with_host(OUTPUT.read_text(encoding="utf-8"), judged, *made)
        OUTPUT.write_text(text + "\n", encoding="utf-8")
        PICTURE.write_text(bench().svg(), encoding="utf-8")
    return report.status(judged)


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
