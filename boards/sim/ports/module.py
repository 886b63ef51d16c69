# SPDX-License-Identifier: MIT
"""What stands for a module: any object that has its attributes.

time = Module(ticks_us=clock.ticks_us)
"""


class Module:
    def __init__(self, **attributes):
        for name, value in attributes.items():
            setattr(self, name, value)
