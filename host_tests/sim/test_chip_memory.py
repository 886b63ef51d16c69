# SPDX-License-Identifier: MIT
"""The simulated chip locks the heap while a hard interrupt runs, as MicroPython does."""

from boards.sim.chip.machine import UART, Chip, Pin, Timer
from boards.sim.clock import Clock
from boards.sim.line.wire import Transceiver, Wire

INTERPRETERS = "unix64 unix32"


class Neighbour:
    name = "neighbour"

    def hear(self, burst):
        pass


def test_a_hard_handler_cannot_take_heap_and_a_soft_one_can():
    clock = Clock()
    wire = Wire(clock, 19200)
    chip = Chip(clock, wire)
    uart, neighbour = UART(chip, 19200), Neighbour()
    Transceiver(wire, uart, Pin(chip))
    wire.attach(neighbour)
    interrupts = []

    def greedy(source):
        interrupts.append([clock.now_us])

    timer = Timer(chip)
    timer.init(mode=Timer.ONE_SHOT, period=1, callback=greedy, hard=False)
    clock.advance(2000)
    assert interrupts == [[1000]] and chip.handler_errors == []
    timer.init(mode=Timer.ONE_SHOT, period=1, callback=greedy, hard=True)
    clock.advance(2000)
    uart.irq(greedy, UART.IRQ_RXIDLE, hard=True)
    wire.talk(neighbour, b"sixteen letters.", 16)
    clock.advance(20_000)
    assert len(interrupts) == 1
    assert [type(error) for error in chip.handler_errors] == [MemoryError, MemoryError]
    interrupts.append([0])  # the heap is open again
