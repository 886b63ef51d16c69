# SPDX-License-Identifier: MIT
"""Puts the modules of a port in place of those of the interpreter, for the board file alone.

`machine`, `time`, `sys`, `micropython` and `rp2` are those of the port while a board file and its
`chips` are loaded; afterwards the interpreter has its own back. What they bound stays bound.
"""

import sys

import micropython

from boards.sim.ports import rp2
from boards.sim.ports.module import Module

NAMES = ("machine", "time", "sys", "micropython", "rp2")
# They bind such modules.
LOADED = ("chips", "hal.link.rp2_rs485", "hal.link.rp2_going_on", "hal.display.rp2_hd44780")


def install(port):
    """The modules of the port, from now on; answers those that were there before."""
    before = {name: sys.modules.get(name) for name in NAMES}
    sys.modules.update(modules_of(port))
    forget()
    return before


def restore(before):
    for name, module in before.items():
        if module is None:
            sys.modules.pop(name, None)
        else:
            sys.modules[name] = module


def forget():
    """Let the next import load these anew."""
    for name in list(sys.modules):
        if name == "board" or any(name == one or name.startswith(one + ".") for one in LOADED):
            sys.modules.pop(name)


def modules_of(port):
    clock = port.clock

    def sleep_ms(ms):
        if port.sleep_loop is None:
            clock.advance(ms * 1000)
        else:
            port.sleep_loop()

    def sleep_us(us):
        clock.advance(us)

    machine = Module(
        Pin=port.Pin,
        UART=port.UART,
        Timer=port.Timer,
        WDT=port.WDT,
        I2C=port.I2C,
        mem32=port.mem32,
        WDT_RESET=port.WDT_RESET,
        reset_cause=lambda: port.reset_word,
    )
    time = Module(
        ticks_us=clock.ticks_us, ticks_ms=clock.ticks_ms, sleep_ms=sleep_ms, sleep_us=sleep_us
    )
    own_sys = Module(implementation=Module(_machine=port.model.machine), modules=sys.modules)
    modules = {"machine": machine, "time": time, "sys": own_sys}
    language = Module(alloc_emergency_exception_buf=lambda size: None)
    for name in dir(micropython):
        if not name.startswith("_"):
            setattr(language, name, getattr(micropython, name))
    modules["micropython"] = language
    if port.model.port == "rp2":
        modules["rp2"] = rp2.module(port)
    return modules
