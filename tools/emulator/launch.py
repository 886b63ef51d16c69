#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Starts the emulated Pico beside a program, and ends with it.

    python3 tools/emulator/launch.py PROGRAM ARGUMENTS...

PROGRAM (a MicroPython of the Unix port with its script) has the caller's terminal. Signals that
are meant for it reach it, its exit status is this one's. It finds in its environment

    USS_PICO_READ, USS_PICO_WRITE   the numbers of two descriptors: the records of README.md
    USS_PICO_SERIAL                 the path of a pty that is the chip's USB serial port

The chip is a process of node. In whatever way PROGRAM ends, the pipe that node reads ends with it,
and so do node and the pty. When this process is killed, PROGRAM is killed as well.
"""

import ctypes
import fcntl
import os
import pty
import resource
import shutil
import signal
import subprocess
import sys
import tty

HERE = os.path.dirname(os.path.abspath(__file__))
SERVER = os.path.join(HERE, "main.mjs")
NODE = os.path.join(HERE, "..", "..", "build", "node", "node")  # else the one that is installed
NOT_FOUND = 127  # the exit status of a shell whose command is not there
NODE_ENDS_S = 1.0  # after this it is killed
MAKES_BLOCKS = "USS_EMULATOR_BLOCKS"  # in the environment: node ends by writing blocks

PASSED_ON = {signal.SIGINT, signal.SIGQUIT, signal.SIGTERM, signal.SIGHUP}
PASSED_ON |= {signal.SIGUSR1, signal.SIGUSR2}
AWAITED = PASSED_ON | {signal.SIGCHLD}
FROM_KERNEL = 128  # si_code of a signal that the terminal sent: to PROGRAM too
PR_SET_PDEATHSIG = 1


def main(command):
    if not command:
        return _refuse("what is to be started? launch.py PROGRAM ARGUMENTS...", 2)
    node = shutil.which(NODE) or shutil.which("node")
    if node is None:
        return _refuse("there is no node:  apt-get install nodejs npm", NOT_FOUND)
    # Signals are taken one by one below; both children begin without that.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, AWAITED)
    chip, descriptors = _start_chip(node, before)
    try:
        program = _start_program(command, descriptors, before)
    except OSError as error:
        program = None
        _refuse("%s: %s" % (command[0], error.strerror), NOT_FOUND)
    for descriptor in descriptors:
        os.close(descriptor)
    status = NOT_FOUND if program is None else _accompany(program)
    _end(chip)
    return status


def _start_chip(node, mask):
    """Start node. Returns its process and PROGRAM's descriptors: from it, to it, the pty's slave.

    PROGRAM keeps the slave open, so that the pty outlives those who use it.
    """
    from_program, to_chip = os.pipe()
    from_chip, to_program = os.pipe()
    master, slave = pty.openpty()
    tty.setraw(slave)
    fcntl.fcntl(master, fcntl.F_SETFL, fcntl.fcntl(master, fcntl.F_GETFL) | os.O_NONBLOCK)
    inherited = (from_program, to_program, master)
    chip = subprocess.Popen(
        [node, SERVER, *map(str, inherited)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        pass_fds=inherited,
        start_new_session=True,  # Ctrl-C in the terminal is not for it
        preexec_fn=lambda: signal.pthread_sigmask(signal.SIG_SETMASK, mask),
    )
    for descriptor in inherited:
        os.close(descriptor)
    return chip, (from_chip, to_chip, slave)


def _start_program(command, descriptors, mask):
    read, write, serial = descriptors
    names = {
        "USS_PICO_READ": str(read),
        "USS_PICO_WRITE": str(write),
        "USS_PICO_SERIAL": os.ttyname(serial),
    }
    prctl = getattr(ctypes.CDLL(None), "prctl", None)

    def prepare():
        if prctl is not None:
            prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)

    return subprocess.Popen(
        command, pass_fds=descriptors, env={**os.environ, **names}, preexec_fn=prepare
    )


def _accompany(program):
    """Wait until PROGRAM ends; hand on what is sent to this process alone. Returns its status."""
    while program.poll() is None:
        news = signal.sigwaitinfo(AWAITED)
        if news.si_signo in PASSED_ON and news.si_code != FROM_KERNEL:
            program.send_signal(news.si_signo)
    return program.returncode


def _end(chip):
    """The pipe to node has ended. It is alone with that, unless it is deep in a long run."""
    try:
        chip.wait(None if MAKES_BLOCKS in os.environ else NODE_ENDS_S)
    except subprocess.TimeoutExpired:
        chip.kill()
        chip.wait()


def _refuse(reason, status):
    print("launch.py: " + reason, file=sys.stderr)
    return status


def _leave(status):
    """End as PROGRAM did: with its exit status, or by the signal that ended it."""
    if status < 0:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if -status not in (signal.SIGKILL, signal.SIGSTOP):
            signal.signal(-status, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {-status})
        os.kill(os.getpid(), -status)
    sys.exit(status)


if __name__ == "__main__":
    _leave(main(sys.argv[1:]))
