# SPDX-License-Identifier: MIT
"""The tables as modules to be frozen, which firmware/catalogue/packed.py and
firmware/panel/languages/__init__.py read.

    modules(top / "firmware")               # {"catalogue/table_mm440.py": text}

A frozen constant stays in the flash, of which the file system leaves little. So the rows of
the catalogue are compressed, in blocks, so that a search need not unpack what stands before a row;
the words of the languages, which are few, as a whole.
"""

import struct
import zlib
from pathlib import Path

BLOCK_BYTES = 2048
WINDOW_BITS = 11
WORDS_WINDOW_BITS = 9


def modules(firmware):
    """{path in the firmware: source} of every table in this folder."""
    tables = {
        f"catalogue/table_{path.stem}.py": module(path.read_bytes())
        for path in sorted(Path(firmware, "catalogue").glob("*.tsv"))
    }
    words = Path(firmware, "panel/languages/words.tsv").read_bytes()
    return tables | {"panel/languages/table.py": words_module(words)}


def words_module(table):
    """The source of the module for the words of the languages: the rows that have any."""
    rows = [row for row in table.splitlines(keepends=True) if b"\t" in row and row[:1] != b"#"]
    return f"PACKED = {deflated(b''.join(rows), WORDS_WINDOW_BITS)!r}\n"


def module(table):
    """The source of the module for the bytes of a table."""
    packed = b""
    index = b""
    head, *rows = [line for line in table.splitlines(keepends=True) if not line.startswith(b"#")]
    for first, block in blocks(rows):
        index += struct.pack("<II", first, len(packed))
        packed += deflated(block, WINDOW_BITS)
    return f"HEAD = {head!r}\nBLOCKS = {packed!r}\nINDEX = {index!r}\n"


def deflated(data, window_bits):
    packer = zlib.compressobj(9, zlib.DEFLATED, -window_bits)
    return packer.compress(data) + packer.flush()


def blocks(rows):
    """Pairs: the key of the first row, and rows one after the other."""
    first, block = key(rows[0]), b""
    for row in rows:
        if len(block) + len(row) > BLOCK_BYTES:
            yield first, block
            first, block = key(row), b""
        block += row
    yield first, block


def key(row):
    """What the rows are in the order of, as the reader counts it."""
    kind = "P" if row[:1] in b"Ppr" else chr(row[0])
    number, _, value = row.split(b"\t", 1)[0][1:].partition(b".")
    return (ord(kind) & 0x1F) << 24 | int(number) << 9 | int(value or 0)
