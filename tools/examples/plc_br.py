# SPDX-License-Identifier: MIT
"""A program in the blocks of the B&R project, called once a scan: the motor runs, and turns round.

Run is on from the third to the thirteenth second. A drive that has tripped is acknowledged first.
"""

from uss.br import DriveController, codes
from uss.master import Master
from uss.timing import Timing, elapsed


def main(board):
    def open_bus():
        return Master(board.make_link(19200), Timing(19200), clock.ticks_mask)

    clock, second = board.clock, 0
    began_ms = clock.ticks_ms()
    with DriveController(open_bus, clock) as controller:
        controller.DriveSequence.ControllSequence[1] = 1
        controller.DriveSetup[1].Lengh.PKW_lengh = 4  # a MICROMASTER 420; 127 for a G110
        wanted, told = controller.DriveSetup[1].PZD, controller.DriveData[1]
        while second < 16:
            controller.Cmd.Start = second >= 1
            wanted.FaultAcknowledge = second == 2
            wanted.Run, wanted.Freq = 3 <= second < 13, 10.0 if second < 8 else -10.0
            controller()
            now = elapsed(clock.ticks_ms(), began_ms, clock.ticks_mask) // 1000
            if now > second:
                print("%2d s  %5.1f Hz" % (now, told.ActualValue.Freq))
            second = now
            board.idle()
        print(codes.text(controller.Status.ErrorID) or "no error")


if __name__ == "__main__":
    import board

    main(board)
