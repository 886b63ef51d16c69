# SPDX-License-Identifier: MIT
"""A setpoint typed at the panel's keys, digit by digit, as an operator types it.

    for key, down_ms, up_ms in typed(world, -1250):     # -12.50 Hz; Untyped: it cannot be now
        ...                                             # press the key, let it go; None: wait

It looks at the display between two keys, as the operator does. Nothing takes effect before SET,
and SET is pressed only if the display says what was wanted. A setpoint for the other direction is
set first, and then reversed.
"""

TAP_MS, RELEASE_MS = 60, 40  # the panel takes a press of 30 ms
DRAWN_MS = 100  # until what a key did is on the display
LOOKS = 5  # at the display, DRAWN_MS apart, before it is given up
CENTIHERTZ_MAX = 65_000

FIRST_PLACE = 2  # the digit that EDIT begins at
PLACES = 5
# Both rows while it is edited: "S: 10.0 F:  0.00", "NEW 010.00Hz A1"; the first word of the second
# row depends on the language. A parameter that is edited has another first row.
SETPOINT, FIRST, UNIT, UNITS = "S:", 4, 10, ("Hz", "% ")
SIGNED = 7  # so far row 1 may have the sign of the setpoint
# Eight keys have most of fourteen behind FN.
COMPACT = {
    "EDIT": ("FN", "FN", "P"),
    "SET": ("FN", "P"),
    "NEXT": ("FN", "UP"),
    "PREVIOUS": ("FN", "DOWN"),
}


class Untyped(Exception):
    """The panel does not take a setpoint now. Text: what its display says."""


def centihertz(text):
    """What a person has written, such as "12.5" or "-30". ValueError."""
    sign, figures = (-1, text[1:]) if text[:1] == "-" else (1, text)
    whole, point, rest = figures.partition(".")
    if not whole.isdigit() or len(whole) > 3 or len(rest) > 2 or rest and not rest.isdigit():
        raise ValueError("%s is no setpoint like 12.5 or -30" % text)
    value = int(whole) * 100 + int((rest + "00")[:2])
    if value > CENTIHERTZ_MAX:
        raise ValueError("%s: a drive turns at 650 Hz at the most" % text)
    return sign * value


def typed(world, wanted):
    """Generate the steps (key, down_ms, up_ms)."""
    yield from press(world, "EDIT")
    yield from until(world, lambda: digits(world))
    if not digits(world):
        raise Untyped("no setpoint can be typed now, the display shows %s" % shown(world))
    text = "%03d.%02d" % divmod(abs(wanted), 100)
    yield from turn(world, digits(world).replace(".", ""), text.replace(".", ""))
    yield from until(world, lambda: digits(world) == text)
    if digits(world) != text:
        raise Untyped("the setpoint is as it was, the display shows %s" % shown(world))
    yield from press(world, "SET")
    yield from until(world, lambda: not digits(world))
    if wanted and ("-" in world.lcd()[0][:SIGNED]) != (wanted < 0):
        yield from press(world, "REVERSE")


def turn(world, before, after):
    """Every digit that differs, the nearer way round."""
    at = FIRST_PLACE
    for place in range(PLACES):
        steps = (int(after[place]) - int(before[place])) % 10
        if steps:
            yield from way(world, "NEXT", "PREVIOUS", (place - at) % PLACES, PLACES)
            yield from way(world, "UP", "DOWN", steps, 10)
            at = place


def way(world, forward, back, steps, all_steps):
    key, count = (forward, steps) if 2 * steps <= all_steps else (back, all_steps - steps)
    for _ in range(count):
        yield from press(world, key)


def press(world, key):
    for each in COMPACT.get(key, (key,)) if "FN" in world.keypad.names else (key,):
        yield each, TAP_MS, RELEASE_MS


def until(world, condition):
    for _ in range(LOOKS):
        yield None, 0, DRAWN_MS
        if condition():
            break


def digits(world):
    """The setpoint that is being edited, as it is shown: "010.00"; "" if none is."""
    first, row = world.lcd()
    text = row[FIRST:UNIT]
    is_edited = first.startswith(SETPOINT) and row[UNIT : UNIT + 2] in UNITS and text[3] == "."
    return text if is_edited and text.replace(".", "").isdigit() else ""


def shown(world):
    return " / ".join(row.strip() for row in world.lcd())
