# SPDX-License-Identifier: MIT
"""Records: what the line carried and what the display showed while somebody did this and that.

    # A text for people.
    drives 1=mm440,2=g110 baud 38400 seed 7

    > press START
    | S: 30.0 F:  0.00 | RUNNING      A1  |
    1: 0000 0000 0000 0000 047F 3333
    = 3020 ms, 412 telegrams, 18 pictures, 5C31A2F0

Behind ">" stands a command of the script language (boards/sim/script.py), or `keys`: taps with 200
ms between them, `PARAM held` and `DOWN x3` too. All other lines are made:

* the display at the end of the command, if it is another one;
* what the drives were asked, behind their addresses, each telegram once;
* how much there was, and the CRC of each telegram and of each picture, with their times.

So a record tells a reader what a change of the firmware changes on the wire.
"""

import binascii

import main
from boards.sim.drives.kinds import expected, listed_drives, simulated
from boards.sim.script import Script
from boards.sim.world import World

LOOK_MS = 10
SHOWN_MAX = 8  # requests behind a command
HELD_MS, TAP_MS, BETWEEN_MS = 1_500, 60, 200


class Record:
    """A world that writes down what happens. head: "drives ..."; lines: what it adds to."""

    def __init__(self, head, lines):
        _, drives, _, baud, _, seed = head.split()
        listed = listed_drives(drives)
        self.world = World(
            main.start, [one.address for one in listed], baud=int(baud), seed=int(seed),
            kinds=simulated(listed), settings={"kinds": expected(listed)},
        )  # fmt: skip
        self._lines = lines
        self._script = Script(self.world, "record", lines.append)
        self._run, self.world.run = self.world.run, self._look_on
        self._shown = self._picture = None
        self._clear()

    def _clear(self):
        self._began_us = self.world.clock.now_us
        self._telegrams = self._pictures = self._crc = 0
        self._asked = []

    def do(self, command):
        """Do it, and write down what happens meanwhile."""
        name, _, rest = command.partition(" ")
        if name == "keys":
            self._press(rest.split(", "))
        else:
            self._script.run([command])
        if self._picture != self._shown:
            self._shown = self._picture
            self._lines.append("| %s | %s |" % self._shown)
        self._lines += self._asked[:SHOWN_MAX]
        if len(self._asked) > SHOWN_MAX:
            self._lines.append("%d more" % (len(self._asked) - SHOWN_MAX))
        if self._telegrams or self._pictures:
            took_ms = (self.world.clock.now_us - self._began_us) // 1000
            told = took_ms, self._telegrams, self._pictures, self._crc
            self._lines.append("= %d ms, %d telegrams, %d pictures, %08X" % told)
        self._clear()

    def _press(self, keys):
        for part in keys:
            key, _, how = part.partition(" ")
            for _ in range(int(how[1:]) if how[:1] == "x" else 1):
                self.world.press(key, HELD_MS if how == "held" else TAP_MS)
                self.world.run(BETWEEN_MS)

    def _look_on(self, ms):
        end_us = self.world.clock.now_us + ms * 1000
        while self.world.clock.now_us < end_us:
            count = self.world.wire.log.count
            self._run(min(LOOK_MS, (end_us - self.world.clock.now_us + 999) // 1000))
            for telegram in self.world.wire.log.last(self.world.wire.log.count - count):
                self._note(*telegram)
            picture = self.world.lcd()
            if picture != self._picture:
                self._picture = picture
                self._pictures += 1
                self._hold("%d|%s|%s" % ((self.world.clock.now_us,) + tuple(picture)))

    def _note(self, at_us, from_panel, characters):
        self._telegrams += 1
        shown = binascii.hexlify(characters).decode()
        self._hold("%d%s%s" % (at_us, ">" if from_panel else "<", shown))
        if not from_panel or len(characters) < 4:
            return
        address, net = characters[2], shown[6:-2].upper()
        words = [net[at : at + 4] for at in range(0, len(net), 4)]
        asked = "%d: %s" % (address, " ".join(words))
        if asked not in self._asked:
            self._asked.append(asked)

    def _hold(self, text):
        self._crc = binascii.crc32(text.encode(), self._crc)


def made(text):
    """The text of a record, made anew from its commands."""
    record, lines = None, []
    for line in text.split("\n"):
        if line[:1] in ("", "#", ">") or record is None:
            lines.append(line)
        if line.startswith("drives "):
            record = Record(line, lines)
        elif line.startswith("> "):
            record.do(line[2:])
    record.world.check()
    return "\n".join(lines)
