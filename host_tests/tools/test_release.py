# SPDX-License-Identifier: MIT
"""A release: its files, their checksums, the packages of the library, and what CI runs."""

import hashlib
import http.server
import json
import os
import re
import subprocess
import threading
import tomllib
import venv
import zipfile
from functools import partial

import pytest

from conftest import strict
from tiers import PACKAGED, TIERS, TOP
from tools.releasing import mip, options, parts
from tools.releasing.version import changes, version
from version import VERSION

INTERPRETERS = "host"

RELEASE = TOP / "tools" / "release"
PROJECT = TOP / "tools/pc/pyproject.toml"
WORKFLOWS = sorted((TOP / ".github/workflows").glob("*.yml"))
MPREMOTE = TOP / "build/mpremote/bin/python"


def release(folder, *words, status=0):
    ended = subprocess.run(
        [RELEASE, "--output", folder, *words], capture_output=True, text=True, timeout=110
    )
    assert ended.returncode == status, ended.stderr
    return ended


def test_the_version_stands_everywhere():
    assert version(TOP) == VERSION == changes(TOP)[0]
    assert tomllib.loads(PROJECT.read_text())["project"]["version"] == VERSION
    assert json.loads((TOP / "firmware" / mip.FILE).read_text())["version"] == VERSION


def test_a_tag_of_another_version_is_refused(tmp_path):
    ended = release(tmp_path, "--tag", "v0.0.1", status=1)
    assert (
        ended.stderr
        == f"tools/release: the tag is v0.0.1, and the version {VERSION}: v{VERSION}\n"
    )


def test_the_parts_are_those_that_the_command_line_knows():
    assert tuple(part.name for part in parts.PARTS) == options.NAMES


def test_the_files_have_checksums_and_are_the_same_each_time(tmp_path):
    folders = (tmp_path / "a", tmp_path / "b")
    for folder in folders:
        release(folder, "--only", "mip", "--only", "settings")
    names = sorted(os.listdir(folders[0]))
    assert names == ["NOTES.md", "SHA256SUMS", f"settings-{VERSION}.zip", f"uss-mip-{VERSION}.zip"]
    for name in names:
        assert (folders[0] / name).read_bytes() == (folders[1] / name).read_bytes(), name
    lines = (folders[0] / "SHA256SUMS").read_text().splitlines()
    assert len(lines) == 2
    for line in lines:
        digest, name = line.split("  ")
        assert hashlib.sha256((folders[0] / name).read_bytes()).hexdigest() == digest
    assert (folders[0] / "NOTES.md").read_text().startswith(f"USS panel {VERSION}\n\n")


def test_a_part_that_cannot_be_made_is_named_and_the_others_are_there(
    tmp_path, monkeypatch, capsys
):
    from tools.releasing import __main__ as command

    def fails(top, folder):
        raise parts.Missing("there is no compiler")

    some = (parts.Part("pico", "the firmware", fails), parts.PARTS[options.NAMES.index("mip")])
    assert command.make(some, tmp_path) == 1
    said = capsys.readouterr().err
    assert "pico: the firmware, 0 of 2\n    not made: there is no compiler\n" in said
    assert (tmp_path / f"uss-mip-{VERSION}.zip").exists()


def test_the_firmware_gets_the_name_of_its_board_and_version(tmp_path):
    top = tmp_path / "tree"
    (top / "tools").mkdir(parents=True)
    (top / "firmware").mkdir()
    (top / "firmware/version.py").write_text('VERSION = "7.8.9"\n')
    uf2 = top / "tools/uf2"
    uf2.write_text('#!/bin/sh\n[ "$3 $1" = "--output --board" ] && echo "$2" >"$4"\n')
    uf2.chmod(0o755)
    parts.firmware("pico2")(top, tmp_path)
    assert (tmp_path / "panel-pico2-7.8.9.uf2").read_text() == "pico2\n"
    uf2.write_text("#!/bin/sh\nexit 3\n")
    with pytest.raises(parts.Missing):
        parts.firmware("pico")(top, tmp_path)


# ---- mip --------------------------------------------------------------------------------------


def test_the_package_for_mip_names_every_file_of_the_library():
    """After a new file:  python3 tools/releasing/mip.py"""
    firmware = TOP / "firmware"
    assert (firmware / mip.FILE).read_text() == mip.package()
    listed = {path for path, _ in json.loads(mip.package())["urls"]}
    there = {path.relative_to(firmware).as_posix() for path in firmware.glob("*/**/*.py")}
    assert listed == {path for path in there if path.startswith(("uss/", "hal/"))}


USES = """
import uss.bus, uss.s7, uss.br, uss.tasks.arrays, hal.pacer
uss.bus.help()
print(uss.bus.__file__)
"""


@pytest.fixture
def server(tmp_path):
    """A web server of the released archive; its address."""
    release(tmp_path / "release", "--only", "mip")
    folder = tmp_path / "served"
    with zipfile.ZipFile(tmp_path / "release" / f"uss-mip-{VERSION}.zip") as packed:
        packed.extractall(folder)

    class Handler(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    handler = partial(Handler, directory=folder)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as serving:
        threading.Thread(target=serving.serve_forever, daemon=True).start()
        base = f"http://127.0.0.1:{serving.server_port}/"
        (folder / "whole.json").write_text(mip.package(base=base))
        yield base
        serving.shutdown()


def test_the_unix_ports_own_mip_installs_the_library(server, tmp_path):
    micropython = PACKAGED if PACKAGED.exists() else TIERS["unix64"].command[0]
    install = f"import mip; mip.install('{server}whole.json', target='{tmp_path}/lib')"
    run = subprocess.run([micropython, "-c", install], capture_output=True, text=True, timeout=60)
    if "no module named 'mip'" in run.stderr + run.stdout:
        pytest.skip("this MicroPython comes without mip")
    assert run.returncode == 0 and "Done" in run.stdout, run.stdout + run.stderr
    assert len(list((tmp_path / "lib").rglob("*.py"))) == len(mip.paths())
    used = subprocess.run(
        [micropython, "-c", USES], capture_output=True, text=True, cwd=tmp_path,
        env={"MICROPYPATH": f"{tmp_path}/lib:.frozen"},
    )  # fmt: skip
    assert used.returncode == 0, used.stderr
    assert "drive.run(hertz)" in used.stdout
    assert used.stdout.splitlines()[-1] == f"{tmp_path}/lib/uss/bus/__init__.py"


BY_MPREMOTE = """
import sys
from types import SimpleNamespace
from mpremote import mip

class Chip:
    def __init__(self): self.files = {}
    def fs_exists(self, path): return True
    def fs_isdir(self, path): return True
    def fs_mkdir(self, path): pass
    def fs_hashfile(self, path, algorithm): return b""
    def fs_writefile(self, path, data, **_): self.files[path] = data

chip = Chip()
state = SimpleNamespace(
    transport=chip, did_action=lambda: None, ensure_raw_repl=lambda: None
)
words = {"command": ["install"], "packages": sys.argv[1:], "target": "/lib"}
mip.do_mip(state, SimpleNamespace(**words, index=None, mpy=False))
for path in sorted(chip.files): print(path, len(chip.files[path]))
"""


@pytest.mark.parametrize("place", ["file", "address"])
def test_mpremote_installs_it_from_a_file_and_from_an_address(server, place):
    if not MPREMOTE.exists():
        pytest.skip("there is no mpremote: tools/deploy fetches it")
    what = f"{server}package.json" if place == "address" else TOP / "firmware" / mip.FILE
    run = subprocess.run(
        [MPREMOTE, "-B", "-c", BY_MPREMOTE, what], capture_output=True, text=True, timeout=60
    )
    assert run.returncode == 0, run.stderr
    told = [line.split() for line in run.stdout.splitlines() if line.startswith("/lib/")]
    sizes = {f"/lib/{path}": (TOP / "firmware" / path).stat().st_size for path in mip.paths()}
    assert {path: int(size) for path, size in told} == sizes


# ---- pip --------------------------------------------------------------------------------------


def test_the_package_for_pip_takes_in_every_folder_of_the_library():
    packages = tomllib.loads(PROJECT.read_text())["tool"]["setuptools"]["packages"]
    uss = TOP / "firmware/uss"
    folders = {path.parent.relative_to(uss.parent) for path in uss.rglob("*.py")}
    stubs = TOP / "tools/pc/stubs"
    of_stubs = {path.parent.relative_to(stubs) for path in stubs.rglob("*.pyi")}
    named = {".".join(path.parts) for path in folders}
    named |= {".".join((f"{path.parts[0]}-stubs", *path.parts[1:])) for path in of_stubs}
    assert set(packages) == named | {"uss_serial", "uss_serial.port"}


IMPORTS = """
import uss_serial
import uss.bus, uss.s7, uss.br, uss.tasks.arrays, uss.families
assert uss_serial.__all__ and uss_serial.SerialLink and uss_serial.Master
assert "site-packages" in uss_serial.__file__ and "site-packages" in uss.bus.__file__
try:
    uss_serial.SerialLink("/no/such/port", 19200)
except uss_serial.PortError as error:
    print(error)
"""


def test_a_wheel_is_built_and_works_in_a_fresh_environment(tmp_path):
    ended = subprocess.run(
        [RELEASE, "--only", "pip", "--output", tmp_path],
        capture_output=True,
        text=True,
        timeout=110,
    )
    if ended.returncode and not strict():
        pytest.skip(f"no wheel can be built here: {ended.stderr.strip()}")
    assert ended.returncode == 0, ended.stderr
    (wheel,) = tmp_path.glob("*.whl")
    assert wheel.name == f"uss_panel_serial-{VERSION}-py3-none-any.whl"
    with zipfile.ZipFile(wheel) as packed:
        names = packed.namelist()
        assert {"uss-stubs/bus/__init__.pyi", "uss_serial/keeper.py", "uss/s7/codes.py"} < {*names}
        for name in names:
            assert os.fsencode(TOP) not in packed.read(name), name
    venv.create(tmp_path / "fresh", symlinks=True)
    python = tmp_path / "fresh/bin/python"
    where = subprocess.check_output(
        [python, "-c", "import site; print(site.getsitepackages()[0])"]
    )
    with zipfile.ZipFile(wheel) as packed:
        packed.extractall(where.decode().strip())  # as pip does with one that is pure Python
    used = subprocess.run(
        [python, "-I", "-c", IMPORTS], capture_output=True, text=True, cwd=tmp_path
    )
    assert used.returncode == 0 and "no port /no/such/port" in used.stdout, used.stderr
    assert not (TOP / "tools/pc/build").exists() and not list(
        (TOP / "tools/pc").glob("*.egg-info")
    )


# ---- CI ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.name)
def test_actions_are_pinned_and_commands_are_there(workflow):
    text = workflow.read_text()
    used = re.findall(r"uses: (\S+)", text)
    for action in used:
        assert re.fullmatch(r"actions/[\w-]+@(v\d+|[0-9a-f]{40})|\./\S+\.yml", action), action
        assert not action.startswith("./") or (TOP / action).exists()
    for command in re.findall(r"(?:\./tools/[\w-]+|\.ci/run)", text):
        assert os.access(TOP / command, os.X_OK), command
    assert "permissions:" in text and "timeout-minutes:" in text
    assert "\t" not in text


def test_the_check_is_that_of_a_fresh_clone_and_the_release_that_of_this_machine():
    check, made = (TOP / f".github/workflows/{name}.yml" for name in ("check", "release"))
    assert "- run: .ci/run\n" in check.read_text()
    text = made.read_text()
    assert './tools/release --output release --tag "$GITHUB_REF_NAME"' in text
    assert "needs: check" in text and "uses: ./.github/workflows/check.yml" in text
    assert "sha256sum --check SHA256SUMS" in text and "*.uf2 *.whl *.zip SHA256SUMS" in text
