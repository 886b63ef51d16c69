# SPDX-License-Identifier: MIT
"""A program of its own beside the panel: it finds the drives on a line that nobody has set up.

The panel leaves the line before, so no motor runs and all the memory is free. What the operator
takes stands in the settings afterwards, and the panel begins anew with it.
"""

# That stay in memory while it goes on.
MODULES = (
    "search.search", "search.hunt", "search.words", "uss.finding.scan", "uss.finding.enquiry",
)  # fmt: skip
