# SPDX-License-Identifier: MIT
"""What the firmware file of this board holds: tools/uf2 builds it."""

include("../chips/manifest.py")
module("board.py")
