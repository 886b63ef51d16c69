# SPDX-License-Identifier: MIT
"""What the bench runs inside the emulated chip besides on_chip.py: the master without a panel."""

import json
import time

import board

from hal.pacer import Pacer
from uss.going_on import master_of
from uss.layout import Layout
from uss.master import CLOSED
from uss.timing import Timing


def mixed(baud, layouts, ms):
    """The master alone for so long; layouts: [(address, PKW words, PZD words), ...]."""
    link = board.make_link(baud)
    bus = master_of(link, Timing(baud), board.clock.ticks_mask)
    for address, pkw_words, pzd_words in layouts:
        bus.turns.add(address, Layout(pkw_words, pzd_words))
    pacer = Pacer(bus, link, board.clock, board.timer)
    bus.refresh(time.ticks_us())
    pacer.start()
    began = time.ticks_ms()
    try:
        while bus.phase != CLOSED:
            bus.refresh(time.ticks_us())
            pacer.tend()
            time.sleep_ms(1)
            if time.ticks_diff(time.ticks_ms(), began) > ms:
                bus.close()
    finally:
        pacer.stop()
    silent = [drive.address for drive in bus.turns.drives if not drive.contact]
    counters = [sum(row) for row in zip(*[drive.counters for drive in bus.turns.drives])]
    print(json.dumps({"silent": silent, "counters": counters}))
