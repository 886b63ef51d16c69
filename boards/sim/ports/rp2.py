# SPDX-License-Identifier: MIT
"""The module `rp2` as far as a board file needs it to be loaded: no state machine runs here.

What the state machines do is proven on the emulated chip (tools/emulator).
"""

from boards.sim.ports.module import Module

DMA_REGISTERS = 16


def module(port):
    class StateMachine:
        def __init__(self, number, *arguments, **options):
            if number in port.claimed:
                port.refuse("state machine", number)
            self.number = number

        def init(self, *arguments, **options):
            pass

        def active(self, on=None):
            return 1

        def put(self, word, shift=0):
            pass

    class DMA:
        registers = [0] * DMA_REGISTERS

        def pack_ctrl(self, **fields):
            return 0

        def config(self, **options):
            pass

        def active(self, on=None):
            return 0

        def close(self):
            pass

    class PIO:
        OUT_LOW, OUT_HIGH, SHIFT_RIGHT, JOIN_TX = 2, 3, 1, 1

    def asm_pio(**options):
        return lambda program: program

    return Module(StateMachine=StateMachine, DMA=DMA, PIO=PIO, asm_pio=asm_pio)
