# SPDX-License-Identifier: MIT
"""A program of an S7-200 in its blocks, called once a scan: a ramp is written, the motor runs.

RUN is on from the third to the thirteenth second. A drive that has tripped is acknowledged first.
"""

from uss.master import Master
from uss.s7 import USS_CTRL, USS_INIT, USS_RPM_R, USS_WPM_R, Port, codes
from uss.timing import Timing, elapsed


def main(board):
    def open_bus(baud):
        return Master(board.make_link(baud), Timing(baud), clock.ticks_mask)

    clock, second = board.clock, 0
    began_ms = clock.ticks_ms()
    with Port(open_bus, clock) as port:
        init, motor = USS_INIT(port), USS_CTRL(port)
        ramp, limit = USS_WPM_R(port), USS_RPM_R(port)
        while second < 16:
            port.scan()
            init(EN=True, MODE=1, BAUD=19200, ACTIVE=0b10)
            ramp(XMT_REQ=second == 1, DRIVE=1, PARAM=1120, VALUE=2.0)
            limit(XMT_REQ=second == 2, DRIVE=1, PARAM=1082)
            motor(RUN=3 <= second < 13, F_ACK=second == 1, DRIVE=1, TYPE=1, SPEED_SP=50.0)
            now = elapsed(clock.ticks_ms(), began_ms, clock.ticks_mask) // 1000
            if now > second:
                print("%2d s  %3.0f %%  %s" % (now, motor.SPEED, codes.text(motor.ERROR)))
            second = now
            board.idle()
        print("P1120 = 2.00: %s; P1082 = %.2f" % (codes.text(ramp.ERROR), limit.VALUE))


if __name__ == "__main__":
    import board

    main(board)
