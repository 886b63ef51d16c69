# SPDX-License-Identifier: MIT
"""An exchange on the line: its times, to scale, and its telegrams, character by character.

`uss.timing` computes the times. The telegrams are those of the running panel.
"""

from tools.pictures import running
from tools.pictures.svg import Picture
from uss.layout import Layout
from uss.telegram import NET
from uss.timing import FRAME_CHARACTERS, RESPONSE_DELAY_US, Timing

ACROSS, EDGE = 460, 14
LAYOUT = Layout(4, 2)
BAUD = 19200
BAUDS = (9600, 19200, 38400, 57600, 115200, 187500)
ADR = NET - 1  # place of the address in a telegram
PAUSE_CHARACTERS = 2  # in which the drive answers here: the least that it may
FONT, SMALL, STEP = 12, 11, 17
AXIS, BAR, ROW = 82, 24, 36  # where the times begin; height of a telegram, and of its row
AFTER = 0.12  # of the next telegram that is seen
# Times: letter, what it is, more of it.
START, REQUEST, DELAY, REPLY = "abcd"
FIELDS = (("STX", 1), ("LGE", 1), ("ADR", 1), ("PKE", 2), ("IND", 2), ("PWE", 4))
WORDS = {"request": (("STW", 2), ("HSW", 2)), "reply": (("ZSW", 2), ("HIW", 2))}
COLOURS = {"request": "blue", "reply": "green"}
WHERE = {"request": "panel", "reply": "drive"}


def times(baud):
    """Of an exchange, in microseconds: {letter: us}, and of all of it."""
    line = Timing(baud)
    delay_us = PAUSE_CHARACTERS * line.start_interval_us // 2
    telegram_us = line.telegram_us(LAYOUT.net_count)
    each = {
        START: line.start_interval_us, REQUEST: telegram_us, DELAY: delay_us, REPLY: telegram_us
    }  # fmt: skip
    return each, line.exchange_us(LAYOUT.net_count, delay_us)


def telegrams():
    """A request without a task and its reply, with the motor running: {"request": bytes, ...}."""
    world = running.panel()
    running.press(world, "START, 3 s")
    address = world.app.panel.selected.drive.address
    heard = world.wire.log.last(20)
    for (_, _, request), (_, from_panel, reply) in zip(heard, heard[1:]):
        is_plain = not any(request[NET : NET + 2])  # PKE
        if not from_panel and is_plain and request[ADR] == reply[ADR] == address:
            return {"request": request, "reply": reply}
    raise AssertionError(heard)


def exchange():
    count = LAYOUT.net_count + FRAME_CHARACTERS
    what = f"{BAUD} baud, {count} characters each way"
    each, all_us = times(BAUD)
    legend = {
        START: "start interval: silence of 2 characters before STX",
        REQUEST: f"request of the panel, {count} characters",
        DELAY: f"response delay: as long at least, {RESPONSE_DELAY_US // 1000} ms at the most",
        REPLY: f"reply of the drive, {count} characters",
    }
    picture = Picture(
        ACROSS,
        "An exchange on the line, with its times",
        what + ": " + "; ".join(f"{legend[at]}, {_ms(us)}" for at, us in each.items()),
    )
    picture.text(EDGE, EDGE + 14, f"An exchange: {what}", size=14, bold=True)
    y = _to_scale(picture, EDGE + 34, each)
    for at, us in each.items():
        picture.text(EDGE, y, at, "orange", FONT, bold=True)
        picture.text(EDGE + 18, y, legend[at], size=FONT)
        picture.text(ACROSS - EDGE, y, _ms(us), size=FONT, anchor="end")
        y += STEP
    picture.text(EDGE + 18, y, "all of it", size=FONT, bold=True)
    picture.text(ACROSS - EDGE, y, _ms(all_us), size=FONT, anchor="end", bold=True)
    y += 24
    for kind, data in telegrams().items():
        y = _characters(picture, y, kind, data)
    picture.down = _table(picture, y + 8) + EDGE
    return picture


def _to_scale(picture, y, each):
    """Panel, drive and driver enable, one below the other. Answers where it goes on."""
    next_us = each[REQUEST] * AFTER
    scale = (ACROSS - EDGE - AXIS) / (sum(each.values()) + each[START] + next_us)
    rows = {name: y + 18 + ROW * at for at, name in enumerate(("panel", "drive", "DE"))}
    for name, top in rows.items():
        said = "driver enable" if name == "DE" else name
        picture.text(EDGE, top + BAR / 2 + 4, said, size=SMALL)
        picture.line([(AXIS, top + BAR), (ACROSS - EDGE, top + BAR)], "line", 1)
    x, edges = AXIS, []
    for at, us in (*each.items(), (START, each[START])):
        long = us * scale
        edges.append(x)
        if at in (REQUEST, REPLY):
            kind = "request" if at == REQUEST else "reply"
            picture.rect(x, rows[WHERE[kind]], long, BAR, COLOURS[kind], radius=2)
            picture.text(x + long / 2, rows[WHERE[kind]] + 16, kind, "paper", FONT, "middle")
        if at == REQUEST:
            picture.rect(x, rows["DE"] + 6, long, BAR - 6, "orange")
        picture.text(x + long / 2, y + 8, at, "orange", FONT, "middle", bold=True)
        x += long
    edges.append(x)
    picture.rect(x, rows["panel"], next_us * scale, BAR, "blue")
    picture.rect(x, rows["DE"] + 6, next_us * scale, BAR - 6, "orange")
    bottom = rows["DE"] + BAR + 6
    for x in edges:
        picture.line([(x, y + 12), (x, bottom)], "line", 1, dashes="3 3")
    return bottom + 22


def _characters(picture, y, kind, data):
    """A telegram, in which each character has its place. Answers where it goes on."""
    place = (ACROSS - 2 * EDGE) / len(data)
    fields = (*FIELDS, *WORDS[kind], ("BCC", 1))
    assert sum(count for _, count in fields) == len(data)
    words = {"request": "request: PKW, 4 words, and PZD, 2 words", "reply": "reply: likewise"}[
        kind
    ]
    picture.text(EDGE, y, words, COLOURS[kind], FONT, bold=True)
    x, at = EDGE, 0
    for name, count in fields:
        long = count * place
        picture.rect(x, y + 6, long, 40, "box", edge="line")
        picture.text(x + long / 2, y + 22, name, "ink", SMALL, "middle")
        shown = data[at : at + count].hex(" ").upper()
        picture.text(x + long / 2, y + 39, shown, COLOURS[kind], SMALL, "middle", mono=True)
        x, at = x + long, at + count
    return y + 68


def _table(picture, y):
    """The times at other rates. Answers where it ends."""
    heads = ("baud", START, REQUEST, DELAY, REPLY, "all of it", "a second")
    ends = [58 + at * (ACROSS - EDGE - 58) / (len(heads) - 1) for at in range(len(heads))]
    for x, head in zip(ends, heads, strict=True):
        picture.text(x, y, head, "orange" if len(head) == 1 else "pale", SMALL, "end", bold=True)
    picture.line([(EDGE, y + 6), (ACROSS - EDGE, y + 6)], "line", 1)
    for baud in BAUDS:
        y += STEP + 1
        each, all_us = times(baud)
        rate = f"{1e6 / all_us:.0f}"
        for x, cell in zip(ends, (str(baud), *map(_ms, each.values()), _ms(all_us), rate)):
            picture.text(x, y, cell, size=SMALL, anchor="end", bold=baud == BAUD)
    return y + 6


def _ms(us):
    return f"{us / 1000:.2f} ms"
