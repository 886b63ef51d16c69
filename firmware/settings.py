"""What a user sets once: the bus, its drives, the limits of the setpoint.

The schema is a table; the settings are read from a board's store as JSON. A file that cannot be
read or has a value out of range gives the default for what is wrong and says so in `complaint`;
nothing that was stored is lost by that, because loading writes nothing.

    settings = load(board.store)
    settings.baud
    save(board.store, settings)
"""

import json

from uss.telegram import NODE_MAX
from uss.timing import BAUD_RATES

SCHEMA = (  # name, default, lowest, highest, meaning
    ("baud", 19200, 300, 187500, "bit/s, one of the rates of USS"),
    ("reply_timeout_ms", 20, 20, 60, "wait for a reply to begin; it delays a STOP as well"),
    ("lost_ms", 1000, 100, 5000, "without a valid reply for so long a drive counts as lost"),
    ("setpoint_centihertz", 1000, 0, 65000, "setpoint after power-up, 0.01 Hz"),
    ("setpoint_step_centihertz", 10, 1, 1000, "step of UP and DOWN, 0.01 Hz"),
    ("lowest_centihertz", 0, 0, 65000, "lowest setpoint, 0.01 Hz"),
    ("highest_centihertz", 65000, 0, 65000, "highest setpoint, 0.01 Hz"),
)
DRIVES = (1,)  # addresses 0...31, each once, in the order of the address keys


class Settings:
    """One attribute for each row of SCHEMA, `drives`, and `complaint`: None or what was wrong."""

    def __init__(self):
        self.complaint = None
        self.drives = DRIVES
        for name, default, _, _, _ in SCHEMA:
            setattr(self, name, default)

    def take(self, stored):
        """Take over what a dictionary says; complain about the first thing that cannot be."""
        for name, _, lowest, highest, _ in SCHEMA:
            if name in stored:
                value = stored[name]
                if _is_integer(value) and lowest <= value <= highest:
                    setattr(self, name, value)
                else:
                    self._complain("%s: %r is not %d...%d" % (name, value, lowest, highest))
        if self.baud not in BAUD_RATES:
            self._complain("baud: %d is no rate of USS" % self.baud)
            self.baud = SCHEMA[0][1]
        if "drives" in stored:
            self._take_drives(stored["drives"])

    def as_dictionary(self):
        stored = {name: getattr(self, name) for name, _, _, _, _ in SCHEMA}
        stored["drives"] = list(self.drives)
        return stored

    def _take_drives(self, drives):
        fits = isinstance(drives, list) and 0 < len(drives) <= NODE_MAX
        for address in drives if fits else ():
            if not (_is_integer(address) and 0 <= address <= NODE_MAX):
                fits = False
        if fits and len(set(drives)) == len(drives):
            self.drives = tuple(drives)
        else:
            self._complain("drives: %r are not up to 31 addresses 0...31" % (drives,))

    def _complain(self, text):
        self.complaint = self.complaint or text


def _is_integer(value):
    return isinstance(value, int) and not isinstance(value, bool)


def load(store):
    """The settings that a store keeps; the defaults where it keeps none."""
    settings = Settings()
    data = store.read()
    if data is None:
        return settings
    try:
        # MicroPython reads half a dictionary without complaint, so the end is looked at as well.
        stored = json.loads(data) if data.rstrip().endswith(b"}") else None
    except ValueError:
        stored = None
    if isinstance(stored, dict):
        settings.take(stored)
    else:
        settings.complaint = "the settings file is damaged"
    return settings


def save(store, settings):
    """Replace what the store keeps by these settings, all or nothing."""
    store.replace(json.dumps(settings.as_dictionary()).encode())
