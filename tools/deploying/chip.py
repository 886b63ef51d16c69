# SPDX-License-Identifier: MIT
"""A chip with MicroPython at the end of a serial line, through mpremote's transport.

    chip = Chip("/dev/ttyACM0")
    chip.interrupt()                    # ends the program that runs; returns what was heard
    chip.enter()                        # a fresh interpreter
    chip.load()                         # with the functions of on_chip.py
    chip.call("look", ["main.py"])
    chip.write("main.py.new", data)
    chip.restart()                      # and the line is closed

Every wait has a limit; whatever goes wrong is a DeployError. The limits are wide, since an
emulated chip may be slower than a real one.
"""

import ast
import io
import os
import struct
import time
from contextlib import redirect_stdout
from pathlib import Path

import serial
from mpremote.transport import TransportError, TransportExecError
from mpremote.transport_serial import SerialTransport

from tools.deploying.errors import DeployError

OPEN_S = 2  # for another program to let go of the line
ANSWER_S = 10  # for an answer to begin, and between two characters of it
INTERRUPT_S = 5  # between two Ctrl-C; one does not disturb a panel that is stopping its drives
STOP_S = 90  # for a panel to stop 31 drives at 300 baud
POLL_S = 0.02
PIECE = 512  # bytes that are written at a time

# Ctrl-C ends a program or a half-typed line, Ctrl-B leaves the raw prompt; after either one
# MicroPython shows its prompt.
TO_THE_PROMPT = b"\r\x03\x02"
# To a panel that logs, Ctrl-C is a character like any other, see hal/serial.py.
END_LOG = b"\r# end panel\r"
PROMPT = b">>> "
RESTART = b"import machine; machine.reset()\r"

ON_CHIP = Path(__file__).with_name("on_chip.py")
LINE_ERRORS = (TransportError, serial.SerialException, OSError, struct.error)


class Chip:
    """port: path of the serial port."""

    def __init__(self, port):
        self.port = port
        self._line = _open(port)

    def close(self):
        try:
            self._line.close()
        except LINE_ERRORS:  # it has gone
            pass

    def interrupt(self):
        """End whatever runs, by Ctrl-C; what was heard until the prompt."""
        self.hear()  # what was said before does not count
        heard = ends_log = b""
        deadline = time.monotonic() + STOP_S
        while not heard.endswith(PROMPT):
            if time.monotonic() > deadline:
                raise DeployError(f"{self.port} comes to no prompt by Ctrl-C: {_shown(heard)}")
            self.send(TO_THE_PROMPT)
            self.send(ends_log)
            ends_log = END_LOG
            heard += self._hear_until(PROMPT, INTERRUPT_S)
        return heard.decode("utf-8", "replace")

    def enter(self):
        """A fresh interpreter at the raw prompt: nothing of an earlier program is left in it."""
        try:
            with silence():
                self._line.enter_raw_repl(soft_reset=True, timeout_overall=ANSWER_S)
        except LINE_ERRORS as error:
            raise DeployError(f"{self.port} does not come to the raw prompt: {error}") from None

    def execute(self, code):
        """Run it; what it printed."""
        try:
            with silence():
                printed, failed = self._line.exec_raw(code, timeout=ANSWER_S)
        except LINE_ERRORS as error:
            raise DeployError(f"{self.port} does not answer any more: {error}") from None
        if failed:
            raise DeployError(f"on the chip: {_last_line(failed.decode('utf-8', 'replace'))}")
        return printed.decode("utf-8", "replace")

    def begin(self, code):
        """Start it at the raw prompt, and leave it alone."""
        try:
            self._line.exec_raw_no_follow(code)
        except LINE_ERRORS as error:
            raise DeployError(f"{self.port} does not answer any more: {error}") from None

    def load(self):
        """Load the functions of on_chip.py into the interpreter."""
        self.execute('import os\nos.chdir("/")')
        self.execute(ON_CHIP.read_text())

    def evaluate(self, expression):
        """The value of an expression, which must consist of Python literals."""
        try:
            return ast.literal_eval(self.execute(f"print(repr({expression}))").strip())
        except (ValueError, SyntaxError):
            raise DeployError(f"what answers at {self.port} does not speak Python") from None

    def call(self, function, *arguments):
        """Call a function of on_chip.py; what it answered."""
        words = ", ".join(repr(argument) for argument in arguments)
        return self.evaluate(f"{function}({words})")

    def read(self, path):
        """The bytes of a file that is there, piece by piece."""
        try:
            with silence():
                return bytes(self._line.fs_readfile(path, chunk_size=PIECE))
        except TransportExecError as error:
            reason = _last_line(error.error_output)
            raise DeployError(f"{path} cannot be read: {reason}") from None
        except LINE_ERRORS as error:
            raise DeployError(f"{path} could not be read: {error}") from None

    def write(self, path, data):
        """Write these bytes to a new file, which replaces no other."""
        try:
            with silence():
                self._line.fs_writefile(path, data, chunk_size=PIECE)
        except TransportExecError as error:
            reason = _last_line(error.error_output)
            raise DeployError(f"{path} cannot be written: {reason}") from None
        except LINE_ERRORS as error:
            raise DeployError(f"{path} could not be written: {error}") from None

    def restart(self):
        """Restart the chip as at power-on. This closes the line, because USB goes with the
        chip."""
        try:
            self.interrupt()
            self.send(RESTART)
            self._line.serial.flush()
        except LINE_ERRORS as error:
            raise DeployError(f"{self.port} could not be restarted: {error}") from None
        finally:
            self.close()

    def send(self, data):
        try:
            self._line.serial.write(data)
        except LINE_ERRORS as error:
            raise DeployError(f"{self.port} has gone: {error}") from None

    def hear(self):
        """The characters that have come."""
        try:
            count = self._line.serial.in_waiting
            return self._line.serial.read(count) if count else b""
        except LINE_ERRORS as error:
            raise DeployError(f"{self.port} has gone: {error}") from None

    def _hear_until(self, ending, limit_s):
        heard = b""
        deadline = time.monotonic() + limit_s
        while time.monotonic() < deadline and not heard.endswith(ending):
            heard += self.hear() or _pause()
        return heard


def silence():
    """mpremote prints what it could not understand, besides raising an error."""
    return redirect_stdout(io.StringIO())


def _pause():
    time.sleep(POLL_S)
    return b""


def _open(port):
    """The transport; a DeployError says what a person can do."""
    if not os.path.exists(port):
        raise DeployError(f"there is no {port}")
    if not os.access(port, os.R_OK | os.W_OK):
        raise DeployError(
            f"{port} may not be used by you: sudo usermod -a -G dialout $USER, then log in again"
        )
    deadline = time.monotonic() + OPEN_S
    while True:
        try:
            return SerialTransport(port, timeout=ANSWER_S)
        except LINE_ERRORS:
            if time.monotonic() > deadline:
                raise DeployError(
                    f"{port} cannot be opened: another program uses it, or it is no serial port"
                ) from None
            _pause()


def _last_line(traceback):
    return traceback.strip().rpartition("\n")[2]


def _shown(heard):
    if not heard:
        return "it is silent"
    return repr(heard[-80:].decode("ascii", "replace"))
