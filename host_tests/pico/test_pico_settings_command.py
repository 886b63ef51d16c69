# SPDX-License-Identifier: MIT
"""tools/settings on an emulated Pico: the real mpremote, a real file system, a motor that runs."""

import os

from serial_tool_bench import at_port, ready, start
from tools.emulator.world import PicoWorld, temporary

INTERPRETERS = "pico"

made = []  # the world of a panel, which takes a while


def panel():
    if not made:
        made.append(PicoWorld("panel"))
    return made[0]


def settings(world, *arguments):
    return at_port(world, "settings", *arguments)


def test_a_panel_that_runs_stops_its_drives_tells_its_settings_and_starts_again():
    world = panel()
    start(world)
    status, said = settings(world, "get", "baud", "drives")
    assert status == 0 and "stops all its drives now" in said, said
    assert "baud = 19200  " in said and "drives = [1]  " in said
    assert said.endswith("# in the order of the address keys; 1...31 addresses 0...31\n"), said
    assert "The panel runs again." in said
    ready(world)
    assert world.drives[1].hz() == 0
    world.check()


def test_a_setting_is_changed_and_the_panel_goes_by_it():
    world = panel()
    status, said = settings(world, "set", "setpoint_centihertz=1234", "language=de")
    assert status == 0 and "settings.json is written." in said, said
    assert world.settings()["setpoint_centihertz"] == 1234
    assert world.run_until(lambda: world.reads("12.3"), 15_000), world.lcd()
    status, said = settings(world, "set", "setpoint_centihertz=1234")
    assert status == 0 and "nothing is written" in said, said


def test_what_the_schema_does_not_allow_is_refused_before_a_drive_is_stopped():
    world = panel()
    for word, why in (
        ("lost_ms=50", "lost_ms: 50 is not 100...5000"),
        ("baud=14400", "baud: 14400 is none of 300 600"),
        ("bautrate=9600", "there is no setting bautrate: there are baud"),
    ):
        status, said = settings(world, "set", word)
        assert status == 2 and why in said and "stops all" not in said, said


def test_settings_and_sets_go_out_and_onto_another_panel():
    folder = temporary()
    os.system("cp tools/examples/settings/pump.set %s.1.set" % folder)
    given = "%s.1.set" % folder
    name = given.rpartition("/")[2]
    world = panel()
    status, said = settings(world, "in", given, "tools/examples/settings/three_drives.json")
    assert status == 0 and "%s is written." % name in said, said
    with open(given, "rb") as file:
        whole = file.read()
    assert world.read_file(name) == whole
    assert world.settings()["drives"] == [1, 2, 3]
    status, said = settings(world, "out", folder + "-out")
    assert status == 0, said
    assert sorted(os.listdir(folder + "-out")) == sorted([name, "settings.json"])
    with open("%s-out/%s" % (folder, name), "rb") as file:
        assert file.read() == whole
    os.system("rm -r %s-out %s %s" % (folder, folder, given))
