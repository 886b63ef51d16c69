# SPDX-License-Identifier: MIT
"""A slave that no family of the library knows: a turbo pump, by what its manual says of it.

It is asked for a parameter without control, as long as it stands; then it is controlled, and runs.
"""

from uss import pzd
from uss.bus import Master
from uss.families import GENERIC
from uss.layout import Layout


class TurboPump(GENERIC):
    name = "turbo pump"
    layout = Layout(4, 6)
    has_eeprom_tasks = False  # a parameter of its own saves what was written
    zsw_says = (
        (0x0001, 0x0001, pzd.ZSW_READY),
        (0x0804, 0x0004, pzd.ZSW_RUNNING),  # operation enabled,
        (0x0800, 0x0800, pzd.ZSW_RUNNING),  # or it turns, driven or not
        (0x0008, 0x0008, pzd.ZSW_FAULT),
        (0x0040, 0x0040, pzd.ZSW_INHIBIT),
    )


def main(board):
    with Master(board.make_link(19200), baud=19200) as bus:
        pump = bus.add(1, TurboPump, control=False)
        print("P2012 = %d, %s, ZSW %04X" % (pump.read(2012), pump.state, pump.zsw))
        bus.remove(pump)
        pump = bus.add(1, TurboPump, unsupervised=True)
        pump.run(percent=50)
        bus.wait(12)
        print("%.1f %%, %s, ZSW %04X" % (pump.percent, pump.state, pump.zsw))


if __name__ == "__main__":
    import board

    main(board)
