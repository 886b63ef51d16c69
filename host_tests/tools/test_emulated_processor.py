# SPDX-License-Identifier: MIT
"""The emulated Pico's processor (tools/emulator/rp2040/processor.ts), instruction by instruction
beside rp2040js, which knows nothing of it; and its divider."""

import json
import subprocess

import pytest

from conftest import strict
from tiers import TOP

INTERPRETERS = "host"

NODE = TOP / "build/node/node"
WASM = TOP / "build/processor/processor.wasm"
SCRIPT = TOP / "host_tests/benches/processor_beside_rp2040js.mjs"
SEED = 2040


def test_every_instruction_does_what_it_does_in_rp2040js_in_as_many_cycles_and_it_divides():
    if not WASM.exists() and not strict():
        pytest.skip("the emulated Pico is not here: tools/panel --board pico fetches it")
    run = subprocess.run([NODE, SCRIPT, str(SEED)], capture_output=True, text=True)
    print(f"seed {SEED}", run.stdout, run.stderr, sep="\n")
    assert run.returncode == 0
    counts = json.loads(run.stdout.splitlines()[-1])
    assert counts["different"] == 0
    assert counts["same"] > 120_000  # and not all of them accesses to somewhere else
