# SPDX-License-Identifier: MIT
"""The panel where MicroPython itself runs in a browser: what tools/web/page/worker.js calls.

    begin('{"drives": "1,2", "baud": 19200, "keys": "direct", "seed": 0}')
    take('{"t":"hello","v":1}')
    lines = turn()                      # time passes; messages, a line each

Text crosses the border alone: a number there has 32 bits. A turn is short, for the memory that
nobody needs any more is collected only between two calls.
"""

import gc
import json
import time

import main
from boards.sim.drives import kinds
from boards.sim.world import World
from tools.live.conversation import Conversation

COLLECT_AFTER = 1_000_000

conversation = None


def begin(options):
    """ValueError: there are no such drives. The others of `World` were looked at before."""
    global conversation
    gc.threshold(COLLECT_AFTER)
    chosen = json.loads(options)
    drives = kinds.listed_drives(chosen["drives"])
    baud = chosen["baud"]
    kinds.knowing(drives, baud)
    expected = kinds.expected(drives)
    world = World(
        main.start,
        [one.address for one in drives],
        baud,
        settings={"kinds": expected} if expected else {},
        seed=chosen["seed"],
        keys=chosen["keys"],
        kinds=kinds.simulated(drives),
    )
    world.place = "the virtual board, in this browser"
    conversation = Conversation(world, 1, time, kinds.as_delivered(world.drives, baud))


def take(line):
    conversation.take(line)


def turn():
    conversation.follow()
    return b"".join(conversation.answers() + conversation.news()).decode()
