# SPDX-License-Identifier: MIT
"""Three drives on one bus; the winder stands in the list twice and is asked twice as often.

The other two follow it: at half and at a tenth of its speed.
"""

from uss.bus import Master
from uss.families import MM420


def main(board):
    with Master(board.make_link(19200), baud=19200) as bus:
        winder, feed, fan = bus.add(1, MM420), bus.add(2, MM420), bus.add(3, MM420)
        bus.arrange((winder, feed, winder, fan))
        for drive in bus.drives:
            if drive.fault:
                drive.acknowledge()
            drive.run(0.0)
        winder.run(30.0)
        for _ in range(100):
            bus.wait(0.1)
            feed.set(winder.hertz / 2)
            fan.set(winder.hertz / 10)
        for drive in bus.drives:
            answers = drive.counters[0]
            print("drive %d: %.2f Hz, %d answers" % (drive.address, drive.hertz, answers))


if __name__ == "__main__":
    import board

    main(board)
