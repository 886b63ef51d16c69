# SPDX-License-Identifier: MIT
"""State machines that measure a pin, for tools/bringup. This file is MicroPython.

What they measure depends on nothing that Python does meanwhile.
"""

import rp2
from machine import Pin

MACHINE = 1  # of PIO 0: that of the display, which is not there yet
FULL = 0xFFFF_FFFF
CYCLES_PER_COUNT = 2


@rp2.asm_pio()
def high():
    """Pushes, after each pulse, FULL - the counts that the pin was high."""
    wrap_target()
    mov(x, invert(null))
    wait(0, pin, 0)
    wait(1, pin, 0)
    label("high")
    jmp(x_dec, "look")
    label("look")
    jmp(pin, "high")
    mov(isr, x)
    push(noblock)
    wrap()


@rp2.asm_pio()
def fall_to_fall():
    """Pushes FULL - the counts from a falling edge to the next one."""
    wrap_target()
    mov(x, invert(null))
    wait(1, pin, 0)
    wait(0, pin, 0)
    label("low")
    jmp(pin, "high")
    jmp(x_dec, "low")
    label("high")
    jmp(x_dec, "look")
    label("look")
    jmp(pin, "high")
    mov(isr, x)
    push(noblock)
    wrap()


class Gauge:
    """program: one of the above. number: of the pin. hz: cycles a second."""

    def __init__(self, program, number, hz):
        pin = Pin(number, Pin.IN, Pin.PULL_DOWN if program is high else Pin.PULL_UP)
        self._machine = rp2.StateMachine(MACHINE, program, freq=hz, in_base=pin, jmp_pin=pin)
        self._machine.active(1)

    def counts(self):
        """Of what was measured since the last look, four at the most."""
        machine = self._machine
        return [FULL - machine.get() for _ in range(machine.rx_fifo())]

    def close(self):
        self._machine.active(0)
