# SPDX-License-Identifier: MIT
"""What a firmware file of the panel holds besides MicroPython: everything that runs, compiled
beforehand, in flash, and the library for Python programs. The manifest of a board includes this,
and adds its board.py.

Read by MicroPython's tools/makemanifest.py, which defines the functions used here; paths start at
this folder. A file on the chip's file system goes before a frozen one of that name, except for
main.py: so a changed board.py can be tried without building anything.
"""

import atexit
import os
import shutil
import sys
import tempfile

# For programs that the panel has no room for beside itself: they run on plain MicroPython.
LEFT_OUT = ("uss/br/", "uss/s7/", "uss/tasks/")
# Without the numbers of lines the code is a fifteenth smaller: the flash beside the file system is
# nearly full. An error of the firmware names the function.
OPT = 3

# The order in which they are frozen is part of the firmware's bytes. MicroPython looks through
# their names from the beginning, twice for a module that it loads: so those that come while the
# panel works stand first, the tables before all. In front of the others are 1.5 ms fewer to read.
ON_DEMAND = (
    "panel/menu/", "panel/lookup/", "panel/sets/", "panel/commission/", "panel/pages/",
    "panel/writer.py", "catalogue/", "uss/finding/", "settings_file.py",
)  # fmt: skip


def python_files(folder):
    found = []
    for path, _, files in os.walk(folder):
        for file in files:
            inside = os.path.relpath(os.path.join(path, file), folder)
            if file.endswith(".py") and not inside.startswith(LEFT_OUT):
                found.append((not inside.startswith(ON_DEMAND), inside))
    return [inside for _, inside in sorted(found)]


# The tables, as constants; `tools` is found from the top of the tree. What is frozen
# is compiled after this file has been read.
sys.path.insert(0, os.path.abspath("../.."))
from tools.deploying import packing  # noqa: E402

tables = tempfile.mkdtemp()
atexit.register(shutil.rmtree, tables)
for path, source in packing.modules("../../firmware").items():
    os.makedirs(os.path.join(tables, os.path.dirname(path)), exist_ok=True)
    with open(os.path.join(tables, path), "w") as file:
        file.write(source)
    freeze(tables, (path,), opt=OPT)

freeze("$(PORT_DIR)/modules", ("_boot.py", "rp2.py"))  # the port's own
freeze("../../firmware", tuple(python_files("../../firmware")), opt=OPT)
freeze("..", ("chips/rp2.py",), opt=OPT)
