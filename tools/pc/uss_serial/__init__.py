# SPDX-License-Identifier: MIT
"""USS on the serial port of a PC: the bus master of `firmware/uss` under CPython.

    from uss_serial import Master, SerialLink

    with Master(SerialLink("/dev/ttyUSB0", 19200), baud=19200) as bus:
        drive = bus.add(1)
        print(drive.read(700))

What __all__ names stays; everything else may change. README.md beside this folder says what
becomes of a motor when your program hangs or dies.
"""

import importlib
import sys
from pathlib import Path

_TOP = Path(__file__).resolve().parents[3]
if (_TOP / "firmware" / "uss").is_dir():  # in the project itself; pip has put all of it together
    sys.path += [path for path in (str(_TOP / "firmware"),) if path not in sys.path]
    __path__.append(str(_TOP / "tools"))  # uss_serial.port is tools/port

from uss_serial import micropython_words  # noqa: E402

sys.modules.setdefault("micropython", micropython_words)

# Loaded when they are named for the first time: the keeper of the port needs none of them.
_HOMES = {"Master": "master", "PortError": "port.errors", "SerialLink": "link", "ports": "listing"}
__all__ = ("Master", "PortError", "SerialLink", "ports")


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError("uss_serial has no %s" % name)
    return getattr(importlib.import_module("uss_serial." + _HOMES[name]), name)
