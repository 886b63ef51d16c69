# SPDX-License-Identifier: MIT
# The first statement after the restart of tools/bringup: what the driver enable does, by its
# jumper. This file is MicroPython; it takes itself off the chip.
import machine

level = machine.Pin(3, machine.Pin.IN, machine.Pin.PULL_DOWN).value()

import os  # noqa: E402

os.remove("/boot.py")
with open("/bringup/bitten", "w") as file:
    file.write(str(level))
