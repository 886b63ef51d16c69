# SPDX-License-Identifier: MIT
"""The file that keeps the settings: power cuts at every step of writing, a full flash, real files.

"Old or new" is the promise; a panel that comes up with the defaults would look for its drives at
other addresses.
"""

import os

import main
import settings_file as settings
from boards.sim.chip.flash import BLOCK_BYTES, ENOSPC, Flash, PowerCut
from boards.sim.world import SETTINGS_FILE, World
from hal.store import FileStore

OLD = b"old " * BLOCK_BYTES
NEW = b"new " * (BLOCK_BYTES + 1)


def flash_with(data=None, blocks=64, torn=False):
    flash = Flash(blocks * BLOCK_BYTES, torn)
    if data is not None:
        flash.files["s"] = data
    return flash


def store_on(flash):
    return FileStore("s", flash.open, flash)


def cuts(files, torn, work):
    """Cut power during work(store) at every step; after each cut the flash, power on again."""
    for step in range(1000):
        flash = Flash(torn=torn)
        flash.files.update(files)
        flash.cut_at = step
        try:
            work(store_on(flash))
        except PowerCut:
            flash.power_on()
            yield flash
        else:
            assert step > 0, "nothing was written"
            return


def write_new(store):
    store.replace(NEW)


def error_of(function, *arguments):
    try:
        function(*arguments)
    except OSError as error:
        return error.args[0]


# --- reading and replacing ----------------------------------------------------------------------


def test_what_was_stored_is_read_again():
    flash = flash_with()
    assert store_on(flash).read() is None
    for data in (OLD, NEW, b"", b"\x00\xff"):
        store_on(flash).replace(data)
        assert store_on(flash).read() == data
        assert list(flash.files) == ["s"]


def test_what_is_there_already_is_not_written_again():
    flash = flash_with(OLD)
    store_on(flash).replace(OLD)
    assert flash.steps == 0


def test_larger_files_stand_beside_it():
    """In its folder; a file has its name once it is whole."""
    for folder, listed in (("", "."), ("sets/", "sets/")):
        flash = flash_with()
        asked = []
        flash.listdir = lambda path: asked.append(path) or ["b.set", "a.txt", "a.set"]
        store = FileStore(folder + "s", flash.open, flash)
        file = store.begin()
        file.write(NEW)
        assert folder + "a.set" not in flash.files
        store.finish(file, "a.set")
        assert flash.files == {folder + "a.set": NEW}
        with store.open("a.set") as file:
            assert file.read() == NEW
        assert store.names(".set") == ["a.set", "b.set"] and asked == [listed]
        store.remove("a.set")
        assert flash.files == {}


# --- power cuts ---------------------------------------------------------------------------------


def test_power_cut_at_any_step_leaves_the_old_or_the_new():
    for torn in (False, True):
        for before in ({"s": OLD}, {"s": b""}, {}):
            steps = 0
            for flash in cuts(before, torn, write_new):
                assert store_on(flash).read() in (before.get("s"), NEW), (torn, steps)
                steps += 1
            assert steps > len(NEW) // BLOCK_BYTES


def test_what_a_power_cut_left_does_not_hinder_the_next_writing():
    for torn in (False, True):
        for flash in cuts({"s": OLD}, torn, write_new):
            store_on(flash).replace(b"shorter")
            assert flash.files == {"s": b"shorter"}


def test_power_cut_again_and_again_leaves_one_remainder_at_most():
    flash = flash_with(OLD, torn=True)
    for step in range(5):
        for _ in range(3):
            flash.cut_at = flash.steps + step
            try:
                store_on(flash).replace(NEW)
            except PowerCut:
                flash.power_on()
            assert flash.files["s"] == OLD
            assert len(flash.files) <= 2, flash.files


def test_power_cut_while_setting_aside_leaves_the_file_and_what_was_set_aside_before():
    before = {"s": OLD, "s.bad": b"an earlier one"}
    for torn in (False, True):
        for flash in cuts(before, torn, FileStore.set_aside):
            assert flash.files["s"] == OLD
            assert flash.files["s.bad"] in (b"an earlier one", OLD)


# --- setting aside ------------------------------------------------------------------------------


def test_what_is_set_aside_stays_until_the_next_is():
    flash = flash_with(OLD)
    store = store_on(flash)
    store.set_aside()
    store.replace(NEW)
    assert flash.files == {"s": NEW, "s.bad": OLD}
    store.set_aside()
    assert flash.files == {"s": NEW, "s.bad": NEW}


def test_a_file_that_is_too_big_to_be_copied_is_moved_aside():
    for count, is_copied in ((255, True), (256, True), (4096, True), (4097, False)):
        data = bytes(range(256)) * 17
        data = data[:count]
        flash = flash_with(data, blocks=200)
        store_on(flash).set_aside()
        assert flash.files.get("s.bad") == data, count
        assert flash.files.get("s") == (data if is_copied else None), count


def test_no_more_is_read_than_is_wanted():
    data = bytes(range(256)) * 3
    store = store_on(flash_with(data))
    for most in (0, 1, 255, 256, 257, 511, 512, 767, 768, 769, 5000):
        assert store.read(most) == data[:most], most
    assert store.read() == data


class Pieces:
    """A file of which no read may bring more than a chip has room for."""

    def __init__(self, data):
        self.data = data

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def read(self, most):
        assert 0 < most <= 256, "a chip may not have that in one piece"
        piece, self.data = self.data[:most], self.data[most:]
        return piece


def test_a_file_is_read_in_pieces():
    data = bytes(range(256)) * 3
    store = FileStore("s", lambda path, mode: Pieces(data), None)
    for most in (-1, 700, 5000):
        assert store.read(most) == data[: most if most > 0 else None], most


def test_without_a_file_nothing_is_set_aside():
    flash = flash_with()
    store_on(flash).set_aside()
    assert flash.files == {} and flash.steps == 0


def test_a_file_that_cannot_be_read_is_moved_aside_and_gives_room_for_another():
    flash = flash_with(OLD)
    flash.unreadable = ("s",)
    store = store_on(flash)
    assert error_of(store.read)
    store.set_aside()
    flash.unreadable = ("s.bad",)
    store.replace(NEW)
    assert store.read() == NEW and flash.files["s.bad"] == OLD


def test_a_file_that_cannot_be_read_is_written_anew():
    flash = flash_with(OLD)
    flash.unreadable = ("s",)
    store_on(flash).replace(OLD)
    assert flash.steps and flash.files == {"s": OLD}
    flash.unreadable = ()
    assert store_on(flash).read() == OLD


# --- a full flash -------------------------------------------------------------------------------


def test_on_a_full_flash_the_old_file_stays_and_nothing_is_left_beside_it():
    blocks = len(OLD) // BLOCK_BYTES
    for spare in range(len(NEW) // BLOCK_BYTES + 1):
        flash = flash_with(OLD, blocks=blocks + spare)
        for _ in range(2):
            assert error_of(store_on(flash).replace, NEW) == ENOSPC, spare
            assert flash.files == {"s": OLD}


def test_settings_that_could_not_be_saved_are_still_to_be_saved():
    flash = flash_with(b'{"drives": [3]}', blocks=3)
    chosen = settings.load(store_on(flash))
    chosen.readdress(3, 5)
    assert error_of(settings.save, store_on(flash), chosen) == ENOSPC
    assert chosen.dirty
    assert settings.load(store_on(flash)).drives == (3,)


def test_a_damaged_file_is_not_overwritten_while_there_is_no_room_to_set_it_aside():
    damaged = b'{"drives": [3], "baud": 1}' + b" " * BLOCK_BYTES
    flash = flash_with(damaged, blocks=3)
    chosen = settings.load(store_on(flash))
    for _ in range(2):
        assert error_of(settings.save, store_on(flash), chosen) == ENOSPC
        assert flash.files == {"s": damaged}


# --- the settings of a panel --------------------------------------------------------------------


class Readdressing:
    """A panel that gives its drive 1 the address 5 and saves that, in its first step.

    found: the settings that each life of the chip came up with, as (drives, lost_ms, complaint).
    """

    def __init__(self, board, found):
        self._app = main.start(board)
        self._board = board
        chosen = self._app.settings
        self._to_save = 1 in chosen.drives
        found.append((chosen.drives, chosen.lost_ms, chosen.complaint))

    def step(self):
        if self._to_save:
            self._to_save = False
            self._app.settings.readdress(1, 5)
            settings.save(self._board.store, self._app.settings)
        self._app.step()


def readdressed(cut_at):
    """What the lives of a panel found whose power was cut at that step, and the world of it."""
    found = []
    world = World(
        lambda board: Readdressing(board, found),
        addresses=(1, 5),
        settings={"drives": [2, 1, 3], "lost_ms": 999},
    )
    world.flash.cut_at = cut_at
    world.run(300)
    return found, world


def test_a_panel_whose_power_is_cut_while_it_saves_has_the_old_settings_or_the_new():
    """The cut is followed by a restart, which finds either and saves again if it is the old."""
    old = ((2, 1, 3), 999, None)
    new = ((2, 5, 3), 999, None)
    step = 0
    cut = True
    while cut:
        found, world = readdressed(step)
        cut = world.resets > 0
        world.reset()
        assert found[0] == old and found[-1] == new, (step, found)
        assert len(found) == (3 if cut else 2) and found[1] in (old, new), (step, found)
        assert list(world.flash.files) == [SETTINGS_FILE]
        world.check()
        step += 1
    assert step > 5, "there are more steps than that"


# --- real files ---------------------------------------------------------------------------------


def in_a_folder(work):
    """work(path of a file) in a new folder, which is removed with what is in it."""
    number = 0
    while True:
        folder = "build/store-%d" % number
        try:
            os.mkdir(folder)
            break
        except OSError:  # of another tier, at the same time
            number += 1
            assert number < 1000, "no folder could be made in build/"
    try:
        work(folder + "/s")
    finally:
        for name in os.listdir(folder):
            os.remove(folder + "/" + name)
        os.rmdir(folder)


def test_real_files_keep_the_settings():
    def work(path):
        store = FileStore(path, open, os)
        assert store.read() is None
        store.set_aside()
        chosen = settings.load(store)
        chosen.readdress(1, 7)
        settings.save(store, chosen)
        assert settings.load(FileStore(path, open, os)).drives == (7,)
        store.replace(b"damaged")
        store.set_aside()
        store.replace(OLD)
        assert FileStore(path, open, os).read() == OLD
        assert FileStore(path + ".bad", open, os).read() == b"damaged"
        assert sorted(os.listdir(path[: -len("/s")])) == ["s", "s.bad"]

    in_a_folder(work)


def test_a_folder_that_is_not_there_is_an_error_of_writing_only():
    store = FileStore("build/no such folder/s", open, os)
    assert store.read() is None
    assert error_of(store.replace, OLD)
