# SPDX-License-Identifier: MIT
"""What a user sets once: the bus, its drives, the limits of the setpoint, what was accepted.

`settings_file` says what there is to set, and reads and writes it. This says how it changes while
the panel works.

    settings.add(7, G110, Layout(127, 2))
    settings.readdress(1, 5)
    settings.dirty                      # it is to be saved
"""

from uss.telegram import NODE_MAX

USUAL_KIND = "mm420"  # what a drive is of which the settings name no kind


class Settings:
    """One attribute for each setting of the tables in `settings_file`, and

    complaint   None, or what was wrong with the file; stays until the next power-up
    suspect     None, or what the complaint is about: the name of a setting, UNREADABLE ...
    damaged     True: the file holds what was not taken over and is not yet set aside
    dirty       True: something was changed and is not saved yet
    new         True: there is no file yet
    unknown     what the file holds besides: name -> the line as it stands there
    half_at     addresses of the drives in `half_written`

    Nobody else writes any of these, but `settings_file`.
    """

    def __init__(self, defaults):
        self.complaint = None
        self.suspect = None
        self.damaged = False
        self.dirty = False
        self.new = False
        self.unknown = {}
        self.half_at = ()
        for name in defaults:
            setattr(self, name, defaults[name])

    def kind(self, address):
        """The kind of a drive, as `families.kinds` has it."""
        return self.kinds.get(str(address), USUAL_KIND)

    def add(self, address, kind):
        """A drive more. ValueError: there are 31, or the address is taken or not 0...31."""
        if address in self.drives or not is_number(address, 0, NODE_MAX):
            raise ValueError("address %r is taken or not 0...31" % (address,))
        if len(self.drives) == NODE_MAX:
            raise ValueError("the panel has %d drives" % NODE_MAX)
        self.drives += (address,)
        self.dirty = True
        self.set_kind(address, kind)

    def change(self, name, value):
        """Another value of a setting that `settings_file` allows."""
        self.dirty = self.dirty or getattr(self, name) != value
        setattr(self, name, value)

    def begin_anew(self, baud):
        """Another line: no drive of the one before is on it."""
        self.baud = baud
        self.drives = self.unsupervised = ()
        self.kinds = {}
        self.repeats = {}
        self.dirty = True

    def remove(self, address):
        """A drive less, and what was accepted for it. ValueError: no such drive."""
        self._check_present(address)
        self.drives = tuple([one for one in self.drives if one != address])
        self.unsupervised = tuple([one for one in self.unsupervised if one != address])
        for values in (self.kinds, self.repeats):
            values.pop(str(address), None)
        self.dirty = True

    def set_kind(self, address, kind):
        """The drive is of this kind from now on."""
        kinds = dict(self.kinds)
        kinds[str(address)] = kind
        if kind == USUAL_KIND:
            kinds.pop(str(address))
        self.dirty = self.dirty or kinds != self.kinds
        self.kinds = kinds

    def accept_unsupervised(self, address):
        """The operator lets this drive run on when telegrams stay away. ValueError: no such drive.

        What was accepted for a drive that is no longer there ends with that.
        """
        self._check_present(address)
        accepted = tuple(one for one in self.drives if one == address or one in self.unsupervised)
        self.dirty = self.dirty or accepted != self.unsupervised
        self.unsupervised = accepted

    def note_set(self, address, check=None):
        """A parameter set is written in part at this address: that with this check, as text; None:
        not any more. That holds for a drive which is not in the list any more, too."""
        checks = dict(self.half_written)
        checks.pop(str(address), None)
        if check is not None:
            checks[str(address)] = check
        self.change("half_written", checks)
        self.note_half()

    def note_half(self):
        """Whether a drive is among them is asked for each picture, which takes no memory."""
        self.half_at = tuple([int(address) for address in self.half_written])

    def readdress(self, old, new):
        """The drive at address `old` answers at `new` from now on; it keeps what was accepted.

        ValueError: there is no drive at `old`, there is one at `new`, or `new` is not 0...31.
        """
        self._check_present(old)
        if new in self.drives or not is_number(new, 0, NODE_MAX):
            raise ValueError("address %r is taken or not 0...31" % (new,))
        accepted = [one for one in self.drives if one in self.unsupervised]
        self.drives = _replaced(self.drives, old, new)
        self.unsupervised = _replaced(accepted, old, new)
        for values in (self.kinds, self.repeats, self.half_written):
            moved = values.pop(str(old), None)
            values.pop(str(new), None)  # of a drive that is gone
            if moved is not None:
                values[str(new)] = moved
        self.note_half()
        self.dirty = True

    def complain(self, suspect, text):
        """Note what is wrong with the file; the first complaint stays."""
        if self.complaint is None:
            self.complaint = "%s: %s" % (suspect, text)
            self.suspect = suspect
        self.damaged = True

    def _check_present(self, address):
        if address not in self.drives:
            raise ValueError("no drive %r" % (address,))


def is_number(value, lowest, highest):
    return type(value) is int and lowest <= value <= highest  # a bool is none


def _replaced(addresses, old, new):
    return tuple(new if address == old else address for address in addresses)
