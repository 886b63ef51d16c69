# SPDX-License-Identifier: MIT
"""What drives report, and what has happened: the fault and the warning of a drive, the journal."""
