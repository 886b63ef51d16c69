# SPDX-License-Identifier: MIT
"""The lists of parameter sets. `panel.sets` does the work."""
