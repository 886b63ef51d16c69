# SPDX-License-Identifier: MIT
"""Settings: tables of what may be set, and a file that may be damaged."""

import json

import settings_file as settings
from boards.sim.chip.flash import Flash
from hal.store import FileStore
from uss.families import NAMES


def stored(data=None):
    """A store that keeps `data`: bytes, or a dictionary; None: nothing yet."""
    flash = Flash()
    if data is not None:
        flash.files["s"] = data if isinstance(data, bytes) else json.dumps(data).encode()
    return FileStore("s", flash.open, flash)


def loaded(data=None):
    return settings.load(stored(data))


def refuses(function, *arguments):
    try:
        function(*arguments)
    except ValueError:
        return True
    return False


# --- loading ------------------------------------------------------------------------------------


def test_without_a_file_the_defaults_hold():
    chosen = loaded()
    assert (chosen.baud, chosen.drives, chosen.setpoint_centihertz) == (19200, (1,), 1000)
    assert (chosen.second_stop, chosen.unsupervised) == ("OFF3", ())
    assert chosen.complaint is None and not chosen.dirty


def test_what_is_stored_is_used():
    chosen = loaded({"baud": 9600, "drives": [3, 0, 31], "unsupervised": [31, 0]})
    assert (chosen.baud, chosen.drives, chosen.unsupervised) == (9600, (3, 0, 31), (31, 0))
    for kind in ("OFF3", "OFF2", "none"):
        assert loaded({"second_stop": kind}).second_stop == kind
    assert chosen.complaint is None and not chosen.dirty


def test_a_damaged_file_gives_defaults_and_says_so():
    unreadable = (b"", b"{", b"}", b"\xff\xfe\x00", b"\xff}", b'{"baud": 9600}}')
    for data in unreadable + (b"[1, 2]", b'"text"', b"null", b"12"):
        chosen = loaded(data)
        assert chosen.baud == 19200 and chosen.drives == (1,)
        assert chosen.complaint.startswith("no JSON: the settings file is damaged"), data
        assert chosen.suspect == settings.NO_JSON


def test_a_file_that_cannot_be_read_gives_defaults_and_says_so():
    flash = Flash()
    flash.files["s"] = b'{"baud": 9600}'
    flash.unreadable = ("s",)
    chosen = settings.load(FileStore("s", flash.open, flash))
    assert chosen.baud == 19200
    assert chosen.complaint == "unreadable: the settings file cannot be read"
    assert chosen.suspect == settings.UNREADABLE


def test_a_file_cut_at_any_character_is_noticed():
    """As a power cut may leave it where the store is not what it should be."""
    store = stored()
    settings.save(store, loaded({"drives": [1, 2], "baud": 9600}))
    whole = store.read().rstrip()
    for length in range(len(whole)):
        chosen = loaded(whole[:length])
        assert chosen.complaint and chosen.baud == 19200, whole[:length]


def test_a_value_that_cannot_be_gives_its_default_and_keeps_the_others():
    for name, value in (
        ("baud", 14400),
        ("baud", "9600"),
        ("baud", 9600.0),
        ("baud", None),
        ("second_stop", "OFF1"),
        ("second_stop", "off3"),
        ("second_stop", None),
        ("second_stop", ["OFF2"]),
        ("reply_timeout_ms", 5),
        ("lost_ms", 0),
        ("setpoint_centihertz", -1),
        ("setpoint_step_centihertz", 0),
        ("highest_centihertz", 65001),
        ("highest_centihertz", 12.5),
        ("highest_centihertz", True),
        ("key_delay_ms", 1000),
        ("key_repeat_ms", 0),
        ("light_minutes", 61),
        ("lock_code", 10000),
        ("lock_code", "1234"),
        ("repeats", {"1": 5}),
        ("repeats", {"1": 1}),
        ("repeats", {"32": 2}),
        ("repeats", {"1": "2"}),
        ("repeats", [2]),
        ("favourites", [700]),
        ("favourites", {"mm450": [700]}),
        ("favourites", {"mm440": 700}),
        ("favourites", {"mm440": [True]}),
        ("favourites", {"mm440": [-1]}),
        ("favourites", {"mm440": [100_000]}),
        ("favourites", {"mm440": list(range(16)), "v20": list(range(17))}),
        ("drives", []),
        ("drives", [32]),
        ("drives", [1, 1]),
        ("drives", "1"),
        ("drives", [True]),
        ("drives", [[1]]),
        ("drives", list(range(32))),
        ("unsupervised", [-1]),
        ("unsupervised", [2, 2]),
        ("unsupervised", {"1": 1}),
        ("unsupervised", None),
        ("unsupervised", list(range(32))),
    ):
        chosen = loaded({"lowest_centihertz": 100, name: value})
        assert getattr(chosen, name) == settings.DEFAULTS[name], (name, value)
        assert chosen.lowest_centihertz == 100
        assert name in chosen.complaint and chosen.suspect == name


def test_what_is_nearly_json_is_a_damaged_file():
    """MicroPython's own reader takes most of it."""
    for data in (
        b'{"baud": 9600,}', b'{"drives": [1, 2,]}', b'{"drives": [1 2]}', b'{,}',
        b'{"baud": 9600 "drives": [1]}', b'{"baud" 9600}', b'{"baud": 9600; "drives": [1]}',
        b'{baud: 9600}', b"{'baud': 9600}", b'{"baud": 9600} {}', b'{"baud": 9600}x',
        b'{"baud": 09600}', b'{"baud": +9600}', b'{"baud": 9600.}', b'{"baud": 9_600}',
        b'{"baud": 0x2580}', b'{"baud": .5}', b'{"baud": 1e}', b'{"baud": -}', b'{"baud": }',
        b'{"baud": nan}', b'{"baud": True}', b'{"second_stop": "OFF\\q3"}', b'{1: 2}',
        b'{"a": "\\u12g4"}', b'{"a": "line\nline"}', b'{"a": "\xff"}', b'{"drives": [1}',
        b'{"baud": 9600, // comment\n "drives": [1]}', b'{"a": ' + 30 * b"1" + b"}",
    ):  # fmt: skip
        chosen = loaded(data)
        assert chosen.suspect == settings.NO_JSON, data
        assert (chosen.baud, chosen.drives) == (19200, (1,)), data


def test_all_that_json_allows_is_taken():
    chosen = loaded(
        b'\t{"a": [], "b": {}, "c": -0.5e+3, "d": [null, true, {"e": "\\"\\u00e9\\n"}],\r\n'
        b' "drives":[ 3 ,4 ] , "second_stop": "\\u004fFF2", "baud": 9600}\n'
    )
    assert chosen.complaint is None
    assert (chosen.drives, chosen.second_stop, chosen.baud) == ((3, 4), "OFF2", 9600)


def test_a_file_that_nests_too_deep_is_damaged_and_no_more():
    for deep in (1000 * b"[" + 1000 * b"]", 1000 * b'{"a":' + b"1" + 1000 * b"}"):
        chosen = loaded(b'{"baud": 9600, "new": ' + deep + b"}")
        assert chosen.baud == 19200 and chosen.complaint


def test_a_file_that_is_too_big_is_not_read():
    for data in (
        b'{"baud": 9600, "text": "' + 10_000 * b"x" + b'"}',
        b'{"baud": 9600' + b"".join(b', "%d": 1' % n for n in range(2_000)) + b"}",
    ):
        chosen = loaded(data)
        assert (chosen.suspect, chosen.baud) == (settings.TOO_BIG, 19200)


def test_a_file_that_is_too_big_is_set_aside_without_being_read():
    flash = Flash(capacity_bytes=100_000)
    flash.files["s"] = data = b'{"baud": 9600}' + 10_000 * b" "
    store = FileStore("s", flash.open, flash)
    chosen = settings.load(store)
    chosen.readdress(1, 5)
    settings.save(store, chosen)
    assert flash.files["s.bad"] == data
    assert settings.load(store).drives == (5,)


def test_unknown_things_that_would_fill_the_file_are_left_out_and_said():
    chosen = loaded({"baud": 9600, "new": 3_000 * "x"})
    assert (chosen.suspect, chosen.baud) == (settings.TOO_BIG, 9600)
    store = stored({})
    settings.save(store, chosen)
    assert len(store.read()) < settings.SIZE_MAX


def test_what_stands_there_twice_is_named_and_has_its_default():
    """However often: nobody knows which of them was meant."""
    for times in (2, 3):
        chosen = loaded(b"{" + b", ".join([b'"baud": 9600'] + [b'"drives": [2]'] * times) + b"}")
        assert (chosen.suspect, chosen.drives, chosen.baud) == ("drives", (1,), 9600)


def test_the_biggest_file_that_is_saved_is_loaded_again():
    every = list(range(31))
    known = {"drives": every, "unsupervised": every, "new": (settings.UNKNOWN_MAX - 10) * "x"}
    flash = Flash(capacity_bytes=20_000)
    flash.files["s"] = json.dumps(known).encode()
    store = FileStore("s", flash.open, flash)
    settings.save(store, settings.load(store))
    assert len(flash.files["s"]) > settings.UNKNOWN_MAX
    assert settings.load(store).complaint is None


def test_a_lowest_setpoint_above_the_highest_gives_the_defaults_for_both():
    chosen = loaded({"lowest_centihertz": 5000, "highest_centihertz": 4999, "baud": 9600})
    assert (chosen.lowest_centihertz, chosen.highest_centihertz) == (0, 65000)
    assert "lowest_centihertz" in chosen.complaint and "highest_centihertz" in chosen.complaint
    assert chosen.baud == 9600
    assert loaded({"lowest_centihertz": 5000, "highest_centihertz": 5000}).complaint is None


def test_every_default_may_be_set():
    assert loaded(settings.DEFAULTS).complaint is None
    for row in settings.CHOICES + settings.NUMBERS + settings.ADDRESSES:
        assert row[-1], row


def test_loading_writes_nothing():
    store = stored(b"damaged")
    settings.load(store)
    assert store.read() == b"damaged"


# --- saving -------------------------------------------------------------------------------------


def test_what_is_saved_is_loaded_again():
    store = stored()
    chosen = loaded({"baud": 38400, "drives": [5, 6], "second_stop": "none", "unsupervised": [6]})
    settings.save(store, chosen)
    again = settings.load(store)
    assert settings.as_dictionary(again) == settings.as_dictionary(chosen)
    assert again.complaint is None


def test_a_person_can_read_the_file():
    favourites = {"mm440": [1120, 3], "g110": [700]}
    store = stored({"drives": [2, 1], "unsupervised": [2], "favourites": favourites})
    settings.save(store, settings.load(store))
    assert store.read().decode() == (
        "{\n"
        '  "baud": 19200,\n'
        '  "second_stop": "OFF3",\n'
        '  "language": "en",\n'
        '  "log": "none",\n'
        '  "reply_timeout_ms": 20,\n'
        '  "lost_ms": 1000,\n'
        '  "setpoint_centihertz": 1000,\n'
        '  "setpoint_step_centihertz": 10,\n'
        '  "lowest_centihertz": 0,\n'
        '  "highest_centihertz": 65000,\n'
        '  "key_delay_ms": 400,\n'
        '  "key_repeat_ms": 120,\n'
        '  "light_minutes": 0,\n'
        '  "lock_code": 0,\n'
        '  "drives": [2, 1],\n'
        '  "unsupervised": [2],\n'
        '  "kinds": {},\n'
        '  "repeats": {},\n'
        '  "half_written": {},\n'
        '  "favourites": {"g110": [700], "mm440": [1120, 3]}\n'
        "}\n"
    )


def test_the_fullest_file_there_can_be_is_read_again():
    addresses = list(range(31))
    favourites = {name.lower(): [99_999] for name in NAMES}
    favourites["mm440"] += [99_999] * (settings.FAVOURITES_MAX - len(NAMES))
    chosen = loaded(
        {
            "drives": addresses,
            "unsupervised": addresses,
            "kinds": {str(address): "mm440-bop/127+8" for address in addresses},
            "repeats": {str(address): 4 for address in addresses},
            "half_written": {str(address): "FFFFFFFF" for address in addresses},
            "favourites": favourites,
            "new": "x" * (settings.UNKNOWN_MAX - 10),
        }
    )
    assert chosen.complaint is None, chosen.complaint
    store = stored()
    settings.save(store, chosen)
    assert settings.load(store).complaint is None, len(store.read())


def test_what_a_newer_firmware_stored_is_kept():
    newer = {"colour": "red", "baud": 9600, "motors": {"1": ["a", None]}, "pi": 3.141592653589793}
    store = stored(newer)
    chosen = settings.load(store)
    assert chosen.complaint is None
    settings.save(store, chosen)
    again = json.loads(store.read())
    assert (again["colour"], again["motors"]) == ("red", {"1": ["a", None]})
    assert b"3.141592653589793" in store.read(), "also where numbers have fewer digits"
    assert again["baud"] == 9600


# --- an update of the firmware -------------------------------------------------------------------

# As a firmware without a lock writes it.
BEFORE_THE_LOCK = b"""{
  "baud": 38400,
  "second_stop": "OFF2",
  "reply_timeout_ms": 30,
  "lost_ms": 2000,
  "setpoint_centihertz": 1500,
  "setpoint_step_centihertz": 5,
  "lowest_centihertz": 100,
  "highest_centihertz": 5000,
  "drives": [7, 3],
  "unsupervised": [3],
  "kinds": {"7": "g110/127"}
}
"""


def test_an_update_takes_over_what_the_firmware_before_has_stored():
    store = stored(BEFORE_THE_LOCK)
    chosen = settings.load(store)
    assert chosen.complaint is None and not chosen.dirty
    before = json.loads(BEFORE_THE_LOCK.decode())
    for name, value in before.items():
        assert getattr(chosen, name) == (tuple(value) if isinstance(value, list) else value), name
    for name in settings.DEFAULTS:
        if name not in before:
            assert getattr(chosen, name) == settings.DEFAULTS[name], name
    settings.save(store, chosen)
    after = json.loads(store.read())
    assert {name: after[name] for name in before} == before


def test_what_is_new_survives_a_firmware_that_does_not_know_it():
    """An older firmware is an older table: somebody goes back to it, and forth again."""
    new = ("key_delay_ms", "key_repeat_ms", "light_minutes", "lock_code")
    store = stored({"lock_code": 1234, "light_minutes": 5, "key_repeat_ms": 80, "baud": 9600})
    newer_numbers, newer_defaults = settings.NUMBERS, settings.DEFAULTS
    settings.NUMBERS = tuple([row for row in newer_numbers if row[0] not in new])
    settings.DEFAULTS = {name: newer_defaults[name] for name in newer_defaults if name not in new}
    try:
        older = settings.load(store)
        assert older.complaint is None and not hasattr(older, "lock_code")
        older.add(9, "mm420")
        settings.save(store, older)
    finally:
        settings.NUMBERS, settings.DEFAULTS = newer_numbers, newer_defaults
    again = settings.load(store)
    assert again.complaint is None and again.drives == (1, 9)
    assert (again.lock_code, again.light_minutes, again.key_repeat_ms) == (1234, 5, 80)


def test_a_file_with_something_wrong_is_set_aside_before_the_first_save_and_only_then():
    for damaged in (b"{", b'{"baud": 14400, "drives": [7]}'):
        flash = Flash()
        flash.files["s"] = damaged
        store = FileStore("s", flash.open, flash)
        chosen = settings.load(store)
        chosen.readdress(chosen.drives[0], 9)
        settings.save(store, chosen)
        assert flash.files["s.bad"] == damaged
        chosen.readdress(9, 10)
        settings.save(store, chosen)
        assert flash.files["s.bad"] == damaged
        assert chosen.complaint, "it stays on the display until the next power-up"
        assert settings.load(store).complaint is None
        assert settings.load(store).drives == (10,)


def test_a_sound_file_is_not_set_aside():
    flash = Flash()
    store = FileStore("s", flash.open, flash)
    settings.save(store, loaded())
    settings.save(store, loaded({"baud": 9600}))
    assert list(flash.files) == ["s"]


# --- changing -----------------------------------------------------------------------------------


def test_a_drive_without_supervision_is_accepted_once_and_for_all():
    chosen = loaded({"drives": [3, 4]})
    chosen.accept_unsupervised(4)
    assert chosen.unsupervised == (4,) and chosen.dirty
    settings.save(stored(), chosen)
    assert not chosen.dirty
    chosen.accept_unsupervised(4)
    assert chosen.unsupervised == (4,) and not chosen.dirty
    chosen.accept_unsupervised(3)
    assert chosen.unsupervised == (3, 4) and chosen.dirty


def test_only_drives_that_are_there_are_accepted():
    chosen = loaded({"drives": [3, 4]})
    for address in (5, 32, -1):
        assert refuses(chosen.accept_unsupervised, address), address
    assert chosen.unsupervised == () and not chosen.dirty


def test_what_was_accepted_goes_with_the_drive_to_its_new_address():
    chosen = loaded({"drives": [3, 4], "unsupervised": [4]})
    chosen.readdress(4, 0)
    assert (chosen.drives, chosen.unsupervised) == ((3, 0), (0,))
    chosen.readdress(3, 31)
    assert (chosen.drives, chosen.unsupervised) == ((31, 0), (0,))
    assert chosen.dirty


def test_a_new_address_inherits_no_acceptance_of_a_drive_that_is_gone():
    chosen = loaded({"drives": [3], "unsupervised": [8]})
    chosen.readdress(3, 8)
    assert (chosen.drives, chosen.unsupervised) == ((8,), ())


def test_an_address_that_cannot_be_is_refused_and_changes_nothing():
    chosen = loaded({"drives": [3, 4], "unsupervised": [3]})
    for old, new in ((5, 6), (3, 4), (3, 3), (3, 32), (3, -1), (3, True), (3, None), (32, 1)):
        assert refuses(chosen.readdress, old, new), (old, new)
    assert (chosen.drives, chosen.unsupervised) == ((3, 4), (3,)) and not chosen.dirty


def test_31_drives_can_all_be_accepted_whatever_the_file_says_of_others():
    store = stored({"drives": list(range(31)), "unsupervised": list(range(1, 32))})
    chosen = settings.load(store)
    for address in range(31):
        chosen.accept_unsupervised(address)
    settings.save(store, chosen)
    assert settings.load(store).unsupervised == tuple(range(31))
    assert settings.load(store).complaint is None


def test_what_is_still_to_be_saved_stays_so_though_nothing_new_is_accepted():
    changed = loaded({"drives": [1], "unsupervised": [1]})
    changed.readdress(1, 5)
    changed.accept_unsupervised(5)
    assert changed.dirty and changed.unsupervised == (5,)
