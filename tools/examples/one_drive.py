# SPDX-License-Identifier: MIT
"""One drive: runs at 25 Hz for ten seconds, tells how fast it is, and stops.

Its address is 1, its rate 19200 baud; P0700 = P1000 = 5 give it to the bus.
"""

from uss.bus import Master
from uss.families import MM420


def main(board):
    with Master(board.make_link(19200), baud=19200) as bus:
        drive = bus.add(1, MM420)
        if drive.fault:  # F0072: it had no telegrams since the last program ended
            drive.acknowledge()
        drive.run(25.0)
        for _ in range(10):
            bus.wait(1)
            print("%6.2f Hz  %s" % (drive.hertz, drive.state))
        drive.stop()
        bus.wait(30, lambda: not drive.is_running)
        print("%6.2f Hz  %s" % (drive.hertz, drive.state))


if __name__ == "__main__":
    import board

    main(board)
