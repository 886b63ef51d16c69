"""What led to a broken rule, for people: keys, screens and telegrams, the last ones, with times.

    for line in story(result): print(line)
"""

TELEGRAMS = 24
WORDS = {
    0x047E: "OFF1", 0x047C: "OFF2", 0x047A: "OFF3", 0x047F: "ON", 0x0C7F: "ON, reverse",
    0x057E: "JOG right", 0x067E: "JOG left",
}  # fmt: skip
STATES = ((0x08, "fault"), (0x40, "inhibited"), (0x04, "running"), (0x02, "ready to run"), (0x01, "ready"))
TASKS = {0: "", 1: "read", 2: "write", 3: "write double", 13: "write double, EEPROM", 14: "write, EEPROM"}


def story(result):
    """Lines."""
    from tools.soaking.rules import RULES, Broken

    broken = result.broken
    if isinstance(broken, Broken):
        yield "seed %d breaks the rule %s: %s" % (result.seed, broken.args[0], RULES[broken.args[0]])
        yield "    " + broken.args[1]
    else:
        yield "seed %d ended in %r" % (result.seed, broken)
    if result.hand is None:
        return
    yield "at %s, %s" % (time_of(result.world.clock.now_us), result.plan)
    events = []
    for at_us, text in result.hand.deeds:
        events.append((at_us, "        " + text))
    if result.weather.faults is not None:
        for at_us, kind, detail in result.weather.faults.log:
            events.append((at_us, "      ! %s %s" % (kind, detail)))
    for at_us, row_1, row_2 in result.reader.screens:
        events.append((at_us, "            |%s|%s|" % (row_1, row_2)))
    for at_us, from_panel, characters in result.world.wire.log.last(TELEGRAMS):
        events.append((at_us, decoded(from_panel, characters)))
    events.sort()
    for at_us, text in events[-110:]:
        yield "%s %s" % (time_of(at_us), text)
    if len(result.world.drives) < 6:
        for _, drive in sorted(result.world.drives.items()):
            yield "    " + drive.report()


def decoded(from_panel, characters):
    shown = "%s %s" % (">" if from_panel else "<", hex_of(characters))
    if len(characters) != 16:
        return shown
    words = [characters[at] << 8 | characters[at + 1] for at in range(3, 15, 2)]
    if from_panel:
        stw = words[4] & ~0x80
        text = WORDS.get(stw, "STW %04X" % words[4])
        if words[4] & 0x80:
            text += ", acknowledge"
    else:
        text = "not ready"
        for bit, name in STATES:
            if words[4] & bit:
                text = name
                break
    task = words[0] >> 12
    if task:
        number = (words[0] & 0x7FF) + (2000 if words[1] & 0x8000 else 0)
        name = TASKS.get(task, "task %d" % task) if from_panel else "reply %d" % task
        text += "; %s P%04d = %04X %04X" % (name, number, words[2], words[3])
    return "%s  A%d %s" % (shown, characters[2] & 31, text)


def hex_of(characters):
    return " ".join("%02X" % character for character in characters)


def time_of(us):
    return "%8d.%06d s" % (us // 1_000_000, us % 1_000_000)
