# SPDX-License-Identifier: MIT
"""Finds out whether the panel has come up after a restart: the panel says so once on the serial
line.

On a real Pico the serial port goes away with the restart and comes back a little later; the chip
keeps its output in between. An emulated one keeps its port.
"""

import time

from tools.deploying.errors import DeployError

RUNS = b"USS panel: runs"  # how the line begins that firmware/main.py prints when it has started
PROMPT = b">>> "
START_S = 90  # for the panel to start; an emulated chip takes its time
KNOCK_S = 3  # between two line feeds that make a prompt show itself
POLL_S = 0.05
TRACEBACK = 600  # characters of what was heard that are shown


def wait_for_panel(open_chip, now_s=time.monotonic, sleep_s=time.sleep):
    """Returns when the panel has said that it runs; a DeployError tells what was heard instead.

    open_chip: a function that opens the line, or raises DeployError while the port is away.
    """
    deadline = now_s() + START_S
    heard = b""
    while now_s() < deadline:
        chip = None
        try:
            chip = open_chip()
            heard = _listen(chip, heard, deadline, now_s, sleep_s)
            break
        except DeployError as error:  # not there yet, or gone again
            heard += f"({error})\r\n".encode() if chip else b""
            sleep_s(POLL_S)
        finally:
            if chip:
                chip.close()
    if RUNS not in heard:
        raise DeployError(f"the panel has not started. From the chip came:\n{_shown(heard)}")


def _listen(chip, heard, deadline, now_s, sleep_s):
    """What was heard until the panel runs, or a prompt shows that it does not, or too late."""
    knock = now_s() + KNOCK_S
    while now_s() < deadline and RUNS not in heard and not heard.endswith(PROMPT):
        heard += chip.hear()
        if now_s() >= knock:
            chip.send(b"\r")
            knock = now_s() + KNOCK_S
        sleep_s(POLL_S)
    return heard


def _shown(heard):
    text = heard.decode("utf-8", "replace").replace("\r", "").strip() or "nothing"
    return "\n".join("    " + line for line in text[-TRACEBACK:].split("\n"))
