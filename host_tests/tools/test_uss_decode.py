# SPDX-License-Identifier: MIT
"""tools/uss decode explains every golden telegram, and what is wrong with one that is none."""

import pytest

import uss_command_bench
from golden import GOLDEN, Telegram
from tools.uss_command import explanation
from tools.uss_command.errors import Failure, Misused
from tools.uss_command.explanation import FROM_DRIVE, TO_DRIVE, explained
from tools.uss_command.files.capture import Capture, characters_of, read_capture

INTERPRETERS = "host"

TELEGRAMS = [Telegram(row) for row in GOLDEN]


def way(one):
    return FROM_DRIVE if one.kind == "reply" else TO_DRIVE


def fields(told):
    return {row["field"]: row for row in told.rows}


@pytest.mark.parametrize("one", TELEGRAMS, ids=lambda one: one.id)
def test_every_golden_telegram_is_explained_character_by_character(one):
    told = explained(one.characters, (one.pkw_words, one.pzd_words), way(one))
    shown = " ".join(row["hex"] for row in told.rows)
    assert bytes.fromhex(shown) == one.characters, "each character stands there once"
    assert [row["at"] for row in told.rows] == sorted({row["at"] for row in told.rows})
    if one.wrong or one.kind == "undefined":
        assert told.wrong and told.summary.startswith("no telegram: ")
        return
    assert not told.wrong and fields(told)["BCC"]["says"] == "right"
    if one.kind not in ("request", "reply"):
        assert one.kind.split()[0] in fields(told)["ADR"]["says"]
        return
    names = fields(told)
    assert "node %d" % one.node in names["ADR"]["says"]
    if one.pkw and "ak" in one.pkw:
        number = "P%04d[%d]" % (one.pkw["number"], one.pkw["index"])
        assert "AK %d:" % one.pkw["ak"] in names["PKE"]["says"]
        assert number in names["IND"]["says"] or one.pkw.get("field")
        last = names.get("PWE2") or names.get("PWE1") or {"says": ""}
        for value in ("word", "count"):
            if value in one.pkw:
                assert last["says"].startswith(str(one.pkw[value]))
        if "float" in one.pkw:
            assert "as a float %.7g" % one.pkw["float"] in last["says"]
        if "error" in one.pkw and "next" not in one.pkw:
            assert "error %d: " % one.pkw["error"] in told.summary
    if one.pzd_words:
        assert ("ZSW" if one.kind == "reply" else "STW") in names


@pytest.mark.parametrize("one", [one for one in TELEGRAMS if one.wrong], ids=lambda one: one.id)
def test_the_reason_of_each_invalid_one_is_said(one):
    told = explained(one.characters)
    if one.wrong == "length":
        assert "LGE %d means" % one.characters[1] in told.summary
    else:
        assert "BCC is %02X, should be" % one.characters[-1] in told.summary


def test_most_are_divided_and_directed_rightly_by_a_guess():
    right = wrong = 0
    for one in TELEGRAMS:
        if one.wrong or one.kind not in ("request", "reply") or not one.pzd_words:
            continue
        told = explained(one.characters)
        expected = explained(one.characters, (one.pkw_words, one.pzd_words), way(one))
        if told.summary == expected.summary:
            right += 1
        else:
            wrong += 1
    assert right > 9 * wrong, (right, wrong)


def test_what_is_wrong_is_said_all_at_once():
    for text, words in (
        ("03 06 00 04 7F 20 00 5E", "begins with 03"),
        ("02", "ends behind the first character"),
        ("02 02 00", "LGE 2 is not within 3...254"),
        ("02 05 00 04 7F 20 5A", "odd"),
        ("02 06 00 04 7F 20 00 5F 00", "1 too many"),
        ("02 06 00 04 7F 20 00", "1 missing"),
        ("02 06 00 04 7F 20 00 5D", "made without STX"),
        ("02 06 60 04 7F 20 00 3F", "mirror and broadcast at once"),
    ):
        assert words in explained(bytes.fromhex(text)).summary, text


def test_characters_are_taken_as_people_write_them():
    for text in ("0206", "02 06", "0x02,0x06", "{02}{06}", "02:06", "02-06"):
        assert characters_of(text) == b"\x02\x06"
    for text in ("", "0", "02 0G", "hello", "00" * 257):
        with pytest.raises(Misused):
            characters_of(text)


def test_a_capture_is_explained_line_by_line(tmp_path):
    path = tmp_path / "capture"
    path.write_text(
        "# a remark\n    0.001263 > 02 06 00 04 7F 20 00 5F\n 14628321 < 02 06 00 FB 34 20 00 EB\n"
        "02 06 00 04 7F 20 00 5E\n"
    )
    assert [row[:2] for row in read_capture(path)] == [
        (0.001263, TO_DRIVE), (14.628321, FROM_DRIVE), (None, None),
    ]  # fmt: skip
    told = uss_command_bench.uss(None, "decode", "--capture", str(path))
    assert told.status == 1, "one of them is none"
    assert [one["summary"] for one in told.all] == [
        "A0 to the drive: ON, HSW 50.00 %",
        "A0 from the drive: running, HIW 50.00 %",
        "no telegram: BCC is 5E, should be 5F",
    ]
    path.write_text("not a telegram\n")
    with pytest.raises(Failure, match="line 1: no telegram in hex"):
        read_capture(path)


def test_it_wants_no_port():
    told = uss_command_bench.uss(None, "decode", "020E0012BC000000000000000000", "00A2")
    assert told.status == 0 and "read P0700[0]" in told.json["summary"]
    assert uss_command_bench.uss(None, "decode").status == 2
    assert explanation.explained(b"").wrong == ["nothing"]


def test_what_began_before_the_capture_did_is_read_again_as_well(tmp_path):
    capture = Capture(str(tmp_path / "heard"))
    capture(False, bytes((2, 1, 3)), at_us=0)
    capture.close()
    assert read_capture(str(tmp_path / "heard")) == [(0.0, FROM_DRIVE, bytes((2, 1, 3)))]
