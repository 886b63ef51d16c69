# SPDX-License-Identifier: MIT
"""The serial ports of this computer."""


def ports():
    """[(path, what the system calls it)]"""
    from serial.tools.list_ports import comports

    return [(port.device, port.description) for port in sorted(comports())]
