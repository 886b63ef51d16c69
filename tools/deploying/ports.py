# SPDX-License-Identifier: MIT
"""Which serial port the chip is at.

Chips with USB of their own are known by its maker and product (targets.py); a Pico that waits for
a UF2 file (BOOTSEL) is a mass storage, has no serial port and so is not found here. Behind a USB
adapter may be anything, such as the line of the drives: nothing is sent there unasked.
"""

from pathlib import Path

from tools.deploying.errors import DeployError
from tools.deploying.targets import TARGETS, USUAL

BOOTSEL = ("2e8a", "0003")  # USB: Raspberry Pi, boot ROM of the RP2040
USB_DEVICES = "/sys/bus/usb/devices"  # Linux

NO_PICO = """\
no Pico with MicroPython is plugged in. One that was never used wants MicroPython first:
    hold BOOTSEL while plugging it in, and copy a .uf2 file onto the drive RPI-RP2.
    A serial port of another kind has to be named: --port PATH"""

NO_ESP32 = """\
no %s with MicroPython is plugged in, or it is behind a USB adapter: name that, --port PATH.
    One that was never used wants MicroPython first: esptool writes it (boards/README.md)."""

WAITS_FOR_UF2 = """\
the Pico has no MicroPython, or BOOTSEL was held: it waits for a .uf2 file.
    Copy one of MicroPython 1.25 or newer onto the drive RPI-RP2, or the panel's own (tools/uf2),
    which needs no tools/deploy."""


def choose(ports, waits_for_uf2=False, chip=USUAL):
    """The device of the one such chip among `ports`, as pyserial's list_ports tells them."""
    target = TARGETS[chip]
    picos = [port for port in ports if target.usb and (port.vid, port.pid) == target.usb]
    if len(picos) == 1:
        return picos[0].device
    if picos:
        lines = [
            f"    --port {pico.device}   serial number {pico.serial_number}" for pico in picos
        ]
        raise DeployError("\n".join(["there are several; say which is meant:", *sorted(lines)]))
    if target.machine_code == "xtensawin":
        raise DeployError(NO_ESP32 % target.called)
    raise DeployError(WAITS_FOR_UF2 if waits_for_uf2 else NO_PICO)


def choose_any(ports, waits_for_uf2=False):
    """As `choose`, whichever chip it is."""
    known = {target.usb: chip for chip, target in TARGETS.items() if target.usb}
    there = [known[port.vid, port.pid] for port in ports if (port.vid, port.pid) in known]
    if len({*there}) > 1:
        raise DeployError("there are several boards: say which is meant, --port PATH")
    return choose(ports, waits_for_uf2, there[0] if there else USUAL)


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
