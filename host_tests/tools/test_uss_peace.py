# SPDX-License-Identifier: MIT
"""Commands of ./tools/uss that only ask: no motor notices, and no drive is left in a fault."""

import pytest

from tools.uss_command.screen import Screen
from uss_virtual_bench import World

INTERPRETERS = "host"

# Family, layout, the control word with which its master turns it.
DRIVES = (
    ("mm420", "4", 0x047F), ("mm420", "127", 0x047F), ("mm420", "3", 0x047F),
    ("mm440", "4+4", 0x047F), ("mm440", "127", 0x047F), ("mm440-bop", "4", 0x047F),
    ("mm3", "", 0x0C7F), ("g110", "4", 0x047F), ("g110", "127", 0x047F), ("g110", "0", 0x047F),
    ("v20", "4", 0x047F), ("v20", "127", 0x047F), ("generic", "4", 0x047F),
    ("g120", "4", 0x047F), ("g120", "127", 0x047F), ("g120", "3", 0x047F), ("g120", "0", 0x047F),
    ("g120", "4+4", 0x047F), ("g120", "4+8", 0x047F),
)  # fmt: skip
OFF = 0x047E
NEVER = {"mm3": {93: 0}, "g120": {2040: 0}}  # it does not watch the line, P2014
SOURCES = {"mm440-bop": {700: 4, 1000: 4}}


def world_of(family, words, stw, runs):
    kind = family + ("/" + words if words else "")
    parameters = {**NEVER.get(family, {2014: 0}), **SOURCES.get(family, {})}
    if family == "generic":
        parameters = {}
    world = World({1: kind}, parameters={1: parameters})
    world.plc.commands({1: OFF if stw & 1 else stw})
    world.run(1.0)
    if runs:
        world.plc.commands({1: stw})
        world.run(1.0)
    assert world.drives[1].state == ("running" if runs else "ready"), world.drives[1].state
    return world, kind


def asking(tmp_path):
    return (
        ("read", "P0700", "P1082"),
        ("scan", "--addresses", "0-2"),
        ("backup", str(tmp_path / "a"), "--numbers", "0-30"),
        ("monitor", "--for", "0.4", "--every", "0.2"),
    )


@pytest.mark.parametrize("runs", (True, False), ids=("runs", "stands"))
@pytest.mark.parametrize("talks", (True, False), ids=("talks", "paused"))
@pytest.mark.parametrize("family, words, stw", DRIVES)
def test_a_motor_goes_on_as_its_master_has_told_it(family, words, stw, talks, runs, tmp_path):
    """Whatever it is, whether or not its master talks; and nobody has said what it is."""
    world, kind = world_of(family, words, stw, runs)
    drive = world.drives[1]
    told = [()]
    if not family.startswith("g120"):
        told.append(("--kind", kind))  # the user knows his drive
        told.append(("--kind", family))
    else:
        told.append(("--kind", "g120"))
    if not runs:
        told.append(("--standing",))
    if not talks:
        world.plc.pause()
        world.run(0.5)
    before = drive.state, drive.stw, drive.starts
    for options in told:
        for command in asking(tmp_path):
            began_us = world.clock.now_us
            outcome = world.uss(*options, *command)
            assert (drive.state, drive.stw, drive.starts) == before, (options, command)
            if talks:
                assert outcome.status == 1 and "another master" in outcome.error
                assert not world.sent(began_us)
            elif options in ((), ("--kind", "g120")):
                assert not world.sent(began_us), "a mirror telegram at most"
                assert command[0] == "scan" or "--standing" in outcome.error
            else:
                knows_nothing = words == "0" or family == "generic" and command[0] == "backup"
                assert not outcome.error or knows_nothing, (options, command, outcome.error)
    world.run(10)
    assert (drive.state, drive.stw, drive.starts) == before


def test_that_a_motor_stands_is_the_word_of_the_user():
    """What the refusals are for: this drive trips, because he has said what is not so."""
    world, _ = world_of("g120", "4", 0x047F, True)
    world.plc.pause()
    world.run(0.5)
    assert world.uss("read", "P0015").status == 1 and world.drives[1].state == "running"
    assert world.uss("--standing", "read", "P0015").status == 0
    assert world.drives[1].state == "fault"


def test_at_a_terminal_it_asks_whether_the_motor_stands(monkeypatch):
    asked = []

    def confirms(_, question):
        asked.append(question)
        return answer

    monkeypatch.setattr(Screen, "confirms", confirms)
    world, _ = world_of("g120", "4", 0x047F, False)
    world.plc.pause()
    world.run(0.5)
    answer = True
    assert world.uss("read", "P0015", "P1082").rows[0]["value"] == 21
    assert world.uss("scan", "--addresses", "0-3").rows[0]["kind"] == "g120/4"
    assert world.uss("--kind", "mm440", "read", "P1082").status == 0, "it knows what that is"
    assert asked[0].startswith("Does the motor of drive 1 stand?") and len(asked) == 2
    answer = False
    began_us = world.clock.now_us
    assert world.uss("read", "P0015").status == 1 and not world.sent(began_us)


def test_a_layout_that_is_not_the_drives_is_never_used():
    """The parameter task P1151 is 147Fh: ON, for a drive that looks for its control word there."""
    world = World({1: "mm440/0+6", 2: "mm440/3+3"})
    world.plc.commands({1: OFF, 2: OFF})
    world.run(0.5)
    world.plc.pause()
    world.run(0.5)
    refused = world.uss("--kind", "mm440/4", "read", "P1151")
    assert "has 0+6 words, not 4+2" in refused.error
    assert "no parameter channel" in world.uss("--kind", "mm440", "read", "P1151").error
    refused = world.uss("--address", "2", "--kind", "mm440/4", "read", "P1151")
    assert "drive 2 has 3+3 words, not 4+2, as --kind says" in refused.error
    assert world.uss("--address", "2", "--kind", "mm440", "read", "P0700").rows[0]["value"] == 5
    for drive in world.drives.values():
        assert (drive.state, drive.stw, drive.starts) == ("ready", OFF, 0)


def test_a_kind_without_a_layout_does_for_every_command():
    world = World({1: "mm440/127", 2: "mm440/4+4"}, parameters={1: {1121: 0.1}, 2: {1121: 0.1}})
    for address in world.drives:
        mm440 = ("--kind", "mm440", "--address", "%d" % address)
        assert world.uss(*mm440, "mirror").json["ok"]
        assert world.uss(*mm440, "read", "P0700").rows[0]["value"] == 5
        assert world.uss(*mm440, "run", "5", "--for", "1", "--unsupervised").json["stopped"]
        assert world.uss(*mm440, "stop").json["stopped"]
        assert world.drives[address].starts == 1


OWN = """
from uss import pzd
from uss.families import MM440
from uss.layout import Layout

class Pump(MM440):
    layout = Layout(4, 4)
    zsw_says = ((0x0001, 0x0001, pzd.ZSW_RUNNING), (0x0008, 0x0008, pzd.ZSW_FAULT))

class Touchy(Pump):
    takes_no_control = False
"""


def test_a_family_of_ones_own_is_asked_as_its_class_says(tmp_path):
    """Here bit 0 says that it runs, as it does when an MM440 stands."""
    (tmp_path / "own.py").write_text(OWN)
    own = str(tmp_path / "own.py")
    world = World({1: "mm440/4+4"})
    world.plc.commands({1: OFF})
    world.run(0.5)
    world.plc.pause()
    world.run(0.2)
    row = world.uss("--kind", own + ":Pump", "read", "P1082").rows[0]
    assert (row["value"], row["name"]) == (50.0, "Max. frequency")
    shown = world.uss("--kind", own + ":Pump", "monitor", "--for", "0.4")
    assert shown.json["state"] == "running"
    assert "--standing" in world.uss("--kind", "1=%s:Touchy" % own, "read", "P1082").error
    for kind, said in (
        (own + ":Pomp", "has no Pomp"), ("gone.py:A", "No such file"),
        (own + ":pzd", "is no class of a family"),
    ):  # fmt: skip
        refused = world.uss("--kind", kind, "read", "P1082")
        assert refused.status == 2 and said in refused.error, refused.error


# --- drives that trip when they hear no more -----------------------------------------------------

FIVE = {1: "mm420", 2: "g110/4", 3: "mm440/4+4", 4: "v20", 5: "mm3"}
AT_38400 = {2010: 8}
WATCHED = {
    1: {2014: 1000}, 2: {2014: 2000}, 3: {2014: 1500, **AT_38400}, 4: {2014: 1000}, 5: {93: 2},
}  # fmt: skip
UNWATCHED = {1: {}, 2: {}, 3: AT_38400, 4: {2014: 0}, 5: {93: 0}}
FOUND = {
    1: (19200, "mm420"), 2: (19200, "g110/4"), 3: (38400, "mm420/4+4"), 4: (19200, "v20"),
    5: (19200, "mm3"),
}  # fmt: skip
SCAN = ("scan", "--addresses", "0-8", "--rates", "19200,9600,38400")


def found(told):
    return {row["address"]: (row["baud"], row["kind"]) for row in told.rows}


def states(world):
    return [drive.state for drive in world.drives.values()]


def in_no_fault(world):
    assert "fault" not in states(world), states(world)


@pytest.mark.parametrize("more", ((), ("--standing",)))
def test_five_drives_that_do_not_watch_the_line_are_found_and_left(more):
    world = World(FIVE, parameters=UNWATCHED)
    told = world.uss(*SCAN, *more)
    assert told.status == 0 and not told.trips
    if more:
        assert found(told) == FOUND
    else:
        assert found(told) == {
            address: (baud, "not asked") for address, (baud, _) in FOUND.items() if address != 3
        }
        assert "--standing" in told.json["remarks"][0]
    world.run(300)
    in_no_fault(world)


def test_five_drives_that_watch_the_line_are_asked_on_as_long_as_scan_runs():
    world = World(FIVE, parameters=WATCHED)
    for second in range(1, 600):
        world.after(second, lambda: in_no_fault(world))
    world.ctrl_c_after(600)
    told = world.uss("--standing", *SCAN)
    assert told.status == 0 and found(told) == FOUND
    assert [(one["address"], one["trips"], one["after_ms"]) for one in told.trips[:5]] == [
        (1, "F0072", 1000), (2, "F0072", 2000), (4, "F72", 1000), (5, "F008", 2000),
        (3, "F0072", 1500),
    ]  # fmt: skip
    assert [one["asked_on"] for one in told.trips] == [True] * 5 + [False] * 5
    in_no_fault(world)
    world.run(3)
    assert states(world) == ["fault"] * 5, "what it has said"


@pytest.mark.parametrize("after_s", (10.0, 10.033, 12.5, 17.071))
def test_the_master_that_takes_over_finds_none_in_a_fault(after_s):
    kinds = {address: kind for address, kind in FIVE.items() if address != 3}
    world = World(kinds, parameters=WATCHED)
    world.after(after_s, lambda: world.plc.commands({address: OFF for address in kinds}))
    told = world.uss("--standing", "scan", "--addresses", "0-8")
    assert told.status == 0 and len(told.rows if "rows" in told.json else told.all[0]["rows"]) == 4
    assert told.json["text"].startswith("another master talks")
    assert world.clock.now_us < (after_s + 3) * 1_000_000
    began_us = world.clock.now_us
    world.run(60)
    in_no_fault(world)
    assert not world.sent(began_us)


def test_the_only_drive_is_handed_over_too():
    """Its master asks the very address that was asked last."""
    world = World({1: "mm420"}, parameters=WATCHED)
    world.after(8, lambda: world.plc.commands({1: OFF}))
    told = world.uss("--standing", "scan", "--addresses", "1")
    assert told.json["text"].startswith("another master talks")
    world.run(60)
    in_no_fault(world)


def test_a_rate_at_which_a_drive_would_trip_is_not_tried():
    world = World({1: "mm420"}, parameters={1: {2014: 1000}})
    world.ctrl_c_after(60)
    told = world.uss("--standing", "scan", "--addresses", "0-3", "--rates", "19200,300,9600")
    assert told.json["remarks"] == [
        "300 baud is not tried: drive 1 would trip, because it waits 1000 ms for a telegram"
    ]
    in_no_fault(world)


def test_leave_ends_at_once_and_says_what_will_happen():
    world = World({1: "mm420"}, parameters=WATCHED)
    told = world.uss("--standing", "--leave", "scan", "--addresses", "0-3")
    assert told.rows[0]["trips_after_ms"] == 1000 and told.rows[0]["motor"] == "stands"
    assert [(one["trips"], one["asked_on"]) for one in told.trips] == [("F0072", False)]
    in_no_fault(world)
    world.run(1.1)
    assert states(world) == ["fault"]
    again = world.uss("--standing", "scan", "--addresses", "1")
    assert again.rows[0]["motor"] == "fault" and not again.trips


@pytest.mark.parametrize(
    "command",
    (
        ("read", "P0700"),
        ("write", "P1120", "7"),
        ("backup", ""),
        ("monitor", "--for", "3"),
        ("trace", "--for", "1"),
    ),
    ids=lambda command: command[0],
)
def test_every_command_says_which_drive_its_end_will_trip(command, tmp_path):
    if command[0] == "backup":
        command = ("backup", str(tmp_path / "a"), "--numbers", "700-1300")
    world = World({1: "mm420"}, parameters=WATCHED)
    told = world.uss("--kind", "mm420", *command)
    assert told.status == 0, told.error
    assert [(one["address"], one["trips"], one["runs"]) for one in told.trips] == [
        (1, "F0072", False)
    ]
    in_no_fault(world)
    world.run(1.1)
    assert states(world) == ["fault"]


def test_stay_keeps_any_drive_from_a_fault():
    world = World({1: "mm420"}, parameters=WATCHED)
    world.after(30, lambda: world.plc.commands({1: OFF}))
    assert world.uss("--kind", "mm420", "--stay", "read", "P0700").status == 0
    world.run(10)
    in_no_fault(world)
    world = World({1: "mm420"}, parameters=WATCHED)
    world.after(30, lambda: world.plc.commands({1: OFF}))
    assert world.uss("--kind", "mm420", "--stay", "stop").json["text"].startswith("another")
    world.run(10)
    in_no_fault(world)


def test_a_motor_that_runs_is_not_left_to_trip():
    """It obeys its terminals, and nobody has talked to it on the bus since its mains came: the
    first telegram of all wakes its supervision."""
    for command in (("read", "P0700"), ("monitor", "--for", "1")):
        world, _ = world_of("mm420", "4", 0x047F, True)
        world.plc.pause()
        world.run(0.2)
        world.drives[1].write(2014, 0, 1000)
        world.after(40, world.plc.resume)
        told = world.uss("--kind", "mm420", *command)
        assert told.trips[0]["runs"] and told.trips[0]["asked_on"]
        assert world.clock.now_us > 40_000_000
        world.run(10)
        assert states(world) == ["running"] and world.drives[1].starts == 1


def test_a_motor_runs_again_although_it_trips_after_each_command():
    world = World({1: "mm420"}, parameters={1: {2014: 1000, 1120: 0.1, 1121: 0.1}})
    told = world.uss("--kind", "mm420", "read", "P0700")
    assert told.trips
    world.run(2)
    refused = world.uss("run", "10", "--for", "1")
    assert refused.status == 1 and "F0072" in refused.error and "run --ack" in refused.error
    told = world.uss("run", "10", "--for", "1", "--ack")
    assert told.status == 0 and told.json["stopped"] and told.trips, told.error
    assert world.drives[1].starts == 1
    world.run(2)
    assert world.uss("ack").json["acknowledged"] == 72
