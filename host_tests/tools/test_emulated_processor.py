# SPDX-License-Identifier: MIT
"""The emulated Pico's processor (tools/emulator/rp2040/processor.ts), instruction by instruction
beside rp2040js, which knows nothing of it; its divider; the waiting for the flash that it leaves
out; and what it does in this machine's own code (tools/emulator/rp2040/blocks)."""

import json
import os
import shutil
import subprocess
import sys

import pytest

from conftest import strict
from tiers import TOP

INTERPRETERS = "host"

NODE = TOP / "build/node/node"
WASM = TOP / "build/processor/processor.wasm"
SCRIPT = TOP / "host_tests/benches/processor_beside_rp2040js.mjs"
WAITS = TOP / "host_tests/benches/waits_for_flash.mjs"
DRAWN = TOP / "host_tests/benches/blocks_beside_interpreter.mjs"
BOTH_WAYS = TOP / "host_tests/benches/panel_beside_itself.mjs"
BLOCKS = TOP / "build/blocks/panel.node"
LAUNCH = TOP / "tools/emulator/launch.py"
PANEL = TOP / "build/pico/panel.uf2"
SEED = 2040


def needs(path):
    if not path.exists() and not strict():
        pytest.skip("the emulated Pico is not here: tools/panel --board pico fetches it")


def test_every_instruction_does_what_it_does_in_rp2040js_in_as_many_cycles_and_it_divides():
    needs(WASM)
    run = subprocess.run([NODE, SCRIPT, str(SEED)], capture_output=True, text=True)
    print(f"seed {SEED}", run.stdout, run.stderr, sep="\n")
    assert run.returncode == 0
    counts = json.loads(run.stdout.splitlines()[-1])
    assert counts["different"] == 0
    assert counts["same"] > 120_000  # and not all of them accesses to somewhere else


def test_what_it_leaves_out_of_the_waiting_for_the_flash_changes_nothing():
    needs(PANEL)
    ran = [
        subprocess.run([NODE, WAITS, *how], capture_output=True, text=True, check=True).stdout
        for how in ([], ["patiently"])
    ]
    shortly, patiently = map(json.loads, ran)
    assert shortly["was"] == patiently["was"]
    assert 100 < shortly["polls"] < patiently["polls"] / 10


def test_every_instruction_does_in_a_block_what_it_does_outside(tmp_path):
    needs(WASM)
    run = subprocess.run([NODE, DRAWN, str(SEED), tmp_path], capture_output=True, text=True)
    print(f"seed {SEED}", run.stdout, run.stderr, sep="\n")
    assert run.returncode == 0
    counts = json.loads(run.stdout.splitlines()[-1])
    assert counts["different"] == 0
    assert counts["same"] > 10_000 and counts["blocks"] > 5_000
    assert counts["changed"] > 10  # programs that have overwritten themselves
    assert counts["staysBesideWriting"] and counts["goesWithWriting"]


def test_a_panel_does_with_blocks_what_it_does_without_to_the_nanosecond():
    needs(BLOCKS)
    done = subprocess.run([NODE, BOTH_WAYS], capture_output=True, text=True, check=True).stdout
    with_blocks, without = json.loads(done)
    assert with_blocks["digest"] == without["digest"]
    assert with_blocks["runs"] > 10_000 and without["runs"] == 0


# Instead of the chip: at the end of the program it takes long to write, in place of the blocks.
WRITES_LATE = """
import fs from 'node:fs';
while (fs.readSync(Number(process.argv[2]), Buffer.alloc(1)) > 0);
setTimeout(() => fs.writeFileSync(process.env.USS_EMULATOR_BLOCKS, 'all'), 1_500);
"""


def test_blocks_are_written_to_their_end_on_a_slow_machine_too(tmp_path):
    needs(NODE)
    folder = tmp_path / "tools/emulator"
    folder.mkdir(parents=True)
    shutil.copy(LAUNCH, folder)
    (folder / "main.mjs").write_text(WRITES_LATE)
    (tmp_path / "build").mkdir()
    (tmp_path / "build/node").symlink_to(NODE.parent)
    blocks = tmp_path / "blocks"
    command = [sys.executable, folder / LAUNCH.name, "true"]
    subprocess.run(command, env={**os.environ, "USS_EMULATOR_BLOCKS": str(blocks)}, check=True)
    assert blocks.read_text() == "all"
