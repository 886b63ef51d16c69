# SPDX-License-Identifier: MIT
"""Files on the Pico's flash, put there and read from outside: an image of 2 MiB in memory.

MicroPython's board RPI_PICO keeps its littlefs in the last 1408 KiB (FLASH_STORAGE_BYTES of its
mpconfigboard.h), in blocks of 4096 bytes that are programmed 256 bytes at a time (_boot.py).
Runs on the Unix port, whose littlefs is the same code.

    image = FlashImage()                # erased
    image.write("settings.json", b"{}")
    image.save("build/pico.flash")
    FlashImage("build/pico.flash").read("settings.json")
"""

import os

import vfs

FLASH_BYTES = 2 * 1024 * 1024
FILES_AT = FLASH_BYTES - 1408 * 1024
BLOCK_BYTES = 4096
PAGE_BYTES = 256

# Commands of MicroPython's block devices (vfs.AbstractBlockDev).
BLOCK_COUNT, BLOCK_SIZE, BLOCK_ERASE = 4, 5, 6

ENOENT = 2
FOLDER = 0x4000  # kind of an entry of ilistdir


class FlashImage:
    """path: of an image to begin with; None: an erased flash. ValueError: it is none."""

    def __init__(self, path=None):
        self._files = None
        self._flash = bytearray(FLASH_BYTES)
        if path is None:
            erased = b"\xff" * BLOCK_BYTES
            for at in range(0, FLASH_BYTES, BLOCK_BYTES):
                self._flash[at : at + BLOCK_BYTES] = erased
            vfs.VfsLfs2.mkfs(self, progsize=PAGE_BYTES)
            return
        with open(path, "rb") as file:
            if file.readinto(self._flash) != FLASH_BYTES or file.read(1):
                raise ValueError("%s is no image of the Pico's flash of 2 MiB" % path)

    def read(self, path):
        """The content of a file, None where there is none. OSError: the file system is damaged."""
        try:
            with self._mounted().open(path, "rb") as file:
                return file.read()
        except OSError as error:
            if error.args[0] == ENOENT:
                return None
            raise

    def write(self, path, content):
        """Put a file there, in place of one of that name, in folders that are made."""
        files = self._mounted()
        parts = path.split("/")
        for depth in range(1, len(parts)):
            try:
                files.mkdir("/".join(parts[:depth]))
            except OSError:  # it is there
                pass
        with files.open(path, "wb") as file:
            file.write(content)

    def blocks(self):
        """What stands in the flash from the file system's first block to its end."""
        return memoryview(self._flash)[FILES_AT:]

    def names(self):
        """The names of what stands in the top folder, sorted."""
        return sorted(entry[0] for entry in self._mounted().ilistdir("/"))

    def save(self, path):
        with open(path, "wb") as file:
            file.write(self._flash)

    def _mounted(self):
        if self._files is None:
            # Without the instants of the host: they make each image another one, and with them a
            # chip takes another time for the check (CRC) of its blocks.
            self._files = vfs.VfsLfs2(self, progsize=PAGE_BYTES, mtime=False)
        return self._files

    # A block device, for littlefs

    def readblocks(self, block, buffer, offset=0):
        at = FILES_AT + block * BLOCK_BYTES + offset
        buffer[:] = memoryview(self._flash)[at : at + len(buffer)]

    def writeblocks(self, block, buffer, offset=None):
        if offset is None:
            self.ioctl(BLOCK_ERASE, block)
            offset = 0
        at = FILES_AT + block * BLOCK_BYTES + offset
        self._flash[at : at + len(buffer)] = buffer

    def ioctl(self, command, block):
        if command == BLOCK_COUNT:
            return (FLASH_BYTES - FILES_AT) // BLOCK_BYTES
        if command == BLOCK_SIZE:
            return BLOCK_BYTES
        if command == BLOCK_ERASE:
            at = FILES_AT + block * BLOCK_BYTES
            self._flash[at : at + BLOCK_BYTES] = b"\xff" * BLOCK_BYTES
        return 0


def files_in(folder, within=""):
    """{path: content} of all that is in a folder of the host."""
    files = {}
    for name, kind, *_ in os.ilistdir(folder):
        if kind == FOLDER:
            files.update(files_in(folder + "/" + name, within + name + "/"))
        else:
            with open(folder + "/" + name, "rb") as file:
                files[within + name] = file.read()
    return files
