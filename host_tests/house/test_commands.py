# SPDX-License-Identifier: MIT
"""The commands in the manuals: what can be run here is run, and says what the manual says; every
option is one of its command, and every option of a command stands in a manual.
"""

import functools
import re
import shutil
import subprocess

import pytest
from test_manuals import MANUALS

from page_bench import indented, text
from tiers import TOP

INTERPRETERS = "host"

READ = [manual for manual in MANUALS if "CHANGELOG" not in manual]
COMMAND = re.compile(r"^(?:\./tools/|python3 tools/|\.ci/run)")

# What is run here: standard input, and what is printed then. The working directory has mine.py,
# a board or a program.
LOOK = "wait 3000\nlcd\n"
READY = "READY        A1"
RUNS = {
    "./tools/panel --drives 1,2,3": (LOOK, READY),
    "./tools/panel --drives 1=mm440,2=g110,3=v20/4,4=g120,5=mm3,8=mm420/factory": (
        LOOK,
        "drive 8 is as delivered: it answers at address 0, at 9600 baud, not 19200",
    ),
    "./tools/panel --unset --drives 8=mm420/factory": (
        "wait 2500\npress SET\nwait 3000\npress SET\nwait 28000\nlcd\n",
        "A0 9600 MM420",
    ),
    "./tools/panel --keys compact": ("wait 3000\npress FN\nwait 300\nlcd\n", "^"),
    "./tools/panel --json FILE": (LOOK, READY),
    "./tools/panel --settings panel1/settings.json": (LOOK, READY),
    "./tools/drive --switch help": ("", "boot_ms"),
    "./tools/example one_drive": ("", "running"),
    "./tools/example mine.py --drives 1,2=g110,5=mm440": ("", "running"),
    "./tools/check-board mine.py": ("", "nothing is wrong with it"),
}
PROGRAM, BOARD = "tools/examples/one_drive.py", "boards/pico/board.py"

# Where the others are run, or why they are not: beginnings of commands.
ELSEWHERE = {
    ".ci/run": "it is what runs all this",
    "./tools/bench": "test_bench.py",
    "./tools/bringup": "test_bringup_command.py, test_pico_bringup.py",
    "./tools/check-board NAME": "test_check_board.py",
    "./tools/deploy": "test_pico_deploy.py, test_pico_deploy_stock.py, test_deploy.py",
    "./tools/drive --pty": "test_drive_command.py",
    "./tools/example FILE --port PATH": "test_uss_serial.py",
    "./tools/example one_drive --port": "test_uss_serial.py",
    "./tools/mutants": "test_mutants_command.py",
    "./tools/panel --board pico": "test_pico_command.py",
    "./tools/panel --lines": "test_lines.py",
    "./tools/panel --port": "test_port_panel.py",
    "./tools/panel --settings": "test_command_line.py",
    "./tools/panel --script": "test_key_scripts.py, test_first_power_on.py, test_manuals.py",
    "./tools/panel --unset --baud 38400": "test_first_power_on.py",
    "./tools/panel --web": "test_page.py, test_page_link.py, test_page_static.py",
    "./tools/panel --join": "test_join.py",
    "./tools/release": "test_release.py",
    "./tools/settings": "test_settings_command.py",
    "./tools/soak": "test_soak_command.py",
    "./tools/test": "it is what runs this",
    "./tools/uf2": "the firmware that the emulated Pico runs is built by it",
    "./tools/uss": "test_uss_session.py, test_uss_sets.py",
    "python3 tools/drawing": "test_drawing.py",
    "python3 tools/emulator/launch.py": "test_pico_command.py",
    "python3 tools/pictures": "test_pictures.py",
    "python3 tools/reference": "test_reference.py",
    "python3 tools/releasing/mip.py": "test_release.py",
}


def commands():
    """Each command in a block of a manual, or in a sentence if it has arguments."""
    for manual in READ:
        page = text(manual)
        blocks = "\n".join(indented(page)).replace("\\\n", " ")
        lines = [line.strip() for line in blocks.split("\n")]
        lines += [line for line in re.findall(r"`([^`\n]+)`", page) if " " in line]
        for line in lines:
            if COMMAND.match(line):
                yield manual, " ".join(line.split())


def test_every_command_is_run_somewhere():
    told = {command for _, command in commands()}
    assert len(told) > 40
    missing = [
        command
        for command in told
        if command not in RUNS and not any(command.startswith(one) for one in ELSEWHERE)
    ]
    assert not missing
    assert RUNS.keys() <= told, RUNS.keys() - told
    for begin, where in ELSEWHERE.items():
        assert any(command.startswith(begin) for command in told) or begin == ".ci/run", begin
        for name in re.findall(r"\w+\.py", where):
            assert list((TOP / "host_tests").rglob(name)), (begin, name)


@pytest.mark.parametrize("command", RUNS)
def test_a_command_does_what_the_manual_says(command, tmp_path):
    typed, said = RUNS[command]
    (tmp_path / "panel1").mkdir()
    shutil.copy(TOP / (BOARD if "check-board" in command else PROGRAM), tmp_path / "mine.py")
    if typed:
        command += " --script -"
    run = subprocess.run(
        ["bash", "-c", command.replace("./tools", str(TOP / "tools"))],
        cwd=tmp_path, input=typed, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert said in run.stdout + run.stderr, run.stdout + run.stderr


# ---- options --------------------------------------------------------------------------------

NAMES = [path.name for path in (TOP / "tools").iterdir() if path.is_file() and not path.suffix]
OPTION = r"--[a-z][a-z0-9-]*[a-z0-9]"


@functools.cache
def options(name):
    """Those of its --help; those of tools/uss, of which each verb has a help, from its source."""
    if name == "uss":
        sources = [
            path.read_text(encoding="utf-8") for path in (TOP / "tools").rglob("uss_c*/*.py")
        ]
        return set(re.findall(rf"""["']({OPTION})["'=]""", "\n".join(sources)))
    command = [TOP / "tools" / name, "--help"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 0, run.stderr
    return set(re.findall(OPTION, run.stdout)) - {"--durations", "--lf"}  # (those of pytest)


@pytest.mark.parametrize("name", NAMES)
def test_every_option_stands_in_a_manual(name):
    told = "\n".join(text(manual) for manual in READ)
    missing = [one for one in sorted(options(name)) if not re.search(rf"{one}(?![\w-])", told)]
    assert not missing


def test_every_option_of_a_command_is_one_of_its_own():
    count = 0
    for manual, command in commands():
        found = re.match(r"\./tools/([\w-]+) (.*)", command)
        if found and found[1] in NAMES:
            known = options(found[1]) | {"--help", "--version"}
            for option in re.findall(rf"(?<!\S)({OPTION})", found[2]):
                count += 1
                assert option in known, (manual, command)
    assert count > 30


def test_every_file_that_a_manual_names_is_there():
    count = 0
    for manual in READ:
        for name in re.findall(
            r"`((?:[\w.-]+/)+[\w.-]+\.(?:py|md|txt|tsv|svg|json|sh|mjs))`", text(manual)
        ):
            if not name.startswith("build/") and "NAME" not in name:
                count += 1
                beside = (TOP / manual).parent / name
                places = (TOP / name, beside, TOP / "firmware" / name, TOP / "boards" / name)
                assert any(place.exists() for place in places), (manual, name)
    assert count > 60
