# SPDX-License-Identifier: MIT
"""What a key may ask for any time: it stays loaded where there is room (`on_demand.keep`)."""

# From the bottom of the house up: an import inside an import inside an import takes stack.
NAMES = (
    "panel.pages.parameter_words", "panel.writer", "panel.pages.question", "panel.pages.risk",
    "panel.pages.writing", "panel.pages.parameters", "panel.menu.words", "panel.menu.engine",
    "panel.menu.main", "uss.families.kinds", "settings_file", "uss.finding", "uss.finding.mirror",
    "panel.menu.address", "catalogue",
)  # fmt: skip
