# SPDX-License-Identifier: MIT
"""The menu's lists for a drive that is new: what USS needs in it, factory settings, the motor."""
