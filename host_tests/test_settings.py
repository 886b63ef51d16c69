"""Settings: a table of what may be set, and a file that may be damaged."""

import json

import settings
from boards.sim.board import Store


def loaded(stored):
    data = stored if isinstance(stored, bytes) else json.dumps(stored).encode()
    return settings.load(Store(data))


def test_without_a_file_the_defaults_hold():
    chosen = settings.load(Store())
    assert (chosen.baud, chosen.drives, chosen.setpoint_centihertz) == (19200, (1,), 1000)
    assert chosen.complaint is None


def test_what_is_stored_is_used():
    chosen = loaded({"baud": 9600, "drives": [3, 0, 31], "setpoint_centihertz": 2500})
    assert (chosen.baud, chosen.drives, chosen.setpoint_centihertz) == (9600, (3, 0, 31), 2500)
    assert chosen.complaint is None


def test_what_is_saved_is_loaded_again():
    store = Store()
    chosen = loaded({"baud": 38400, "drives": [5, 6], "highest_centihertz": 6000})
    settings.save(store, chosen)
    again = settings.load(store)
    assert again.as_dictionary() == chosen.as_dictionary()


def test_a_damaged_file_gives_defaults_and_says_so():
    for data in (b"", b"{", b"\xff\xfe\x00", b"[1, 2]", b'"text"', b"null", b"12"):
        chosen = loaded(data)
        assert chosen.baud == 19200 and chosen.drives == (1,)
        assert chosen.complaint, data


def test_a_file_cut_at_any_character_is_noticed():
    """As a power cut may leave it where the store is not what it should be."""
    whole = json.dumps({"drives": [1, 2], "baud": 9600}).encode()
    for length in range(len(whole)):
        chosen = loaded(whole[:length])
        assert chosen.complaint and chosen.baud == 19200, whole[:length]


def test_a_value_out_of_range_gives_its_default_and_keeps_the_others():
    for name, value in (
        ("baud", 14400),
        ("baud", "9600"),
        ("baud", None),
        ("reply_timeout_ms", 5),
        ("lost_ms", 0),
        ("setpoint_centihertz", -1),
        ("setpoint_step_centihertz", 0),
        ("highest_centihertz", 65001),
        ("highest_centihertz", 12.5),
        ("highest_centihertz", True),
        ("drives", []),
        ("drives", [32]),
        ("drives", [1, 1]),
        ("drives", "1"),
        ("drives", [True]),
        ("drives", list(range(32))),
    ):
        stored = {"lowest_centihertz": 100, name: value}
        chosen = loaded(stored)
        default = settings.DRIVES
        for row in settings.SCHEMA:
            if row[0] == name:
                default = row[1]
        assert getattr(chosen, name) == default, (name, value)
        assert chosen.lowest_centihertz == 100
        assert name in chosen.complaint


def test_every_default_is_within_its_limits():
    for name, default, lowest, highest, meaning in settings.SCHEMA:
        assert lowest <= default <= highest and meaning, name


def test_loading_writes_nothing():
    store = Store(b"damaged")
    settings.load(store)
    assert store.read() == b"damaged"
