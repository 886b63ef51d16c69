# SPDX-License-Identifier: MIT
"""What the documents leave open about a drive: one switch for each question, with its default.

A switch says how a whole drive behaves, whatever its family. Differences between families are in
their tables (mm420.py), the settings of a drive in its parameters. A drive takes its switches when
it is built, and you may change them at any time.

    drive = Drive(clock, wire, 1, switches={"stale_replies": 2})
    drive.switches.reexecute = True
    drive.switches.set("no_rights_error", 11)       # with the name looked up first
"""

SWITCHES = (
    # name, default, what it does, where it is left open
    ("stale_replies", 0, "telegrams for which a new task still gets the old reply",
     "USS specification C-4.2.1.1 allows any number"),
    ("reexecute", False, "a task that stands is carried out with every telegram",
     "USS specification C-4.2.1.1 does not forbid it"),
    ("raw_numbers", False, "PNU 2000...2047 without a page are those numbers",
     "a master for the G110 sends them; the manuals know the page alone"),
    ("text_bits_error", 0, "what a task gets that is about no text, with bit 8 or 9 of IND, which "
     "select one: 0 they mean nothing and come back, else this error number, such as 3",
     "USS specification C-4.2.2: a master sends 0; what a drive makes of a 1 is not told"),
    ("second_word", True, "variable length: of two value words the word in PWE2 is taken, PWE1 "
     "only where PWE2 is 0; False: always PWE1",
     "the MM420 reference manual lists both forms"),
    ("level_for_reading", False, "numbers above the access level are not read either, error 204",
     "the manuals speak of changing"),
    ("no_rights_error", 0, "what a write without change rights (P0927) gets: 0 the reply AK 8, "
     "else this error number, 7 or 11",
     "USS specification: AK 8; the PROFIBUS board and the V20: 11"),
    ("silent_refusals", False, "a telegram with a task that it does not carry out gets no reply "
     "at all; False: the reply AK 7 or 8",
     "USS specification C-4.2.1: a reply is due; slaves that keep silent were reported"),
    ("inactive_refused", False, "numbers that another one puts out of use (P0308 or P0309, as "
     "P0100 says) cannot be changed, error 101",
     "the error is listed, when it comes is not"),
    ("tightened_limits", True, "while it runs, P1080 stays below P1082, error 201",
     "the errors 200 and 201 are listed, when they come is not"),
    ("keeps_link", True, "a factory reset leaves the numbers alone that the family lists as kept, "
     "the link's own among them; False: these get their defaults too",
     "documented for the V20, general knowledge for the others"),
    ("silence_s", None, "{number: seconds} that P0340, P0970 and the like take, in which it says "
     "nothing; what is not named has the time of the family's table",
     "the lists speak of seconds up to a minute"),
    ("silent_at_once", False, "such a write gets no reply before the silence",
     "not told"),
    ("layout_at_once", False, "the reply to a write of P2012 or P2013 has the new layout already",
     "recordings suggest it, the manuals do not say"),
    ("clean_power_up", False, "at power-up OFF1 stands in the image: ready, FB31; False: 0000, "
     "inhibited, FBC1",
     "FBC1 was recorded once; the state of others is not told"),
    ("boot_ms", 300, "milliseconds in which it says nothing after power-up",
     "not told; short here, because a master that takes a silent drive for lost sees longer ones"),
    ("buffered_ms", 0, "milliseconds without mains that its DC link carries it over",
     "the MM4 instructions (automatic restart) tell no times; 0 is the hardest for a master"),
    ("dark_ms", 0, "milliseconds that its electronics live after that, with F0003 where the motor "
     "ran; mains that come back then were a brownout, later ones a blackout",
     "the MM4 instructions (automatic restart) go by a display that is dark, and tell no times"),
    ("bus_restart", True, "an ON of this bus that stands is one for P1210; False: terminals alone",
     "the MM4 parameter lists ask for a digital input, what the bus does is not told"),
    ("bare_standby", False, "in standby bits 11 to 15 of ZSW are 0 and bit 10 is 1: 0731",
     "seen on one MM440; most recordings say FB31"),
    ("broadcast_bit_10", False, "a broadcast counts only with STW bit 10 in the telegram itself; "
     "False: in what it makes of the control word",
     "not told for one whose enable array leaves that bit out"),
    ("broadcast_without_flag", False, "an enable array of zeros takes over all process data",
     "USS specification A-3 has no such broadcast"),
    ("broadcast_retriggers", True, "a broadcast starts the telegram failure time anew",
     "USS specification C-3.1 speaks of telegrams for this drive"),
    ("strict_gaps", False, "a gap of two characters inside a telegram ends it, counted as "
     "residual time; False: only the residual time is watched",
     "USS specification A-6.3 asks a receiver for no more"),
    ("counts_all", False, "telegrams for others are counted as well; False: its own, and what "
     "went wrong before an address was seen",
     "USS specification A-5.2.3 does not say"),
    ("overload_trips", True, "a second at the current limit trips, and a motor that got too hot",
     "the reaction is a parameter of some families"),
    ("overvoltage_trips", False, "a ramp down that feeds back too much trips; False: the DC link "
     "is held somehow",
     "Vdc-max controllers stretch the ramp, which this one does not"),
)  # fmt: skip


# The values that a switch can be set to by name: a yes-or-no switch 0 and 1, these switches the
# values here, all others numbers up to SWITCH_MAX.
SWITCH_VALUES = {"no_rights_error": (0, 7, 11)}
SWITCH_MAX = 0xFFFF


def switch_value(name, word):
    """The value that a word means for a switch. ValueError: there is no such switch, or no such
    value.
    """
    usual = {row[0]: row[1] for row in SWITCHES}.get(name)
    if usual is None:
        raise ValueError("there is no such switch; --switch help of tools/drive lists them")
    number = int(word) if word.isdigit() else None
    if isinstance(usual, bool):
        number = {"true": 1, "false": 0, "on": 1, "off": 0}.get(word.lower(), number)
        allowed, named = (0, 1), "0 or 1"
    elif name in SWITCH_VALUES:
        allowed = SWITCH_VALUES[name]
        named = "one of %s" % ", ".join([str(value) for value in allowed])
    else:
        allowed, named = range(SWITCH_MAX + 1), "0...%d" % SWITCH_MAX
    if number not in allowed:
        raise ValueError("it can be %s" % named)
    return type(usual)(number)


class Switches:
    """One attribute for each row. ValueError: `values` has a name that there is not."""

    def __init__(self, values=None):
        for name, default, _, _ in SWITCHES:
            setattr(self, name, default)
        for name in values or ():
            self.set(name, values[name])

    def set(self, name, value):
        """ValueError: there is no such switch."""
        if name not in [row[0] for row in SWITCHES]:
            raise ValueError("a drive has no switch %s" % name)
        setattr(self, name, value)
