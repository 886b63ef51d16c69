# SPDX-License-Identifier: MIT
"""The loops over characters that the bus engine runs in every exchange, as fast as can be.

They are in machine code (`viper`) if the interpreter has it. Under CPython, and on ports of
MicroPython that compile no machine code, the same loops run in plain Python (`python`, which says
what each of them means).
"""

# The import may raise: CPython knows no viper; a port that compiles the source may have no
# emitter; a port that is handed bytecode may get that of another processor.
try:
    from uss.fast.viper import (
        agreeing, calling, copy, exclusive_or, frame, get_words, greatest, is_reply, reply_about,
        translate,
    )  # fmt: skip
except (ImportError, AttributeError, NameError, SyntaxError, ValueError):
    from uss.fast.python import (
        agreeing, calling, copy, exclusive_or, frame, get_words, greatest, is_reply, reply_about,
        translate,
    )  # fmt: skip

__all__ = (
    "agreeing", "calling", "copy", "exclusive_or", "frame", "get_words", "greatest", "is_reply",
    "reply_about", "translate",
)  # fmt: skip
