# SPDX-License-Identifier: MIT
"""ErrorID 100...600 of the B&R project, with its meanings.

    text(101)                               # "reference frequency is not 1...650 Hz"
    of_reply(drive.counters, before)        # what went wrong with telegrams since then

Source: D. Matocha, Implementation of Siemens USS communication protocol with BR-Automation PLC
controller (bachelor thesis, Liberec 2019), annex C. Where the source has several codes with one
meaning, it does not say which step gives which; the first of them is used here. README.md says
which codes nothing gives here, and why.
"""

from micropython import const

NO_ERROR = const(0)

CONTROL_WORD = const(100)
REFERENCE = const(101)
FREQUENCY = const(102)
PERCENT = const(103)
STX_SENT = const(200)
PKW_LENGTH = const(201)
PZD_LENGTH = const(202)
LGE_SENT = const(203)
ADDRESS = const(204)
PKW_WORD = const(206)
PZD_WORD = const(209)
TOO_LONG = const(211)
STX_RECEIVED = const(300)
LGE_RECEIVED = const(301)
LGE_DIFFERS = const(302)
ADDRESS_RECEIVED = const(303)
PKW_LENGTH_RECEIVED = const(304)
PZD_LENGTH_RECEIVED = const(305)
BCC_RECEIVED = const(308)
ADDRESS_DIFFERS = const(310)
REFERENCE_RECEIVED = const(400)
PZD_RECEIVED = const(401)
READ_FAILED = const(507)
NO_MESSAGE = const(600)

_PKW_LENGTH = "PKW_lengh is not 0, 3, 4 or 127 words"
_PZD_LENGTH = "PZD_lengh is not 0...16 words"
_PKW_WORD = "a PKW word is not 0000h...FFFFh"
_PZD_WORD = "a PZD word is not 0000h...FFFFh"
_REFERENCE = "reference frequency is not 1...650 Hz"
_BCC = "BCC is not 00h...FFh"
_BCC_DIFFERS = "the BCC that was computed is not the one received"
_DVFRAME = "of B&R's library DVFrame: see Automation Help"

# By the block that gives them there: codes, meanings.
BLOCKS = (
    ("TxCreatePZD", (
        (100, "ControlWord is not 0000h...FFFFh"),
        (101, _REFERENCE),
        (102, "wanted frequency is not -200...199.994 % of the reference frequency"),
        (103, "percent of the wanted frequency are not -200...199.994 %"),
    )),
    ("TxCompose", (
        (200, "STX is not 02h"),
        (201, _PKW_LENGTH),
        (202, _PZD_LENGTH),
        (203, "LGE is not 03h...FEh"),
        (204, "ADR is not 00h...1Fh"),
        (205, _PKW_LENGTH),
        (206, _PKW_WORD),
        (207, _PZD_LENGTH),
        (208, _PKW_LENGTH),
        (209, _PZD_WORD),
        (210, _PZD_WORD),
        (211, "PZD_lengh is too long: more than 126 words"),
        (212, _PKW_WORD),
        (213, _PZD_WORD),
        (214, _BCC),
        (215, _BCC),
    )),
    ("TxSender, RxReceive, COMConnection", (
        (60, _DVFRAME),
        (8071, _DVFRAME),
        (8072, _DVFRAME),
        (8073, _DVFRAME),
        (8078, _DVFRAME),
        (8079, _DVFRAME),
        (8251, _DVFRAME),
        (8252, _DVFRAME),
        (8253, _DVFRAME),
        (8254, _DVFRAME),
        (8255, _DVFRAME),
        (8256, _DVFRAME),
        (8257, _DVFRAME),
        (8258, _DVFRAME),
        (600, "no message was received"),
    )),
    ("RxDecompose", (
        (300, "STX is not 02h"),
        (301, "LGE is not 03h...FEh"),
        (302, "LGE is not the same: sent and received length"),
        (303, "ADR is not 00h...1Fh"),
        (304, _PKW_LENGTH),
        (305, _PZD_LENGTH),
        (306, _PKW_LENGTH),
        (307, _PKW_LENGTH),
        (308, _BCC_DIFFERS),
        (309, _BCC_DIFFERS),
        (310, "ADR is not the same: sent and received"),
    )),
    ("RxCreatePZD", (
        (400, _REFERENCE),
        (401, "a PZD word is not 0000h...FFFFh"),
    )),
    ("DriveController", (
        (500, "TxCreatePZD shows no status"),
        (501, "TxCompose shows no status"),
        (502, "TxSender shows no status"),
        (503, "RxReceive shows no status"),
        (505, "RxDecompose shows no status"),
        (506, "RxCreatePZD shows no status"),
        (507, "FRM_read was not executed correctly"),
    )),
)  # fmt: skip

# For each of `drive.COUNTERS`, in their order: the code of the replies that it counts. A reply
# that ends before its length is no message: it is never handed to RxDecompose.
COUNTER_CODES = (
    NO_ERROR,
    STX_RECEIVED,
    LGE_DIFFERS,
    BCC_RECEIVED,
    ADDRESS_DIFFERS,
    NO_MESSAGE,
    NO_MESSAGE,
)


def text(code):
    """Words for a code of the source, "" for 0. KeyError beyond."""
    if code == NO_ERROR:
        return ""
    for _, rows in BLOCKS:
        for number, meaning in rows:
            if number == code:
                return meaning
    raise KeyError(code)


def of_reply(counters, before):
    """The code of what was counted since `before`, a copy of a drive's `counters`; NO_ERROR if
    that was nothing, or only valid replies. Of several, one of a reply goes before NO_MESSAGE."""
    code = NO_ERROR
    for index in range(1, len(COUNTER_CODES)):
        if counters[index] != before[index] and code in (NO_ERROR, NO_MESSAGE):
            code = COUNTER_CODES[index]
    return code
