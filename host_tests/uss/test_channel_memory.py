# SPDX-License-Identifier: MIT
"""The parameter channel works in hard interrupts: whatever is asked, it takes no memory."""

import gc
import sys

import micropython

from pkw_bench import characters
from uss import pkw
from uss.channel import Channel
from uss.layout import VARIABLE
from uss.tasks import arrays, descriptions, texts
from uss.tasks.change_reports import Reports

INTERPRETERS = "unix64 unix32"

MASK = (1 << 30) - 1
CHANNEL_SIZE = 128  # bytes of a 32-bit chip: 31 drives have one each


def exchanged(channel, replies):
    """Requests and replies with the heap locked; the last request says AK 0."""
    net = bytearray(260)
    received = [b"\x02\x0e\x05" + characters(*words) for words in replies]
    now = 0
    micropython.heap_lock()
    try:
        for reply in received:
            channel.fill(net, 3, now)
            channel.take(reply, 3, len(reply) - 3)
            channel.fill(net, 3, now)
            channel.miss(now)
            now += 100_000
    finally:
        micropython.heap_unlock()


def test_tasks_of_every_kind_take_no_memory():
    text = [0x4142] * 8
    for pkw_words, job, replies in (
        (4, pkw.read(2000), ((0, 0, 0, 0), (0x2000, 0x8000, 0xFFFF, 0xFFFF))),
        (3, pkw.write_word(700, 5), ((0, 0, 0), (0x12BC, 0, 0xFFFF))),
        (VARIABLE, pkw.read(2000), ((0x2000, 0x8000, 0xFFFF, 0xFFFF),)),
        (VARIABLE, pkw.read(1), ((0x7001, 0, 0, 0xFFFF, 0xFFFF),)),
        (4, pkw.write_word(700, 5, eeprom=True), ((0x82BC, 0, 0, 0),)),
        (VARIABLE, arrays.read_all(304), ([0x4130, 0xFF] + [0xFFFF] * 124,)),
        (VARIABLE, arrays.read_all(304, 2), ([0x5130, 0xFF] + [0xFFFF] * 4,)),
        (VARIABLE, arrays.write_all_words(304, [0xFFFF] * 9), ([0x4130, 0xFF] + [0xFFFF] * 9,)),
        (VARIABLE, texts.read_text(7, 3), ([0xF007, 3] + text,)),
        (VARIABLE, descriptions.read_description(52), ([0x3034, 0xFF] + [0xFFFF] * 20,)),
        (4, descriptions.read_description(52, 7), ((0x3034, 7, 0xFFFF, 0xFFFF),)),
    ):
        channel = Channel(MASK, pkw_words, 20)
        channel.ask(job)
        exchanged(channel, replies)
        assert job.state in (pkw.DONE, pkw.REFUSED), job


def test_a_job_that_times_out_takes_no_memory():
    channel = Channel(MASK)
    jobs = [pkw.read(700), pkw.write_word(700, 5)]
    for job in jobs:
        channel.ask(job)
    exchanged(channel, [(0, 0, 0, 0)] * 60)
    assert [job.state for job in jobs] == [pkw.TIMED_OUT] * 2


def test_change_reports_take_no_memory():
    channel = Channel(MASK)
    reports = Reports(channel)
    job = pkw.read(700)
    channel.ask(job)
    replies = [(0x9000 | (number & 1) << 11 | number, 0, 0, 0xFFFF) for number in range(12)]
    exchanged(channel, replies + [(0x12BC, 0, 0xFFFF, 0xFFFF)])
    assert job.state == pkw.DONE
    assert [reports.get().number for _ in range(8)] == list(range(8))


def test_a_channel_is_small():
    channels = [None] * 100
    for _ in range(2):  # the first time makes what is made only once
        gc.collect()
        before = gc.mem_alloc()
        for number in range(len(channels)):
            channels[number] = Channel(MASK)
        gc.collect()
        size = (gc.mem_alloc() - before) / len(channels)
        channels[:] = [None] * len(channels)
    word_size = 4 if sys.maxsize < 1 << 32 else 8
    assert size < (CHANNEL_SIZE + 8) * word_size // 4, size
