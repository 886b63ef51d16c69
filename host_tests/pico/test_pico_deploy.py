# SPDX-License-Identifier: MIT
"""tools/deploy on the emulated Pico: the real mpremote, a real file system, and a motor that runs.

The tool is a process of its own at the chip's serial port; meanwhile the world's time goes on.
"""

import os

from pico_bench import panel_files
from serial_tool_bench import AtPort, at_port, read, ready, start
from tools.emulator.world import PicoWorld, temporary

INTERPRETERS = "pico"

# Packages that lie on a frozen panel before the tool comes: one whole copying, that onto the stock
# Pico, is enough. A part of a package would hide the frozen rest of it.
LIE_THERE = ("catalogue", "panel", "search")


def deploy(world, *arguments):
    return at_port(world, "deploy", *arguments)


def quiet(world, ms):
    """Whether the panel sends nothing for so long."""
    before = world.wire.log.count
    world.run(ms)
    return world.wire.log.count == before


def test_what_cannot_be_is_told_before_anything_is_done():
    output = temporary()
    for arguments, status, reason in (
        ("--board esp8266", 2, "invalid choice: 'esp8266'"),
        ("--board-file /no/such/file", 2, "there is no file /no/such/file"),
        ("--remove --replace", 2, "--remove goes with none of"),
        ("--port /no/such/port", 1, "there is no /no/such/port"),
        ("--port /dev/null", 1, "/dev/null cannot be opened"),
    ):
        ended = os.system("./tools/deploy %s >%s 2>&1 </dev/null" % (arguments, output))
        said = read(output)
        assert ended >> 8 == status and reason in said, said
    os.remove(output)


def test_the_mpremote_that_the_readme_names_is_there():
    output = temporary()
    assert os.system("build/mpremote/bin/mpremote --version >%s 2>&1" % output) == 0, read(output)
    assert read(output).startswith("mpremote ")
    os.remove(output)


def test_a_panel_that_logs_is_stopped_too():
    world = PicoWorld("panel", settings={"log": "JSON"})
    start(world)
    status, said = deploy(world, "--dry-run")
    assert status == 0 and "It has stopped them." in said, said
    ready(world)
    assert world.drives[1].hz() == 0
    world.check()


half_made = []  # the world of a frozen panel with half of the files, and what the tool said


def frozen_panel_with_half_of_the_files():
    if not half_made:
        files = panel_files()
        there = {path: files[path] for path in files if path.split("/")[0] in LIE_THERE}
        world = PicoWorld("panel", files=there)
        start(world)
        tool = AtPort(world, "deploy")
        tool.goes_on_until(lambda: "copy    hal/keypad.mpy" in tool.said)
        world.cut_power()
        ended = tool.ends()
        world.reset()
        half_made.append((world,) + ended)
    return half_made[0]


def test_over_a_frozen_panel_half_of_the_files_starts_nothing():
    world, status, said = frozen_panel_with_half_of_the_files()
    assert status == 1 and "It starts no panel until tools/deploy has run" in said, said
    assert "It has stopped them." in said and "which stays the frozen one" in said
    assert quiet(world, 5_000) and world.drives[1].hz() == 0


full_made = []


def frozen_panel_with_all_files():
    if not full_made:
        world, _, _ = frozen_panel_with_half_of_the_files()
        full_made.append((world,) + deploy(world))
    return full_made[0]


def test_over_a_frozen_panel_the_other_half_makes_a_panel_of_files():
    world, status, said = frozen_panel_with_all_files()
    assert status == 0 and "The panel runs." in said, said
    assert "copy    uss/master.mpy" in said and "copy    app.mpy" not in said, said
    assert world.read_file("app.mpy") and world.read_file("main.py") is None
    start(world)
    world.check()


def test_over_a_frozen_panel_then_all_files_can_go_again():
    world, _, _ = frozen_panel_with_all_files()
    start(world)
    status, said = deploy(world, "--remove")
    assert status == 0 and "remove  uss/master.mpy" in said, said
    for path in ("app.mpy", "app.py", "board.py", "uss/master.mpy", "deployed.json"):
        assert world.read_file(path) is None, path
    start(world)
    world.check()


def test_what_a_short_name_in_a_traceback_stands_for_is_told():
    file = temporary()
    assert os.system("./tools/deploy --names >" + file) == 0
    told = [line.split() for line in read(file).split("\n")]
    os.remove(file)
    assert ["panel.panel", "_act"] in [line[:1] + line[2:] for line in told]
