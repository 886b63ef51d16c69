# SPDX-License-Identifier: MIT
"""tools/deploy makes a panel of an emulated Pico with plain MicroPython, and renews it."""

import os

from serial_tool_bench import AtPort, at_port, ready, start
from tools.emulator.world import PicoWorld, temporary

INTERPRETERS = "pico"

OWN_BOARD = "boards/pico/board.py"

# To make a panel of a stock Pico takes a while. Each test goes on with it where it is.
under_way = []  # its world, and the tool that has copied some files
made = []  # its world, and what the tool has said


def stock_pico_with_some_files():
    if not under_way:
        world = PicoWorld("stock", files={"boot.py": b"# mine"})
        tool = AtPort(world, "deploy")
        tool.goes_on_until(lambda: "copy    panel/pages/home.mpy" in tool.said)
        under_way.append((world, tool))
    return under_way[0]


def stock_pico_with_the_panel():
    if not made:
        world, tool = stock_pico_with_some_files()
        status, said = tool.ends()
        assert status == 0 and said.endswith("The panel runs.\n"), said
        made.append((world, said))
    return made[0]


def test_a_line_for_each_file_says_how_far_it_is():
    _, tool = stock_pico_with_some_files()
    copied = [line.split(", ") for line in tool.said.split("\n") if line.startswith("copy ")]
    counts = [line[1].split(" of ") for line in copied]
    assert [int(count) for count, _ in counts] == list(range(1, len(counts) + 1))
    (whole,) = {int(whole) for _, whole in counts}
    assert 30 < len(counts) < whole
    assert copied[-1][2].endswith(" s left")


def test_a_stock_pico_becomes_a_panel():
    world, said = stock_pico_with_the_panel()
    assert "It is Raspberry Pi Pico with RP2040, micropython 1.25.0." in said
    assert "app.mpy" in said  # compiled for the chip
    assert "catalogue/mm440.tsv" in said  # as it is
    start(world)
    world.check()


def test_then_it_is_stopped_while_it_runs_and_brought_up_to_date():
    world, _ = stock_pico_with_the_panel()
    start(world)
    with open(OWN_BOARD) as file:
        own = file.read() + "# mine\n"
    board = temporary()
    with open(board, "w") as file:
        file.write(own)
    status, said = at_port(world, "deploy", "--board-file", board)
    os.remove(board)
    assert status == 0 and "It has stopped them." in said, said
    assert "copy    board.py" in said and "app.mpy" not in said
    assert world.restarts[-1][1] == "reset"
    ready(world)
    world.run(1_000)
    assert world.drives[1].hz() == 0 and world.drives[1].state == "ready"

    # The board file is one's own now, and nothing else differs.
    status, said = at_port(world, "deploy")
    assert status == 0 and "nothing is copied" in said, said
    assert "board.py on the chip is not the tree's, and is kept" in said
    assert world.read_file("board.py").decode() == own
    assert world.read_file("boot.py") == b"# mine"
    assert world.settings()["drives"] == [1]
    start(world)
