# SPDX-License-Identifier: MIT
"""Which serial port the Pico is at.

A Pico with MicroPython is a USB device of the maker and product in MICROPYTHON_RP2; one that waits
for a UF2 file (BOOTSEL) is a mass storage, has no serial port and so is not found here.
"""

from pathlib import Path

from tools.deploying.errors import DeployError

MICROPYTHON_RP2 = (0x2E8A, 0x0005)  # USB: Raspberry Pi, MicroPython
BOOTSEL = ("2e8a", "0003")  # USB: Raspberry Pi, boot ROM of the RP2040
USB_DEVICES = "/sys/bus/usb/devices"  # Linux

NO_PICO = """\
no Pico with MicroPython is plugged in. One that was never used wants MicroPython first:
    hold BOOTSEL while plugging it in, and copy a .uf2 file onto the drive RPI-RP2.
    A serial port of another kind has to be named: --port PATH"""

WAITS_FOR_UF2 = """\
the Pico has no MicroPython, or BOOTSEL was held: it waits for a .uf2 file.
    Copy one of MicroPython 1.25 or newer onto the drive RPI-RP2, or the panel's own (tools/uf2),
    which needs no tools/deploy."""


def choose(ports, waits_for_uf2=False):
    """The device of the one Pico among `ports`, as pyserial's list_ports tells them."""
    picos = [port for port in ports if (port.vid, port.pid) == MICROPYTHON_RP2]
    if len(picos) == 1:
        return picos[0].device
    if picos:
        lines = [
            f"    --port {pico.device}   serial number {pico.serial_number}" for pico in picos
        ]
        raise DeployError("\n".join(["there are several; say which is meant:", *sorted(lines)]))
    raise DeployError(WAITS_FOR_UF2 if waits_for_uf2 else NO_PICO)


def waits_for_uf2(folder=USB_DEVICES):
    """Whether a Pico is plugged in with its boot ROM running; False where that cannot be told."""
    try:
        return any(
            (_read(device, "idVendor"), _read(device, "idProduct")) == BOOTSEL
            for device in Path(folder).iterdir()
        )
    except OSError:
        return False


def _read(device, name):
    try:
        return (device / name).read_text().strip()
    except OSError:
        return ""
