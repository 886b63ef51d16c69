# SPDX-License-Identifier: MIT
"""Line coverage of firmware/, from the lines that the cpython tier saw run.

Each process notes them (cpython/line_notes.py); here the library `coverage` makes one table of
them.
"""

import io
from collections import defaultdict
from pathlib import Path

# Where no line is ever seen, and why.
UNSEEN = (
    "hal/*/rp2_*.py",  # runs on the chip alone: tier pico
    "uss/fast/viper.py",  # machine code
)


class LineCoverage:
    def __init__(self, top: Path):
        self.top = top
        self.seen = defaultdict(set)  # file, from the top of the tree -> line numbers

    def note(self, file, numbers):
        self.seen[file].update(numbers)

    def report(self):
        """The lines of the table, the total last."""
        from coverage import Coverage  # here: a pytest that runs one file need not wait for it

        firmware = self.top / "firmware"
        coverage = Coverage(None, config_file=False)
        data = coverage.get_data()
        data.add_lines({str(self.top / file): lines for file, lines in self.seen.items()})
        data.touch_files(map(str, firmware.rglob("*.py")))
        table = io.StringIO()
        omitted = [str(firmware / pattern) for pattern in UNSEEN]
        coverage.report(show_missing=True, omit=omitted, file=table)
        return table.getvalue().splitlines()
