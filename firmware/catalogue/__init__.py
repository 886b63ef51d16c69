# SPDX-License-Identifier: MIT
"""What is known of the drive families: rows of tables that stay in flash and are read one by one.

    row = find("mm440", 1120)                   # a list of cells, or None: it has no such number
    row[NAME + DE]                              # b"Hochlaufzeit": one byte a character, ISO 8859-1
    value(row[HIGHEST])                         # 650
    for row in rows("mm440", b"300-311 335"):   # the numbers of a group, in order
    for row in choices("mm440", row[FORM]):     # what 0, 1, 2... or the bits are called
    fault("mm440", 72)[REMEDY + EN].split(LINE) # lines of 60 characters at the most

README.md tells how the tables are written. A family has the rows that stand in its own table; a
cell that is empty there is that of the family that it is like. A row costs a search in the file,
of some milliseconds on a chip: `paced` splits it, and gives None where there is more to do.
"""

from micropython import const

FAMILIES = ("mm440", "mm430", "mm420", "mm410", "g110", "v20", "g120", "mm3")

# Columns. A text in both languages: the column, and EN or DE. UNSURE and SOURCE end every row.
KEY, NAME, UNSURE, SOURCE = 0, 1, -2, -1
EN, DE = 0, 1
TYPE, INDICES, UNIT, FORM, LOWEST, HIGHEST, DEFAULT, LEVEL, STATES, ASKS = range(3, 13)
CAUSE, REMEDY = 3, 5  # of a fault or a warning
NUMBERS = 3  # of a group
STEP_NUMBER, STEP_INDEX, STEP_VALUE, STEP_NOTE = 3, 4, 5, 6  # of a step of commissioning

LINE = b"|"  # between the lines of a text
ALL = b"0-32767"

_NEAR = const(256)  # bytes; what is nearer is found by reading on
_PIECE = const(128)  # bytes that are read at once
_READING, _PARAMETER = const(18), const(16)  # r and P, of which a table has one order
_LIKE, _COMMAND_SETS, _DRIVE_SETS = const(2), const(3), const(4)  # of the head

_IS_FROZEN = ".frozen" in __path__  # then no table is a file, and nobody looks for one
# What a search needs, from the bottom of the house up: to load it takes long.
LOADS = ("catalogue.tables", "catalogue.packed") if _IS_FROZEN else ()
_packed = []  # `Packed`, once it was needed


def find(family, number, kind="P"):
    for row in rows(family, b"%d" % number, kind):
        return row
    return None


def fault(family, number):
    return find(family, number, "F")


def warning(family, number):
    return find(family, number, "A")


def groups(family):
    """The groups, as a menu has them; a number may stand in several."""
    return rows(family, ALL, "G")


def steps(family, procedure):
    """The steps of commissioning: 1 makes it ready for USS, 2 resets it, 3 is for the motor."""
    return rows(family, b"%d00-%d99" % (procedure, procedure), "S")


def choices(family, form):
    """The texts of a parameter's values or bits; its column FORM tells which: b"v700", b"b52"."""
    return rows(family, form[1:], "V")


def rows(family, numbers=ALL, kind="P", paced=False):
    """The rows with these numbers, such as b"300-311 335", in this order.

    kind: "P" parameters, "F" faults, "A" warnings, "G" groups, "S" steps, "V" texts of values.
    """
    found = _rows(family, ord(kind) & 0x1F, numbers)
    return found if paced else (row for row in found if row)


def number(row, place=0):
    """The number of a row; with place 1 the value or bit that a row of `choices` is about."""
    return int(row[KEY][1:].split(b".")[place])


def indices(row):
    """How many a parameter has."""
    return int(row[INDICES].split()[0])


def value(cell):
    """The number in a cell, None if it is empty; a connector 52:3 as the drive has it."""
    if not cell:
        return None
    if b":" in cell:
        connector, index = cell.split(b":")
        return int(connector) << 16 | int(index)
    return float(cell) if b"." in cell else int(cell)


def _rows(family, kind, numbers):
    """Rows, complete, and None after each look for one."""
    as_a_whole = kind not in b"\x01\x06\x10"  # neither A nor F nor P: what stands together
    missing = True
    yield from _prepare(family)
    with _table(family) as table:
        yield None
        head = _cells(_line(table))
        like = head[_LIKE].decode()
        is_completed = like and not as_a_whole
        if is_completed:
            yield from _prepare(like)
        with _table(like) if is_completed else table as other:
            if is_completed:
                yield None
            for part in numbers.split():
                first, _, last = part.partition(b"-")
                first, last = _key(first, kind), _key(last or first, kind) | 0x1FF
                for row in _between(table, first, last):
                    if row:
                        missing = False
                        yield None
                        row = _cells(row)
                        yield None
                        if is_completed and b"" in row:
                            row = yield from _completed(row, other)
                        row = _plain(row, head)
                    yield row
    if like and missing and as_a_whole:
        yield from _rows(like, kind, numbers)


def _completed(row, table):
    """With what is empty from the row with the same key of the other family's table."""
    key = row_key(row[KEY])
    for other in _between(table, key, key):
        yield None
        if other:
            return [cell or from_other for cell, from_other in zip(row, _cells(other))]
    return row


def _plain(row, head):
    """With nothing for -, and with the number of data sets before their name."""
    row = [b"" if cell == b"-" else cell for cell in row]
    if row[INDICES:] and row[INDICES] in (b"CDS", b"DDS"):
        sets = _COMMAND_SETS if row[INDICES] == b"CDS" else _DRIVE_SETS
        row[INDICES] = head[sets] + b" " + row[INDICES]
    return row


def _between(table, first, last):
    """The rows with these keys, as lines, and None after each look for the first."""
    is_packed = hasattr(table, "bring")
    yield from table.bring(first) if is_packed else _bring(table, first)
    yield None
    while True:
        line = _row(table)
        if not line and is_packed and (yield from table.go_on()):
            continue
        key = row_key(line) if line else last + 1
        if key > last:
            return
        yield line if key >= first else None


def _bring(table, first):
    """Search a file: the next row is that with this key, or one before it that is near."""
    low, high = 0, table.seek(0, 2)
    while high - low > _NEAR:
        middle = (low + high) // 2
        table.seek(middle)
        _line(table)  # what is left of it
        line = _row(table)
        if line and row_key(line) < first:
            low = table.tell() - len(line)
        else:
            high = middle
        yield None
    table.seek(low)


def _prepare(family):
    """Load what reads a table that is frozen in. None after it."""
    if family not in FAMILIES:
        raise ValueError("no catalogue of %s" % family)
    if _IS_FROZEN and not _packed:
        from catalogue.packed import Packed

        _packed.append(Packed)
        yield None


def _table(family):
    """A table as a stream of bytes: a file, or what is frozen into the firmware."""
    if _IS_FROZEN:
        return _packed[0](family, row_key)
    return open(__file__.rpartition("/")[0] + "/" + family + ".tsv", "rb")


def _row(table):
    """The next row; empty at the end."""
    line = _line(table)
    while line and not 65 <= line[0] & 0xDF <= 90:  # no letter: the head, a remark
        line = _line(table)
    return line


def _line(table):
    """What is left of a line. `readline` would ask the file system for byte after byte."""
    if hasattr(table, "line"):
        return table.line()
    line = b""
    while True:
        piece = table.read(_PIECE)
        end = piece.find(b"\n") + 1
        if end:
            table.seek(end - len(piece), 1)
            return line + piece[:end]
        line += piece
        if not piece:
            return line


def row_key(line):
    """That of the row which begins so."""
    return _key(line[1:], line[0])


def _key(cell, kind):
    """What the rows are in the order of, an integer that needs no heap."""
    kind &= 0x1F
    main, _, part = cell.split(b"\t", 1)[0].partition(b".")
    return (_PARAMETER if kind == _READING else kind) << 24 | int(main) << 9 | int(part or 0)


def _cells(line):
    """Cells in ISO 8859-1. A file is UTF-8, and has nothing that does not fit; of a long line the
    letters with an accent are few, so what stands between them is moved as a whole.
    """
    if b"\xc2" in line or b"\xc3" in line:  # what is frozen has neither
        first, *others = line.replace(b"\xc2", b"").split(b"\xc3")
        line = first + b"".join([bytes((part[0] | 0x40,)) + part[1:] for part in others])
    return line.rstrip(b"\n").split(b"\t")
