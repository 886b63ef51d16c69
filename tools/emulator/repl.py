# SPDX-License-Identifier: MIT
"""MicroPython's prompt on the emulated chip, by way of its USB serial.

    world = PicoWorld("stock")
    world.repl.open()                               # interrupts what runs, waits for the prompt
    world.repl.execute("print(1 + 1)")              # ("2\r\n", ""): what came of it
    world.repl.close()                              # back to the friendly prompt

The records take the world's time; no answer within `ms` of it is a ReplError.
"""

CTRL_A, CTRL_B, CTRL_C, CTRL_D = b"\x01", b"\x02", b"\x03", b"\x04"
RAW_PROMPT = b"raw REPL; CTRL-B to exit\r\n>"
PIECE_BYTES = 256
OPEN_MS = 5_000
EXECUTE_MS = 5_000


class ReplError(Exception):
    """The prompt did not answer as it should. Text: what came instead."""


class Repl:
    """world: has usb (what came), tell and run_until."""

    def __init__(self, world):
        self._world = world

    def write(self, data):
        for at in range(0, len(data), PIECE_BYTES):
            self._world.tell("U", content=data[at : at + PIECE_BYTES])

    def wait_for(self, text, ms=OPEN_MS, since=0):
        """Let time pass until `text` has come; answer what came from `since` to its end."""
        world = self._world
        if not world.run_until(lambda: world.usb.find(text, since) >= 0, ms):
            raise ReplError("no %r; what came: %r" % (text, bytes(world.usb[-500:])))
        return bytes(world.usb[since : world.usb.find(text, since) + len(text)])

    def open(self, ms=OPEN_MS):
        """Ctrl-C ends what runs; then the raw prompt."""
        self._world.usb = bytearray()
        self.write(b"\r" + CTRL_C + CTRL_C + b"\r" + CTRL_A)
        self.wait_for(RAW_PROMPT, ms)

    def close(self):
        self.write(b"\r" + CTRL_B)

    def begin(self, code):
        """Start `code` at the raw prompt, and leave it alone."""
        self._world.usb = bytearray()
        self.write(code.encode() + CTRL_D)
        self.wait_for(b"OK")

    def execute(self, code, ms=EXECUTE_MS):
        """Do `code` at the raw prompt; answer (what it printed, its traceback or "")."""
        self.begin(code)
        printed = self.wait_for(CTRL_D, ms, since=2)
        error = self.wait_for(CTRL_D + b">", ms, since=2 + len(printed))
        return printed[:-1].decode(), error[:-2].decode()
