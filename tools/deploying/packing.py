# SPDX-License-Identifier: MIT
"""The tables as modules to be frozen, which firmware/catalogue/packed.py and
firmware/panel/languages/__init__.py read.

    modules(top / "firmware")               # {"catalogue/tables.py": text}

A frozen constant stays in the flash, of which the file system leaves little. So the rows of
the catalogue are in ISO 8859-1, and compressed in blocks, so that a search need not unpack what
stands before a row; the words of the languages, which are looked for while a motor runs, only lack
the English texts.
"""

import struct
import zlib
from itertools import accumulate
from pathlib import Path

BLOCK_BYTES = 2048
WINDOW_BITS = 11


def modules(firmware):
    """{path in the firmware: source} of every table in this folder."""
    tables = {
        path.stem: packed(path.read_bytes())
        for path in sorted(Path(firmware, "catalogue").glob("*.tsv"))
    }
    words = Path(firmware, "panel/languages/words.tsv").read_bytes()
    return {"catalogue/tables.py": f"TABLES = {tables!r}\n"} | words_modules(words)


def words_modules(table):
    """{path in the firmware: source} of the words of each language. No text stands in there, but
    its check sum.
    """
    (_, *names), *rows = [
        line.split("\t") for line in table.decode().splitlines() if not line.startswith("#")
    ]
    sources = {}
    for column, name in enumerate(names, 1):
        said = [(row[0].encode(), row[column]) for row in rows if row[column:] and row[column]]
        keys = [zlib.crc32(text) for text, _ in said]
        assert len(set(keys)) == len(keys)
        words = [words.encode("latin-1") for _, words in said]
        ends = accumulate(map(len, words), initial=0)
        sources[f"panel/languages/words_{name}.py"] = (
            f"KEYS = {struct.pack(f'<{len(keys)}I', *keys)!r}\n"
            f"PLACES = {struct.pack(f'<{len(keys) + 1}H', *ends)!r}\n"
            f"WORDS = {b''.join(words)!r}\n"
        )
    return sources


def packed(table):
    """What packed.py reads, of the bytes of a table: its first line, the blocks, their index."""
    stream = b""
    index = b""
    table = table.decode().encode("latin-1")
    assert not {0xC2, 0xC3}.intersection(table)  # by these the reader knows UTF-8
    head, *rows = [line for line in table.split(b"\n") if line and not line.startswith(b"#")]
    head, rows = head + b"\n", [row + b"\n" for row in rows]
    for first, block in blocks(rows):
        index += struct.pack("<II", first, len(stream))
        packer = zlib.compressobj(9, zlib.DEFLATED, -WINDOW_BITS)
        stream += packer.compress(block) + packer.flush()
    return head, stream, index


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
