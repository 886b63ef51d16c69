# SPDX-License-Identifier: MIT
"""The options of --web; all others are the panel's."""

import argparse

LOCAL = "127.0.0.1"
PORT_MAX = 65535


class Misused(Exception):
    """The command line asks for something that cannot be."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Misused(message)


def options(words):
    """(what is chosen, the words that are for the panel). Misused."""
    parser = Parser(add_help=False, allow_abbrev=False)
    parser.add_argument("--web", action="store_true")
    parser.add_argument("--bind", metavar="ADDRESS")
    parser.add_argument("--web-port", metavar="N")
    parser.add_argument("--static", metavar="FOLDER")
    chosen, rest = parser.parse_known_args(words)
    if chosen.static is not None:
        for option, value in (("--bind", chosen.bind), ("--web-port", chosen.web_port)):
            if value is not None:
                raise Misused("%s is for a server: --static needs none" % option)
    for option in ("--script", "--lines"):
        if any(word == option or word.startswith(option + "=") for word in rest):
            raise Misused("%s is not for --web" % option)
    chosen.bind = chosen.bind or LOCAL
    chosen.web_port = port(chosen.web_port or "0")
    return chosen, rest


def port(text):
    if not text.isdigit() or int(text) > PORT_MAX:
        raise Misused("--web-port %s: 0...%d; 0 takes one that is free" % (text, PORT_MAX))
    return int(text)
