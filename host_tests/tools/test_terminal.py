# SPDX-License-Identifier: MIT
"""./tools/panel in a terminal: a person types, looks at the screen, leaves; nothing stays behind.

The terminal is a real one (a pty); what is written to it is shown on a screen of 24 x 80, so that
the tests read what a person would. They wait for what they expect, and give up after a while.
"""

import os
import signal
import termios
import time

import pytest

from terminal_bench import PATIENCE_S, Terminal, terminals
from tiers import TOP

INTERPRETERS = "host"

MICROPYTHON = os.path.join(TOP, "build", "unix64", "micropython")

# With its supervision set, START does not ask first.
SUPERVISED = "param 1 P2014[0] 1000"

terminal = pytest.fixture(terminals)


def test_s_starts_the_drive_and_space_stops_it(terminal):
    panel = terminal("--speed", "5")
    panel.shows("READY        A1")
    assert panel.screen.second and not panel.screen.cursor
    panel.commands(SUPERVISED)
    panel.shows("P2014[0]=1000")
    panel.back_to_the_keys()
    panel.type("s")
    panel.shows("RUNNING      A1")
    panel.shows("10.00 Hz right  running")
    panel.type(" ")
    panel.shows("ready")
    panel.type("q")
    assert panel.ends() == 0 and panel.is_as_before()
    assert "USS panel: ended after 0:00:" in panel.screen.text()


def test_the_display_has_a_frame(terminal):
    panel = terminal()
    panel.shows("\u2502READY        A1 \u2502")
    lines = panel.screen.lines()
    assert lines[1].startswith(" \u250c" + 16 * "\u2500" + "\u2510")
    assert lines[4].startswith(" \u2514" + 16 * "\u2500" + "\u2518")


def test_without_utf_8_all_is_ascii(terminal):
    panel = terminal(LC_ALL="C")
    panel.shows("|READY        A1 |")
    assert panel.screen.text().isascii() and "+----------------+" in panel.screen.text()


def test_a_capital_holds_a_jog_and_lets_go_of_it(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.type("J")
    panel.shows("j JOG_LEFT     HELD")
    panel.shows_no_more("HELD")


@pytest.mark.parametrize("pieces", [("\x1b ",), ("\x1b", " "), ("\x1b[", " ")])
def test_space_right_after_esc_stops_the_drive(terminal, pieces):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("s")
    panel.shows("RUNNING      A1")
    for piece in pieces:
        panel.type(piece)
    panel.shows("READY        A1")


def test_stop_and_ctrl_c_do_not_wait_for_a_command(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.type("s")
    panel.shows("RUNNING      A1")
    panel.commands("wait 600000")
    panel.shows("waiting, 599 s left")
    panel.type(" ")
    panel.shows("ended early: wait 600000")
    panel.shows("READY        A1")
    panel.commands("hang 600000")
    panel.shows("waiting, 5")
    panel.type("\x03")
    assert panel.ends() == 130 and panel.is_as_before()


def test_help_and_quit_may_be_typed_after_a_colon(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.commands("help")
    panel.shows("press hold down up wait")
    panel.commands("quit")
    assert panel.ends() == 0 and panel.is_as_before()


@pytest.mark.parametrize("discipline", ["0", "5"])
@pytest.mark.parametrize("ending", ["q", "\x03", signal.SIGKILL])
def test_the_line_discipline_stays_as_it_was(terminal, discipline, ending):
    panel = terminal(discipline=discipline)
    panel.shows("READY")
    assert "line = %s;" % discipline in panel.before[0]
    if ending == signal.SIGKILL:
        os.kill(panel.program(), ending)
    else:
        panel.type(ending)
    panel.ends()
    assert panel.is_as_before()


def test_a_held_key_is_let_go_by_esc(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.type("T")
    panel.shows("t STOP         HELD")
    panel.type("\x1b")
    panel.shows_no_more("HELD")


def test_arrows_move_the_setpoint(terminal):
    panel = terminal("--speed", "5")
    panel.shows("READY")
    panel.type("\x1b[A\x1b[A")
    panel.shows("S: 10.2")
    panel.type("\x1bOB")
    panel.shows("S: 10.1")


def test_commands_of_the_script_language_work_after_a_colon(terminal):
    panel = terminal()
    panel.shows("READY")
    panel.commands("unplug 1")
    panel.shows("done: unplug 1")
    panel.shows("NO CONTACT")
    panel.commands("jump")
    panel.shows("unknown command jump")
    panel.commands("plug 1", "off 1")
    panel.shows("Hz        off")
    panel.commands("on 1", "switch 1 boot_ms")
    panel.shows("boot_ms=300")
    panel.shows("READY        A1")


@pytest.mark.parametrize("text", ["\x1b[200~test results\x1b[201~", "speed, and a lot of it\n"])
def test_words_that_are_pasted_or_typed_after_a_command_start_no_motor(terminal, text):
    panel = terminal()
    panel.shows("READY        A1")
    panel.commands(SUPERVISED, "jump")
    panel.shows("unknown command jump")
    for letter in "speed":
        panel.type(letter)
        time.sleep(0.05)
    panel.shows(" :speed_")
    panel.type("\x1b")
    panel.shows_no_more(":speed_")
    panel.type(text)
    panel.shows("as a paste does")
    time.sleep(0.2)  # what comes right behind a paste is a part of it
    panel.commands("wait 500", "drive 1")
    panel.shows("state=ready")
    panel.shows("starts=0")


def test_start_in_a_terminal_that_hides_the_display_is_refused(terminal):
    panel = terminal()
    panel.shows("READY        A1")
    panel.resize(24, 18)
    panel.type("s")
    panel.shows("no START while")
    panel.resize(24, 80)
    panel.shows("READY        A1")
    panel.commands("drive 1")
    panel.shows("starts=0")


def test_speed_lets_time_pass_faster(terminal):
    panel = terminal("--speed", "10")
    began = time.monotonic()
    panel.shows("time 0:00:3")
    assert time.monotonic() - began < 25
    panel.waits(lambda: speed_shown(panel) > 1.5, "a speed of more than 1.5")


def speed_shown(panel):
    return float(panel.screen.lines()[0].split("speed x")[1])


def test_ctrl_c_leaves_the_terminal_as_it_was(terminal):
    panel = terminal()
    panel.shows("READY")
    assert panel.settings() != panel.before
    panel.type("\x03")
    assert panel.ends() == 130 and panel.is_as_before()
    assert "ended by Ctrl-C" in panel.screen.text()
    assert "Traceback" not in panel.screen.text()


def test_an_interrupt_from_outside_does_so_too(terminal):
    panel = terminal()
    panel.shows("READY")
    os.killpg(panel.process.pid, signal.SIGINT)
    assert panel.ends() == 130 and panel.is_as_before()
    assert "Traceback" not in panel.screen.text()


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_a_program_that_is_killed_leaves_the_terminal_as_it_was(terminal, how):
    panel = terminal()
    panel.shows("READY")
    os.kill(panel.program(), how)
    assert panel.ends() == 128 + how and panel.is_as_before()
    assert "panel: ended by signal %d" % how in panel.screen.text()


def test_who_is_asked_to_end_ends_its_program(terminal):
    panel = terminal()
    panel.shows("READY")
    program = panel.program()
    panel.process.terminate()
    assert panel.ends() == 128 + signal.SIGTERM and panel.is_as_before()
    assert not os.path.exists("/proc/%d" % program)


def test_a_terminal_that_is_closed_ends_it():
    panel = Terminal()
    panel.shows("READY")
    program = panel.program()
    os.close(panel.slave)
    os.close(panel.master)
    panel.process.wait(PATIENCE_S)
    assert not os.path.exists("/proc/%d" % program)


# The panel with a firmware that fails: nothing that a person can type does that.
FAILING = """
import main
from boards.sim.world import World
from tools.live.terminal_panel import live

world = World(main.start)
world.run(1000)
step = world.app.step
stopped = []
close = world.app.close
world.app.close = lambda: (close(), stopped.append(True))

def fail():
    step()
    if world.keypad_is_down:
        raise RuntimeError("on purpose")

world.keypad_is_down = False
down = world.down

def press(key):
    down(key)
    world.keypad_is_down = True

world.down = press
world.app.step = fail
try:
    live(world, 1)
finally:
    print("stopped", stopped)
"""


def test_an_exception_is_shown_on_a_terminal_as_it_was(terminal):
    panel = terminal(
        program=[MICROPYTHON, "-X", "heapsize=16M", "-c", FAILING],
        MICROPYPATH="%s:%s/firmware:.frozen" % (TOP, TOP),
    )
    panel.shows("READY")
    panel.type("s")
    # Without ./tools/panel, which sets the line discipline right.
    assert panel.ends() == 1 and termios.tcgetattr(panel.slave) == panel.before[1]
    assert "RuntimeError: on purpose" in panel.screen.text()
    assert "stopped [True]" in panel.screen.text()


def test_a_wrong_command_line_is_said_in_a_terminal_too(terminal):
    panel = terminal("--speed", "0")
    assert panel.ends() == 2 and panel.is_as_before()
    assert "--speed 0: time passes 1...100 times as fast" in panel.screen.text()


def test_a_script_works_in_a_terminal_too(terminal, tmp_path):
    script = tmp_path / "ready.txt"
    script.write_text("wait 1000\nexpect READY\nlcd\n")
    panel = terminal("--script", str(script))
    assert panel.ends() == 0 and panel.is_as_before()
    assert "|READY        A1 |" in panel.screen.text()


def test_a_small_terminal_shows_what_fits_and_says_so(terminal):
    panel = terminal(rows=12, columns=60)
    panel.shows("q quits. 60 x 12 is too small: the panel needs 79 x 24")
    panel.shows("READY        A1")
    panel.resize(24, 80)
    panel.shows("telegrams:")
    panel.shows("READY        A1")
    assert "too small" not in panel.screen.text()


@pytest.mark.parametrize("columns", [62, 79, 80, 200])
def test_no_column_is_lost(terminal, columns):
    whole = " small letter: tap  CAPITAL: hold  Esc: let go  space: STOP  : command  q: quit"
    panel = terminal(columns=columns)
    panel.shows("telegrams:")
    panel.waits(lambda: panel.screen.lines()[6] == whole[:columns].rstrip(), whole[:columns])


def test_settings_that_name_other_drives_are_pointed_out(terminal, tmp_path):
    kept = tmp_path / "settings.json"
    kept.write_text('{"drives": [5, 6]}')
    panel = terminal("--settings", str(kept), "--drives", "1,2")
    panel.says("the panel looks for drives 5,6; there are 1,2")
    panel.shows("NO CONTACT   A5")
    panel.type("q")
    assert panel.ends() == 0 and panel.is_as_before()


def test_many_drives_fit_the_screen(terminal):
    panel = terminal("--drives", ",".join(str(address) for address in range(31)))
    panel.shows("+ 26 more")
    panel.type("q")
    assert panel.ends() == 0 and panel.is_as_before()
