# SPDX-License-Identifier: MIT
"""The version of the panel, in one place: the display shows it after power-on, every command of
tools/ tells it (--version), and the file for the Pico carries it. A release begins here, and in
.github/CHANGELOG.md. Major, minor and patch; below 1.0 a minor one may change what was promised.
"""

VERSION = "0.14.0"
