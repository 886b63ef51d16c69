# SPDX-License-Identifier: MIT
"""An HD44780 on four data lines of the RP2040: a PIO state machine moves the pins and waits.

Fulfils the contract `display` of `hal` as `hd44780.Hd44780` does, which takes 250 us for each
byte on this chip, most of it waiting. Here a byte is a word for the state machine, and the loop
goes on. Register select, enable and D4...D7 are six pins in a row, in this order.

    display = PioHd44780(4, Pin(7), Pin(8), clock)      # state machine, register select, enable

Runs on the chip alone; it is proven on the emulated one.
"""

import rp2
from micropython import const

from hal.display.character_display import CharacterDisplay

_CYCLES_HZ = const(1_000_000)  # of the state machine: its waits are microseconds

# The wait after a byte, and after a nibble while the controller is set up.
_BYTE_US = const(61)
_NIBBLE_US = const(100)
_BACKLOG_US = const(700)  # a full FIFO takes so long, so the wait for a command may begin so late


@rp2.asm_pio(
    out_init=(rp2.PIO.OUT_LOW,) * 6,
    sideset_init=rp2.PIO.OUT_LOW,
    out_shiftdir=rp2.PIO.SHIFT_RIGHT,
    fifo_join=rp2.PIO.JOIN_TX,
)
def nibbles():
    """From bit 0 of a word: nibbles - 1; for each of them the six pins; 7 bits of wait in us.

    Enable is one of the six and always 0 there: the side-set raises it 1 us after the others.
    """
    pull(block).side(0)
    out(y, 1).side(0)
    label("nibble")
    out(pins, 6).side(0)
    nop().side(1)[1]
    jmp(y_dec, "nibble").side(0)
    out(x, 7).side(0)
    label("wait")
    jmp(x_dec, "wait").side(0)


class PioHd44780(CharacterDisplay):
    """state_machine_number: 0...7. register_select, enable: Pins. clock: contract of `hal`."""

    bytes_per_piece = 5  # 0.5 ms of computing; the FIFO takes 8, more would have to wait
    cells_per_piece = 16  # another 0.2 ms

    def __init__(self, state_machine_number, register_select, enable, clock):
        state_machine = rp2.StateMachine(
            state_machine_number,
            nibbles,
            freq=_CYCLES_HZ,
            out_base=register_select,
            sideset_base=enable,
        )
        state_machine.active(1)
        self._put = state_machine.put
        CharacterDisplay.__init__(self, clock)

    def _byte(self, register, code):
        high = register | code >> 2 & 0x3C
        low = register | code << 2 & 0x3C
        self._put(1 | high << 1 | low << 7 | _BYTE_US << 13)

    def _nibble(self, register, code):
        self._put((register | code >> 2 & 0x3C) << 1 | _NIBBLE_US << 7)

    def _pause(self, us):
        """Nothing: the state machine makes the pauses itself."""

    def _come_back_after(self, wait_us):
        CharacterDisplay._come_back_after(self, wait_us + _BACKLOG_US)

    def _end_piece(self):
        return True
