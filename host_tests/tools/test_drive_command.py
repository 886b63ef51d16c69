# SPDX-License-Identifier: MIT
"""./tools/drive as somebody uses it who has a USS master of his own.

The master here is a file descriptor: it writes a telegram and reads what comes.
"""

import fcntl
import os
import select
import signal
import struct
import subprocess
import sys
import time
import tty
from types import SimpleNamespace

import pytest

from boards.sim.line.wire import Burst
from program_bench import DRIVE, PATIENCE_S, Drives, Talking, as_in_a_terminal, programs
from tools.driving import decoding
from tools.port.serial_port import FRAME, PARITY, LineCut, Pty, SerialPort

INTERPRETERS = "host"

SET_PIPE_SIZE = 1031  # F_SETPIPE_SZ, Linux

STOP, RUN = 0x047E, 0x047F
READ_P0700 = (0x12BC, 0, 0, 0)
NOTHING = (0, 0, 0, 0)

program = pytest.fixture(programs)


def telegram(adr, words):
    net = b"".join(struct.pack(">H", word) for word in words)
    characters = bytes((0x02, len(net) + 2, adr)) + net
    bcc = 0
    for character in characters:
        bcc ^= character
    return characters + bytes((bcc,))


class Master:
    """A master that knows nothing but the path of its port."""

    def __init__(self, path):
        self.port = os.open(path, os.O_RDWR | os.O_NOCTTY)

    def asks(self, characters, size=16):
        """The reply, of so many characters."""
        os.write(self.port, characters)
        return self.hears(size)

    def hears(self, size=16, patience_s=PATIENCE_S):
        deadline = time.monotonic() + patience_s
        heard = b""
        while len(heard) < size and (left_s := deadline - time.monotonic()) > 0:
            if select.select([self.port], [], [], left_s)[0]:
                heard += os.read(self.port, 300)
        return heard

    def is_not_answered(self, characters, silence_s=0.1):
        os.write(self.port, characters)
        return self.hears(1, silence_s) == b""


def test_a_master_reads_starts_and_stops(program):
    drives = program(Drives, "--address", "5", "--family", "mm440")
    master = Master(drives.path)
    reply = master.asks(telegram(5, READ_P0700 + (STOP, 0)))
    assert reply[:11] == b"\x02\x0e\x05\x12\xbc\x00\x00\x00\x00\x00\x05"
    master.asks(telegram(5, NOTHING + (STOP, 0)))
    master.asks(telegram(5, NOTHING + (RUN, 0x1000)))
    drives.waits(5, state="running", hz="12.50")
    master.asks(telegram(5, NOTHING + (STOP, 0)))
    drives.waits(5, state="ready")


def test_several_drives_of_several_families_share_the_line(program):
    drives = program(Drives, "--address", "1,2=g110,3=mm3", "--set", "2:P2013=0")
    master = Master(drives.path)
    assert len(master.asks(telegram(1, NOTHING + (STOP, 0)))) == 16
    assert len(master.asks(telegram(2, (STOP, 0)), 8)) == 8
    assert len(master.asks(telegram(3, NOTHING[:3] + (STOP, 0)), 14)) == 14
    assert master.is_not_answered(telegram(4, NOTHING + (STOP, 0)))


def test_it_is_told_what_happens_to_the_drive(program):
    drives = program(Drives)
    master = Master(drives.path)
    request = telegram(1, NOTHING + (STOP, 0))
    drives.does("fault 1 F0001")
    assert drives.report()["fault"] == "F0001"
    assert master.asks(request)[12] & 0x08
    drives.does("unplug 1")
    assert drives.report()["state"] == "fault"
    assert master.is_not_answered(request)
    drives.does("plug 1")
    drives.report()
    assert len(master.asks(request)) == 16


def test_mains_off_and_on_lose_the_ram_and_keep_the_eeprom(program):
    drives = program(Drives, "--set", "P1082=40.0", "--switch", "boot_ms=0")
    master = Master(drives.path)
    write = (0x24C7, 0x0000, 0, 0)  # P1223: there is none
    assert master.asks(telegram(1, write + (STOP, 0)))[3] >> 4 == 7
    write_p2011 = (0x200B, 0x8000, 0, 7)  # into the RAM
    assert master.asks(telegram(1, write_p2011 + (STOP, 0)))[3] >> 4 == 1
    assert len(master.asks(telegram(7, NOTHING + (STOP, 0)))) == 16
    drives.does("off 1")
    assert drives.report()["state"] == "off"
    assert master.is_not_answered(telegram(7, NOTHING + (STOP, 0)))
    drives.does("on 1")
    assert drives.report()["address"] == "1"
    assert drives.asked("param 1 P1082") == "P1082[0]=40.0"
    assert len(master.asks(telegram(1, NOTHING + (STOP, 0)))) == 16


def test_a_drive_that_powers_up_ready_starts_for_an_on_that_stands(program):
    drives = program(Drives, "--switch", "clean_power_up=1", "--set", "P1120=0.0")
    assert drives.asked("switch 1 clean_power_up") == "clean_power_up=1"
    assert drives.asked("switch 1 boot_ms=100") == "boot_ms=100"
    master = Master(drives.path)
    master.asks(telegram(1, NOTHING + (STOP, 0x1000)))
    master.asks(telegram(1, NOTHING + (RUN, 0x1000)))
    assert drives.report()["starts"] == "1"
    drives.does("off 1")
    assert master.is_not_answered(telegram(1, NOTHING + (RUN, 0x1000)))
    drives.does("on 1")
    assert drives.report()["state"] == "off"  # it boots
    for _ in range(20):
        os.write(master.port, telegram(1, NOTHING + (RUN, 0x1000)))
        time.sleep(0.05)
        if drives.report()["starts"] == "2":
            break
    report = drives.report()
    assert (report["state"], report["starts"], report["fault"]) == ("running", "2", "-")


def test_the_log_says_every_telegram_in_words(program):
    drives = program(Drives, "--log")
    master = Master(drives.path)
    master.asks(telegram(1, READ_P0700 + (STOP, 0x1000)))
    said = "> A1  read P0700[0]                STW 047E HSW   25.00 %  OFF1"
    assert drives.line().endswith(said)
    assert "< A1  is P0700[0] = 5" in drives.line()
    os.write(master.port, telegram(1, READ_P0700 + (STOP, 0))[:-1] + b"\x00")
    assert drives.line().endswith("(BCC 00 should be D9)")


def test_the_log_says_how_a_telegram_was_meant_when_it_began(program):
    """What it writes, address or layout, is in force from its reply on, and not before."""
    for switch in ("layout_at_once=0", "layout_at_once=1"):
        drives = program(Drives, "--log", "--switch", switch)
        master = Master(drives.path)
        master.asks(telegram(1, (0x200B, 0x8000, 0, 7, STOP, 0)))
        assert "> A1  write P2011[0] = 7  " in drives.line()
        assert "< A1  is P2011[0] = 7  " in drives.line()
        master.asks(telegram(7, (0x200C, 0x8000, 0, 4, STOP, 0)))
        assert "> A7  write P2012[0] = 4  " in drives.line()
        assert "< A7  is P2012[0] = 4  " in drives.line()
        master.asks(telegram(7, (0x100C, 0x8000, 0, 0, STOP, 0, 0, 0)), 20)
        assert "> A7  read P2012[0]  " in drives.line()
        assert "< A7  is P2012[0] = 4  " in drives.line()


def test_who_talks_into_a_reply_is_told_so_and_hears_no_more_of_it(program):
    drives = program(Drives, "--log", "--baud", "600", "--family", "generic")
    master = Master(drives.path)
    request = telegram(1, NOTHING + (STOP, 0))  # 0.3 s, and so is the reply
    said = [""]
    while "talked into" not in said[-1]:  # or it was too late: the machine has stalled
        os.write(master.port, request)
        heard = master.hears(1)
        os.write(master.port, request)
        drives.does("wait 1500", "drive 1")
        said = [drives.line()]
        while not said[-1].startswith("address=1 "):
            said.append(drives.line())
        said.pop()
        heard += master.hears(300, 0.05)
    _, answered, spoilt = said
    assert spoilt.endswith(" >" + 16 * " ??" + "  (talked into: 16 of 16 characters damaged)")
    assert " ??  (talked into: " in answered and len(heard) < 16
    assert " < " + " ".join("%02X" % character for character in heard) + " ??" in answered


def test_the_drives_do_not_wait_for_whoever_reads_the_log(program):
    drives = program(Drives, "--log", "--baud", "115200")
    fcntl.fcntl(drives.process.stdout, SET_PIPE_SIZE, 4096)
    master = Master(drives.path)
    for _ in range(100):
        assert len(master.asks(telegram(1, NOTHING + (STOP, 0)))) == 16
    while "lines left out: nobody read them" not in drives.line():
        os.write(master.port, telegram(1, NOTHING + (STOP, 0)))


def test_a_second_after_garbage_at_the_speed_of_a_pty_the_drive_answers(program):
    drives = program(Drives, "--log")  # which nobody reads
    fcntl.fcntl(drives.process.stdout, SET_PIPE_SIZE, 4096)
    port = os.open(drives.path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    garbage, sent = bytes(range(256)) * 16, 0
    until = time.monotonic() + 0.5
    while time.monotonic() < until:
        try:
            sent += os.write(port, garbage)
        except BlockingIOError:
            pass
    assert sent > 20_000, "10 s of a line at 19200"
    os.close(port)
    time.sleep(1)
    master = Master(drives.path)
    master.hears(4096, 0.05)
    assert len(master.asks(telegram(1, NOTHING + (STOP, 0)))) == 16


class Unread(Talking):
    """./tools/drive in a terminal that nobody looks at; what it says on standard error is read."""

    def __init__(self, link, output, *options):
        self.terminal, terminal = os.openpty()
        self.process = subprocess.Popen(
            [DRIVE, "--pty", "--link", link, *options],
            stdin=subprocess.PIPE,
            stdout=terminal if output is None else output,
            stderr=subprocess.PIPE,
            preexec_fn=as_in_a_terminal,
        )
        os.close(terminal)
        self._said = b""
        deadline = time.monotonic() + PATIENCE_S
        while not os.path.exists(link):
            assert time.monotonic() < deadline and self.process.poll() is None
            time.sleep(0.01)

    def shows(self, text):
        """Look at the terminal until this has been there; what has."""
        shown = b""
        deadline = time.monotonic() + PATIENCE_S
        while text.encode() not in shown:
            assert time.monotonic() < deadline, shown[-200:]
            if select.select([self.terminal], [], [], 0.1)[0]:
                shown += os.read(self.terminal, 65536)
        return shown.decode()


@pytest.mark.parametrize("how", ["full", "stopped"])
def test_nor_for_whoever_looks_at_a_terminal(program, tmp_path, how):
    link = str(tmp_path / "line")
    drives = program(Unread, link, None, "--log", "--baud", "115200")
    drives.shows(link)
    if how == "stopped":
        os.write(drives.terminal, b"\x13")  # Ctrl-S
    master = Master(link)
    for _ in range(600 if how == "full" else 20):  # 100 kB
        assert len(master.asks(telegram(1, NOTHING + (STOP, 0)))) == 16
        drives.does("drive 1")
    if how == "stopped":
        os.write(drives.terminal, b"\x11")
    shown = drives.shows("lines left out: nobody read them")
    drives.does("param 1 P0700")
    shown += drives.shows("P0700[0]=5")
    assert "\r\n" in shown
    drives.process.send_signal(signal.SIGINT)
    assert drives.process.wait(PATIENCE_S) == 0
    assert drives.process.stderr.read() == b""
    os.close(drives.terminal)


def test_ctrl_c_ends_it_while_its_terminal_is_stopped(program, tmp_path):
    link = str(tmp_path / "line")
    drives = program(Unread, link, None, "--log")
    os.write(drives.terminal, b"\x13")
    assert len(Master(link).asks(telegram(1, NOTHING + (STOP, 0)))) == 16
    drives.process.send_signal(signal.SIGINT)
    assert drives.process.wait(PATIENCE_S) == 0 and not os.path.islink(link)
    os.close(drives.terminal)


@pytest.mark.parametrize(
    "how, why", [("full", "No space left on device"), ("gone", "Input/output error")]
)
def test_a_log_that_cannot_be_written_is_said_once(program, tmp_path, how, why):
    link = str(tmp_path / "line")
    if how == "full":
        with open("/dev/full", "wb") as full:
            drives = program(Unread, link, full, "--log")
    else:
        drives = program(Unread, link, None, "--log")
    os.close(drives.terminal)
    master = Master(link)
    for _ in range(5):
        assert len(master.asks(telegram(1, NOTHING + (STOP, 0)))) == 16
        drives.does("drive 1", "jump", "off 9")
    drives.does("quit")
    assert drives.process.wait(PATIENCE_S) == 0
    assert drives.process.stderr.read().decode() == (
        "tools/drive: standard output: %s; the drives are served all the same\n" % why
    )


def test_who_has_read_enough_ends_it(program):
    command = '"$1" --pty --log | { read path; echo "$path"; }; echo "${PIPESTATUS[0]}"'
    drives = program(Talking, "bash", "-c", command, "-", DRIVE)
    master = Master(drives.line())
    with pytest.raises(OSError):
        while True:
            os.write(master.port, telegram(1, NOTHING + (STOP, 0)))
            master.hears(16, 0.1)
    assert drives.ends() == 0 and drives.rest == "0\n"


def test_a_closed_standard_input_gives_no_commands(program):
    drives = program(Talking, "bash", "-c", 'exec "$1" --pty <&-', "-", DRIVE)
    master = Master(drives.line())
    assert len(master.asks(telegram(1, NOTHING + (STOP, 0)))) == 16


def test_a_reply_delay_is_kept(program):
    drives = program(Drives, "--reply-delay", "150")
    master = Master(drives.path)
    began = time.monotonic()
    master.asks(telegram(1, NOTHING + (STOP, 0)))
    assert time.monotonic() - began > 0.15


def test_commands_that_make_no_sense_are_told_and_change_nothing(program):
    drives = program(Drives)
    assert "no panel here" in drives.asked("press START")
    unknown = drives.asked("jump")
    assert unknown.startswith("unknown command jump (there are: wait ")
    assert unknown.endswith(" help quit)") and "press" not in unknown
    assert drives.asked("off").endswith(": use: off A")
    assert drives.asked("off 9").endswith(": no drive at address 9: there are 1 (use: off A)")
    assert drives.asked("switch 1 boot_ms=x").endswith("(use: switch A NAME[=VALUE])")
    assert "quit" in drives.asked("help")
    drives.does("quit")
    assert drives.ends() == 0


@pytest.mark.parametrize("digits", [400, 5000])  # Python reads 4300
def test_numbers_may_be_of_any_length(program, digits):
    drives = program(Drives)
    number = digits * "9"
    for command in (
        "supply 1 %s", "load 1 %s", "late 1 %s", "babble %s", "strike lost %s", "dip %s",
        "param 1 P2014 %s", "param 1 P1082 %s.0", "line flip %s",
    ):  # fmt: skip
        drives.does(command % number)
    drives.does("quit")
    assert drives.ends() == 0 and "Traceback" not in drives.rest


def test_drives_are_served_however_long_a_command_waits(program):
    drives = program(Drives)
    drives.does("drive 1", "wait 8640000000")
    drives.line()
    assert len(Master(drives.path).asks(telegram(1, NOTHING + (STOP, 0)))) == 16
    drives.process.send_signal(signal.SIGINT)
    assert drives.ends() == 0 and drives.rest == ""


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, None])
def test_it_ends_quietly(program, tmp_path, ending):
    link = tmp_path / "line"
    drives = program(Drives, "--link", str(link))
    assert link.is_symlink() and drives.path == str(link)
    drives.report()
    if ending is None:
        drives.process.stdin.close()  # that is no reason to end
        assert len(Master(drives.path).asks(telegram(1, NOTHING + (STOP, 0)))) == 16
        ending = signal.SIGINT
    drives.process.send_signal(ending)
    assert drives.ends() == 0 and drives.rest == ""
    assert not link.is_symlink()


@pytest.mark.parametrize(
    "words, status, why",
    [
        ((), 2, "one of the arguments --pty --port is required"),
        (("--pty", "--address", "32"), 2, "--address: 32 is no address 0...31"),
        (("--pty", "--address", "1,1"), 2, "--address: 1 stands there twice"),
        (("--pty", "--address", "1=mm9"), 2, "--address: no family mm9"),
        (("--pty", "--set", "3:P2014=0"), 2, "--set 3:P2014=0: use A:P2014=0"),
        (("--pty", "--set", "P2014=much"), 2, "--set P2014=much: much is no number"),
        (("--pty", "--address", "\u00b2"), 2, "is no address 0...31"),
        (("--pty", "--reply-delay", "nan"), 2, "nan is not 0...60000 ms"),
        (("--pty", "--reply-delay", "-1"), 2, "-1 is not 0...60000 ms"),
        (("--pty", "--switch", "1:no_such=1"), 2, "there is no such switch; --switch help"),
        (("--pty", "--switch", "silence_s=5"), 2, "there is no such switch; --switch help"),
        (("--pty", "--switch", "stale_replies=-1"), 2, "stale_replies=-1: it can be 0...65535"),
        (("--pty", "--switch", "stale_replies=2.5"), 2, "it can be 0...65535"),
        (("--pty", "--switch", "no_rights_error=99"), 2, "it can be one of 0, 7, 11"),
        (("--pty", "--switch", "1:reexecute=7"), 2, "it can be 0 or 1"),
        (("--pty", "--baud", "12345"), 2, "invalid choice: 12345"),
        (("--pty", "--baud", "300"), 2, "has no code for 300 baud"),
        (("--pty", "--address", "1", "--drives", "2"), 2, "--drives stands there twice"),
        (("--pty", "--baud=9600", "--baud=9600"), 2, "--baud stands there twice"),
        (("--pty", "--switch", "1:stale_replies=True"), 2, "stale_replies=True: it can be 0"),
        (("--pty", "--switch", "1:reexecute=maybe"), 2, "reexecute=maybe: it can be 0 or 1"),
        (("--port", "/dev/no_such"), 5, "there is no port /dev/no_such"),
        (("--port", "/dev/null"), 5, "/dev/null is no serial port"),
    ],
)
def test_what_cannot_be_is_refused(program, words, status, why):
    drives = program(Talking, DRIVE, *words)
    assert drives.ends() == status and why in drives.rest


@pytest.mark.parametrize("word", ["1", "True", "on", "false"])
def test_a_switch_is_turned_by_the_word_that_people_write(program, word):
    drives = program(Drives, "--switch", "1:clean_power_up=" + word)
    assert drives.asked("switch 1 clean_power_up") == "clean_power_up=%d" % (word != "false")


def test_idle_it_takes_next_to_no_time(program):
    drives = program(Drives, "--address", ",".join(map(str, range(31))))
    drives.report()
    before = processor_s(drives.process.pid)
    began = time.monotonic()
    while time.monotonic() - began < 1:
        assert Master(drives.path).hears(1, 1) == b""
    assert processor_s(drives.process.pid) - before < 0.05


def processor_s(process):
    with open("/proc/%d/stat" % process) as file:
        times = file.read().rsplit(")", 1)[1].split()[11:13]
    return sum(map(int, times)) / os.sysconf("SC_CLK_TCK")


# ---- the port itself ---------------------------------------------------------------------------


def test_what_parmrk_marks_becomes_flags():
    port = SerialPort("/dev/none", 19200)
    data, flags = port.unmarked(b"\x02\xff\xff\xff\x00\x41\x10\xff")
    assert data == b"\x02\xff\x41\x10" and flags == bytes((0, 0, PARITY, 0))
    data, flags = port.unmarked(b"\x00\x00\x03")  # a break, whose mark came in two pieces
    assert data == b"\x00\x03" and flags == bytes((FRAME, 0))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="as Linux does it")
def test_a_rate_without_a_name_can_be_set():
    master, slave = os.openpty()
    port = SerialPort(os.ttyname(slave), 187500)
    port._descriptor = slave
    tty.setraw(slave)
    port.set_other_rate()  # reads back what it has set
    os.close(slave)
    os.close(master)


def test_a_pty_that_is_closed_is_a_line_that_is_cut():
    ours = Pty()
    ours.open()
    port = SerialPort(ours.path, 19200)
    port.open()
    assert port.is_pty
    ours.write(b"\x02\xff\n\r")
    assert select.select([port], [], [], PATIENCE_S)[0]
    assert port.read()[0] == b"\x02\xff\n\r"
    assert port.read()[0] == b""
    ours.close()
    with pytest.raises(LineCut):
        for _ in range(2):
            port.read()
    port.close()


# ---- the log in words ---------------------------------------------------------------------------


def setup(address, pkw, **others):
    usual = {"two_directions": False, "raw_numbers": False, "second_word": True}
    return SimpleNamespace(address=address, layout=(pkw, 2), **{**usual, **others})


DRIVES = {
    1: setup(1, 4),
    2: setup(2, 127),
    3: setup(3, 0),
    4: setup(4, 127, second_word=False),
    5: setup(5, 3, two_directions=True),  # a MICROMASTER 3
    6: setup(6, 4, raw_numbers=True),
}
TEXT = struct.unpack(">8H", b"BAUDRATE FOR XS2")


@pytest.mark.parametrize(
    "adr, words, said",
    [
        (1, (0x3000, 0x8000, 0x4248, 0x0000, 0x047F, 0xE000),
         "write long P2000[0] = 50 (42480000) STW 047F HSW  -50.00 %  ON"),
        (1, NOTHING + (0x04FE, 0), "-                            "
         "STW 04FE HSW    0.00 %  OFF1, ACKNOWLEDGE"),
        (2, (0x200B, 0x8000, 0x0007, 0x047E, 0), "write P2011[0] = 7"),
        (2, (0x22BC, 0, 0, 5, 0x047E, 0), "write P0700[0] = 5"),  # four words all the same
        (2, (0x22BC, 0, 5, 0, 0x047E, 0), "write P0700[0] = 5"),
        (4, (0x22BC, 0, 5, 6, 0x047E, 0), "write P0700[0] = 5"),
        (2, (0x72BC, 0xFF, 5, 4, 3, 0x047E, 0), "write array P0700[255] = 5, 4, 3 "),
        (2, (0x8460, 0xFF, 0x4120, 0, 0, 7, 0x047E, 0),
         "write array long P1120[255] = 10 (41200000), 7 "),
        (2, (0xF009, 0x0002, 0, 0x047E, 0), "read text P0009[2]  "),
        (2, (0xF009, 0x0202, 0, 0x047E, 0), "read text P0009[2], field 2  "),
        (2, (0xF009, 0x0102) + TEXT + (0x047E, 0), "write text P0009[2] = 'BAUDRATE FOR XS2'"),
        (2, (0xF009, 0x0302) + TEXT + (0x047E, 0), "write text P0009[2], field 2 = 'BAUDRATE"),
        (1, (0x27DD, 0, 0, 4, 0x047E, 0), "write PNU 2013[0] (no page) = 4"),
        (1, (0x17DD, 0x8000, 0, 0, 0x047E, 0), "read PNU 2013[0] (page 80)"),
        (6, (0x17DD, 0, 0, 0, 0x047E, 0), "read P2013[0] "),
        (3, (0x0C7F, 0x2000), "STW 0C7F HSW   50.00 %  ON, REVERSE"),
        (5, NOTHING[:3] + (0x0C7F, 0x2000), "STW 0C7F HSW   50.00 %  ON, RIGHT"),
        (5, NOTHING[:3] + (0x147F, 0x2000), "STW 147F HSW   50.00 %  ON, LEFT"),
        (3, (0x0000, 0x2000), "NOT BY PLC"),
        (0x41, NOTHING + (0x047E, 0), "A1  mirror"),
        (0x20, (0x8002, 0, 0, 0, 0x047E, 0), "all broadcast, enable 8002 0000 0000 0000 047E"),
        (0x81, NOTHING + (0x047E, 0), "(special telegram)"),
        (9, NOTHING + (0x047E, 0), "(nobody has address 9)"),
        (1, (0x047E, 0), "(A1 has 4 + 2 words: LGE 6 should be 14)"),
    ],
)  # fmt: skip
def test_a_request_in_words(adr, words, said):
    assert said in decoding.line(0, True, telegram(adr, words), DRIVES)


@pytest.mark.parametrize(
    "adr, words, said",
    [
        (1, (0x73E8, 0, 0, 2, 0xFB31, 0), "error P1000[0] = 2"),
        (2, (0x73E8, 0, 2, 0xFB31, 0), "error P1000[0] = 2 "),
        (2, (0x7001, 0, 0, 2, 0xFB31, 0), "error P0001[0] = 0 "),  # then the next number there is
        (2, (0x72BC, 0xFF, 108, 0xFB31, 0), "error P0700[255] = 108 "),
        (2, (0x12BC, 0, 5, 0xFB31, 0), "is P0700[0] = 5 "),
        (2, (0x42BC, 0xFF, 5, 4, 3, 0xFB31, 0), "is array P0700[255] = 5, 4, 3 "),
        (2, (0x42BC, 1, 5, 0xFB31, 0), "is array P0700[1] = 5 "),
        (2, (0x62BC, 0, 3, 0xFB31, 0), "elements P0700[0] = 3 "),
        (2, (0xF009, 0x0102) + TEXT + (0xFB31, 0), "text P0009[2] = 'BAUDRATE FOR XS2'"),
        (5, (0x705B, 0, 2, 0xFB31, 0), "error P0091[0] = 2 "),
        (5, NOTHING[:3] + (0xFB34, 0x1000), "running, at setpoint"),
        (1, (0x83E8, 0, 0, 0, 0xFB31, 0), "no change rights P1000[0]"),
        (1, NOTHING + (0xFB34, 0x1000), "ZSW FB34 HIW   25.00 %  running, at setpoint"),
        (9, NOTHING + (0xFB34, 0x1000), "(another drive's)"),
    ],
)
def test_a_reply_in_words(adr, words, said):
    assert said in decoding.line(1_500_000, False, telegram(adr, words), DRIVES)


def test_what_is_no_telegram_is_shown_as_it_is():
    for characters, why in (
        (b"\x55", "55  (no STX)"),
        (b"\x02", "02  (cut off: 1 characters)"),
        (b"\x02\x0e\x01", "02 0E 01  (cut off: 3 of 16 characters)"),
        (2 * telegram(3, (0x047E, 0)), "(8 characters behind the telegram, without a pause)"),
    ):
        assert decoding.line(0, True, characters, DRIVES).endswith(why)


@pytest.mark.parametrize(
    "page, first",
    [
        (0x00, 0), (0x80, 2000), (0x10, 4000), (0x90, 6000), (0x20, 8000), (0xA0, 10000),
        (0x30, 12000), (0xB0, 14000), (0x40, 16000), (0x50, 20000), (0xF0, 30000), (0x04, 32000),
        (0x74, 60000), (0x08, 64000),
    ],
)  # fmt: skip
def test_the_page_makes_the_number(page, first):
    read = telegram(1, (0x100D, page << 8 | 1, 0, 0, STOP, 0))
    assert "read P%04d[1] " % (first + 13) in decoding.line(0, True, read, DRIVES)


def test_damaged_characters_are_not_told_as_if_they_had_been_sent():
    ends = [573 * (i + 1) for i in range(260)]
    request = telegram(1, READ_P0700 + (STOP, 0))
    burst = Burst(ends, 573)
    burst.begin(0, 10_000)
    burst.append(request, len(request))
    assert decoding.said(burst) == (list(request), "")
    burst.blame(4, PARITY)
    characters, damage = decoding.said(burst)
    assert decoding.line(0, True, characters, DRIVES, damage).endswith(
        "> 02 0E 01 12 ?? 00 00 00 00 00 00 04 7E 00 00 D9  "
        "(parity or stop bit wrong: 1 of 16 characters)"
    )
    burst.begin(0, 10_000)
    burst.append(request, len(request))
    burst.garble(3 * 573)
    characters, damage = decoding.said(burst)
    assert decoding.line(0, True, characters, DRIVES, damage).endswith(
        "> 02 0E 01" + 13 * " ??" + "  (talked into: 13 of 16 characters damaged)"
    )
