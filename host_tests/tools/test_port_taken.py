# SPDX-License-Identifier: MIT
"""Whose a port is: one program has it at a time, and everybody else before and after.

To root every door is open, so what others meet is tried as another user: in a program of its own,
which begins as root at the most.
"""

import os
import subprocess
import sys

import pytest

from tiers import TOP

INTERPRETERS = "host"

NOBODY = 65534
LEFT_OVER = "%s is left over: the terminal that it leads to was made after it, by somebody else"

BEGIN = """
import fcntl, os, signal, struct, sys, termios, time
sys.path.insert(0, %r)
from tools.port.serial_port import PortError, Pty, SerialPort

def become_nobody():
    if os.getuid() == 0:
        os.setgroups([])
        os.setgid(%d)
        os.setuid(%d)

def opens(path):
    port = SerialPort(path, 19200)
    try:
        port.open()
    except PortError as error:
        return str(error)
    port.close()
    os.close(os.open(path, os.O_RDWR | os.O_NOCTTY))
    return "opened"
""" % (str(TOP), NOBODY, NOBODY)


def tells(program):
    """The lines that a program says which begins with the functions above."""
    done = subprocess.run(
        [sys.executable, "-B", "-c", BEGIN + program],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, timeout=60,
        start_new_session=True,
    )  # fmt: skip
    return done.stdout.decode().splitlines()


def test_a_pty_is_used_by_one_after_the_other():
    assert tells("""
become_nobody()
pty = Pty()
pty.open()
print(opens(pty.path))
print(opens(pty.path))
""") == ["opened", "opened"]


def test_by_one_at_a_time_and_by_the_next_one_even_when_that_was_killed():
    said = tells("""
become_nobody()
pty = Pty()
pty.open()
told, tell = os.pipe()
child = os.fork()
if child == 0:
    port = SerialPort(pty.path, 19200)
    port.open()
    os.write(tell, b"!")
    signal.pause()
os.read(told, 1)
print(opens(pty.path).replace(pty.path, "it"))
os.kill(child, signal.SIGKILL)
os.waitpid(child, 0)
print(opens(pty.path))
""")
    assert said == ["it is in use by another program", "opened"]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="asks as Linux has it")
def test_nobody_is_kept_from_a_pty_whoever_is_root():
    assert tells("""
TIOCGEXCL = 0x80045440
pty = Pty()
pty.open()
port = SerialPort(pty.path, 19200)
port.open()
exclusive = bytearray(4)
fcntl.ioctl(port.fileno(), TIOCGEXCL, exclusive)
print(struct.unpack("i", exclusive)[0])
""") == ["0"]


@pytest.mark.parametrize("name", ["os.ttyname(slave)", "'/dev/tty'"])
def test_the_terminal_in_which_it_runs_is_no_port(name):
    said = tells(
        """
master, slave = os.openpty()
fcntl.ioctl(slave, termios.TIOCSCTTY, 0)
before = termios.tcgetattr(slave)
print(opens(%s))
print(termios.tcgetattr(slave) == before)
"""
        % name
    )
    assert said[0].endswith(" is the terminal in which this runs") and said[1] == "True"


@pytest.mark.skipif(os.getuid() != 0, reason="needs two users: root and another one")
def test_whose_terminal_it_is_is_said_to_others():
    (said,) = tells("""
pty = Pty()
pty.open()
become_nobody()
print(opens(pty.path))
""")
    assert said.endswith(": not allowed: it is a terminal of root")


# ---- the link to a pty --------------------------------------------------------------------------


def linked(link, program="print(opens(pty.path))"):
    """What a program says that makes a pty with this link; the pty is closed at the end."""
    return tells(
        """
pty = Pty(link=%r)
try:
    pty.open()
except PortError as error:
    print(error)
else:
    %s
    pty.close()
"""
        % (str(link), program)
    )


def test_a_link_is_made_and_goes_with_the_pty(tmp_path):
    link = tmp_path / "line"
    assert linked(link, "print(opens(%r))" % str(link)) == ["opened"]
    assert not link.is_symlink()


def test_the_link_of_one_that_was_killed_is_replaced(tmp_path):
    link = tmp_path / "line"
    link.symlink_to("/dev/pts/987654")
    assert linked(link) == ["opened"]
    assert not link.is_symlink()


def test_also_when_somebody_else_has_its_terminal_now(tmp_path):
    link = tmp_path / "line"
    said = tells(
        """
link = %r
killed = Pty(link)
killed.open()
was = killed.path
killed.link = None         # which is left behind
killed.close()
time.sleep(0.1)
other = Pty()
other.open()
print(other.path == was, os.readlink(link) == was)
print(opens(link))          # it is not for us
pty = Pty(link)
pty.open()
print(os.readlink(link) == pty.path != other.path, opens(link))
"""
        % str(link)
    )
    assert said == [
        "True True",
        LEFT_OVER % link,
        "True opened",
    ]


def test_a_pty_that_has_gone_does_not_come_back_as_another_one(tmp_path):
    said = tells(
        """
link = %r
pty = Pty()
pty.open()
os.symlink(pty.path, link)
ports = [SerialPort(pty.path, 19200), SerialPort(link, 19200)]
for port in ports:
    port.open()
    port.close()
    port.open()             # as long as it is the same
    port.close()
was = pty.path
pty.close()
time.sleep(0.1)
other = Pty()
other.open()
print(other.path == was)
for port in ports:
    try:
        port.open()
    except PortError as error:
        print(error)
os.remove(link)
os.symlink(other.path, link)
ports[1].open()
print("opened")
"""
        % str(tmp_path / "line")
    )
    assert said[0] == "True" and said[3:] == ["opened"], said
    assert "has gone for good" in said[1] and "is left over" in said[2], said


def test_the_link_of_one_that_lives_is_not(tmp_path):
    link = tmp_path / "line"
    path, trouble, still = tells(
        """
pty, other = Pty(link=%r), Pty(link=%r)
pty.open()
print(pty.path)
try:
    other.open()
except PortError as error:
    print(error)
print(os.readlink(%r))
"""
        % (3 * (str(link),))
    )
    assert still == path
    assert trouble.startswith("%s leads to %s, which is not ours" % (link, path))


@pytest.mark.parametrize("there", ["/etc/hostname", "/dev/null", "/no/such/file", "/dev/ttyS0"])
def test_other_links_are_left_alone(tmp_path, there):
    link = tmp_path / "line"
    link.symlink_to(there)
    assert linked(link) == [
        "%s leads to %s, which is not ours: remove it, or use another name" % (link, there)
    ]
    assert os.readlink(link) == there


def test_and_files(tmp_path):
    file = tmp_path / "line"
    file.write_text("kept")
    assert linked(file) == ["%s: File exists" % file]
    assert file.read_text() == "kept"


def test_a_link_that_somebody_else_has_put_there_meanwhile_stays(tmp_path):
    link = tmp_path / "line"
    replaced = "os.remove(pty.link); os.symlink('/dev/null', pty.link)"
    assert linked(link, replaced) == []
    assert os.readlink(link) == "/dev/null"
