# SPDX-License-Identifier: MIT
"""Parameter sets: what the panel saves is what the drive has, what it writes stands in a set, and
a drive that has one in part is not started.

A1 SAVE  41%        >SAVED: 276     the file has so many values, each as the drive has it
3 DIFFER    1/4     >SET=WRITE A2   from here on values of a set are written, once the settings in
                                    the flash say that the drive has one in part
2 MAY CUT   1/3                     SET: also those that ask first
A2                  >WRITTEN, EQUAL the drive has all that is in the set

In use:

    sets = KeptSets(world, witness)
    sets.read(rows, now)                        # the display, after every slice: raises Broken
    sets.key(key, now)                          # before a key goes down
    sets.writes(address)                        # whether a set is being written into that drive
    sets.judge_write(address, key, value, ...)  # such a write: raises Broken
    sets.is_half(address)                       # START and JOG must be refused
"""

import json
import struct

from tools.soaking.judging.case import drive_at
from tools.soaking.judging.facts import CHOSEN_US, EEPROM_WRITES, MENU, NEVER, S
from tools.soaking.judging.rules import Broken

ENDING, FIRST, END = ".set", "USS SET 1", "end"
SETTINGS_FILE, HALF = "settings.json", "half_written"
INTO, IN_EEPROM = MENU + "INTO A", "EEPROM"
WRITE = MENU + "SET=WRITE A"
GIVE_UP = MENU + "GIVE UP A"
YES = (MENU + "SET=DO PARAM=NO", MENU + "THE BUS OFF, OR", MENU + "CHANGE THE Hz:")
NAMES, COMPARES = "NAME, SET=SAVE", MENU + "COMPARE A"  # row 1, row 2
SAVED = MENU + "SAVED: "
EQUAL = (MENU + "WRITTEN, EQUAL", MENU + "ALL EQUAL")
# Beside what stands in the set: commissioning, and the access level.
BESIDES = ((10, 0), (10, 1), (3, 3), (9, 3))
LATE_US = 2 * S  # telegrams that were made ready before PARAM ended it


class KeptSets:
    def __init__(self, world, witness):
        self._world = world
        self._witness = witness
        self._half = {}  # address -> whether something of a set was written, and no more is known
        self._target = None  # the drive that a set is written into,
        self._is_permanent = self._cuts = False  # also into the EEPROM; also what asks first
        self._ended_us = NEVER
        self._left = None  # the drive whose set is given up, if that is said once more
        self._chosen = None  # (address, whether EEPROM) of the entry that SET was pressed on
        self._offers = {}  # what SET says yes to -> when that was read last
        self._offered = None  # the entry, or the address to be written into, that goes with it
        self._rows = None
        self._begun_us = NEVER  # saving, or comparing with a drive
        self._changed_us = {}  # address -> somebody else has changed a value there

    # --- what the display says ------------------------------------------------------------------

    def read(self, rows, now):
        row_1, row_2 = rows[0].strip(), rows[1].rstrip()
        if row_2.startswith(INTO) and row_2[len(INTO) : len(INTO) + 1].isdigit():
            words = row_2[len(INTO) :].split()
            self._offer("into", (int(words[0]), words[-1] == IN_EEPROM), now)
        elif row_1 == NAMES:
            self._offer("save", None, now)
        elif row_2.startswith(COMPARES) and row_2[len(COMPARES) :].isdigit():
            self._offer("into", (int(row_2[len(COMPARES) :]), False), now)
        elif row_2.startswith(WRITE) and row_2[len(WRITE) :].isdigit():
            self._offer("write", int(row_2[len(WRITE) :]), now)
        elif row_2.startswith(GIVE_UP) and row_2[len(GIVE_UP) :].isdigit():
            self._offer("give up", int(row_2[len(GIVE_UP) :]), now)
        elif row_2 in YES:
            self._offer("yes", None, now)
        if rows != self._rows:
            self._rows = rows
            if row_2.startswith(SAVED) and row_2[len(SAVED) :].isdigit():
                self._judge_saved(int(row_2[len(SAVED) :]))
            elif row_2 in EQUAL and self._chosen is not None:
                self._judge_equal(self._chosen[0])

    def _offer(self, name, what, now):
        self._offers = {name: now}
        self._offered = what

    def key(self, key, now):
        answers = now - self._offers.get("yes", NEVER) < CHOSEN_US  # PARAM is no, and it goes on
        if key == "PARAM" and self._target is not None and not answers:
            self._ended_us = now
        if key != "SET":
            return
        for name, read_us in self._offers.items():
            if now - read_us < CHOSEN_US:
                self._choose(name, now)
        self._offers = {}

    def _choose(self, name, now):
        if name == "into":
            self._chosen = self._offered
            self._target, self._left, self._begun_us = None, None, now
        elif name == "save":
            self._begun_us = now
        elif name == "write":
            address = self._offered
            self._target, self._cuts, self._ended_us = address, False, NEVER
            self._is_permanent = self._chosen == (address, True)
        elif name == "give up":
            self._target, self._left = None, self._offered
        elif self._target is not None:
            self._cuts = True
        else:
            self._half.pop(self._left, None)

    def changed(self, address, now):
        """Somebody has changed something at the drive itself."""
        self._changed_us[address] = now

    # --- what is written ------------------------------------------------------------------------

    def writes(self, address, now):
        """Whether a set may be on its way into this drive."""
        is_over = self._ended_us > 0 and now - self._ended_us > LATE_US
        return address == self._target and not is_over

    def is_half(self, address):
        return address in self._half

    def booted(self):
        self._target = None
        self._offers = {}

    def judge_write(self, address, what, task, family, where):
        """what: number, index and value of a write."""
        number, index, value = what
        stored = json.loads(self._world.flash.files[SETTINGS_FILE])
        if str(address) not in stored.get(HALF, {}):
            raise Broken("WRITE", "%s, and no settings say that a set is begun" % where)
        self._half[address] = True
        if task in EEPROM_WRITES and not self._is_permanent and number not in family.permanent:
            raise Broken("EEPROM", "%s, of a set that is for the RAM" % where)
        if (number, value) in BESIDES and not index:
            return
        sets = [rows for _, rows in self._files() if (number, index) in rows]
        if value not in [rows[number, index][0] for rows in sets]:
            raise Broken("WRITE", "%s: %08X, which is in no set" % (where, value))
        if number in family.dangerous and not self._cuts:
            raise Broken("WRITE", "%s, and nobody was asked" % where)

    def _judge_saved(self, count):
        """The file that is new, whichever it is, has what its drive has."""
        told = None
        for owner, rows in self._files():
            drive = drive_at(self._world, owner)
            if len(rows) != count:
                continue
            differs = () if drive is None or self._is_changed(owner) else differences(drive, rows)
            if not differs:
                return
            told = owner, differs[:5]
        if told is None:
            raise Broken("SET", "no file has %d values" % count)
        raise Broken("SET", "saved, and drive %d differs in %s" % told)

    def _judge_equal(self, address):
        """Nothing of a set is missing in the drive, but for what asks first if that was declined;
        another drive keeps more of its own."""
        self._half.pop(address, None)
        self._target = None
        drive = drive_at(self._world, address)
        family = self._witness.kinds[address].family
        files = [rows for owner, rows in self._files() if owner == address]
        if drive is None or not files or self._is_changed(address):
            return
        if len(files) < len(self._files()):
            return  # it may be the set of another drive
        left = [
            [key for key in differences(drive, rows) if key[0] not in family.dangerous]
            for rows in files
        ]
        if all(left):
            raise Broken(
                "SET", "drive %d reads as equal, and differs in %s" % (address, left[0][:5])
            )

    def _is_changed(self, address):
        return self._changed_us.get(address, NEVER) >= self._begun_us

    def _files(self):
        """(address, {(number, index): (value, bits)}) of each set in the flash that is whole."""
        found = []
        for name, data in self._world.flash.files.items():
            if name.endswith(ENDING):
                owner, rows = set_in(data)
                if rows is not None:
                    found.append((owner, rows))
        return found


def set_in(data):
    """Address and {(number, index): (value, bits)} of a set's file; None for the latter: it is
    not whole.
    """
    lines = bytes(data).decode().split("\n")
    rows, owner = {}, None
    if lines[0] != FIRST:
        return owner, None
    for line in lines[1:]:
        words = line.split()
        if words[:1] == ["address"]:
            owner = int(words[1])
        elif words[:1] == [END]:
            return owner, rows if int(words[1]) == len(rows) else None
        elif len(words) == 4 and words[0][:1] == "P":
            rows[int(words[0][1:]), int(words[1])] = int(words[3], 16), 4 * len(words[3])
    return owner, None


def differences(drive, rows):
    """The numbers and indices in which a drive has another value than a set."""
    found = []
    for number, index in sorted(rows):
        try:
            value = drive.read(number, index)
        except KeyError:
            found.append((number, index))
            continue
        if isinstance(value, float):
            (value,) = struct.unpack("<I", struct.pack("<f", value))
        wanted, bits = rows[number, index]
        if value & (1 << bits) - 1 != wanted:
            found.append((number, index))
    return found
