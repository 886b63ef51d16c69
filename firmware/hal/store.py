# SPDX-License-Identifier: MIT
"""Files that survive power cuts, on a file system whose rename overwrites at once.

Fulfils the contract `store` of `hal`. It writes new data to a file beside the old one, and a
rename puts that in its place: littlefs, which the ports for the RP2040 and the ESP32 use, promises
that either the old or the new file is there afterwards (littlefs README, Usage). FAT promises
nothing of the kind. If a power cut leaves a file beside the old one, it is never read, and the
next write replaces it.

    store = FileStore("settings.json", open, os)
    store.replace(b"{}")                    # the small file that it is about

    file = store.begin()                    # a larger one beside it, written piece by piece
    file.write(b"...")
    store.finish(file, "1.set")
"""

from micropython import const

_PIECE = const(256)
_ENOENT = const(2)
_COPY_MAX = const(4096)  # bytes: a chip has to hold it
_UNFINISHED = "unfinished.new"


class FileStore:
    """path: of the file, in a folder that is there. open, os: those of Python.

    Beside the file there may be path + ".new", an unfinished one, and path + ".bad", one that was
    set aside.
    """

    def __init__(self, path, open, os):
        self._path = path
        self._open = open
        self._os = os

    def read(self, most=-1):
        return self._read(self._path, most)

    def replace(self, data):
        self._put(self._path, data)

    def set_aside(self):
        """Keep a copy as path + ".bad", in place of an earlier one.

        A copy, because power may be cut between moving the file away and writing the next one.
        Only a file that cannot be read, or is too big to copy, is moved.
        """
        try:
            data = self.read(_COPY_MAX + 1)
            is_copied = data is None or len(data) <= _COPY_MAX
        except OSError:
            data, is_copied = None, False
        if not is_copied:
            self._os.rename(self._path, self._path + ".bad")
        elif data is not None:
            self._put(self._path + ".bad", data)

    # --- larger files beside it -----------------------------------------------------------------

    def names(self, ending):
        names = self._os.listdir(self._beside("") or ".")
        return sorted([name for name in names if name.endswith(ending)])

    def open(self, name):
        return self._open(self._beside(name), "rb")

    def begin(self):
        return self._open(self._beside(_UNFINISHED), "wb")

    def finish(self, file, name):
        file.close()
        self._os.rename(self._beside(_UNFINISHED), self._beside(name))

    def remove(self, name):
        self._os.remove(self._beside(name))

    def _beside(self, name):
        folder, slash, _ = self._path.rpartition("/")
        return folder + slash + name

    def _read(self, path, most):
        try:
            with self._open(path, "rb") as file:
                return _whole(file, most)
        except OSError as error:
            if error.args[0] == _ENOENT:
                return None
            raise

    def _put(self, path, data):
        if self._holds(path, data):
            return  # the same data: do not wear the flash
        new = self._path + ".new"
        try:
            with self._open(new, "wb") as file:
                file.write(data)
            self._os.rename(new, path)
        except OSError:
            self._remove(new)  # there is little room
            raise

    def _holds(self, path, data):
        try:
            return self._read(path, len(data) + 1) == data
        except OSError:  # a file that cannot be read does not hold these data
            return False

    def _remove(self, path):
        try:
            self._os.remove(path)
        except OSError:
            pass


def _whole(file, most):
    """The content of a file, at most `most` bytes of it; below 0: all. It is read in pieces,
    because a read takes one piece of memory for all that it may bring, and a chip may not have
    that."""
    data = b""
    while len(data) != most:
        piece = file.read(_PIECE if most < 0 else min(_PIECE, most - len(data)))
        if not piece:
            break
        data += piece
    return data
