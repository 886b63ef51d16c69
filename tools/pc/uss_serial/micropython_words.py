# SPDX-License-Identifier: MIT
"""Stands for the module `micropython`, which CPython lacks: what `firmware/uss` uses of it."""


def const(value):
    return value
