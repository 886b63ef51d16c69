# SPDX-License-Identifier: MIT
"""What a drive tells of itself while it runs, for people: which parameter has its current, say.

    of(MM440, 4)                # ((OUTPUT, 24, FLOAT), (SPEED, 22, FLOAT), ...)
    quantity, number, factor = row          # index 0 of the parameter

Numbers: parameter lists of the MICROMASTER 420 and 440. Rows with (?) are unverified. A drive that
lacks one refuses it, and tells the others.
"""

# OUTPUT: frequency in Hz. SPEED: 1/min. CURRENT: A. VOLTAGE: that of the motor, and DC_LINK, V.
# POWER: kW, or hp where P0100 says so. MOTOR, INVERTER: their temperatures, degrees Celsius.
OUTPUT, SPEED, CURRENT, VOLTAGE, DC_LINK, POWER, MOTOR, INVERTER = range(8)

# How it is told: a floating-point number, or a word in so many hundredths of the unit.
FLOAT = 0

_MM4 = (
    (OUTPUT, 24, FLOAT),
    (SPEED, 22, FLOAT),
    (CURRENT, 27, FLOAT),
    (VOLTAGE, 25, FLOAT),
    (DC_LINK, 26, FLOAT),
)
_INVERTER = ((INVERTER, 37, FLOAT),)  # [0]: the heat sink
_VECTOR = _MM4 + ((POWER, 32, FLOAT), (MOTOR, 35, FLOAT)) + _INVERTER

ROWS = {
    "MM410": _MM4 + _INVERTER,  # (?)
    "MM420": _MM4 + _INVERTER,
    "MM430": _VECTOR,  # (?)
    "MM440": _VECTOR,
    "CU240S": _VECTOR,  # (?)
    "G110": _MM4 + _INVERTER,  # (?) speed and temperature
    "V20": _VECTOR,  # (?) all of them
    "G120": _VECTOR,  # (?) all of them
    "MM3": (  # (?) all of them
        (SPEED, 135, 100),
        (CURRENT, 132, 10),
        (VOLTAGE, 137, 100),
        (DC_LINK, 134, 100),
    ),
}


def of(family, pkw_words):
    """The rows of a family, as far as so many PKW words can carry them: three carry no float."""
    rows = ROWS.get(family.__name__, ()) if pkw_words else ()
    return tuple([row for row in rows if pkw_words != 3 or row[2] != FLOAT])
