# SPDX-License-Identifier: MIT
"""A telegram, character by character, in words; and what is wrong with one that is none.

told = explained(bytes.fromhex("02 06 00 04 7F 20 00 5F"))
told.wrong                          # [] or what is wrong, in words
told.rows                           # [{"at": 0, "hex": "02", "field": "STX", "says": ...}]
told.summary                        # "A0 to the drive: ON, HSW 50.00 %"
"""

from uss import bits, pkw, pzd, telegram
from uss.bus.pkw_errors import error_text
from uss.layout import VARIABLE
from uss.telegram import BROADCAST, MIRROR, NODE_MAX, SPECIAL, STX

TO_DRIVE, FROM_DRIVE = "to the drive", "from the drive"
MIN_SIZE, NET = 5, 3
PKW_MIN = 3  # words, with variable length
TASKS = (
    "no task", "read", "write a word", "write a double word", "read the description",
    "write the description", "read an element", "write an element, a word",
    "write an element, a double word", "how many elements", "", "write an element, a double word, "
    "to EEPROM", "write an element, a word, to EEPROM", "write a double word to EEPROM",
    "write a word to EEPROM", "text",
)  # fmt: skip
REPLIES = (
    "no reply", "a word", "a double word", "the description", "an element, a word",
    "an element, a double word", "the number of elements", "refused", "no change rights",
    "change report, a word", "change report, a double word", "change report, an element",
    "change report, an element, a double word", "", "", "text",
)  # fmt: skip
WORD_TASKS, DOUBLE_TASKS = (2, 7, 12, 14), (3, 8, 11, 13)
WORD_REPLIES, DOUBLE_REPLIES = (1, 4, 6, 9, 11), (2, 5, 10, 12)
DESCRIPTION, REFUSED, TEXT = 3, 7, 15
PAGE_BITS = ((0x8000, 1), (0x1000, 2), (0x2000, 4), (0x4000, 8), (0x0400, 16), (0x0800, 32))
STW_WORDS = {
    pzd.ON: "ON", pzd.OFF1: "OFF1", pzd.OFF2: "OFF2", pzd.OFF3: "OFF3",
    pzd.ON_REVERSE: "ON, reversed", pzd.JOG_RIGHT: "JOG right", pzd.JOG_LEFT: "JOG left",
}  # fmt: skip
STATES = ("not ready", "ready", "running", "fault", "inhibited")
CONTROL, REQUESTED = 0x0400, 0x0200  # STW bit 10; ZSW bit 9
GUESSES = ((4, 2), (3, 2), (0, 2), (VARIABLE, 2), (4, 4), (VARIABLE, 4), (4, 0), (3, 0))


class Explained:
    """rows: dictionaries of at, hex, field, says. wrong: reasons. summary: a line."""

    def __init__(self):
        self.rows = []
        self.wrong = []
        self.summary = ""

    def add(self, at, characters, field, says=""):
        shown = " ".join("%02X" % one for one in characters)
        self.rows.append({"at": at, "hex": shown, "field": field, "says": says})


def explained(characters, layout=None, direction=None, family=None):
    """layout: (PKW words, PZD words) or None: guessed. direction: TO_DRIVE, FROM_DRIVE or None."""
    told = Explained()
    told.wrong = wrongs(characters)
    if not characters:
        return told
    _head(told, characters)
    end = min(len(characters), characters[1] + 1) if len(characters) > 1 else len(characters)
    if told.wrong and len(characters) < (characters[1:2] or b"\0")[0] + 2:
        end = len(characters)  # cut off: the last character is none of BCC
    net = characters[NET:end]
    if len(characters) > NET:
        _net(told, characters[2], net, layout, direction, family)
    if end < len(characters):
        _check(told, characters, end)
    if told.wrong:
        told.summary = "no telegram: " + "; ".join(told.wrong)
    return told


def wrongs(characters):
    """Everything that is wrong with what claims to be a telegram, in words."""
    count = len(characters)
    found = []
    if not count:
        return ["nothing"]
    if characters[0] != STX:
        found.append("begins with %02X, not with STX (02)" % characters[0])
    if count < 2:
        return found + ["ends behind the first character"]
    length = characters[1]
    if length < 3 or length > 254:
        found.append("LGE %d is not within 3...254" % length)
    if length & 1:
        found.append("LGE %d is odd: the net characters are no whole words" % length)
    if count != length + 2:
        missing = length + 2 - count
        what = "%d missing" % missing if missing > 0 else "%d too many" % -missing
        found.append(
            "LGE %d means %d characters, here are %d: %s" % (length, length + 2, count, what)
        )
    elif count >= MIN_SIZE and telegram.bcc(characters, count):
        right = telegram.bcc(characters, count - 1)
        text = "BCC is %02X, should be %02X" % (characters[-1], right)
        if characters[-1] == right ^ STX:
            text += " (it was made without STX)"
        found.append(text)
    if count > 2 and characters[2] & (BROADCAST | MIRROR) == BROADCAST | MIRROR:
        found.append("ADR %02X: mirror and broadcast at once is not defined" % characters[2])
    if count > 2 and characters[2] & (SPECIAL | MIRROR) == SPECIAL | MIRROR:
        found.append("ADR %02X: special and mirror at once is not defined" % characters[2])
    return found


def _head(told, characters):
    told.add(0, characters[:1], "STX", "start of text" if characters[0] == STX else "not STX")
    if len(characters) > 1:
        length = characters[1]
        told.add(
            1, characters[1:2], "LGE", "%d characters follow, %d altogether" % (length, length + 2)
        )
    if len(characters) > 2:
        adr = characters[2]
        kinds = [name for bit, name in (
            (BROADCAST, "broadcast: to all"), (MIRROR, "mirror: to be sent back"),
            (SPECIAL, "special: not of the drive profile"),
        ) if adr & bit]  # fmt: skip
        node = [] if adr & BROADCAST else ["node %d" % (adr & NODE_MAX)]
        told.add(2, characters[2:3], "ADR", ", ".join(node + kinds))


def _check(told, characters, at):
    right = telegram.bcc(characters, at)
    says = "right" if characters[at] == right else "should be %02X" % right
    told.add(at, characters[at : at + 1], "BCC", says)
    if at + 1 < len(characters):
        told.add(at + 1, characters[at + 1 :], "", "behind the telegram")


def _net(told, adr, net, layout, direction, family):
    words = [net[i] << 8 | net[i + 1] for i in range(0, len(net) - 1, 2)]
    if adr & SPECIAL:
        told.add(NET, net, "net", "of a kind of its own")
        told.summary = "special telegram, %d net characters" % len(net)
        return
    count, direction = _divided(words, layout, direction)
    if adr & MIRROR:
        told.add(NET, net, "net", "comes back as it is, and nobody acts on it")
        told.summary = "mirror telegram for A%d" % (adr & NODE_MAX)
        return
    if adr & BROADCAST:
        _enable(told, words[:count])
        direction, parts = TO_DRIVE, ["to all drives"]
    else:
        parts = ["A%d %s" % (adr & NODE_MAX, direction)]
        if count:
            parts.append(_parameter(told, words[:count], direction))
    parts.append(_process(told, NET + 2 * count, words[count:], direction, family))
    if len(net) & 1:
        told.add(NET + len(net) - 1, net[-1:], "net", "half a word")
    told.summary = ": ".join(parts[:1] + [", ".join(part for part in parts[1:] if part)])


def _divided(words, layout, direction):
    """How many of the words are PKW, and which way they go, told or guessed."""
    if layout is not None:
        pkw_words, pzd_words = layout
        count = len(words) - pzd_words if pkw_words == VARIABLE else min(pkw_words, len(words))
        count = max(count, 0)
    else:
        count = max(_candidates(len(words)), key=lambda one: _likeliness(words, one))
    if direction is None:
        process = words[count:]
        direction = FROM_DRIVE if process and _is_zsw(process[0]) else TO_DRIVE
    return count, direction


def _candidates(count):
    """Possible numbers of PKW words, the most usual first."""
    found = []
    for pkw_words, pzd_words in GUESSES:
        left = count - pzd_words
        if left == pkw_words or pkw_words == VARIABLE and left >= PKW_MIN:
            found.append(left)
    return found or [min(4, count)]


def _likeliness(words, count):
    process = words[count:]
    good = 0
    if process:
        good += 2 * (_is_stw(process[0]) or _is_zsw(process[0]))
    if count:
        ak, rest = words[0] >> 12, words[1:count]
        good += ak == 0 and not any(rest) or ak != 0
    return good


def _is_stw(word):
    return word & (CONTROL | REQUESTED) == CONTROL and word & 0x0078 == 0x0078


def _is_zsw(word):
    return word & REQUESTED != 0 and word & CONTROL == 0


def parameter_number(pke, ind):
    """The number, or None if PNU is beyond its page."""
    page = sum(value for bit, value in PAGE_BITS if ind & bit)
    pnu = pke & 0x07FF
    return page * pkw.PNU_PER_PAGE + pnu if pnu < pkw.PNU_PER_PAGE else None


def _parameter(told, words, direction):
    """Rows for the PKW words; what they say in short."""
    names = TASKS if direction == TO_DRIVE else REPLIES
    ak, pke = words[0] >> 12, words[0]
    ind = words[1] if len(words) > 1 else 0
    number = parameter_number(pke, ind)
    name = names[ak] or "AK %d is not defined" % ak
    toggle = ", bit 11 set: change report" if pke & 0x0800 else ""
    told.add(
        NET, words_bytes(words[:1]), "PKE", "AK %d: %s; PNU %d%s" % (ak, name, pke & 0x7FF, toggle)
    )
    label = "P%04d[%d]" % (number, ind & 0xFF) if number is not None else "no number"
    if len(words) > 1:
        told.add(NET + 2, words_bytes(words[1:2]), "IND", "index %d, page %02Xh: %s" % (
            ind & 0xFF, ind >> 8, label if ak else "-"))  # fmt: skip
    value = _value(ak, words[2:], direction)
    for place, word in enumerate(words[2:]):
        says = value if place == len(words) - 3 else ""
        told.add(NET + 4 + 2 * place, words_bytes([word]), "PWE%d" % (place + 1), says)
    if not ak:
        return name
    return " ".join([name, label] + (["= " + value] if value else []))


def _value(ak, words, direction):
    """What PWE says, in words."""
    if not words or ak == 0:
        return ""
    if direction == FROM_DRIVE and ak == REFUSED:
        error = words[1] if len(words) == 2 else words[0]
        if len(words) == 2 and words[0]:  # variable length: the number first
            error = words[0]
        return "error %d: %s" % (error, error_text(error))
    singles, doubles = (
        (WORD_TASKS, DOUBLE_TASKS) if direction == TO_DRIVE else (WORD_REPLIES, DOUBLE_REPLIES)
    )
    if ak == TEXT and len(words) == 8:
        return repr(words_bytes(words).decode("latin-1").rstrip())
    if ak in doubles and len(words) > 1:
        double = words[0] << 16 | words[1]
        real = pkw.words_to_float(words[0], words[1])
        return "%d, or as a float %.7g" % (double, real)
    if ak in singles or direction == FROM_DRIVE and ak == DESCRIPTION and len(words) == 1:
        word = words[1] if len(words) == 2 else words[0]
        return "%d (%04Xh)" % (word, word)
    return ""


def _enable(told, words):
    for name, word in zip("abcd", words):
        told.add(NET + 2 * "abcd".index(name), words_bytes([word]), "enable " + name,
                 "which PZD words the drives take" if name == "a" else "which bits")  # fmt: skip


def _process(told, at, words, direction, family):
    """Rows for the PZD words; what they say in short."""
    if not words:
        return ""
    to_drive = direction == TO_DRIVE
    table = (getattr(family, "stw_bits", None) or bits.STW_BITS) if to_drive else (
        getattr(family, "zsw_bits", None) or bits.ZSW_BITS)  # fmt: skip
    names = " ".join(bits.names(words[0], table))
    if not to_drive:
        short = STATES[pzd.state(words[0])]
    elif not words[0] & CONTROL:
        short = "nothing commanded (bit 10 is 0)"
    else:
        short = STW_WORDS.get(words[0], "ON" if words[0] & 1 else "OFF1")
    told.add(at, words_bytes(words[:1]), "STW" if to_drive else "ZSW", "%s: %s" % (short, names))
    for place, word in enumerate(words[1:], 2):
        field, says = "PZD%d" % place, ""
        if place == 2:
            field = "HSW" if to_drive else "HIW"
            says = "%.2f %% of the reference" % (100 * pzd.signed(word) / pzd.FULL_SCALE)
            short += ", %s %.2f %%" % (field, 100 * pzd.signed(word) / pzd.FULL_SCALE)
        told.add(at + 2 * (place - 1), words_bytes([word]), field, says)
    return short


def words_bytes(words):
    return b"".join(word.to_bytes(2, "big") for word in words)
