# SPDX-License-Identifier: MIT
"""The page of any parameter, as the judge reads it.

Ramp-up time        or  A1 0...650s         in turn
P1120[0]  10.00s
"""

NUMERIC = "0123456789.:-"


def label_in(rows):
    """Number, with P or r, and index of the parameter in row 2, or None; the index is None where
    none stands there.
    """
    label, _, rest = rows[1].partition(" ")
    name, bracket, index = label.partition("[")
    if name[:1] not in ("P", "r") or len(name) != 5 or not name[1:].isdigit():
        return None
    index = index.rstrip("]") if bracket else ""
    return (name, int(index)) if index.isdigit() else (name, None)


def address_above(rows):
    """The address that row 1 has in turn with the name, above a parameter; or None."""
    if label_in(rows) is None:
        return None
    first, _, rest = rows[0].partition(" ")
    if first[:1] != "A" or not first[1:].isdigit():
        return None
    return int(first[1:]) if "..." in rest or not rest.strip() else None


def is_wrong(rows, drive):
    """Whether row 2 has another value than the drive, as far as that can be told: not of what
    changes by itself, nor of one index of several that is not named.
    """
    label = label_in(rows)
    if label is None or label[0][0] != "P":
        return False
    number, index = int(label[0][1:]), label[1]
    text = rows[1].partition(" ")[2].strip()
    digits = "".join([one for one in text[:-1] if one in NUMERIC] + [text[-1:]])
    if text[-1:] == "h" or text[:1] not in NUMERIC or not digits.strip(NUMERIC[10:]):
        return False  # not read, not told, or in hexadecimal
    digits = digits if digits[-1] in NUMERIC else digits[:-1]
    if not text.startswith(digits):
        return False  # half drawn
    try:
        if index is None:
            if _has(drive, number, 1):
                return False
            index = 0
        value = drive.read(number, index)
    except (KeyError, IndexError, ValueError):
        return False
    if ":" in digits:
        source, _, part = digits.partition(":")
        return value != int(source) << 16 | int(part)
    decimals = len(digits.partition(".")[2])
    if isinstance(value, int):
        return (value - int(float(digits))) & 0xFFFF != 0
    return abs(value - float(digits)) > 0.51 / 10**decimals + abs(value) / 1_000_000


def _has(drive, number, index):
    try:
        drive.read(number, index)
    except (KeyError, IndexError, ValueError):
        return False
    return True
