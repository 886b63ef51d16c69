# SPDX-License-Identifier: MIT
"""The loops over characters that the bus engine runs in every exchange, as fast as can be.

In machine code (`viper`) where the interpreter has it, or else, the same in plain Python
(`python`, which says what each of them means): under CPython, and on ports of MicroPython
that compile no machine code.
"""

# What importing it raises: CPython knows no viper; no emitter in a port that compiles the source,
# or one for another processor in a port that is handed bytecode.
try:
    from uss.fast.viper import (
        agreeing, calling, copy, exclusive_or, frame, get_words, greatest, is_reply, reply_about,
    )  # fmt: skip
except (ImportError, AttributeError, NameError, SyntaxError, ValueError):
    from uss.fast.python import (
        agreeing, calling, copy, exclusive_or, frame, get_words, greatest, is_reply, reply_about,
    )  # fmt: skip

__all__ = (
    "agreeing", "calling", "copy", "exclusive_or", "frame", "get_words", "greatest", "is_reply",
    "reply_about",
)  # fmt: skip
