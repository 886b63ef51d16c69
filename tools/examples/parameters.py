# SPDX-License-Identifier: MIT
"""Parameters of a drive: read, written into RAM and into EEPROM, and a refusal.

While a call waits for its answer, the bus goes on.
"""

from uss import pkw
from uss.bus import Master, Refused
from uss.families import MM420


def main(board):
    with Master(board.make_link(19200), baud=19200) as bus:
        drive = bus.add(1, MM420)
        print("P0700 =", drive.read(700), "and P1082 = %.2f Hz" % drive.read(1082))
        print("RAM: P1120 = %.1f s" % drive.write(1120, 5.0))
        print("EEPROM as well: P1121 = %.1f s" % drive.write(1121, 8.0, eeprom=True))
        try:
            drive.write(1082, 900.0)
        except Refused as refusal:
            print(refusal, "(error %d)" % refusal.number)
        job = pkw.read(2010, index=1)  # if you cannot wait, ask, and look later
        drive.ask(job)
        while job.state == pkw.PENDING:
            bus.rest()
        print("P2010[1] =", job.integer_value())


if __name__ == "__main__":
    import board

    main(board)
