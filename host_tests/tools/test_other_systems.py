# SPDX-License-Identifier: MIT
"""The panel, the drives, tools/uss and the tests of two tiers where there is no Debian.

The machine here has a `micropython` in its PATH, and of the programs that scripts call those of
macOS: no apt, no dpkg, no flock, no timeout, and a readlink without -f. What its bash cannot do
is looked for in the text of the scripts.
"""

import os
import re
import shutil
import subprocess
import sys
from contextlib import contextmanager

import pytest

from tiers import TIERS, TOP

INTERPRETERS = "host"

MICROPYTHON = TIERS["unix64"].command[0]

TREE = ("boards", "firmware", "host_tests", "tools")
EVERYWHERE = (
    "bash sh env dirname mkdir rm ln cat sed awk grep head tail sleep sort cp chmod cmp tee "
    "stty find tar ps"
).split()
# macOS has had `readlink -f` since 2022 only, and its `mv` has never known -T.
STRICT = """#!/bin/sh
case "$1" in -*) echo "{name}: illegal option $1" >&2; exit 1 ;; esac
exec {path} "$@"
"""
LACKING = "apt-get apt-cache dpkg dpkg-deb flock timeout nproc sha256sum stat node".split()

# The scripts that the commands of this file run, and those that they source.
COMMANDS = "panel drive example uss test soak check-board deploy bringup".split()
SCRIPTS = [TOP / "tools" / name for name in COMMANDS]
SCRIPTS += [
    TOP / "tools" / "fetch" / f"{name}.sh"
    for name in "begin folder packages micropython pytest uss mpremote".split()
]
NEWER_THAN_3_2 = {
    "an array of names": r"(declare|local|typeset) -\w*[Ag]",
    "lines into an array": r"\b(mapfile|readarray)\b",
    "letters made small or large": r"\$\{\w+(\[[^]]*\])?(,,?|\^\^?)",
    "words made ready to be read again": r"\$\{[\w@*[\]]+@[A-Za-z]\}",
    "the number of a subshell, the clock": r"\$\{?(BASHPID|EPOCH\w+|SRANDOM)\b",
    "both outputs at once": r"\|&|&>>",
    "on into the next case": r";;?&",
    "whether a variable is set": r"\[\[ -[vR] ",
    "waiting for the next child": r"\bwait -[np]\b",
    "a coprocess": r"\bcoproc\b",
    "options of bash": r"shopt -s (globstar|lastpipe|inherit_errexit|autocd)",
    "reading so many characters": r"\bread -\w*[iN]",
    "a date by printf": r"printf [^\n]*%\(",
    "a file number into a variable": r"\{[a-z_]+\}[<>]",
    "an index from the end": r"\$\{\w+\[-\d",
    "a length from the end": r"\$\{\w+:[^}-]+: ?-\d",
}


@pytest.fixture(scope="module")
def machine(tmp_path_factory):
    return Machine(tmp_path_factory.mktemp("mac"))


class Machine:
    """A fresh tree, and a PATH with nothing of Debian's."""

    def __init__(self, folder):
        self.top = folder / "a tree"
        self.programs = folder / "bin"
        self.top.mkdir()
        self.programs.mkdir()
        for name in TREE:
            shutil.copytree(TOP / name, self.top / name, ignore=shutil.ignore_patterns("__pyc*"))
        for name in EVERYWHERE:
            (self.programs / name).symlink_to(shutil.which(name))
        (self.programs / "python3").symlink_to(sys.executable)
        for name in ("readlink", "mv"):
            self.install(name, STRICT.format(name=name, path=shutil.which(name)))
        self.install("uname", "#!/bin/sh\necho Darwin\n")
        self.install("micropython", f'#!/bin/sh\nexec {MICROPYTHON} "$@"\n')

    def install(self, name, text):
        (self.programs / name).unlink(missing_ok=True)  # a link leads to the machine's own program
        (self.programs / name).write_text(text)
        (self.programs / name).chmod(0o755)

    def environment(self):
        kept = {name: os.environ[name] for name in ("HOME", "LANG") if name in os.environ}
        return {**kept, "PATH": str(self.programs)}

    def run(self, command, *arguments, text="", folder=None):
        return subprocess.run(
            [folder or self.top / "tools" / command, *arguments],
            env=self.environment(),
            input=text,
            capture_output=True,
            text=True,
            timeout=110,
        )

    def has(self, name):
        """What pip has put into build/ already is taken from there, so that no network is
        needed."""
        if not (TOP / "build" / name).exists():
            pytest.skip(f"there is no build/{name}: tools/test, or tools/uss, fetches it")
        (self.top / "build").mkdir(exist_ok=True)
        if not (self.top / "build" / name).exists():
            (self.top / "build" / name).symlink_to(TOP / "build" / name)


def test_nothing_of_debian_is_within_reach(machine):
    for name in LACKING:
        assert not (machine.programs / name).exists(), name
    asked = subprocess.run(
        [machine.programs / "readlink", "-f", "/"], capture_output=True, env=machine.environment()
    )
    assert asked.returncode == 1


def test_the_panel_runs_on_the_micropython_that_is_installed(machine):
    script = "wait 1000\npress START\nwait 5000\nlcd\n"
    run = machine.run("panel", "--script", "-", text=script)
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines() == ["|S: 10.0 F: 10.00|", "|RUNNING      A1 |"]
    assert f"using {machine.programs}/micropython" in run.stderr
    assert os.path.islink(machine.top / "build/unix64/micropython")
    again = machine.run("panel", "--script", "-", text="wait 1000\nexpect READY\n")
    assert (again.returncode, again.stderr) == (0, "")


def test_the_panel_runs_behind_a_link_as_well(machine, tmp_path):
    (tmp_path / "here").symlink_to(machine.top / "tools")
    (tmp_path / "panel").symlink_to("here/panel")
    run = machine.run("", "--script", "-", text="wait 1000\nlcd\n", folder=tmp_path / "panel")
    assert run.stdout.splitlines()[-1:] == ["|READY        A1 |"], run.stderr


@contextmanager
def drives(machine, link, *arguments):
    command = [machine.top / "tools" / "drive", "--pty", "--link", link, *arguments]
    process = subprocess.Popen(
        command,
        env=machine.environment(),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout.readline().strip() == str(link)
        yield
    finally:
        process.communicate("quit\n", timeout=20)


def test_a_drive_is_served_and_tools_uss_reads_it(machine, tmp_path):
    machine.has("uss")
    link = tmp_path / "line"
    with drives(machine, link, "--baud", "19200", "--set", "1:P2014=500"):
        line = ("--port", str(link), "--baud", "19200", "--kind", "mm420", "--leave")
        run = machine.run("uss", *line, "read", "P2014")
    assert run.returncode == 0, run.stderr
    assert "P2014" in run.stdout and "500" in run.stdout


def test_the_tests_of_the_64_bit_and_cpython_tiers_pass(machine):
    machine.has("pytest")
    files = ("host_tests/uss/test_timing.py", "host_tests/hal/test_keypad.py")
    chosen = [str(machine.top / file) for file in files]
    run = machine.run("test", *chosen, "-q")
    assert run.returncode == 0, run.stdout + run.stderr
    assert re.search(r"\d\d passed", run.stdout), run.stdout
    assert "MicroPython unix32: not to be had here" in run.stderr
    assert "Not run: tier unix32" in run.stdout


def test_without_a_micropython_it_says_how_to_get_one(machine, tmp_path):
    other = tmp_path / "bin"
    shutil.copytree(machine.programs, other, symlinks=True)
    (other / "micropython").unlink()
    shutil.rmtree(machine.top / "build", ignore_errors=True)
    for manager, command in (
        ("brew", "brew install micropython"),
        ("pacman", "pacman -S micropython"),
        ("dnf", "dnf install micropython"),
        (None, "apt-get install micropython, or brew install micropython, or pacman"),
    ):
        if manager:
            (other / manager).write_text("#!/bin/sh\n")
            (other / manager).chmod(0o755)
        command_line = [machine.top / "tools" / "panel", "--script", "-"]
        run = subprocess.run(
            command_line, env={"PATH": str(other)}, input="", capture_output=True, text=True
        )
        assert run.returncode == 3 and run.stdout == ""
        assert command in run.stderr, run.stderr
        if manager:
            (other / manager).unlink()


def test_two_that_fill_build_at_once_wait_for_each_other_without_flock(machine):
    commands = (
        'there() { [[ -e $1/it ]]; }; make() { echo made; sleep 0.2; : >"$1/it"; };'
        "fill thing there make & fill thing there make & wait; fill thing there make"
    )
    source = 'set -euo pipefail; top=$0; . "$top/tools/fetch/folder.sh"; '
    run = subprocess.run(
        [machine.programs / "bash", "-c", source + commands, machine.top],
        env=machine.environment(),
        capture_output=True,
        text=True,
    )
    assert run.stdout == "made\n", run.stderr
    shutil.rmtree(machine.top / "build" / "thing")


def test_a_command_is_given_up_without_timeout(machine):
    source = 'top=$0; . "$top/tools/fetch/folder.sh"; '
    for command, status in (
        ("within 1 sleep 60", 137),
        ("within 5 false", 1),
        ("echo typed | within 5 grep -q typed", 0),
    ):
        run = subprocess.run(
            [machine.programs / "bash", "-c", source + command, machine.top],
            env=machine.environment(),
            capture_output=True,
            text=True,
            timeout=20,
        )
        assert (run.returncode, run.stderr) == (status, ""), command


# ---- bash 3.2 ---------------------------------------------------------------------------------


def newer(text):
    """What in a script bash 3.2 does not know. Comments and texts may say anything."""
    code = re.sub(r"(^|\s)#.*", "", text)
    return [what for what, pattern in NEWER_THAN_3_2.items() if re.search(pattern, code)]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.name)
def test_the_bash_of_macos_understands_the_scripts(script):
    assert newer(script.read_text()) == []


def test_the_rule_would_notice():
    for planted in (
        "mapfile -t lines",
        "declare -A table",
        "local -A table",
        "echo ${word^^}",
        "echo ${word,,}",
        "echo ${word@Q}",
        "echo $BASHPID",
        "make |& tee log",
        "make &>>log",
        "a) echo;;& b) echo",
        "[[ -v word ]]",
        "wait -n",
        "coproc cat",
        "shopt -s globstar",
        "read -N 1 letter",
        "printf '%(%F)T'",
        "exec {lock}>file",
        "echo ${list[-1]}",
        "echo ${word:1:-1}",
    ):
        assert len(newer(planted)) == 1, planted
    assert newer("echo ${word:1} ${word%,} ${#list[@]} a,b; a) echo;; # mapfile") == []


def test_every_script_finds_its_tree_in_the_same_words():
    heads = set()
    for path in (TOP / "tools").iterdir():
        if path.is_file() and os.access(path, os.X_OK):
            text = path.read_text()
            heads.add(text[text.index("self=") : text.index('. "$top/tools/fetch/begin.sh"')])
    assert len(heads) == 1
