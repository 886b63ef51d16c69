# SPDX-License-Identifier: MIT
"""How the settings are stored: a file of JSON, a line for each.

The schema is four tables. What is wrong in the file, or in a file that cannot be read, has its
default, and `complaint` says so. That loses nothing: loading writes nothing, and the first save
sets the file aside. A save keeps what a newer firmware stored and this one does not know.

    settings = load(board.store)
    settings.readdress(1, 5)
    if settings.dirty:
        save(board.store, settings)
"""

import json

import on_demand
from settings import Settings, is_number
from uss.families import NAMES
from uss.families.kinds import kind
from uss.telegram import NODE_MAX
from uss.timing import BAUD_RATES

SIZE_MAX = 4096  # bytes of the file: a chip has to hold it, and what is made of it
UNKNOWN_MAX = 1472
REPEATS_MAX = 4
FAVOURITES_MAX = 32  # of all families together

_NUMBER_MAX = 99_999  # of a favourite: five digits can be typed
_FAMILIES = [name.lower() for name in NAMES]

# What may be wrong with the file as a whole, in place of the name of a setting.
UNREADABLE, TOO_BIG, NO_JSON = "unreadable", "too big", "no JSON"

CHOICES = (  # name, default, what it may be, meaning
    ("baud", 19200, BAUD_RATES, "bit/s"),
    ("second_stop", "OFF3", ("OFF3", "OFF2", "none"), "what holding STOP for 1.5 s sends"),
    ("language", "en", ("en", "de"), "of the display: columns of panel/languages/words.tsv"),
    ("log", "none", ("none", "JSON"), "a line a second on the serial port"),
)
LIMITS = ("lowest_centihertz", "highest_centihertz")  # of the setpoint: never crossed
NUMBERS = (  # name, default, lowest, highest, meaning
    ("reply_timeout_ms", 20, 20, 500, "wait for a reply to begin; it delays a STOP as well"),
    ("lost_ms", 1000, 100, 5000, "without a valid reply for so long a drive counts as lost"),
    ("setpoint_centihertz", 1000, 0, 65000, "setpoint after power-up, 0.01 Hz"),
    ("setpoint_step_centihertz", 10, 1, 1000, "step of UP and DOWN, 0.01 Hz"),
    ("lowest_centihertz", 0, 0, 65000, "lowest setpoint, 0.01 Hz"),
    ("highest_centihertz", 65000, 0, 65000, "highest setpoint, 0.01 Hz"),
    ("key_delay_ms", 400, 200, 900, "a key held so long begins to repeat"),
    ("key_repeat_ms", 120, 40, 500, "from one repeat to the next"),
    ("light_minutes", 0, 0, 60, "without a key for so long the backlight goes off; 0: never"),
    ("lock_code", 0, 0, 9999, "of the lock; 0: there is none"),
)
ADDRESSES = (  # name, default, fewest, meaning; addresses 0...31, each once, 31 at the most
    ("drives", (1,), 1, "in the order of the address keys"),
    ("unsupervised", (), 0, "drives accepted without a telegram time-out, P2014 = 0"),
)
BY_ADDRESS = (  # name, default, meaning; an object: address as text -> text or number
    ("kinds", {}, "family, and layout if unusual, of drives that are no mm420"),
    ("repeats", {}, "2...4: how often a drive stands in the circulating list"),
    ("half_written", {}, "the check of a set that is on the drive in part, and makes it whole"),
)
BY_FAMILY = (  # name, default, meaning; an object: family -> parameter numbers
    ("favourites", {}, "in place of those that parameter mode shows"),
)
DEFAULTS = {row[0]: row[1] for row in CHOICES + NUMBERS + ADDRESSES + BY_ADDRESS + BY_FAMILY}


def load(store):
    """The settings that a store keeps; the defaults where it keeps none."""
    settings = Settings(DEFAULTS)
    try:
        data = store.read(SIZE_MAX + 1)
        if data is not None and len(data) > SIZE_MAX:
            settings.complain(TOO_BIG, "the settings file has more than %d bytes" % SIZE_MAX)
        elif data is not None:
            _take_fields(settings, _fields(data))
        settings.new = data is None
    except OSError:
        settings.complain(UNREADABLE, "the settings file cannot be read")
    except ValueError as error:
        settings.complain(NO_JSON, "the settings file is damaged (%s)" % error)
    return settings


def save(store, settings):
    """Replace what the store keeps by these settings, all or nothing.

    OSError: the store failed; the old settings are there, and `dirty` stays as it was.
    """
    if settings.damaged:
        store.set_aside()
        settings.damaged = False
    store.replace(_as_file(settings))
    settings.dirty = False


def moved(settings, name, value, steps):
    """This value of a choice or a number so many steps up or down, within its limits."""
    for row in CHOICES:
        if row[0] == name:
            position = row[2].index(value) + (1 if steps > 0 else -1)
            return row[2][max(0, min(position, len(row[2]) - 1))]
    lowest, highest = [row[2:4] for row in NUMBERS if row[0] == name][0]
    if name == LIMITS[0]:
        highest = getattr(settings, LIMITS[1])
    elif name == LIMITS[1]:
        lowest = getattr(settings, LIMITS[0])
    return max(lowest, min(highest, value + steps))


def as_dictionary(settings):
    """All that is known."""
    return {name: getattr(settings, name) for name in DEFAULTS}


def _as_file(settings):
    """What is stored, as bytes: JSON in the order of the tables, the unknown at the end."""
    lines = []
    for name, *_ in CHOICES + NUMBERS + ADDRESSES + BY_ADDRESS + BY_FAMILY:
        line = "%s: %s" % (json.dumps(name), _as_json(getattr(settings, name)))
        lines.append(line.encode())
    lines += [settings.unknown[name] for name in sorted(settings.unknown)]
    return b"{\n  " + b",\n  ".join(lines) + b"\n}\n"


# --- what stands in the file ---------------------------------------------------------------------


def _fields(data):
    """What stands in the file. The module that reads it is needed once: it gives 3 KB back, which
    a chip lacks that has the firmware as files.
    """
    try:
        return on_demand.load("strict_json").fields(data)
    finally:
        on_demand.drop("strict_json")


def _take(settings, stored):
    """Take over what a dictionary says; complain about the first thing that cannot be."""
    for name, default, choices, _ in CHOICES:
        value = stored.get(name, default)
        if type(value) is type(default) and value in choices:
            setattr(settings, name, value)
        else:
            words = " ".join(str(choice) for choice in choices)
            settings.complain(name, "%r is none of %s" % (value, words))
    for name, default, lowest, highest, _ in NUMBERS:
        value = stored.get(name, default)
        if is_number(value, lowest, highest):
            setattr(settings, name, value)
        else:
            settings.complain(name, "%r is not %d...%d" % (value, lowest, highest))
    for name, default, fewest, _ in ADDRESSES:
        value = stored.get(name, default)
        if _are_addresses(value, fewest):
            setattr(settings, name, tuple(value))
        else:
            settings.complain(name, "%r are not up to 31 addresses 0...31" % (value,))
    settings.kinds = _by_address(settings, "kinds", stored, kind)
    settings.repeats = _by_address(settings, "repeats", stored, _check_repeats)
    settings.half_written = _by_address(settings, "half_written", stored, _check_set)
    settings.note_half()
    favourites = stored.get("favourites", {})
    if _are_favourites(favourites):
        settings.favourites = favourites
    else:
        text = "%r is not up to %d numbers, by family"
        settings.complain("favourites", text % (favourites, FAVOURITES_MAX))
    if settings.lowest_centihertz > settings.highest_centihertz:
        limits = (settings.lowest_centihertz, settings.highest_centihertz)
        settings.complain("lowest_centihertz", "%d is above highest_centihertz: %d" % limits)
        settings.lowest_centihertz = DEFAULTS["lowest_centihertz"]
        settings.highest_centihertz = DEFAULTS["highest_centihertz"]


def _take_fields(settings, found):
    """As `_take`, from the `fields` of the file; what is not known is kept."""
    stored, kept = {}, 0
    for name, value, source in found:
        if name in stored:
            settings.complain(name, "it stands there twice")
            value = DEFAULTS.get(name)  # nobody knows which of them was meant
        elif name not in DEFAULTS:
            kept += len(source)
            if kept > UNKNOWN_MAX:
                settings.complain(TOO_BIG, "more than %d bytes are not known" % UNKNOWN_MAX)
            else:
                settings.unknown[name] = source
        stored[name] = value
    _take(settings, stored)


def _by_address(settings, name, stored, check):
    """What is stored for addresses, as far as `check` takes it; complain about the others."""
    values, known = stored.get(name, {}), {}
    try:
        for address in values:
            if address != str(int(address)) or not 0 <= int(address) <= NODE_MAX:
                raise ValueError("%r is no address 0...31" % (address,))
            check(values[address])
            known[address] = values[address]
    except (ValueError, TypeError, AttributeError) as error:  # no object, no text in it
        settings.complain(name, str(error))
    return known


def _check_repeats(value):
    if not is_number(value, 2, REPEATS_MAX):
        raise ValueError("%r is not 2...%d" % (value, REPEATS_MAX))


def _check_set(value):
    if not isinstance(value, str) or not len(value) == 8:
        raise ValueError("%r is no check of a set" % (value,))


def _are_addresses(values, fewest):
    if not isinstance(values, (list, tuple)) or not fewest <= len(values) <= NODE_MAX:
        return False
    for value in values:
        if not is_number(value, 0, NODE_MAX):
            return False
    return len(set(values)) == len(values)


def _are_favourites(value):
    if not isinstance(value, dict):
        return False
    count = 0
    for family in value:
        numbers = value[family]
        if family not in _FAMILIES or not isinstance(numbers, list):
            return False
        count += len(numbers)
        for number in numbers:
            if not is_number(number, 0, _NUMBER_MAX):
                return False
    return count <= FAVOURITES_MAX


def _as_json(value):
    """As json.dumps, and addresses in their order."""
    if not isinstance(value, dict):
        return json.dumps(value)
    names = sorted(value, key=lambda name: "%9s" % name)
    return "{%s}" % ", ".join(['"%s": %s' % (one, json.dumps(value[one])) for one in names])
