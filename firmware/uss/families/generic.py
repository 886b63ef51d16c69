# SPDX-License-Identifier: MIT
"""The specification alone, and what each value of a family means."""

from uss import pzd
from uss.layout import VARIABLE, Layout
from uss.families.rows import COUNT_OF_ROWS
from uss.timing import BAUD_RATES

# Of a parameter that must not be written without asking: the bus may lose the drive by it, or a
# setpoint may mean something else afterwards.
CUTS_OFF, RESCALES = range(2)


def codes(first, last):
    """Code -> bits per second: a code is the rate's place in the list of the specification."""
    return {code: BAUD_RATES[code - 1] for code in range(first, last + 1)}


class GENERIC:
    """A drive of which nothing is known but that it keeps to the specification."""

    name = "USS drive"

    # Telegrams: the layout that is meant when none is told, and what the drive can be set to.
    layout = Layout(4, 2)
    pkw_choices = (0, 3, 4, VARIABLE)
    pzd_choices = range(0, 17)
    takes_broadcast = False  # an option of the drive (specification A-3)
    has_indices = True
    has_eeprom_tasks = True  # 11...14, which write RAM and EEPROM; else `save` does it
    first_index = 1  # of an array: the specification counts positions, the drives from 0
    # An index other than 0 goes with the tasks for arrays, 6...8, 11, 12 (C-4.2.2). False: the
    # family is known to take it with 1...3, 13 and 14, or has no arrays.
    has_array_tasks = True

    # The line: code of the parameter -> bits per second; as the drive is delivered.
    baud_codes = {}
    baud = 9600

    # Numbers of the link's parameters, and the index of the link in them: 0 is that of the RS-485
    # terminals. `bop` makes the family with the other link.
    has_bop_link = False
    link_index = 0
    linked = ()  # numbers that have this index, where it is not 0
    com = None  # the same family on its terminals, where this is not that one
    baud_number = None
    address_number = None
    pzd_words_number = None
    pkw_words_number = None
    off_time_number = None  # telegram-off time: without a telegram for so long the drive trips
    off_time_unit_ms = 1
    off_time_fault = None  # the number of that fault
    fault_number = None  # holds the number of the present fault
    warning_number = None  # of the present warning
    fault_format = "F%d"  # how the family's manuals print it
    motor = None  # numbers of the motor's rated frequency and rated speed

    # To be set at the drive first: (number, value).
    access = None  # so that every parameter can be written
    protocol = None  # so that the terminals talk USS
    save = None  # copies RAM to EEPROM

    # What a panel without a catalogue shows: (number, highest value that it writes; None: it only
    # reads this one).
    shown = ()

    # What must be known before a start, in the order of `rows`: (number, index, kind, value where
    # the drive has no such parameter; None: it must be), or None where the family has none.
    survey = (None,) * COUNT_OF_ROWS
    # What gives STW, HSW, ZSW and HIW their meaning. Every row of a subject must have one of the
    # values: (subject, row, place of the digit that counts, values, digit of SELECTION that must
    # be 0 or the rule is void; None: always).
    meaning = ()
    absolute_value = None  # of ABSOLUTE when PZD2 is in 0.01 Hz instead of 4000h parts

    # Control words; OFF1, OFF2 and OFF3 are pzd.OFF1, OFF2 and OFF3 everywhere.
    on = pzd.ON
    on_reverse = 0  # 0: there is none, a negative setpoint reverses
    jog_right = 0  # 0: there is none
    jog_left = 0
    hsw_is_signed = True  # a negative setpoint turns left
    hiw_is_signed = True  # else HIW is the magnitude, and bit 14 of ZSW the direction
    is_cumulative = True  # bits 0, 1 and 2 of ZSW add up to xx7h; else the last stands alone

    # What ZSW says, where that is not what the specification's says: (mask, value, what it means
    # if these bits have this value: ZSW_READY, ZSW_RUNNING, ZSW_FAULT, ZSW_INHIBIT, ZSW_WARNING,
    # ZSW_RUNS_RIGHT of `pzd`). A drive that says nothing of being ready: (0, 0, ZSW_READY).
    zsw_says = None
    # Bit 10 of STW may be 0 towards it while it stands: it takes parameters and no control.
    takes_no_control = True  # specification C-5.2.1: the process data are not valid then

    # What the bits of the words are called: tables of `bits`, each a name there or itself.
    stw_bits = "STW_BITS_PROFILE"
    zsw_bits = "ZSW_BITS_PROFILE"
    stw2_bits = ()
    zsw2_bits = ()

    # 32-bit parameters that are integers, in a family whose others are floating point: their
    # numbers, or the name of one of `integers.TABLES`. None: not known of any.
    integer_doubles = None

    # Parameters that must not be written without asking, each with CUTS_OFF or RESCALES; and those
    # that belong into the EEPROM as well, always: with its next power-up the drive would be where
    # nobody looks for it.
    ask_first = {}
    permanent = ()
