# SPDX-License-Identifier: MIT
"""Files on a flash memory whose power can be cut before every step of writing.

It behaves like littlefs: a file that is written appears with its new content when it is closed,
all at once, and rename overwrites at once (littlefs README, Usage). It has no folders and never
wears out. Its steps take as long as on the Pico; everything stands still meanwhile, interrupts
too.

    flash = Flash()
    store = FileStore("settings.json", flash.open, flash)      # in place of `open` and `os`
    flash.cut_at = flash.steps + 2
    try:
        store.replace(b"{}")
    except PowerCut:
        flash.power_on()
"""

import io

ENOENT = 2
EIO = 5
ENOSPC = 28

BLOCK_BYTES = 64  # are written in one step; small, so that there are many steps

# Winbond W25Q16JV (the Pico's), AC characteristics, typical: 0.4 ms a page, 45 ms a sector erased.
# littlefs does not erase for each of its commits; this assumes the worst case.
PROGRAM_US = 400
ERASE_US = 45_000
CAPACITY_BYTES = 1408 * 1024  # of the file system of a Pico


class PowerCut(BaseException):
    """The power is gone. It is a BaseException, so that no error handler goes on regardless."""


class Flash:
    """torn: if the power is cut while a file is written, a reader sees what had been written by
    then.

    littlefs promises better; a firmware that survives this does not need that promise. busy:
    called with the microseconds that each step takes.

    files        path -> bytes, as a reader finds them; a test may put something there
    unreadable   paths that cannot be read: OSError
    blocks_max   so many fit; a test may change it
    steps        how many were taken: a file created, a block written, a file committed
                 (close), renamed, removed
    cut_at       power is cut instead of the step with this number, counted from 0; None: never
    """

    def __init__(self, capacity_bytes=CAPACITY_BYTES, torn=False, busy=None):
        self.files = {}
        self.unreadable = ()
        self.steps = 0
        self.cut_at = None
        self.blocks_max = capacity_bytes // BLOCK_BYTES
        self._torn = torn
        self._busy = busy
        self._has_power = True
        self._writing = {}  # path -> what has been written of it and is not committed

    def power_on(self):
        self._has_power = True
        self.cut_at = None

    def open(self, path, mode):
        """OSError: ENOENT, EIO. mode: "rb" or "wb"."""
        self._need_power()
        if mode == "wb":
            if path not in self.files:
                self._step()
                self.files[path] = b""
            self._writing[path] = b""
            return _Writer(self, path)
        self._need(path)
        if path in self.unreadable:
            raise OSError(EIO)
        return io.BytesIO(self.files[path])

    def rename(self, old, new):
        self._need(old)
        self._step()
        self.files[new] = self.files.pop(old)

    def listdir(self, _folder):
        self._need_power()
        return list(self.files)

    def remove(self, path):
        self._need(path)
        self._step()
        del self.files[path]

    def write_block(self, path, block):
        """For the writer of a file. OSError: ENOSPC; what was written so far is given up."""
        self._need_power()
        if self._blocks_used() == self.blocks_max:
            del self._writing[path]
            raise OSError(ENOSPC)
        half = len(block) // 2
        self._writing[path] += block[:half]
        self._step(PROGRAM_US)
        self._writing[path] += block[half:]

    def commit(self, path):
        """For the writer of a file: what it has written replaces what was there."""
        self._step()
        self.files[path] = self._writing.pop(path)

    def _step(self, takes_us=ERASE_US + PROGRAM_US):
        self._need_power()
        if self.steps == self.cut_at:
            self._has_power = False
            if self._torn:
                self.files.update(self._writing)
            self._writing = {}
            raise PowerCut()
        self.steps += 1
        if self._busy:
            self._busy(takes_us)

    def _need_power(self):
        if not self._has_power:
            raise PowerCut()

    def _need(self, path):
        self._need_power()
        if path not in self.files:
            raise OSError(ENOENT)

    def _blocks_used(self):
        contents = list(self.files.values()) + list(self._writing.values())
        return sum(-(-len(content) // BLOCK_BYTES) for content in contents)


class _Writer:
    """A file that is being written. What does not fill a block waits in memory."""

    def __init__(self, flash, path):
        self._flash = flash
        self._path = path
        self._waiting = b""
        self._given_up = False  # the flash was full

    def write(self, data):
        self._waiting += data
        while len(self._waiting) > BLOCK_BYTES:
            self._put()
        return len(data)

    def close(self):
        if self._waiting:
            self._put()
        if not self._given_up:
            self._flash.commit(self._path)

    def _put(self):
        block, self._waiting = self._waiting[:BLOCK_BYTES], self._waiting[BLOCK_BYTES:]
        try:
            self._flash.write_block(self._path, block)
        except OSError:
            self._waiting = b""
            self._given_up = True
            raise

    def __enter__(self):
        return self

    def __exit__(self, _type, _value, _traceback):
        self.close()
