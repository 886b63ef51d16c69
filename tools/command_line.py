# SPDX-License-Identifier: MIT
"""A command line, and what is wrong with it in one sentence.

    parser = Parser(prog="tools/soak", description="...")
    parser.add_argument("--jobs", type=count(1, 1000))
    parser.error("--jobs: 0 is not 1...1000")       # tools/soak: --jobs: 0 is not 1...1000

argparse puts all options in front of what it has to say. Here --help lists them.
"""

import argparse

NOT_UNDERSTOOD = 2  # exit status


class Parser(argparse.ArgumentParser):
    def error(self, message):
        message = message.removeprefix("argument ")
        self.exit(NOT_UNDERSTOOD, f"{self.prog}: {message}\n")


def count(low, high):
    """Type of an argument: an integer from low to high."""

    def understand(word):
        try:
            number = int(word)
        except ValueError:
            raise argparse.ArgumentTypeError("%s is no whole number" % word) from None
        if not low <= number <= high:
            raise argparse.ArgumentTypeError("%s is not %d...%d" % (word, low, high))
        return number

    return understand
