# SPDX-License-Identifier: MIT
"""Your own program, without a panel: START runs the pump, STOP stops it, for ever.

The bus works by interrupts; if this loop hangs, the bus stops the motor after 300 ms, and the
watchdog restarts the chip. Ctrl-C ends it.
"""

from hal.pacer import Pacer
from uss.bus import Master, UssError
from uss.families import MM420


def main(board):
    start, stop = (1 << board.keypad.names.index(name) for name in ("START", "STOP"))

    def attend():  # also while START waits for the drive
        board.watchdog.feed()
        if board.keypad.read() & stop:
            bus.stop_all()

    with Master(board.make_link(19200), idle=attend) as bus:
        bus.pace(Pacer, board.timer)
        pump = bus.add(1, MM420)
        while True:
            bus.step()
            attend()
            if board.keypad.read() & (start | stop) == start and not pump.is_on():
                try:
                    if pump.fault:
                        pump.acknowledge()
                    pump.run(40.0)
                except UssError as reason:
                    print(reason)
            board.idle()


if __name__ == "__main__":
    import board

    try:
        main(board)
    finally:
        board.watchdog.stop()
