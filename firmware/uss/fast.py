"""The loops over characters that the bus engine runs in every exchange, as fast as can be.

In machine code (`fast_viper`) where the interpreter has it, or else, the same in plain Python:
under CPython, and on ports of MicroPython that compile no machine code.
"""


def exclusive_or(buffer, count):
    """Exclusive or of the first `count` characters."""
    check = 0
    for index in range(count):
        check ^= buffer[index]
    return check


def is_telegram(buffer, count, address):
    """Whether the `count` characters are a whole telegram with this ADR.

    STX and LGE stand where they should and the BCC is right; `telegram.judge` says what is wrong.
    """
    return (
        count >= 5
        and buffer[0] == 0x02
        and buffer[1] == count - 2
        and buffer[2] == address
        and exclusive_or(buffer, count) == 0
    )


def copy(source, target, at, count):
    """Put the first `count` characters of `source` into `target` from index `at` on."""
    for index in range(count):
        target[at + index] = source[index]


IN_PYTHON = (exclusive_or, is_telegram, copy)  # for the test that compares them with the others

# What importing it raises: CPython knows no viper; no emitter in a port that compiles the source,
# or one for another processor in a port that is handed bytecode.
try:
    from uss.fast_viper import copy, exclusive_or, is_telegram
except (ImportError, AttributeError, NameError, SyntaxError, ValueError):
    pass
