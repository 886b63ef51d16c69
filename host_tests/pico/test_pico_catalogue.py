# SPDX-License-Identifier: MIT
"""The catalogue on the chip: how soon a row is there, and what it takes of the memory."""

from tools.emulator.world import PicoWorld

INTERPRETERS = "pico"

FIRST_ROW_MS = 300  # the bar
PIECE_US = 4_000  # of what a step of the main loop may take
RAM_BYTES = 4096

# Some groups of each family. What it prints: the longest time to the first row in ms, the longest
# piece of a search in us, bytes that stay.
MEASURE = """
import gc, time
import on_demand
def look(family, numbers):
    began = last = time.ticks_us()
    longest = 0
    for row in catalogue.rows(family, numbers, paced=True):
        now = time.ticks_us()
        longest = max(longest, now - last)
        last = now
        if row:
            return now - began, longest
    raise ValueError(family)
def look_around():
    worst, piece = 0, 0
    for family in catalogue.FAMILIES:
        for group in catalogue.groups(family):
            if catalogue.number(group) in (1, 3, 9):
                gc.collect()
                took, longest = look(family, group[catalogue.NUMBERS])
                worst = max(worst, took)
                if catalogue.number(group) > 1:  # the first look finds out that there is no file
                    piece = max(piece, longest)
    assert catalogue.fault("v20", 72)[catalogue.NAME] == b"USS/Modbus lost"
    assert catalogue.find("mm420", 1120)[catalogue.NAME + catalogue.DE] == b"Hochlaufzeit"
    return worst // 1000, piece
gc.collect(); gc.collect()
before = gc.mem_alloc()
import catalogue
worst, piece = look_around()
gc.collect(); gc.collect()
print(worst, piece, gc.mem_alloc() - before)
"""


def measured(world):
    world.repl.open(ms=10_000)
    printed, error = world.repl.execute(MEASURE, ms=60_000)
    assert not error, error
    return [int(word) for word in printed.split()]


def test_the_tables_of_a_firmware_file():
    worst_ms, piece_us, cost = measured(PicoWorld("panel"))
    print("frozen:", worst_ms, "ms,", piece_us, "us,", cost, "bytes")
    assert worst_ms < FIRST_ROW_MS, worst_ms
    assert piece_us < PIECE_US, piece_us
    assert cost < RAM_BYTES, cost


def test_the_tables_as_files():
    files = {}
    for name in ("__init__.py", "mm440.tsv", "mm420.tsv", "v20.tsv"):
        with open("firmware/catalogue/" + name) as file:
            files["catalogue/" + name] = file.read()
    with open("firmware/on_demand.py") as file:
        files["on_demand.py"] = file.read()
    init = files["catalogue/__init__.py"]
    at = init.index("FAMILIES = ")
    end = init.index("\n", at)
    files["catalogue/__init__.py"] = (
        init[:at] + 'FAMILIES = ("mm440", "mm420", "v20")' + init[end:]
    )
    worst_ms, piece_us, cost = measured(PicoWorld("stock", files=files))
    print("files:", worst_ms, "ms,", piece_us, "us,", cost, "bytes")
    assert worst_ms < FIRST_ROW_MS, worst_ms
