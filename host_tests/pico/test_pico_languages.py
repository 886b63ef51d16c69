# SPDX-License-Identifier: MIT
"""The languages on the chip: how long words that were not shown yet take, and what memory."""

from tools.emulator.world import PicoWorld

INTERPRETERS = "pico"

STEP_US = 4_000  # of the main loop
FILE_US = 15_000  # the file system takes its time; once for a text, from then on it is kept
RAM_BYTES = 3_700  # compiled on the chip; a file that comes compiled takes less

# What it prints: the longest search, of a text near the end of the table, or that has no row, and
# one of a state, in us; bytes that stay with as many words as are kept.
MEASURE = """
import gc, time
import on_demand  # which a panel has anyway
gc.collect(); gc.collect()
before = gc.mem_alloc()
from panel.languages import Language
language = Language("de")
def search_us(text):
    gc.collect()
    began = time.ticks_us()
    words = language.get(text, text)
    return time.ticks_us() - began, words
first = search_us(b"READY")
last_us, words = search_us(b"WIRES? MAINS?")
assert words == b"ADERN? NETZ?", words
none_us, words = search_us(b"NO SUCH TEXT")
state_us, words = search_us(b"RUNNING")
assert words == b"L\\xc4UFT", words
again_us, words = search_us(b"RUNNING")
for number in range(20):
    language.get(b"%d" % number, b"")
gc.collect(); gc.collect()
print(max(last_us, none_us), state_us, again_us, gc.mem_alloc() - before)
"""


def measured(world):
    world.repl.open(ms=10_000)
    printed, error = world.repl.execute(MEASURE, ms=60_000)
    assert not error, error
    return [int(word) for word in printed.split()]


def judge(figures, most_us):
    longest_us, state_us, again_us, cost = figures
    print(longest_us, state_us, again_us, "us,", cost, "bytes")
    assert max(state_us, longest_us) < most_us, longest_us
    assert again_us < 500, again_us
    assert cost < RAM_BYTES, cost


def test_the_words_of_a_firmware_file():
    judge(measured(PicoWorld("panel")), STEP_US)


def test_the_words_as_files():
    files = {"panel/__init__.py": ""}
    for name in ("on_demand.py", "panel/languages/__init__.py", "panel/languages/words.tsv"):
        with open("firmware/" + name, encoding="utf-8") as file:
            files[name] = file.read()
    judge(measured(PicoWorld("stock", files=files)), FILE_US)
