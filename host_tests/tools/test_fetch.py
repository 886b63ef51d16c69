# SPDX-License-Identifier: MIT
"""How tests are collected and judged, and how MicroPython, node and the firmware for the Pico are
fetched.

What that does when all is well, every run of the tests shows; here stands what goes wrong.
"""

import bz2
import io
import lzma
import os
import shutil
import struct
import subprocess
import sys
import tarfile
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import pytest

import conftest
import line_coverage
import tiers
from version import VERSION

INTERPRETERS = "host"

TOOLS = tiers.TOP / "tools"
PICOS = [name for name in tiers.TIERS if name.startswith("pico")]
HOST_TESTS = tiers.TOP / "host_tests"
FLASH = 0x10000000  # where a Pico has it
LEFT_OUT = ("uss/br/", "uss/s7/", "uss/tasks/")  # of a firmware file: the panel needs none of it


# ---- collecting and judging -----------------------------------------------------------------


@pytest.fixture
def run_pytest(tmp_path):
    """Writes a test file and runs pytest on it, in a process of its own, as tools/test does."""

    (tmp_path / "without_pico.py").write_text(without(*PICOS))

    def run(source, *arguments, **environment):
        (tmp_path / "test_it.py").write_text(source)
        # pytest's usual folder is for all who run it: the one who leaves it may clear away much.
        arguments += (f"--basetemp={tmp_path.with_suffix('.base')}",)
        if not any("pico" in text for text in (source, *arguments)):
            arguments += ("-p", "without_pico")  # to ask them takes seconds
        ours = ("CI", "USS_STRICT", "USS_COVERAGE")  # of the run that this test is part of
        inherited = {k: v for k, v in os.environ.items() if k not in ours}
        return subprocess.run(
            [sys.executable, "-BX", tiers.CACHES, "-m", "pytest", "-c", HOST_TESTS / "pytest.ini"]
            + ["--rootdir", tmp_path, "-p", "no:cacheprovider", "-p", "conftest", *arguments],
            cwd=tmp_path,
            env={**inherited, "PYTHONPATH": f"{HOST_TESTS}:{tmp_path}", **environment},
            capture_output=True,
            text=True,
            timeout=60,
        )

    return run


@cache
def versions():
    """Of the tiers that this machine has."""
    return tiers.survey().versions


def here(*names):
    """The INTERPRETERS line for those of the tiers that this machine has."""
    return f'INTERPRETERS = "{" ".join(name for name in names if name in versions())}"\n'


def test_each_function_is_an_item_under_each_interpreter(run_pytest):
    run = run_pytest("def test_one(): pass\ndef test_two(): pass\n", "--collect-only", "-q")
    expected = [
        f"test_it.py::{tier}::{function}"
        for tier in tiers.TIERS
        if tier in versions() and tiers.TIERS[tier].everywhere
        for function in ("test_one", "test_two")
    ]
    assert run.stdout.splitlines()[: len(expected)] == expected


def test_a_failure_shows_the_source_line_and_what_was_printed(run_pytest):
    source = here("unix64", "cpython") + (
        "def test_good(): print('not of interest')\n"
        "def test_bad():\n"
        "    print('seen', 3)\n"
        "    assert 3 == 4\n"
    )
    run = run_pytest(source)
    tried = source.splitlines()[0].count("unix64") + 1
    assert run.returncode == 1
    assert run.stdout.count("    assert 3 == 4\n") == tried
    assert run.stdout.count("seen 3\n") == tried
    assert "not of interest" not in run.stdout
    assert "FAILED test_it.py::cpython::test_bad - assert 3 == 4" in run.stdout
    assert f"{tried} failed, {tried} passed" in run.stdout.splitlines()[-1]


def test_a_crash_fails_its_function_and_the_others_still_run(run_pytest):
    run = run_pytest(
        here("unix64", "unix32", "cpython") + "import os\n"
        "def test_before(): pass\n"
        "def test_crash():\n"
        "    print('last words')\n"
        "    os.system('kill -SEGV $PPID')\n"
        "def test_after(): pass\n"
    )
    assert run.stdout.count("In this function the interpreter died of SIGSEGV.") >= 1
    assert "last words" in run.stdout
    assert "test_after" not in run.stdout, run.stdout
    counts = run.stdout.splitlines()[-1].split()
    assert int(counts[3]) == 2 * int(counts[1])  # "= 3 failed, 6 passed in ..."


def test_a_hang_is_ended_and_the_others_still_run(run_pytest):
    run = run_pytest(
        here("unix64") + "def test_before(): pass\n"
        "def test_hang():\n"
        "    while True: pass\n"
        "def test_after(): pass\n",
        *("-o", "function_timeout_s=1"),
    )
    if "unix64" in versions():
        assert "In this function the interpreter hung and was killed after 1 s." in run.stdout
        assert "1 failed, 2 passed" in run.stdout.splitlines()[-1]


def test_what_ends_pytest_ends_the_interpreters(run_pytest, tmp_path):
    # The test tells the number of its process, and then hangs; meanwhile pytest is ended.
    source = here("cpython") + (
        "import os\n"
        "def test_hang():\n"
        f"    open({str(tmp_path / 'number')!r}, 'w').write(str(os.getpid()))\n"
        "    os.kill(os.getppid(), 15)\n"
        "    while True: pass\n"
    )
    run = run_pytest(source)
    assert run.returncode == 2 and "KeyboardInterrupt" in run.stdout
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "number").read_text()), 0)


def test_an_ordinary_pytest_test_that_hangs_is_given_up(run_pytest):
    run = run_pytest(
        'INTERPRETERS = "host"\n'
        "import os\n"
        "def test_hang(): os.read(os.pipe()[0], 1)\n"
        "def test_after(tmp_path): pass\n",
        *("-o", "function_timeout_s=1"),
    )
    assert "The test hung and was given up after 1 s." in run.stdout
    assert "1 failed, 1 passed" in run.stdout.splitlines()[-1]


def test_a_crash_of_an_ordinary_pytest_test_is_its_own_and_the_others_still_run(run_pytest):
    run = run_pytest(
        'INTERPRETERS = "host"\n'
        "import os, pytest\n"
        "def test_before(): pass\n"
        "def test_crash():\n"
        "    os.write(2, b'last words')\n"
        "    os.kill(os.getpid(), 11)\n"
        "@pytest.mark.parametrize('text', ['a::b', '[c]', '\\n', ' '])\n"
        "def test_after(text): pass\n"
        "def test_skipped(): pytest.skip('none here')\n"
        "def test_bad(capfd):\n"
        "    os.system('echo seen')\n"
        "    assert 3 == 4\n",
        "-rfs",
    )
    assert "In or after this test the interpreter died of SIGSEGV." in run.stdout
    assert "FAILED test_it.py::test_bad - assert 3 == 4" in run.stdout
    assert "seen\n" in run.stdout and "SKIPPED [1] test_it.py:9: none here" in run.stdout
    assert "2 failed, 5 passed, 1 skipped" in run.stdout.splitlines()[-1]


def test_an_ordinary_pytest_file_that_ends_badly_is_noticed(run_pytest):
    leave_badly = "import atexit, os\natexit.register(os._exit, 5)\n"
    run = run_pytest('INTERPRETERS = "host"\n' + leave_badly + "def test_a(): pass\n")
    assert "In or after this test the interpreter ended with status 5." in run.stdout
    assert "1 failed" in run.stdout.splitlines()[-1]


def test_what_ends_pytest_lets_ordinary_tests_put_away_what_they_have_started(
    run_pytest, tmp_path
):
    run = run_pytest(
        'INTERPRETERS = "host"\n'
        "import os, pytest, subprocess, time\n"
        "@pytest.fixture\n"
        "def started():\n"
        "    yield subprocess.Popen(['sleep', '60'])\n"
        f"    open({str(tmp_path / 'put away')!r}, 'w').close()\n"
        "def test_hang(started):\n"
        f"    open({str(tmp_path / 'number')!r}, 'w').write(str(started.pid))\n"
        "    os.kill(os.getppid(), 15)\n"
        "    time.sleep(60)\n"
    )
    assert run.returncode == 2 and "KeyboardInterrupt" in run.stdout
    assert (tmp_path / "put away").exists()
    assert not is_running(int((tmp_path / "number").read_text()))


def is_running(number):
    """Whether there is that process, and it is not dead and only waits to be looked at."""
    try:
        return "\nState:\tZ" not in Path(f"/proc/{number}/status").read_text()
    except FileNotFoundError:
        return False


def test_by_hand_an_ordinary_pytest_test_runs_in_the_pytest_that_was_started(run_pytest):
    run = run_pytest('INTERPRETERS = "host"\ndef test_a(): print("seen", 3)\n', "-s")
    assert "seen 3\n" in run.stdout and "1 passed" in run.stdout


def test_a_test_that_swallows_the_first_time_limit_is_given_up_at_the_next(run_pytest):
    run = run_pytest(
        'INTERPRETERS = "host"\n'
        "import os, time\n"
        "class Slow:\n"
        "    def __del__(self): time.sleep(60)  # Python ignores what is raised in here\n"
        "def test_hang(): Slow(); os.read(os.pipe()[0], 1)\n",
        *("-o", "function_timeout_s=1"),
    )
    assert "The test hung and was given up after 1 s." in run.stdout
    assert "1 failed" in run.stdout.splitlines()[-1]


def test_a_file_that_cannot_be_imported_fails_all_its_functions(run_pytest):
    run = run_pytest(here("cpython") + "import nothing_of_that_name\ndef test_a(): pass\n")
    assert "No module named 'nothing_of_that_name'" in run.stdout
    assert "1 failed" in run.stdout.splitlines()[-1]


def test_a_death_after_the_last_function_is_noticed(run_pytest):
    leave_badly = "import atexit, os\natexit.register(os._exit, 5)\n"
    run = run_pytest(here("cpython") + leave_badly + "def test_a(): pass\n")
    assert "After this function the interpreter ended with status 5." in run.stdout


def test_sys_exit_in_a_test_is_a_failure(run_pytest):
    run = run_pytest(here("unix64", "cpython") + "import sys\ndef test_a(): sys.exit(0)\n")
    assert run.returncode == 1 and "SystemExit" in run.stdout


def test_what_would_silently_not_run_is_refused(run_pytest):
    for source, message in (
        ("def test_a(): pass\ndef test_a(): pass\n", "there are two functions test_a"),
        ("def test_a(tmp_path): pass\n", "test_a is not a plain function"),
        ("async def test_a(): pass\n", "test_a is not a plain function"),
        ("INTERPRETERS = 'unix16'\ndef test_a(): pass\n", "'unix16', which is not a tier"),
    ):
        run = run_pytest(source)
        assert run.returncode == 2 and message in run.stdout, run.stdout


def test_a_missing_tier_is_named_and_under_ci_it_is_a_failure(run_pytest, tmp_path):
    (tmp_path / "without_unix32.py").write_text(without("unix32"))
    source = here("cpython") + "def test_a(): pass\n"
    relaxed = run_pytest(source, "-p", "without_unix32")
    assert relaxed.returncode == 0
    assert "Not run: tier unix32 (there is no /no/such/program)" in relaxed.stdout
    assert "apt-get install gcc-multilib" in relaxed.stdout
    for environment in ({"CI": "true"}, {"USS_STRICT": "1"}):
        strict = run_pytest(source, "-p", "without_unix32", "-k", "test_a", **environment)
        assert strict.returncode == 1 and "FAILED" in strict.stdout


def test_a_tier_that_nobody_has_to_have_is_named_and_no_failure(run_pytest, tmp_path):
    (tmp_path / "without_hard.py").write_text(without("pico_hard", "pico_hard_again"))
    source = 'INTERPRETERS = "cpython pico_hard"\ndef test_a(): pass\n'
    run = run_pytest(source, "-p", "without_hard", "-k", "test_a", USS_STRICT="1")
    assert "tier pico_hard" not in run.stdout.partition("Not run")[0]
    assert run.stdout.count("Not run: tier pico_hard") == 2
    assert "1 passed" in run.stdout, run.stdout


def test_where_one_of_several_tiers_is_enough_the_first_that_is_here_runs(run_pytest, tmp_path):
    (tmp_path / "without_unix32.py").write_text(without("unix32"))
    source = 'INTERPRETERS = "unix32|cpython"\ndef test_a(): pass\n'
    run = run_pytest(source, "--collect-only", "-q", "-p", "without_unix32")
    assert "::cpython::test_a\n" in run.stdout and "1 test coll" in run.stdout, run.stdout
    if "unix32" in versions():
        run = run_pytest(source, "--collect-only", "-q")
        assert "::unix32::test_a\n" in run.stdout and "1 test coll" in run.stdout, run.stdout


def without(*names):
    """A plugin that takes these tiers away."""
    return (
        "from tiers import TIERS, Tier\n"
        f"for name in {names}:\n"
        "    name, _, *others = TIERS[name]\n"
        "    TIERS[name] = Tier(name, ('/no/such/program',), *others)\n"
    )


def test_an_interpreter_that_is_not_what_it_should_be_is_refused():
    run = subprocess.run(
        [sys.executable, "-B", "host_tests/runner.py", "unix32"],
        cwd=tiers.TOP,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 1 and run.stdout.startswith("this is not unix32")


# ---- line coverage --------------------------------------------------------------------------


def test_the_table_names_lines_that_nothing_ran(tmp_path):
    (tmp_path / "firmware").mkdir()
    (tmp_path / "firmware" / "a.py").write_text('"""Text."""\nb = 2\n\nc = 3\nd = 4\ne = 5\n')
    (tmp_path / "firmware" / "never.py").write_text("a = 1\n")
    coverage = line_coverage.LineCoverage(tmp_path)
    coverage.note("firmware/a.py", [1, 2])
    coverage.note("firmware/a.py", [6])
    rows = [row.split(maxsplit=4)[1:] for row in coverage.report()]
    assert ["4", "2", "50%", "4-5"] in rows and ["1", "1", "0%", "1"] in rows, rows
    assert rows[-1] == ["5", "3", "40%"]


def test_of_ordinary_files_those_that_wait_come_first_and_then_the_longest():
    last_run = {
        conftest.LASTED: {"long::host": 9, "short::host": 1, "computes::host": 20},
        conftest.BUSY: {"long::host": 0.1, "short::host": 0.4, "computes::host": 0.9},
    }
    config = SimpleNamespace(
        getini=lambda _: 0, cache=SimpleNamespace(get=lambda name, _: last_run[name])
    )
    items = [SimpleNamespace(path=name) for name in ("computes", "short", "long")]
    conftest.Pool(config).sort(items)
    assert [item.path for item in items] == ["long", "short", "computes"]


def test_the_lines_that_the_tests_of_a_file_ran_are_noted(run_pytest):
    source = (
        'INTERPRETERS = "cpython"\nfrom uss.timing import characters_us, elapsed\n'
        "def test_a(): assert characters_us(9600, 1) == 1146\n"
    )
    more = "def test_b(): assert elapsed(3, 1, 255) == 2\n"

    def lines_not_run(source):
        assert "line coverage" not in run_pytest(source).stdout
        run = run_pytest(source, "--coverage")
        assert " passed" in run.stdout, run.stdout
        row = next(row for row in run.stdout.splitlines() if "uss/timing.py" in row)
        return int(row.split()[2])

    assert lines_not_run(source) == lines_not_run(source + more) + 2


# ---- obtaining MicroPython ------------------------------------------------------------------

# Stands in for MicroPython: tells its version when asked, and otherwise shows how it is called.
STAND_IN = """#!/bin/sh
case "$*" in
    *sys.implementation*) echo "micropython {new_enough}" ;;
    *) printf '%s\\n' "$MICROPYPATH" "$@"; cat; exit 7 ;;
esac
"""

NEEDED = (
    "bash env readlink dirname mkdir rm mv ln cat sed awk grep head tail flock sleep "
    "find sort xargs sha256sum stat cp tar chmod date"
).split()


class Machine:
    """A copy of the tools, in a folder with a blank in its name, and the programs it may use."""

    def __init__(self, folder):
        self.top = folder / "a tree"
        self.programs = folder / "bin"
        self.programs.mkdir()
        shutil.copytree(TOOLS, self.top / "tools")
        for name in NEEDED:
            if path := shutil.which(name):
                (self.programs / name).symlink_to(path)

    def install(self, name, text):
        (self.programs / name).unlink(missing_ok=True)  # a link leads to the machine's own program
        (self.programs / name).write_text(text)
        (self.programs / name).chmod(0o755)

    def run(self, *command, **options):
        return subprocess.run(
            command, env={"PATH": str(self.programs)}, capture_output=True, text=True, **options
        )

    def panel(self, *arguments):
        return self.run(self.top / "tools" / "panel", *arguments, input="standard input", cwd="/")

    def shell(self, commands, files=("folder", "packages", "micropython")):
        sourced = " ".join(f'. "$top/tools/fetch/{file}.sh";' for file in files)
        return self.run("bash", "-c", f"set -euo pipefail; top=$0; {sourced} {commands}", self.top)


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def test_an_installed_micropython_gets_all_arguments_and_the_paths(machine):
    machine.install("micropython", STAND_IN.format(new_enough=True))
    run = machine.panel("--script", "a file")
    top = machine.top
    assert run.returncode == 7
    assert run.stdout.splitlines() == (
        [f"{top}:{top}/firmware:.frozen", "-X", "heapsize=16M"]
        + [f"{top}/tools/live/virtual_panel.py", "--script", "a file", "standard input"]
    )
    assert "using" in run.stderr
    assert machine.panel().stderr == ""  # it remembers


def test_without_any_micropython_it_says_what_to_install(machine):
    machine.install("micropython", STAND_IN.format(new_enough=False))
    run = machine.panel()
    assert run.returncode == 3 and run.stdout == ""
    assert "is not MicroPython 1.25 or newer, passed over" in run.stderr
    assert "apt-get install micropython" in run.stderr
    assert sorted(os.listdir(machine.top / "build")) == ["lock"]


def test_what_is_remembered_is_looked_for_again_when_it_is_gone(machine):
    machine.install("micropython", STAND_IN.format(new_enough=True))
    machine.panel()
    (machine.programs / "micropython").rename(machine.programs / "elsewhere")
    assert machine.panel().returncode == 3
    (machine.programs / "elsewhere").rename(machine.programs / "micropython")
    assert machine.panel().returncode == 7


@pytest.mark.parametrize(
    "program",
    ["#!/bin/sh\nexit 0\n", "#!/bin/sh\nexit 1\n", "#!/no/such/interpreter\n", "no program"],
)
def test_what_is_only_called_micropython_is_passed_over(machine, program):
    machine.install("micropython", program)
    assert machine.panel().returncode == 3


def test_what_micropython_does_most_is_seen_from_any_folder(tmp_path):
    shell = f"top={tiers.TOP}; . $top/tools/fetch/folder.sh; . $top/tools/fetch/micropython.sh;"
    for name in versions().keys() & {"unix64", "unix32"}:
        command = ["bash", "-c", f"{shell} simulate {tiers.TIERS[name].command[0]}"]
        seen = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert seen.returncode == 0, (name, seen.stderr)
        assert seen.stdout.count('"times"') == 1, (name, seen.stdout)


def test_a_starter_finds_loader_and_libraries_wherever_the_folder_is(machine, tmp_path):
    packed = tmp_path / "packed"
    libraries = packed / "usr/lib/some-linux-gnu"
    libraries.mkdir(parents=True)
    (packed / "usr/bin").mkdir()
    (libraries / "libc.so.6").write_text("")
    (libraries / "ld-linux-some.so.2").write_text('#!/bin/sh\nprintf "%s\\n" "$@"\n')
    (libraries / "ld-linux-some.so.2").chmod(0o755)
    run = machine.shell(f"packages_starter '{packed}' thing")
    assert run.returncode == 0, run.stderr
    moved = packed.rename(tmp_path / "a place")
    started = machine.run(moved / "thing", "an argument", "more").stdout.splitlines()
    assert started == [
        "--library-path", f"{moved}/./usr/lib/some-linux-gnu", f"{moved}/usr/bin/thing",
        "an argument", "more",
    ]  # fmt: skip


def test_the_mirror_is_the_one_that_the_machine_takes_its_release_from(machine, tmp_path):
    (tmp_path / "os-release").write_text("ID=debian\nVERSION_CODENAME=bookworm\n")
    machine.install(
        "apt-get",
        "#!/bin/sh\n"
        "echo bookworm main cdrom://disc/\n"
        "echo bookworm main http://mirror/debian\n"
        "echo bookworm contrib http://mirror/other\n"
        "echo bookworm-security main http://mirror/security\n"
        "echo bookworm main http://mirror/debian\n",
    )
    run = machine.shell(f'os_release="{tmp_path}/os-release"; mirrors; releases')
    assert run.stdout.splitlines() == ["http://mirror/debian", "trixie", "bookworm"]


@pytest.mark.parametrize(
    "system, expected",
    [
        ("ID=debian\nVERSION_CODENAME=trixie\n", "debian trixie"),
        ("ID=ubuntu\nID_LIKE=debian\nVERSION_CODENAME=noble\n", "ubuntu noble resolute"),
        (
            'ID=linuxmint\nID_LIKE="ubuntu debian"\nVERSION_CODENAME=x\nUBUNTU_CODENAME=noble\n',
            "ubuntu noble resolute",
        ),
        ("ID=fedora\n", ""),
    ],
)
def test_the_releases_to_look_into(machine, tmp_path, system, expected):
    (tmp_path / "os-release").write_text(system)
    run = machine.shell(f'os_release="{tmp_path}/os-release"; distribution; releases')
    assert run.stdout.split() == expected.split()


def test_a_folder_of_build_is_made_once_however_many_want_it(machine):
    commands = (
        'there() { [[ -e $1/it ]]; }; make() { echo made; sleep 0.2; : >"$1/it"; };'
        "fill thing there make & fill thing there make & wait; fill thing there make"
    )
    assert machine.shell(commands).stdout == "made\n"
    assert sorted(os.listdir(machine.top / "build")) == ["lock", "thing"]


def test_what_could_not_be_made_leaves_nothing_behind(machine):
    commands = (
        'there() { [[ -e $1/it ]]; }; make() { : >"$1/half"; return 1; };'
        "fill thing there make || echo failed"
    )
    assert machine.shell(commands).stdout == "failed\n"
    assert os.listdir(machine.top / "build") == ["lock"]


def test_a_tar_of_sources_is_unpacked_without_its_outermost_folder(machine, tmp_path):
    (machine.programs / "python3").symlink_to(sys.executable)
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w") as archive:
        archive.addfile(tarfile.TarInfo("name-1.0/py/empty.c"))
    for ending, compression in (("xz", lzma), ("bz2", bz2)):
        (tmp_path / f"it.tar.{ending}").write_bytes(compression.compress(packed.getvalue()))
        (tmp_path / ending).mkdir()
        machine.shell(f'unpack_tar "{tmp_path}/it.tar.{ending}" "{tmp_path}/{ending}"')
        assert (tmp_path / ending / "py" / "empty.c").exists()


# ---- obtaining node -------------------------------------------------------------------------

NODE_FILES = ("folder", "packages", "pytest", "node")
SLOW_NODE = '#!/bin/sh\ncase "$2" in *"< 18 "*) exit 0 ;; esac\nexit 1\n'  # 18 to 23, if asked


def test_an_installed_node_is_used_when_it_is_new_enough(machine):
    machine.install("node", "#!/bin/sh\nexit 0\n")  # it is asked whether it is, by its status
    machine.install("npm", "#!/bin/sh\necho npm\n")
    run = machine.shell('get_pytest() { :; }; get_node; "$build/node/npm"', NODE_FILES)
    assert (run.returncode, run.stdout) == (0, "npm\n")
    assert f"using {machine.programs}/node" in run.stderr


def test_a_slow_node_is_used_where_no_fast_one_can_be_fetched(machine):
    machine.install("node", SLOW_NODE)
    machine.install("npm", "#!/bin/sh\n")
    run = machine.shell("get_pytest() { :; }; get_node", NODE_FILES)
    assert run.returncode == 0 and "fetching it" in run.stderr
    assert f"using {machine.programs}/node" in run.stderr
    run = machine.shell("get_pytest() { :; }; get_node", NODE_FILES)
    assert (run.returncode, run.stderr) == (0, "")


def test_one_that_was_fetched_before_is_kept_where_no_other_is_to_be_had(machine):
    fetched = machine.top / "build/node"
    fetched.mkdir(parents=True)
    for name, text in (("node", SLOW_NODE), ("npm", "#!/bin/sh\n")):
        (fetched / name).write_text(text)
        (fetched / name).chmod(0o755)
    run = machine.shell("get_pytest() { :; }; get_node", NODE_FILES)
    assert run.returncode == 0 and "keeping the old one" in run.stderr
    assert (fetched / "node").read_text() == SLOW_NODE
    run = machine.shell("get_pytest() { :; }; get_node", NODE_FILES)
    assert (run.returncode, run.stderr) == (0, "")


@pytest.mark.parametrize("installed", [(), ("node",), ("node", "npm")])
def test_an_old_node_or_one_without_npm_is_not_used(machine, installed):
    for name in installed:
        machine.install(name, "#!/bin/sh\nexit 1\n")
    run = machine.shell("get_pytest() { :; }; get_node", NODE_FILES)
    assert run.returncode == 1 and "using" not in run.stderr
    assert "apt-get install nodejs npm" in run.stderr
    assert os.listdir(machine.top / "build") == ["lock"]


# ---- the firmware for the Pico --------------------------------------------------------------

PICO_FILES = ("begin", "folder", "packages", "pytest", "pico")

# Stands in for the compilers: what it "compiles" is the manifest and one Python file.
PICO_STAND_IN = r"""
    functions=$pico_often
    has_python() { :; }
    has_pico_compiler() { [[ -e $1/versions ]]; }
    has_pico_tools() { has_pico_compiler "$1"; }
    has_pico_sources() { has_pico_compiler "$1"; }
    make_pico_compiler() { echo gcc 1 >"$1/versions"; }
    make_pico_tools() { : >"$1/versions"; }
    make_pico_sources() { echo micropython 2 >"$2/versions"; }
    pico_do() {
        shift
        case $1 in
            ninja)
                mkdir -p "$3/CMakeFiles"
                [[ -e $3/CMakeFiles/py.o ]] ||
                    printf '.text.%s\n' $functions >"$3/CMakeFiles/py.o"
                : >"$3/firmware.elf"
                cat "$3/CMakeFiles/py.o" "$3/manifest.py" "$top/firmware/app.py" \
                    >"$3/firmware.bin"
                ;;
            arm-none-eabi-objcopy) sed -i "s/^${4%=*}\$/${4#*=}/" "$5" ;;
            python) cp "${@: -1}" "${@: -2:1}" ;;
        esac
    }
"""


@pytest.fixture
def pico(machine):
    """The machine, with a small firmware and compilers that take no time."""
    for folder in ("firmware/uss", "boards/chips", "boards/pico"):
        (machine.top / folder).mkdir(parents=True)
    (machine.top / "firmware" / "app.py").write_text("first\n")
    (machine.top / "firmware" / "version.py").write_text('VERSION = "1.2.3"\n')
    (machine.top / "boards" / "pico" / "manifest.py").write_text("")
    return machine


def get_firmware(machine, name, also=""):
    """Gets it; answers whether it was built, and what it holds."""
    run = machine.shell(f"{PICO_STAND_IN} {also} get_pico_firmware {name}", PICO_FILES)
    assert run.returncode == 0, run.stderr
    return "building" in run.stderr, (machine.top / "build/pico" / f"{name}.uf2").read_text()


def test_a_firmware_is_built_anew_when_something_in_it_has_changed(pico):
    assert get_firmware(pico, "panel")[0]
    firmware = pico.top / "firmware"
    changes = [
        lambda: (firmware / "app.py").write_text("second\n"),
        lambda: (firmware / "uss" / "new.py").write_text(""),
        lambda: (firmware / "uss" / "new.py").rename(firmware / "new.py"),
        lambda: (firmware / "new.py").unlink(),
        lambda: (pico.top / "boards" / "pico" / "board.py").write_text(""),
        lambda: (pico.top / "boards" / "chips" / "chip.py").write_text(""),
        lambda: (pico.top / "tools" / "fetch" / "pico_requirements.txt").write_text("cmake\n"),
    ]
    for number, change in enumerate(changes):
        change()
        assert get_firmware(pico, "panel")[0], number
        assert not get_firmware(pico, "panel")[0], number
    released = "pico_edition() { echo 1.25.0 2026-01-01 2.1.1 trixie; };"
    assert get_firmware(pico, "panel", released)[0]


def test_what_is_not_in_a_firmware_does_not_have_it_built_anew(pico):
    get_firmware(pico, "panel")
    get_firmware(pico, "stock")
    (pico.top / "firmware" / "app.py").write_text("first\n")  # the same, at another time
    (pico.top / "firmware" / "notes.txt").write_text("")
    with (pico.top / "tools" / "fetch" / "pico.sh").open("a") as script:
        script.write("# a comment\n")
    assert not get_firmware(pico, "panel")[0]
    (pico.top / "firmware" / "app.py").write_text("second\n")
    assert not get_firmware(pico, "stock")[0]
    assert get_firmware(pico, "panel")[0]


def test_the_panel_and_stock_differ_in_what_is_frozen(pico):
    manifest = f"include('{pico.top}/boards/pico/manifest.py')"
    for build in ("", "_hard"):
        assert manifest in get_firmware(pico, f"panel{build}")[1]
        stock = get_firmware(pico, f"stock{build}")[1]
        assert manifest not in stock and "freeze('$(PORT_DIR)/modules'" in stock


def test_what_runs_most_often_is_kept_in_memory_in_the_panel(pico):
    own = 'functions="first second"; pico_often="second";'
    panel = get_firmware(pico, "panel", own)[1]
    assert panel.startswith(".text.first\n.time_critical.second\n")
    (pico.top / "firmware" / "app.py").write_text("second\n")  # what is compiled stays
    assert get_firmware(pico, "panel", own)[1].startswith(".text.first\n.time_critical.second\n")
    for stock in ("stock", "stock_hard"):
        assert get_firmware(pico, stock, own)[1].startswith(".text.first\n.text.second\n")


def test_a_function_that_another_compiler_does_not_make_is_named_and_left_out(pico):
    also = "functions='first nlr_pop'; pico_often='nlr_pop gone';"
    run = pico.shell(f"{PICO_STAND_IN} {also} get_pico_firmware panel", PICO_FILES)
    assert run.returncode == 0 and "no gone to be put into the memory" in run.stderr
    assert ".time_critical.nlr_pop" in (pico.top / "build/pico/panel.uf2").read_text()


def test_a_firmware_that_cannot_be_built_is_not_there_and_says_why(pico):
    get_firmware(pico, "panel")
    (pico.top / "firmware" / "app.py").write_text("second\n")
    fail = 'pico_do() { [[ $2 != ninja ]] || { echo "error compiling app.py"; return 1; }; };'
    run = pico.shell(f"{PICO_STAND_IN} {fail} get_pico_firmware panel", PICO_FILES)
    assert run.returncode == 1 and "error compiling app.py" in run.stderr
    assert os.listdir(pico.top / "build" / "pico") == []
    assert get_firmware(pico, "panel")[1].endswith("second\n")


def test_the_old_firmware_stays_until_the_new_one_is_there(pico):
    get_firmware(pico, "panel")
    (pico.top / "firmware" / "app.py").write_text("second\n")
    show = """
        eval "as_before_$(declare -f pico_do)"
        pico_do() { cat "$build/pico/panel.uf2"; as_before_pico_do "$@"; }
        quietly() { shift; "$@"; }
    """
    run = pico.shell(f"{PICO_STAND_IN} {show} get_pico_firmware panel", PICO_FILES)
    assert run.returncode == 0 and run.stdout.count("first\n") >= 2, run.stderr


def test_two_that_want_a_firmware_at_once_build_it_once(pico):
    get = "get_pico_firmware panel"
    run = pico.shell(f"{PICO_STAND_IN} {get} & {get} & wait; {get}", PICO_FILES)
    assert run.stderr.count("building") == 1


def test_the_compiler_is_unpacked_without_what_is_for_other_chips(pico, tmp_path):
    gcc, newlib = "usr/lib/gcc/arm-none-eabi/14.2.1", "usr/lib/arm-none-eabi/newlib"
    wanted = {
        *("usr/bin/arm-none-eabi-gcc", f"{gcc}/cc1", f"{gcc}/thumb/v6-m/nofp/libgcc.a"),
        *(f"{newlib}/thumb/v6-m/nofp/libc.a", f"{newlib}/nosys.specs"),
        *("usr/include/newlib/stdio.h", "usr/lib/gcc/arm-none-eabi/14.2.1/include/arm_acle.h"),
    }
    other = {
        *(f"{gcc}/lto1", f"{gcc}/libgcc.a", f"{gcc}/thumb/nofp/libgcc.a", f"{gcc}/plugin/x.h"),
        *(f"{gcc}/arm/v5te/hard/libgcc.a", f"{newlib}/thumb/v8-m.main+fp/hard/libc.a"),
        *(f"{newlib}/libc.a", f"{newlib}/thumb/v7-m/nofp/libm.a", "usr/share/doc/copyright"),
        *("usr/bin/arm-none-eabi-lto-dump", f"{newlib}/thumb/v6-m/nofp/libc_nano.a"),
    }
    library = "usr/lib/x86_64-linux-gnu/libmpc.so.3"
    with tarfile.open(tmp_path / "it.tar", "w") as archive:
        for name in sorted(wanted | other | {library}):
            archive.addfile(tarfile.TarInfo(f"./{name}"))
    pico.install("dpkg-deb", '#!/bin/sh\ncat "$2"\n')
    folder = tmp_path / "compiler"
    run = pico.shell(
        "packages_open() { :; }; packages_dependencies() { echo libc6; echo libmpc3; };"
        'packages_download() { echo "${@:3}"; mkdir -p "$1/downloads"; '
        f'cp "{tmp_path}/it.tar" "$1/downloads/gcc.deb"; }};'
        f'mkdir "{folder}"; unpack_pico_compiler "{folder}" trixie; rm -r "{folder}/view"',
        PICO_FILES,
    )
    assert run.stdout.split()[-2:] == ["libnewlib-dev", "libmpc3"], run.stderr
    found = {str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file()}
    assert found == wanted | {"libraries/libmpc.so.3", f"{newlib}/libstdc++.a"}


@pytest.mark.parametrize(
    "offered, says",
    [
        ("1.25.0+ds-1", ""),
        ("1.25.0", ""),
        ("1.26.1-2", "micropython 1.25.0 is wanted there, and it has 1.26.1-2"),
        ("", "micropython 1.25.0 is wanted there, and it has none"),
    ],
)
def test_sources_are_taken_in_the_very_version_that_was_tried(pico, offered, says):
    stand_in = f"packages_version() {{ echo {offered}; }}"
    run = pico.shell(f"{stand_in}; pico_offers view micropython 1.25.0", PICO_FILES)
    assert (run.returncode, run.stderr.strip()) == (bool(says), says)


@pytest.mark.parametrize(
    "name, release, version, released",
    [
        ("panel", "trixie", "1.25.0", "2025-04-15"),
        ("panel_hard", "testing", "1.26.1", "2025-09-11"),
    ],
)
def test_a_firmware_has_the_version_and_date_of_its_own_sources(
    pico, tmp_path, name, release, version, released
):
    (tmp_path / "os-release").write_text("ID=debian\n")
    run = pico.shell(
        f'os_release="{tmp_path}/os-release"; pico_releases "$(pico_sources_of {name})";'
        f"pico_do {name} bash -c 'echo $MICROPY_GIT_TAG; date -ud @$SOURCE_DATE_EPOCH +%F;"
        " echo $PYTHONHASHSEED'",
        PICO_FILES,
    )
    assert run.stdout.split() == [release, f"v{version}", released, "0"], run.stderr


def test_a_testing_that_has_moved_on_is_said_in_a_line_and_costs_nothing_else(pico):
    gone = """
        make_pico_sources() { pico_offers view micropython 1.26.1; }
        packages_version() { echo 1.28.0-1; }
    """
    run = pico.shell(f"{PICO_STAND_IN} {gone} get_pico_firmware panel_hard", PICO_FILES)
    assert run.returncode == 1
    assert run.stderr.strip() == "micropython 1.26.1 is wanted there, and it has 1.28.0-1"
    assert get_firmware(pico, "panel")[0]


PORT = "    pico_platform\n    pico_platform_compiler\n    pico_platform_panic\n"


@pytest.mark.parametrize(
    "there", [PORT, PORT.replace("_compiler", "_common\n    pico_platform_compiler")]
)
def test_the_part_that_the_sdk_has_more_is_named_once(pico, tmp_path, there):
    file = tmp_path / "CMakeLists.txt"
    file.write_text(there)
    run = pico.shell(f'name_common_part "{file}"', PICO_FILES)
    assert run.returncode == 0, run.stderr
    assert file.read_text().split() == [
        f"pico_platform{part}" for part in ("", "_common", "_compiler", "_panic")
    ]
    file.write_text("another port\n")
    assert pico.shell(f'name_common_part "{file}"', PICO_FILES).returncode == 1


def test_what_is_inserted_stands_behind_the_line_that_is_there_once(pico, tmp_path):
    file = tmp_path / "gc.c"
    file.write_text("first\n  [second] {\nthird\n")
    insert = f'insert_behind "{file}" "  [second] {{" <<<new'
    assert pico.shell(insert, PICO_FILES).returncode == 0
    assert file.read_text() == "first\n  [second] {\nnew\nthird\n"
    for text in ("first\n", "  [second] {\n  [second] {\n"):
        file.write_text(text)
        assert pico.shell(insert, PICO_FILES).returncode == 1
        assert file.read_text() == text


def test_sources_that_were_changed_otherwise_are_fetched_again(pico, tmp_path):
    (tmp_path / "versions").write_text("micropython 1.25.0\n")
    has = f'has_pico_sources "{tmp_path}"'
    assert pico.shell(has, PICO_FILES).returncode == 1
    assert pico.shell(f'micropython_changes >"{tmp_path}/changes"', PICO_FILES).returncode == 0
    assert pico.shell(has, PICO_FILES).returncode == 0
    assert pico.shell(f"name_common_part() {{ :; }}; {has}", PICO_FILES).returncode == 1


def have_firmware(machine):
    """Puts one there that was made of what is in the tree, as the real compilers would have."""
    run = machine.shell(
        'mkdir -p "$build/pico"; echo first >"$build/pico/panel.uf2";'
        '{ pico_fingerprint panel; echo micropython 2; } >"$build/pico/panel.made_of"',
        PICO_FILES,
    )
    assert run.returncode == 0, run.stderr


def test_uf2_tells_where_the_file_is_and_how_it_gets_onto_the_pico(pico, tmp_path):
    have_firmware(pico)
    uf2 = pico.top / "tools" / "uf2"
    plain = pico.run(uf2)
    assert plain.returncode == 0 and plain.stderr == ""
    assert plain.stdout.startswith(f"{pico.top}/build/pico/panel.uf2: 1 KB")
    assert "    micropython 2\n" in plain.stdout and "BOOTSEL" in plain.stdout
    for output, file in ((tmp_path / "a file", "a file"), (tmp_path / "bin", "bin/panel.uf2")):
        run = pico.run(uf2, "--output", output)
        assert run.stdout.startswith(f"{tmp_path}/{file}: 1 KB"), run.stderr
        assert (tmp_path / file).read_text() == "first\n"


COMMANDS = "panel drive example test soak mutants bench uf2 deploy check-board bringup".split()
COMMANDS += "uss settings release".split()


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_tells_the_version_and_needs_nothing_for_it(pico, command):
    for name in NEEDED:
        if name not in ("bash", "env", "dirname", "sed"):
            (pico.programs / name).unlink(missing_ok=True)
    run = pico.run(pico.top / "tools" / command, "--version")
    assert (run.returncode, run.stdout, run.stderr) == (0, "USS panel 1.2.3\n", "")


def test_a_firmware_that_would_run_into_the_files_is_refused(pico):
    binary = pico.top / "firmware.bin"
    binary.write_bytes(bytes(1025))
    fits = f"fits_before_the_files '{binary}'"
    run = pico.shell(f"{fits} 1025 && echo yes", PICO_FILES)
    assert run.stdout == "yes\n", run.stderr
    run = pico.shell(f"{fits} 1024 || echo no", PICO_FILES)
    assert run.stdout == "no\n"
    assert "1025 bytes, 1 more than the files on the flash leave" in run.stderr


def test_these_are_all_the_commands():
    assert sorted(COMMANDS) == sorted(
        path.name for path in TOOLS.iterdir() if path.is_file() and os.access(path, os.X_OK)
    )


def test_another_version_is_another_firmware_and_told_of_it(pico):
    assert get_firmware(pico, "panel")[0] and get_firmware(pico, "stock")[0]
    told = {}
    for version in ("1.2.3", "1.3.0"):
        (pico.top / "firmware" / "version.py").write_text(f'VERSION = "{version}"\n')
        assert get_firmware(pico, "panel")[0] == (version != "1.2.3")
        run = pico.shell("pico_flags panel; pico_versions panel", PICO_FILES)
        told[version] = run.stdout
        assert f"""-DPICO_PROGRAM_DESCRIPTION='"USS panel {version}"'""" in run.stdout
        assert f"USS panel {version}\nmicropython 2\n" in run.stdout
    assert not get_firmware(pico, "stock")[0]
    assert "USS" not in pico.shell("pico_flags stock; pico_versions stock", PICO_FILES).stdout


def test_uf2_says_what_is_wrong(pico, tmp_path):
    uf2 = pico.top / "tools" / "uf2"
    for arguments in (("--wrong",), ("--output",), ("--output", ""), ("a", "b", "c")):
        run = pico.run(uf2, *arguments)
        assert run.returncode == 2 and run.stderr.endswith("is not understood\n"), arguments
        assert run.stderr.count("\n") == 1
    run = pico.run(uf2)
    assert run.returncode == 3 and "wants Python 3.11" in run.stderr
    (pico.programs / "python3").symlink_to(sys.executable)
    run = pico.run(uf2)
    assert run.returncode == 3 and "could not be built" in run.stderr and run.stdout == ""
    have_firmware(pico)
    assert pico.run(uf2, "--output", tmp_path / "no" / "such").returncode == 1


def program_description(image):
    """What `picotool info` finds under this name, or None (Pico SDK, binary_info/structure.h)."""
    begin = image.index(struct.pack("<I", 0x7188EBF2), 0, 512)
    first, end, _, marker = struct.unpack_from("<4I", image, begin + 4)
    assert marker == 0xE71AA390
    for at in range(first - FLASH, end - FLASH, 4):
        entry = struct.unpack_from("<I", image, at)[0] - FLASH
        kind, tag, number, text = struct.unpack_from("<HHII", image, entry)
        if (kind, tag, number) == (6, 0x5052, 0xB6A07C19):  # a text, "RP", description
            return image[text - FLASH : image.index(0, text - FLASH)].decode()
    return None


@pytest.mark.parametrize("name", ["panel", "stock"])
def test_the_firmware_is_one_for_the_pico_and_tells_nothing_of_this_machine(name):
    file = tiers.TOP / "build" / "pico" / f"{name}.uf2"
    if not file.exists():
        pytest.skip("no firmware is here: tools/panel --board pico has it built")
    image = bytearray()
    blocks = file.read_bytes()
    for at in range(0, len(blocks), 512):
        head = struct.unpack_from("<8I", blocks, at)
        assert head[:3] == (0x0A324655, 0x9E5D5157, 0x2000)  # a block of a file for a family
        assert head[7] == 0xE48BFF56  # the RP2040
        assert head[3] == FLASH + len(image)
        image += blocks[at + 32 : at + 32 + head[4]]
    assert b"v1.25.0 on 2025-04-15" in image
    told = program_description(bytes(image))
    assert told == (f"USS panel {VERSION}" if name == "panel" else None)
    for path in (str(tiers.TOP), os.path.expanduser("~/"), "/tmp/", "/usr/"):
        assert path.encode() not in image
    firmware = tiers.TOP / "firmware"
    ours = {str(path.relative_to(firmware)) for path in firmware.rglob("*.py")}
    ours |= {"board.py", "chips/rp2.py"}
    for path in ours - {"main.py"}:  # a name that MicroPython knows
        frozen = b"\0" + path.encode() + b"\0" in image
        assert frozen == (name == "panel" and not path.startswith(LEFT_OUT)), path
