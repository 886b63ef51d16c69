# SPDX-License-Identifier: MIT
"""Status codes 0...22, numbered as in the S7-200's USS library; the S7-1200's words beside them.

For programs that were written for these libraries. This turns the engine's findings, the ends of
jobs and refused arguments into codes. It decides nothing; `s7` uses it.

    text(NO_ANSWER)                         # "the drive did not respond"
    word(NO_ANSWER)                         # 818Bh
    of_reply(drive.counters, before)        # what went wrong since then
    of_job(job, pkw.WORD, NO_ERROR)         # WIDTH_DOUBLE: a double word came

Sources: S7-200 system manual, USS library, error codes; S7-1200 system manual, USS STATUS.
"""

from micropython import const

from uss import pkw

# In the order of their numbers, as in the table below.
(
    NO_ERROR,  # 0
    NO_ANSWER,
    CHECKSUM,
    PARITY,
    INTERFERENCE,
    ILLEGAL_COMMAND,  # 5
    ILLEGAL_ADDRESS,
    PORT_NOT_USS,
    PORT_BUSY,
    SPEED_RANGE,
    REPLY_LENGTH,  # 10
    FIRST_CHARACTER,
    LENGTH_CHARACTER,
    WRONG_DRIVE,
    BUFFER_ADDRESS,
    PARAMETER_NUMBER,  # 15
    PROTOCOL,
    CHANGE_NOT_ALLOWED,
    BAUD_RATE,
    NOT_ACTIVE,
    PARAMETER_REPLY,  # 20
    WIDTH_DOUBLE,
    WIDTH_WORD,
) = range(23)

# By code number: the S7-200's text, and the S7-1200's word for the same cause, or None if that
# library has none.
CODES = (
    ("no error", 0x0000),
    ("the drive did not respond", 0x818B),
    ("checksum error in the reply", 0x8184),
    ("parity error in the reply", None),
    ("interference by the user's program", None),
    ("illegal command", None),
    ("illegal drive address", 0x8185),
    ("the port is not set up for USS", 0x818E),
    ("the port is busy with another instruction", 0x818A),
    ("speed setpoint out of range", 0x8186),
    ("length of the reply is wrong", 0x8180),
    ("first character of the reply is wrong", None),
    ("length character of the reply is wrong", 0x8180),
    ("another drive answered", 0x8187),
    ("DB_PTR is wrong", None),
    ("parameter number is wrong", None),
    ("invalid protocol", None),
    ("USS is active: change not allowed", None),
    ("illegal baud rate", 0x8189),
    ("no communication: the drive is not active", 0x818E),
    ("parameter or value in the reply is wrong, or an error number", 0x818C),
    ("double word returned instead of word", 0x8182),
    ("word returned instead of double word", 0x8183),
)

# The S7-1200's words that say more than the code beside them.
WRONG_VALUE_TYPE = const(0x8181)  # ILLEGAL_COMMAND: VALUE does not fit the width
ACCESS_REFUSED = const(0x818D)  # PARAMETER_REPLY: reply 8, no rights to change it

# All words of the S7-1200's USS library. No block gives 8188h: the layout of a drive is part of
# its family, and `Layout` refuses a wrong one with a ValueError.
WORDS = {
    0x0000: "no error",
    0x8180: "length of the reply does not fit the characters received",
    0x8181: "VALUE is none of Word, DWord, Real",
    0x8182: "DWord or Real received instead of Word",
    0x8183: "Word received instead of DWord or Real",
    0x8184: "checksum error in the reply",
    0x8185: "illegal drive address",
    0x8186: "speed setpoint out of range",
    0x8187: "another drive answered",
    0x8188: "illegal number of process data words",
    0x8189: "illegal baud rate",
    0x818A: "the parameter channel is in use",
    0x818B: "the drive did not respond",
    0x818C: "the drive answered with an error number",
    0x818D: "the drive refused access",
    0x818E: "the drive is not initialised",
}

# For each of `drive.COUNTERS`, in their order: the code of the replies that it counts. CHECKSUM
# stands for a parity error too, because a UART may hand such characters over unmarked.
COUNTER_CODES = (
    NO_ERROR,
    FIRST_CHARACTER,
    LENGTH_CHARACTER,
    CHECKSUM,
    WRONG_DRIVE,
    NO_ANSWER,
    REPLY_LENGTH,  # residual run time: the reply ended before its length
)


def text(code):
    """Words for a code 0...22. IndexError beyond."""
    return CODES[code][0]


def word(code):
    """The S7-1200's STATUS word for a code; None where it has none. IndexError beyond 22."""
    return CODES[code][1]


def of_reply(counters, before):
    """The code of what was counted since `before`, a copy of a drive's `counters`.

    NO_ERROR if that was nothing, or only valid replies. Of several codes, the one that says most:
    a drive may also have been silent for the same reason.
    """
    code = NO_ERROR
    for index in range(1, len(COUNTER_CODES)):
        if counters[index] != before[index] and code in (NO_ERROR, NO_ANSWER):
            code = COUNTER_CODES[index]
    return code


def of_job(job, width, reply_code):
    """The code of a parameter job that ended.

    width: pkw.WORD or pkw.DOUBLE, what was expected. reply_code: the code of the drive's last
    reply; it decides for a job that timed out, whether the drive was silent or answered something
    else. A job on which alone the drive is silent is NO_ANSWER.
    """
    if job.state == pkw.TIMED_OUT:
        return reply_code or PARAMETER_REPLY
    if job.state == pkw.UNANSWERED:
        return NO_ANSWER
    if job.state != pkw.DONE:
        return PARAMETER_REPLY
    if job.width == width:
        return NO_ERROR
    return WIDTH_DOUBLE if width == pkw.WORD else WIDTH_WORD


def word_of_job(job, code):
    """The S7-1200's word beside the `code` of a job that ended."""
    if job.state == pkw.REFUSED and job.error == pkw.NO_CHANGE_RIGHTS:
        return ACCESS_REFUSED
    return word(code)
