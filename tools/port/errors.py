# SPDX-License-Identifier: MIT
"""What may be wrong with a port; the text says it in words, and what helps."""


class PortError(Exception):
    """The port cannot be had."""


class LineCut(Exception):
    """The port has gone: its adapter was unplugged, or the other end of a pty closed."""
