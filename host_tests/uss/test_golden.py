# SPDX-License-Identifier: MIT
"""Golden telegrams, there and back: built from what they mean, and understood as they are meant.

There: the words of every telegram from the fields of its row; what a master sends, by the master's
own means. Back: every reply goes through a whole master, whose drive then says what the row says.
What is not valid changes nothing.
"""

import golden
from line_bench import MASK, Line, of_words, sealed
from uss import bits, outside, pkw, pzd, telegram
from uss.channel import Channel
from uss.drive import Drive
from uss.layout import Layout
from uss.tasks import arrays, descriptions, texts
from uss.tasks.change_reports import Reports

# --- the words of a row -------------------------------------------------------------------------

STW_BITS = {name: 1 << bit for bit, name, _ in bits.STW_BITS}


def pzd_word(text):
    """Four hexadecimal digits or the name of a control word; +BIT and -BIT behind it change it."""
    head, *changes = text.split()
    word = getattr(pzd, head) if hasattr(pzd, head) else int(head, 16)
    for change in changes:
        bit = STW_BITS[change[1:]]
        word = word | bit if change[0] == "+" else word & ~bit
    return word


def value_words(meant, pkw_words):
    """PWE: a value of 16 bits is the low word of the two in four fixed PKW words."""
    if "double" in meant:
        return list(pkw.words_of(meant["double"]))
    if "float" in meant:
        return list(pkw.float_to_words(meant["float"]))
    if "text" in meant:
        text = meant["text"].encode()
        return [telegram.get_word(text, at) for at in range(0, 16, 2)]
    word = meant.get("word", meant.get("count", meant.get("error", 0)))
    if "next" in meant:
        return [word, meant["next"]]
    return [0, word] if pkw_words == 4 else [word]


def pkw_area(example):
    """The PKW words that say what the row means."""
    meant = example.pkw
    if meant is None:
        return [0] * example.pkw_words
    if "ak" not in meant:
        return [int(word, 16) for word in meant.get("enable", meant.get("words"))]
    head = pkw.pke(meant["ak"], meant["number"]) | meant.get("toggle", 0) << 11
    page = pkw.ind(meant["number"], meant["index"]) | meant.get("field", 0) << 8
    return [head, page] + value_words(meant, example.layout[0])


def test_every_valid_telegram_is_built_from_what_it_means():
    for example in golden.VALID:
        words = pkw_area(example) + [pzd_word(text) for text in example.pzd]
        assert of_words(words, example.address()) == example.characters, example.id


# --- what a master sends, by its own means ------------------------------------------------------

MAKERS = {
    1: lambda asked: pkw.read(asked["number"], asked["index"]),
    2: lambda asked: write(asked, eeprom=False),
    3: lambda asked: write(asked, eeprom=False),
    4: lambda asked: descriptions.read_description(asked["number"], asked["index"]),
    6: lambda asked: arrays.read_element(asked["number"], asked["index"]),
    8: lambda asked: arrays.write_element_double(asked["number"], asked["index"], asked["double"]),
    9: lambda asked: arrays.count_elements(asked["number"]),
    13: lambda asked: write(asked, eeprom=True),
    14: lambda asked: write(asked, eeprom=True),
    15: lambda asked: text_job(asked),
}


def write(asked, eeprom):
    number, index = asked["number"], asked["index"]
    if "float" in asked:
        return pkw.write_float(number, asked["float"], index, eeprom)
    if "word" in asked:
        return pkw.write_word(number, asked["word"], index, eeprom)
    # A word task with a double word in it, which is what the drive refuses.
    return pkw.Job(asked["ak"], number, index, *pkw.words_of(asked["double"]))


def text_job(asked):
    """Bit 8 of IND says write, bit 9 the second field (C-4.2.2)."""
    number, element, field = asked["number"], asked["index"], 1 + (asked["field"] >> 1)
    if asked["field"] & 1:
        return texts.write_text(number, element, asked["text"], field)
    return texts.read_text(number, element, field)


def job_of(asked):
    """The job that asks this, or None when nothing is asked."""
    return MAKERS[asked["ak"]](asked) if asked and "ak" in asked else None


# Requests that a master does not send, and why.
NOT_SENT = {
    "S1-1b": "STW 0000: bit 10 of a word to a drive is never 0",
    "S4-1": "the same",
    "S4-7": "the same",
    "S4-3": "a setpoint beside OFF1",
    "S4-5": "the same",
    "V15": "OFF3 beside ON",
    "V63": "bit 11 acknowledges a report: see the test of change reports",
    "V67": "a telegram without a task is never so long",
}


def contact(drive):
    """The drive has answered one telegram, so that commands are sent to it."""
    drive.fill(0)
    layout = drive.layout
    reply = sealed(bytes(layout.net_count), drive.address)
    drive.take(reply, len(reply), 0)


def command(drive, words):
    """Have the next telegram carry these PZD words; the first is one that starts or stops."""
    stw = pzd_word(words[0])
    if stw & pzd.STW_RUN:
        drive.start(int(words[1], 16), stw)
    elif stw & pzd.STW_ACKNOWLEDGE:
        drive.acknowledge()
    else:
        drive.stop(stw)
    for index in range(2, len(words)):
        drive.put(index + 1, int(words[index], 16))


def sent(example):
    """The telegram of a drive that was told what the row means."""
    drive = Drive(example.node, MASK, layout=Layout(*example.layout))
    contact(drive)
    if example.pzd:
        command(drive, example.pzd)
    job = job_of(example.pkw)
    if job:
        drive.ask(job)
        assert job.state == pkw.PENDING, example.id
    drive.fill(0)
    telegram.seal(drive.request, drive.address, drive.size - 4)
    return bytes(drive.request[: drive.size])


def test_every_request_of_a_master_is_sent_as_printed():
    count = 0
    for example in golden.VALID:
        if example.kind == "request" and example.id not in NOT_SENT:
            assert sent(example) == example.characters, example.id
            count += 1
    print(count, "requests")
    assert count == sum(row.kind == "request" for row in golden.VALID) - len(NOT_SENT)


def test_every_task_is_placed_as_printed():
    """Also those beside STW words that a master does not send."""
    for example in golden.VALID:
        asked = example.pkw
        if example.kind != "request" or asked is None or "toggle" in asked:
            continue
        channel = Channel(MASK, example.layout[0])
        job = job_of(asked)
        channel.ask(job)
        net = bytearray(32)
        size = channel.fill(net, 0, 0)
        assert size == 2 * example.pkw_words, example.id
        assert net[:size] == example.net[:size], example.id


def test_mirror_telegrams_are_sent_as_printed():
    for name in ("SPMq", "V16"):
        example = golden.BY_ID[name]
        probe = outside.Mirror(example.node, example.net)
        assert bytes(probe.request) == example.characters, name


def test_special_telegrams_are_sent_as_printed():
    for name, node in (("V57", 5), ("V58", None)):
        example = golden.BY_ID[name]
        assert bytes(outside.Special(node, example.net).request) == example.characters, name


# Broadcasts: what is taken over of which word, and what the master says to the row.
AS_PRINTED, WITH_BIT_10, NEVER = range(3)
BROADCASTS = {
    "SPB1": ({2: 0xFFFF}, WITH_BIT_10),
    "SPB2": ({1: 0x0020}, WITH_BIT_10),
    "V17": ({1: 0x0001}, AS_PRINTED),
    "V53": ({1: 0x0002}, AS_PRINTED),
    "V54": ({}, NEVER),  # it enables nothing, not even itself
    "V55": ({1: 0xFFFF, 2: 0xFFFF}, NEVER),  # it starts motors
}


def test_broadcasts_are_sent_as_printed_but_for_bit_10_and_never_start_anything():
    for example in golden.VALID:
        if example.kind != "broadcast":
            continue
        takes, kind = BROADCASTS[example.id]
        words = [pzd_word(text) for text in example.pzd]
        if kind == WITH_BIT_10:
            words[0] |= STW_BITS["CONTROL"]
        try:
            built = outside.Broadcast(words, takes)
        except ValueError:
            assert example.id == "V55"
            continue
        expected = of_words(pkw_area(example) + words, example.address())
        assert (bytes(built.request) == expected) == (kind != NEVER), example.id


def test_an_adr_that_means_nothing_cannot_be_sent():
    example = golden.BY_ID["V56"]
    assert example.address() == 0x65
    for make in (outside.Mirror, outside.Special):
        try:
            make(0x25, example.net)
        except ValueError:
            continue
        raise AssertionError(make)


# --- what a master makes of replies -------------------------------------------------------------


def told(example, characters):
    """A drive, and what came of the job that this reply answers, after a master has heard it."""
    line = Line(lambda request: characters)
    drive = line.master.turns.add(example.node, Layout(*example.layout))
    job = job_of(example.asked())
    if job:
        drive.ask(job)
        assert job.state == pkw.PENDING, example.id
    line.exchange()
    return drive, job


def check_result(example, job):
    """The job says what the row says."""
    meant = example.pkw
    if meant["ak"] == 7:
        assert job.state == pkw.REFUSED and job.error == meant["error"], example.id
        assert job.next == meant.get("next"), example.id
    elif meant["ak"] == 8:
        assert job.state == pkw.REFUSED and job.error == pkw.NO_CHANGE_RIGHTS, example.id
    else:
        assert job.state == pkw.DONE, example.id
        check_value(example.id, job, meant)


def check_value(name, job, meant):
    if "text" in meant:
        assert job.text() == meant["text"].rstrip(), name
    elif "float" in meant:
        assert job.width == pkw.DOUBLE and job.float_value() == meant["float"], name
    elif "double" in meant:
        assert job.width == pkw.DOUBLE and job.integer_value() == meant["double"], name
    elif meant["ak"] != 3:
        assert job.integer_value() == meant.get("word", meant.get("count")), name


# Replies that do not answer what was asked: the job goes on.
NO_ANSWER = ("V62", "V65")


def test_every_reply_is_understood_as_it_is_meant():
    replies = 0
    for example in golden.VALID:
        if example.kind != "reply":
            continue
        drive, job = told(example, example.characters)
        assert list(drive.counters) == [1, 0, 0, 0, 0, 0, 0], example.id
        words = [pzd_word(text) for text in example.pzd]
        for index in range(len(words)):
            assert drive.word(index + 1) == words[index], (example.id, index)
        if words:
            assert drive.state() == getattr(pzd, example.state), example.id
        if example.id in NO_ANSWER:
            assert job.state == pkw.PENDING, example.id
        elif job:
            check_result(example, job)
        replies += 1
    print(replies, "replies")


def test_a_limit_is_described():
    """SP4: element 7 of a description, the lower limit."""
    example = golden.BY_ID["SP4r"]
    _, job = told(example, example.characters)
    assert job.description().lower == 0x5FFF


def test_a_mirror_telegram_that_came_back_is_recognised():
    for name in ("SPMq", "V16"):
        example = golden.BY_ID[name]
        line = Line(lambda request: request)
        line.master.turns.add(1)
        probe = outside.Mirror(example.node, example.net)
        line.master.turns.post(probe)
        line.exchange(2)
        assert example.characters in line.requests
        assert probe.state == outside.DONE, name


def test_a_change_report_is_acknowledged_and_the_task_goes_on():
    """V61 to V64: bit 11 of the reply comes back in the next request (C-4.2.1.2)."""
    replies = [golden.BY_ID[name].characters for name in ("V62", "V64")]
    idle = golden.BY_ID["V02"].characters
    line = Line(lambda request: idle)
    drive = line.master.turns.add(1)
    reports = Reports(drive.channel)
    line.exchange()
    job = pkw.read(1000)
    drive.ask(job)
    line.answer = lambda request: replies.pop(0) if request[3] & 0xF0 and replies else idle
    line.exchange(4)
    for name in ("V61", "V63"):
        assert golden.BY_ID[name].characters in line.requests, name
    report = reports.get()
    assert (report.number, report.index, report.integer_value()) == (700, 0, 2)
    assert job.state == pkw.DONE and job.integer_value() == 5


# --- what is not valid --------------------------------------------------------------------------


def test_what_is_not_valid_changes_nothing_in_the_master():
    for example in golden.INVALID:
        characters = example.characters
        line = Line()
        drive = line.master.turns.add(characters[2], Layout(example.pkw_words, example.pzd_words))
        reply = of_words([0] * (drive.layout.net_count // 2 - 2) + [0xFB34, 0x2000], drive.address)
        line.answer = lambda request, reply=reply: reply
        line.exchange()
        line.answer = lambda request, characters=characters: characters
        line.exchange()
        assert drive.counters[0] == 1 and sum(drive.counters) == 2, example.id
        assert (drive.zsw, drive.hiw) == (0xFB34, 0x2000), example.id
        line.answer = lambda request, reply=reply: reply
        line.exchange()
        assert drive.counters[0] == 2 and drive.status == 0, example.id


def test_every_telegram_to_somebody_else_changes_nothing_in_the_master():
    """All valid ones, flag bits and all, as a reply of drive 30, whose layout fits each."""
    for example in golden.VALID:
        line = Line(lambda request: sealed(bytes(layout.net_count), 30))
        layout = Layout(*example.layout)
        drive = line.master.turns.add(30, layout)
        line.exchange()
        line.answer = lambda request, characters=example.characters: characters
        line.exchange()
        assert drive.counters[0] == 1 and drive.counters[4] == 1, example.id
        assert drive.zsw == drive.hiw == 0
