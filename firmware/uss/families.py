# SPDX-License-Identifier: MIT
"""The drive families, as data: what a program must know of a drive to talk to it and to run it.

A family is a class that only holds values and is never instantiated; what it does not say itself
it has from the family it is like. `GENERIC`, the specification alone, says what each value means.
A drive that differs is one more class: `class Pump(MM440): layout = Layout(4, 4)`. Each row that
the protocol notes hold unverified is marked (?). The panel needs `profiles` alone and never
imports this file.

    bus.add(3, MM440)
    MM440.baud_codes[7]                # 19200
    baud_code(MM440, 19200)            # 7, for P2010

How the families differ from the MICROMASTER 4, in short (USS.md 1.3, 1.9, 4.2, 4.5, 4.7):

    MM3     3 + 2 words, no IND, numbers below 1000; ON is 0C7Fh right, 147Fh left, and HIW has no
            sign; P091...P095, telegram-off time in seconds
    G110    parameters without index, 127 PKW words as delivered, no P2009
    V20     USS is chosen by P2023 = 1 and a power cycle; baud codes from 9600 on; trips with F72
    CU240S  the first G120: as an MM440
    G120    ready xx31h, runs xx37h; reference p2000 in rpm; link p2020...p2040; jog bits reserved;
            no broadcast; trips with F01910, and with F07220 when bit 10 drops while it runs
"""

from micropython import const

from uss import bits, profiles, pzd
from uss.layout import VARIABLE, Layout
from uss.profiles import CUTS_OFF, RESCALES, WORD
from uss.timing import BAUD_RATES

# How a value that is surveyed is to be read, besides profiles.WORD and CENTIHERTZ.
RPM = const(2)  # a floating-point speed in 1/min
STEPS = const(3)  # a frequency in 0.1 Hz, or in 0.01 Hz when the row ABSOLUTE is not 0

# The MICROMASTER 4's, of drives without P2009.
_SURVEY_WITHOUT_ABSOLUTE = (
    profiles.SURVEY[: profiles.ABSOLUTE] + (None,) + profiles.SURVEY[profiles.ABSOLUTE + 1 :]
)


def _baud_codes(first, last):
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

    # Numbers of the link's parameters, and the index among the links where its RS-485 stands.
    link_index = 0
    baud_number = None
    address_number = None
    pzd_words_number = None
    pkw_words_number = None
    off_time_number = None  # telegram-off time: without a telegram for so long the drive trips
    off_time_unit_ms = 1
    off_time_fault = None  # the number of that fault
    fault_number = None  # holds the number of the present fault
    fault_format = "F%d"  # how the family's manuals print it
    motor = None  # numbers of the motor's rated frequency and rated speed

    # To be set at the drive first: (number, value).
    access = None  # so that every parameter can be written
    protocol = None  # so that the terminals talk USS
    save = None  # copies RAM to EEPROM

    # What must be known before a start, in the order of profiles.COMMAND_SOURCE...SUPERVISION:
    # (number, index, kind), or None where the family has no such parameter.
    survey = (None,) * len(profiles.SURVEY)
    command_value = None  # of COMMAND_SOURCE and of SETPOINT_SOURCE when USS has the drive
    setpoint_value = None
    absolute_value = None  # of ABSOLUTE when PZD2 is in 0.01 Hz instead of 4000h parts

    # Control words; OFF1, OFF2 and OFF3 are pzd.OFF1, OFF2 and OFF3 everywhere.
    on = pzd.ON
    on_reverse = 0  # 0: there is none, a negative setpoint reverses
    jog_right = 0  # 0: there is none
    jog_left = 0
    hsw_is_signed = True  # a negative setpoint turns left
    hiw_is_signed = True  # else HIW is the magnitude, and bit 14 of ZSW the direction
    is_cumulative = True  # bits 0, 1 and 2 of ZSW add up to xx7h; else the last stands alone

    # What the bits of the words are called.
    stw_bits = bits.STW_BITS_PROFILE
    zsw_bits = bits.ZSW_BITS_PROFILE
    stw2_bits = ()
    zsw2_bits = ()

    # 32-bit parameters that are integers, in a family whose others are floating point. None: not
    # known of any.
    integer_doubles = None

    # Parameters that a program should not write unasked, as profiles.ASK_FIRST, and those that are
    # useless when they are lost with the power, as profiles.PERMANENT.
    ask_first = {}
    permanent = ()


class MM3(GENERIC):
    """MICROMASTER 3: MICROMASTER, MICROMASTER Vector, MIDIMASTER Vector. (?) all but the layout,
    0C7Fh and that IND is 0."""

    name = "MICROMASTER 3"
    layout = Layout(3, 2)
    pkw_choices = (3,)
    pzd_choices = range(2, 3)
    has_indices = False
    has_eeprom_tasks = False
    first_index = 0
    has_array_tasks = False
    baud_codes = _baud_codes(3, 7)
    baud = 9600
    baud_number = 92
    address_number = 91
    off_time_number = 93
    off_time_unit_ms = 1000
    off_time_fault = 8
    fault_number = 930
    fault_format = "F%03d"
    motor = (81, 82)
    access = (9, 3)
    save = (971, 1)
    survey = (
        (910, 0, WORD),  # 1: ON and setpoint both come from USS
        None,
        (94, 0, STEPS),
        (95, 0, WORD),
        (12, 0, STEPS),
        (13, 0, STEPS),
        (93, 0, WORD),
    )
    command_value = 1
    absolute_value = 2
    on = 0x0C7F  # bit 11 is "run right"
    on_reverse = 0x147F  # bit 12 is "run left"
    jog_right = pzd.JOG_RIGHT
    jog_left = pzd.JOG_LEFT
    hsw_is_signed = False
    hiw_is_signed = False
    is_cumulative = False
    stw_bits = bits.STW_BITS_MM3
    zsw_bits = bits.ZSW_BITS_MM3
    integer_doubles = ()
    ask_first = {
        9: CUTS_OFF,  # access level
        91: CUTS_OFF,
        92: CUTS_OFF,
        93: CUTS_OFF,
        94: RESCALES,
        95: RESCALES,
        910: CUTS_OFF,  # remote mode
        944: CUTS_OFF,  # factory reset
    }
    permanent = (91, 92)


class MM420(GENERIC):
    """MICROMASTER 420, on its RS-485 terminals, the COM link."""

    name = "MICROMASTER 420"
    pzd_choices = range(0, 5)  # (?)
    takes_broadcast = True  # (?) the manuals ask for the specification's PKW area, nobody saw one
    first_index = 0
    has_array_tasks = False  # it has them, and takes an index with the others (MM420 manual)
    baud_codes = _baud_codes(3, 9)  # (?) the ends of the range
    baud = 9600
    link_index = profiles.COM_LINK
    baud_number = 2010
    address_number = profiles.USS_ADDRESS
    pzd_words_number = 2012
    pkw_words_number = 2013
    off_time_number = profiles.TELEGRAM_OFF_TIME
    off_time_fault = 72  # (?) older lists say 70
    fault_number = profiles.FAULT_NUMBER
    fault_format = "F%04d"
    motor = (310, 311)
    access = (3, 3)
    save = (971, 1)
    survey = profiles.SURVEY
    command_value = profiles.USS_ON_COM_LINK
    setpoint_value = profiles.USS_ON_COM_LINK
    absolute_value = 1
    on_reverse = pzd.ON_REVERSE
    jog_right = pzd.JOG_RIGHT
    jog_left = pzd.JOG_LEFT
    is_cumulative = False  # captured of MM4 and G110; (?) of a V20
    stw_bits = bits.STW_BITS
    zsw_bits = bits.ZSW_BITS
    stw2_bits = bits.STW2_BITS
    zsw2_bits = bits.ZSW2_BITS
    integer_doubles = (  # (?) rated voltage and fault value; the others are connectors
        208, 731, 732, 733, 771, 810, 840, 949, 1070, 1110, 2016, 2019, 2051, 2103, 2106, 2200,
        2253, 2264,
    )  # fmt: skip
    ask_first = profiles.ASK_FIRST
    permanent = profiles.PERMANENT


class MM410(MM420):
    """MICROMASTER 410."""

    name = "MICROMASTER 410"
    baud_codes = _baud_codes(3, 7)  # (?)


class MM440(MM420):
    """MICROMASTER 440."""

    name = "MICROMASTER 440"
    pzd_choices = range(0, 9)
    baud_codes = _baud_codes(4, 12)


class MM430(MM440):
    """MICROMASTER 430, for pumps and fans."""

    name = "MICROMASTER 430"


class G110(MM420):
    """SINAMICS G110, the variant with USS instead of the analogue input."""

    name = "SINAMICS G110"
    layout = Layout(VARIABLE, 2)
    has_indices = False
    survey = _SURVEY_WITHOUT_ABSOLUTE  # (?) that it has none
    absolute_value = None


class V20(MM440):
    """SINAMICS V20, as its connection macro Cn010 sets it up for USS."""

    name = "SINAMICS V20"
    layout = Layout(VARIABLE, 2)
    has_array_tasks = True
    baud_codes = _baud_codes(6, 12)
    baud = 38400
    fault_format = "F%d"
    protocol = (2023, 1)  # 2 is Modbus; acts after a power cycle
    survey = _SURVEY_WITHOUT_ABSOLUTE  # (?) that it has none
    absolute_value = None
    ask_first = dict(profiles.ASK_FIRST)
    ask_first[717] = CUTS_OFF  # (?) connection macro: rewrites the sources and the link
    permanent = profiles.PERMANENT + (2023,)


class CU240S(MM440):
    """SINAMICS G120 of the first generation, with a Control Unit CU240S. (?) what the MM440 says
    besides the link, the scaling and the arrays."""

    name = "SINAMICS G120 CU240S"
    has_array_tasks = True


class G120(GENERIC):
    """SINAMICS G120 of the second generation (CU230-2, CU240-2, CU250-2), G120C, G120X."""

    name = "SINAMICS G120"
    layout = Layout(VARIABLE, 2)
    pzd_choices = range(0, 9)  # (?)
    first_index = 0
    baud_codes = _baud_codes(4, 13)
    baud = 38400  # (?)
    baud_number = 2020
    address_number = 2021
    pzd_words_number = 2022
    pkw_words_number = 2023
    off_time_number = 2040
    off_time_fault = 1910
    fault_number = 947  # (?)
    fault_format = "F%05d"
    motor = (310, 311)
    protocol = (2030, 1)
    save = (971, 1)
    survey = (
        None,  # the macro p0015 = 21 connects ON and setpoint to the link
        None,
        (2000, 0, RPM),
        None,
        (1080, 0, RPM),
        (1082, 0, RPM),
        (2040, 0, WORD),  # (?) the type
    )
    on_reverse = pzd.ON_REVERSE
    stw_bits = bits.STW_BITS_G120
    zsw_bits = bits.ZSW_BITS_G120
    integer_doubles = MM420.integer_doubles  # (?)
    ask_first = {  # (?) the selection
        10: CUTS_OFF,  # commissioning: the motor does not run
        15: CUTS_OFF,  # macro
        840: CUTS_OFF,  # source of ON
        970: CUTS_OFF,  # factory reset
        1070: CUTS_OFF,  # source of the setpoint
        2000: RESCALES,
        2020: CUTS_OFF,
        2021: CUTS_OFF,
        2022: CUTS_OFF,
        2023: CUTS_OFF,
        2030: CUTS_OFF,
        2040: CUTS_OFF,
        2051: RESCALES,  # what the drive sends
    }
    permanent = (2020, 2021, 2022, 2023, 2030)


MM4 = MM420  # of an MM4 that is not known closer: what each of them can
FAMILIES = (GENERIC, MM3, MM410, MM420, MM430, MM440, G110, V20, CU240S, G120)


def baud_code(family, baud):
    """The code of a baud rate for the family's parameter. ValueError when it has none."""
    for code, rate in family.baud_codes.items():
        if rate == baud:
            return code
    raise ValueError("%s has no code for %r baud" % (family.name, baud))


def can_be_set_to(family, layout):
    """Whether drives of the family can have telegrams of this `Layout`."""
    return layout.pkw_words in family.pkw_choices and layout.pzd_words in family.pzd_choices


def value(job, kind, is_fine=False):
    """What a job that is done read for a row of `survey`: an integer, or a float in Hz or 1/min.

    kind: of the row. is_fine: whether the row ABSOLUTE is not 0, which matters to STEPS alone.
    """
    if kind == STEPS:
        return job.integer_value() / (100 if is_fine else 10)
    if kind == WORD:
        return job.integer_value()
    return job.float_value()


def is_float(family, number):
    """Whether a 32-bit value of this parameter is floating point, as far as anybody knows."""
    return family.integer_doubles is not None and number not in family.integer_doubles
