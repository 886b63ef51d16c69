# SPDX-License-Identifier: MIT
"""The facts for the judge: words of the specification, the panel's promises as times.

Written from the documents, not from the firmware, so that a mistake does not stand in both.
"""

MS = 1000
S = 1_000_000

# Control words (specification C-5.2.1) of a panel that never gives control away. Those that turn a
# motor are of a MICROMASTER 4; other families have others, see `families`.
OFF1, OFF2, OFF3 = 0x047E, 0x047C, 0x047A
ON, ON_REVERSE, JOG_RIGHT, JOG_LEFT = 0x047F, 0x0C7F, 0x057E, 0x067E
ACKNOWLEDGE = 0x0080
CONTROLS = 0x0400  # bit 10: a drive obeys a word only with it
ON_BIT, JOG_BITS, JOG_RIGHT_BIT = 0x0001, 0x0300, 0x0100
RUN = ON_BIT | JOG_BITS  # each of them turns the motor
OFFS = (OFF1, OFF2, OFF3)
SECOND_STOPS = {"OFF3": OFF3, "OFF2": OFF2, "none": OFF1}

ZSW_RUNNING, ZSW_FAULT, ZSW_INHIBIT, ZSW_WARNING = 0x0004, 0x0008, 0x0040, 0x0080

# Task ids (specification C-4.2.1, table 4.1).
READS = (0, 1, 4, 6, 9)
RAM_WRITES = (2, 3, 7, 8)
EEPROM_WRITES = (11, 12, 13, 14)
DOUBLES = (3, 8, 11, 13)  # of those, such that write a double word

# Row 2 of a question: to which SET says yes; START may; about a risk that nothing takes away.
WRITES, RUNS_ON, RISKS = "SET=DO  PARAM=NO", "SET=FIX START=GO", "START=GO STOP=NO"
QUESTIONS = (WRITES, RUNS_ON)
GOES = (RUNS_ON, RISKS)
CHOICES = (WRITES, RUNS_ON, RISKS)
MENU = ">"  # row 2 of every list of the menu begins so
TYPED = "NEW"  # row 2 begins so while the setpoint is set digit by digit, or a parameter
LEAVES = ("LEAVE THE LINE &", "FIND DRIVES?")  # row 1 of WRITES, before the search
NO_PARAMETERS = "NO PARAMETERS"  # parameter mode, of a drive that can tell none
NOT_USS = "NOT USS"  # a START is refused: what the drive obeys is another one
OFFERED = (700, 719, 1000)  # one of these is then offered, into the EEPROM
UNTOLD = ("IT MAY RUN ON", "IF PANEL DIES")  # row 1 of RISKS, where no P2014 can be read

# How long the panel may take: a key settles in 20 ms and bounces for up to 5; five steps of the
# loop, two of them of its own and those of a drawing that is under way.
SETTLED_US = 25 * MS
STEPS = 5
DRAWN_STEPS = 25  # a row that is the same for so long is drawn to its end
SEEN_US = 300 * MS  # and a page that has come or gone is to be seen by then
CHOSEN_US = 500 * MS  # what SET chooses has been on the display by then
SHORT_CHORD_US = 120 * MS  # within this it is not known which of two keys came first
DEAD_MAN_US = 300 * MS
SECOND_STOP_US = 1_500 * MS
ALL_STOP_US = 4_000 * MS
START_S, START_ROUNDS = 12, 10  # a START is given up by then
HELD_SET_US = 1_400 * MS
HELD_OPENS_US = 900 * MS  # PARAM opens the menu, an address key ANY ADDRESS
WISH_US = 40 * S  # a write that SET has asked for is over by then, and 20 rounds of the line
# Settings of a drive that runs are read so often: what setpoint and actual frequency mean, and its
# limits, while it is shown and while not; in so many readings, and replies to each of those.
MEANT_US, MEANT_READS = 10 * S, 36
LIMITED_SHOWN_US, LIMITED_US, LIMITED_READS = 2_500 * MS, 10 * S, 8
READ_REPLIES = 2  # of a drive whose replies do not lag
# A drive is sent a telegram in another layout, to be sent back, when it has no contact and has not
# answered so many; so many, if it may run, and these last ones said STOP. At the least the list
# asks silent drives half the time.
SILENT_MIN, STOPPED_MIN, TOLD_MIN = 3, 30, 10
DOUBTED_US = 30 * S  # answers that a bad line has spoilt make a drive look like another, so long
SHARED = 2
# Of the loop, for each that runs and is not shown, where that takes longer: until its limits have
# been read, and all its settings.
LOOKED_STEPS, MEANT_STEPS = 200, 900
LONG_US = 2 * S  # a P2014 that is longer, or 4 rounds, is a risk
HUNG_MAX_US = 5 * S
LEFT_US = 30 * S  # when SET has said so, the panel has left the line by then, and 20 rounds
LOOKED_FOR_US = 2 * S  # what the menu asks an address is sent by then, and 4 rounds
BABBLED_US = 4 * S  # and so much later where the line was not free meanwhile
LOST_SAID_US = 700 * MS  # until the display says that a drive is lost
STUCK_US = 5_000 * MS  # a bus that stands for so long makes the watchdog bite
WATCHDOG_US = 2_000 * MS

NEVER = -1_000_000_000_000  # an instant long ago
ALWAYS = 1 << 60


def debounce_us(plan):
    """The time from when a key moves until that must have had its effect."""
    return SETTLED_US + STEPS * plan.loop_us


def lost_us(plan):
    return plan.settings.get("lost_ms", 1000) * MS


def start_us(plan, turns=None):
    """By then a START has led to ON, or never will: a step and a round of the list later. turns:
    telegrams of a round, if some drives stand in it several times."""
    round_us = exchange_us(plan) * (turns or len(plan.listed))
    return max(START_S * S, START_ROUNDS * round_us) + S + 2 * round_us


def exchange_us(plan):
    """The longest exchange on this line: the reply comes, and ends, at the last moment. Its
    telegrams have 4 PKW words and the PZD words of the plan."""
    character_us = -(-11_000_000 // plan.baud)
    timeout_us = max(plan.settings.get("reply_timeout_ms", 20) * MS, 4 * character_us)
    size = 2 * (4 + plan.pzd_words) + 4
    return (2 + size) * character_us + timeout_us + (size + 9) * character_us
