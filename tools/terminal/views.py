# SPDX-License-Identifier: MIT
"""What is shown, as texts with colours: each function takes what was told, and answers a Text.

It knows no terminal and no keys; the widgets (widgets.py) show these texts.
"""

import re

from rich.text import Text

BLANKS = re.compile("  +")
MANY = 6  # drives: more may have no room
LIT = "bold #101800 on #9db83c"  # the display
DARK = "#9db83c on #26300c"  # when its light is off
STATES = {"running": "bold green", "stopping": "yellow", "fault": "bold red", "off": "dim"}
STATES.update({"silent": "bold red"})
DRIVES_HEAD = " drive  motor             setpoint  current  state"
HEARD_HEAD = " drive   state      exchanges"
SIMULATED = "%s%-4s (%s) %7.2f Hz %-5s %9.2f %6.2f A  "
REASONS = (  # counters of the specification: what a person calls them
    ("start", "no start"),
    ("length", "length"),
    ("bcc", "BCC"),
    ("address", "address"),
    ("residual", "cut off"),
)


def display(lcd):
    """Both rows."""
    return Text("\n".join(lcd["text"]), style=LIT if lcd["on"] and lcd["lit"] else DARK)


def head(told):
    """The first line: where, since when, how fast."""
    tenths = told.us // 100_000
    clock = "%d:%02d:%02d.%d" % (
        tenths // 36000, tenths // 600 % 60, tenths // 10 % 60, tenths % 10,
    )  # fmt: skip
    text = Text(" USS panel on %s   time %s" % (told.hello["place"], clock))
    if told.hello["real"]:
        return Text(" REAL DRIVES ", "bold white on #c00000").append_text(text)
    return text.append("   speed x %.1f" % told.speed)


def drives(told, shafts):
    """A line for each drive: those that turn, or are shown, come first."""
    text = Text(no_wrap=True)
    real = any(drive["hz"] is None for drive in told.drives)
    text.append(HEARD_HEAD if real else DRIVES_HEAD, "dim")
    if len(told.drives) > MANY:
        text.append(", %d drives" % len(told.drives), "dim")
    for drive in sorted(told.drives, key=lambda drive: (not matters(told, drive), drive["a"])):
        text.append("\n")
        text.append_text(heard(told, drive) if real else simulated(told, drive, shafts))
    return text


def matters(told, drive):
    return bool(drive["hz"]) or drive["at"] == told.shown


def simulated(told, drive, shafts):
    hz = drive["hz"]
    turns = "right" if hz > 0 else "left" if hz < 0 else ""
    shown = "*" if drive["at"] == told.shown else " "
    line = Text(
        SIMULATED
        % (shown, "A%d" % drive["at"], shafts.mark(drive["a"]), abs(hz), turns,
           drive["set_hz"], drive["amps"])
    )  # fmt: skip
    line.append("%-9s" % drive["state"], STATES.get(drive["state"], ""))
    for trouble, style in ((drive["fault"], "bold red"), (drive["warning"], "yellow")):
        if trouble:
            line.append(" " + trouble, style)
    if not drive["plugged"]:
        line.append(" unplugged", "bold red")
    return line


def heard(told, drive):
    """Of a real drive only its telegrams are known; its speed stands on the display."""
    shown = "*" if drive["at"] == told.shown else " "
    line = Text("%s%-7s" % (shown, "A%d" % drive["at"]))
    line.append("%-10s " % drive["state"], STATES.get(drive["state"], ""))
    return line.append_text(counted(told.counts.get(drive["a"])))


def counted(counts):
    """What came of the exchanges with a drive: good, silent, refused and why."""
    if not counts:
        return Text()
    line = Text("good %d" % counts["good"])
    if counts["no_reply"]:
        line.append("  silent %d" % counts["no_reply"], "bold red")
    reasons = ["%s %d" % (name, counts[field]) for field, name in REASONS if counts[field]]
    if reasons:
        line.append("  refused: " + ", ".join(reasons), "yellow")
    return line


def exchanges(told):
    """The counters of all drives together."""
    if not told.counts:
        return Text(" exchanges: this chip does not tell", "dim")
    total = {}
    for counts in told.counts.values():
        for name, value in counts.items():
            total[name] = total.get(name, 0) + value
    line = Text(" exchanges: ").append_text(counted(total))
    silent = sorted(address for address, one in told.counts.items() if one["no_reply"])
    if silent:
        line.append("  (by %s)" % ", ".join("A%d" % address for address in silent), "red")
    return line


def telegram(row, width, in_hex):
    """A telegram: when it came first, from whom, how often since then, and what it says."""
    ours = row.message["from"] == "panel"
    line = Text("%5d.%06d " % divmod(row.first_us, 1_000_000), "dim", no_wrap=True)
    line.append("> " if ours else "< ", "cyan" if ours else "green")
    line.append("%-6s " % ("x %d" % row.count if row.count > 1 else ""), "magenta")
    words = hexed(row.message["hex"]) if in_hex else row.message["text"]
    if len(line) + len(words) > width:
        words = BLANKS.sub("  ", words)
    line.append(words, "bold red" if row.message["wrong"] else "")
    line.truncate(width, overflow="ellipsis")
    return line


def hexed(digits):
    return " ".join(digits[at : at + 2] for at in range(0, len(digits), 2))
