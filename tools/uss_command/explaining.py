# SPDX-License-Identifier: MIT
"""decode: explains telegrams that somebody has typed, or that --trace or sniff have kept."""

from tools.uss_command import explanation
from tools.uss_command.errors import FAILED, Misused
from tools.uss_command.files.capture import characters_of, read_capture
from tools.uss_command.settings import EVERYONE, kinds

COLUMNS = ("at", "hex", "field", "says")


def add(commands):
    parser = commands.add_parser("decode", help="explain a telegram, and what is wrong with it")
    parser.add_argument("hex", nargs="*", metavar="HEX", help="02 06 00 04 7F 20 00 5F")
    parser.add_argument("--capture", metavar="FILE", help="all telegrams of a file")
    parser.add_argument("--layout", metavar="4+2", help="PKW and PZD words; guessed otherwise")
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--request", action="store_const", dest="way", const=explanation.TO_DRIVE)
    way.add_argument("--reply", action="store_const", dest="way", const=explanation.FROM_DRIVE)
    parser.set_defaults(run=decode)


def decode(screen, settings, chosen):
    """Exit status 1: one of them is no telegram."""
    if bool(chosen.hex) == bool(chosen.capture):
        raise Misused("decode wants characters in hex, or --capture FILE")
    known = kinds(chosen.kind or "")[0].get(EVERYONE, (None, None))
    layout = layout_of(chosen.layout)
    if layout is None and known[1] is not None:
        layout = known[1].pkw_words, known[1].pzd_words
    status = 0
    if chosen.capture:
        for at_s, way, characters in read_capture(chosen.capture):
            told = explanation.explained(characters, layout, chosen.way or way, known[0])
            status = FAILED if told.wrong else status
            _say_line(screen, at_s, way, characters, told)
        return status
    told = explanation.explained(characters_of(" ".join(chosen.hex)), layout, chosen.way, known[0])
    screen.table(told.summary, COLUMNS, told.rows, summary=told.summary, wrong=told.wrong)
    return FAILED if told.wrong else 0


def _say_line(screen, at_s, way, characters, told):
    mark = {explanation.TO_DRIVE: ">", explanation.FROM_DRIVE: "<"}.get(way, " ")
    shown = characters.hex(" ").upper()
    screen.event(
        "%12s %s %-48s %s" % ("" if at_s is None else "%.6f" % at_s, mark, shown, told.summary),
        at_s=at_s, way=way, hex=shown, summary=told.summary, wrong=told.wrong,
    )  # fmt: skip


def layout_of(text):
    """(4, 2) for "4+2", None for None. Misused."""
    if text is None:
        return None
    pkw_words, plus, pzd_words = text.partition("+")
    if not (plus and pkw_words.isdigit() and pzd_words.isdigit()):
        raise Misused("--layout: %s is no layout such as 4+2 or 127+2" % text)
    return int(pkw_words), int(pzd_words)
