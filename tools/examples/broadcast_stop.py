# SPDX-License-Identifier: MIT
"""Broadcast: three drives run, and one telegram stops them all at the same instant.

After it the program stops each drive once more by itself, because nobody answers a broadcast.
"""

from uss.bus import Master
from uss.families import MM420


def main(board):
    with Master(board.make_link(19200), baud=19200) as bus:
        drives = [bus.add(address, MM420) for address in (1, 2, 3)]
        for drive in drives:
            if drive.fault:
                drive.acknowledge()
            drive.run(20.0)
        bus.wait(10)
        print([drive.state for drive in drives])
        bus.broadcast_stop()
        bus.wait(30, lambda: not any(drive.is_running for drive in drives))
        print([drive.state for drive in drives])


if __name__ == "__main__":
    import board

    main(board)
