# SPDX-License-Identifier: MIT
"""What a user sets once: the bus, its drives, the limits of the setpoint, what was accepted.

The schema is three tables; the settings stand in a board's store as JSON, a line for each. What is
wrong in the file, or in a file that cannot be read, has its default, and `complaint` says so. That
loses nothing: loading writes nothing, and the first save sets the file aside. A save keeps what a
newer firmware stored and this one does not know.

    settings = load(board.store)
    settings.readdress(1, 5)
    if settings.dirty:
        save(board.store, settings)
"""

import json
import sys

from uss.telegram import NODE_MAX
from uss.timing import BAUD_RATES

SIZE_MAX = 4096  # bytes of the file: a chip has to hold it, and what is made of it
UNKNOWN_MAX = 2048  # of that, what is kept though it is not known

# What may be wrong with the file as a whole, in place of the name of a setting.
UNREADABLE, TOO_BIG, NO_JSON = "unreadable", "too big", "no JSON"

CHOICES = (  # name, default, what it may be, meaning
    ("baud", 19200, BAUD_RATES, "bit/s"),
    ("second_stop", "OFF3", ("OFF3", "OFF2", "none"), "what holding STOP for 1.5 s sends"),
)
NUMBERS = (  # name, default, lowest, highest, meaning
    ("reply_timeout_ms", 20, 20, 500, "wait for a reply to begin; it delays a STOP as well"),
    ("lost_ms", 1000, 100, 5000, "without a valid reply for so long a drive counts as lost"),
    ("setpoint_centihertz", 1000, 0, 65000, "setpoint after power-up, 0.01 Hz"),
    ("setpoint_step_centihertz", 10, 1, 1000, "step of UP and DOWN, 0.01 Hz"),
    ("lowest_centihertz", 0, 0, 65000, "lowest setpoint, 0.01 Hz"),
    ("highest_centihertz", 65000, 0, 65000, "highest setpoint, 0.01 Hz"),
)
ADDRESSES = (  # name, default, fewest, meaning; addresses 0...31, each once, 31 at the most
    ("drives", (1,), 1, "in the order of the address keys"),
    ("unsupervised", (), 0, "drives accepted without a telegram time-out, P2014 = 0"),
)
DEFAULTS = {row[0]: row[1] for row in CHOICES + NUMBERS + ADDRESSES}


class Settings:
    """One attribute for each row of CHOICES, NUMBERS and ADDRESSES (tuples), and

    complaint   None, or what was wrong with the file; stays until the next power-up
    suspect     None, or what the complaint is about: the name of a setting, UNREADABLE ...
    damaged     True: the file holds what was not taken over and is not yet set aside
    dirty       True: something was changed and is not saved yet

    Nobody else writes any of these, but `save` puts damaged and dirty back.
    """

    def __init__(self):
        self.complaint = None
        self.suspect = None
        self.damaged = False
        self.dirty = False
        self._unknown = {}  # name -> the line as it stands in the file
        for name in DEFAULTS:
            setattr(self, name, DEFAULTS[name])

    def take(self, stored):
        """Take over what a dictionary says; complain about the first thing that cannot be."""
        for name, default, choices, _ in CHOICES:
            value = stored.get(name, default)
            if type(value) is type(default) and value in choices:
                setattr(self, name, value)
            else:
                words = " ".join(str(choice) for choice in choices)
                self.complain(name, "%r is none of %s" % (value, words))
        for name, default, lowest, highest, _ in NUMBERS:
            value = stored.get(name, default)
            if _is_number(value, lowest, highest):
                setattr(self, name, value)
            else:
                self.complain(name, "%r is not %d...%d" % (value, lowest, highest))
        for name, default, fewest, _ in ADDRESSES:
            value = stored.get(name, default)
            if _are_addresses(value, fewest):
                setattr(self, name, tuple(value))
            else:
                self.complain(name, "%r are not up to 31 addresses 0...31" % (value,))
        if self.lowest_centihertz > self.highest_centihertz:
            limits = (self.lowest_centihertz, self.highest_centihertz)
            self.complain("lowest_centihertz", "%d is above highest_centihertz: %d" % limits)
            self.lowest_centihertz = DEFAULTS["lowest_centihertz"]
            self.highest_centihertz = DEFAULTS["highest_centihertz"]

    def take_file(self, found):
        """As `take`, from the `fields` of the file; what is not known is kept."""
        stored, kept = {}, 0
        for name, value, source in found:
            if name in stored:
                self.complain(name, "it stands there twice")
                value = DEFAULTS.get(name)  # nobody knows which of them was meant
            elif name not in DEFAULTS:
                kept += len(source)
                if kept > UNKNOWN_MAX:
                    self.complain(TOO_BIG, "more than %d bytes are not known" % UNKNOWN_MAX)
                else:
                    self._unknown[name] = source
            stored[name] = value
        self.take(stored)

    def accept_unsupervised(self, address):
        """The operator lets this drive run on when telegrams stay away. ValueError: no such drive.

        What was accepted for a drive that is no longer there ends with that.
        """
        self._check_present(address)
        accepted = tuple(one for one in self.drives if one == address or one in self.unsupervised)
        self.dirty = self.dirty or accepted != self.unsupervised
        self.unsupervised = accepted

    def readdress(self, old, new):
        """The drive at address `old` answers at `new` from now on; it keeps what was accepted.

        ValueError: there is no drive at `old`, there is one at `new`, or `new` is not 0...31.
        """
        self._check_present(old)
        if new in self.drives or not _is_number(new, 0, NODE_MAX):
            raise ValueError("address %r is taken or not 0...31" % (new,))
        accepted = [one for one in self.drives if one in self.unsupervised]
        self.drives = _replaced(self.drives, old, new)
        self.unsupervised = _replaced(accepted, old, new)
        self.dirty = True

    def as_dictionary(self):
        """All that is known."""
        return {name: getattr(self, name) for name in DEFAULTS}

    def as_file(self):
        """What is stored, as bytes: JSON in the order of the tables, the unknown at the end."""
        lines = []
        for name, *_ in CHOICES + NUMBERS + ADDRESSES:
            line = "%s: %s" % (json.dumps(name), json.dumps(getattr(self, name)))
            lines.append(line.encode())
        lines += [self._unknown[name] for name in sorted(self._unknown)]
        return b"{\n  " + b",\n  ".join(lines) + b"\n}\n"

    def complain(self, suspect, text):
        """Note what is wrong with the file; the first complaint stays."""
        if self.complaint is None:
            self.complaint = "%s: %s" % (suspect, text)
            self.suspect = suspect
        self.damaged = True

    def _check_present(self, address):
        if address not in self.drives:
            raise ValueError("no drive %r" % (address,))


def _is_number(value, lowest, highest):
    return type(value) is int and lowest <= value <= highest  # a bool is none


def _are_addresses(values, fewest):
    if not isinstance(values, (list, tuple)) or not fewest <= len(values) <= NODE_MAX:
        return False
    for value in values:
        if not _is_number(value, 0, NODE_MAX):
            return False
    return len(set(values)) == len(values)


def _replaced(addresses, old, new):
    return tuple(new if address == old else address for address in addresses)


def _fields(data):
    """What stands in the file. The module that reads it is needed once: it gives 3 KB back, which
    a chip lacks that has the firmware as files.
    """
    from strict_json import fields

    try:
        return fields(data)
    finally:
        sys.modules.pop("strict_json", None)


def load(store):
    """The settings that a store keeps; the defaults where it keeps none."""
    settings = Settings()
    try:
        data = store.read(SIZE_MAX + 1)
        if data is not None and len(data) > SIZE_MAX:
            settings.complain(TOO_BIG, "the settings file has more than %d bytes" % SIZE_MAX)
        elif data is not None:
            settings.take_file(_fields(data))
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
    store.replace(settings.as_file())
    settings.dirty = False
