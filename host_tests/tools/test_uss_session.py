# SPDX-License-Identifier: MIT
"""A technician's session with ./tools/uss: in virtual time, or on drives of ./tools/drive."""

import json
import os
import signal
import subprocess
import time

import pytest

from conftest import strict
from program_bench import Drives, programs
from tiers import TOP
from uss_command_bench import COMMAND, ENVIRONMENT, hubs, start, telegram, told, uss
from uss_virtual_bench import World

INTERPRETERS = "host"

FAST = ("--baud", "115200")
OFF = telegram("02 0E 01 00 00 00 00 00 00 00 00 04 7E 00 00")
ON = telegram("02 0E 01 00 00 00 00 00 00 00 00 04 7F 0C CD")

program = pytest.fixture(programs)
hub = pytest.fixture(hubs)


def run(drives, line):
    """As another master does it."""
    line.say(OFF)
    drives.waits(state="ready")
    time.sleep(0.1)  # its answer is over
    line.say(ON)
    drives.waits(state="running")


def test_mirror_read_and_write_as_the_first_program_did():
    """The MM440 of that program: address 0, P0700 = 4, P1082 = 50; 2 and 40.5 are written."""
    world = World({0: "mm440"}, parameters={0: {700: 4}})
    assert world.uss("--address", "0", "mirror").json["ok"]
    wrong = world.uss("--address", "1", "mirror")
    assert wrong.status == 1 and wrong.error.startswith("drive 1 does not answer at 19200 baud")
    there = ("--address", "0", "--kind", "mm440")
    both = world.uss(*there, "read", "P0700", "P1082")
    assert [(row["value"], row["type"], row["unit"]) for row in both.rows] == [
        (4, "U16", ""), (50.0, "Float", "Hz"),
    ]  # fmt: skip
    assert (
        both.rows[0]["shown"] == "4 USS on BOP link" and both.rows[1]["name"] == "Max. frequency"
    )
    for words in (("P0700", "--type", "float"), ("P1082", "--type", "word"),
                  ("P0700", "--type", "dword")):  # fmt: skip
        refused = world.uss(*there, "read", *words)
        assert refused.status == 1 and "not of type" in refused.error
    assert world.uss(*there, "read", "P0700", "--type", "word").rows[0]["value"] == 4
    asked = world.uss(*there, "write", "P0700", "2")
    assert asked.status == 1 and "--sure" in asked.error
    assert world.drives[0].read(700, 0) == 4
    assert world.uss(*there, "write", "P0700", "2", "--sure").rows[0]["before"] == 4
    assert world.uss(*there, "write", "P1082", "40.5").rows[0]["value"] == 40.5
    both = world.uss(*there, "read", "P0700", "P1082")
    assert [row["value"] for row in both.rows] == [2, 40.5]


def test_the_free_telegram_of_the_terminal_program_and_its_answer_as_printed(program):
    drives = program(
        Drives, "--baud", "57600", "--address", "0=g110/0", "--set", "P1120=0.5", "--set",
        "P1121=0.5",
    )  # fmt: skip
    free = ("send", "02 06 00 04 7F 20 00")
    refused = uss(drives.path, *free, baud=57600)
    assert refused.status == 1 and "send --on" in refused.error
    assert drives.report(0)["starts"] == "0"
    assert uss(drives.path, "send", "02 06 00 04 7E 00 00", baud=57600).status == 0
    sent = uss(drives.path, *free, "--on", "--for", "1.5", baud=57600)
    shown = [one["hex"] for one in sent.all]
    assert sent.status == 0 and "02 06 00 04 7F 20 00 5F" in shown
    assert "02 06 00 FB 34 20 00 EB" in shown
    assert drives.report(0)["state"] == "ready", "OFF1 has followed"


def test_drives_of_two_rates_are_found_on_one_port_and_left_in_peace(program, hub):
    """More of them: test_uss_peace.py."""
    slow = program(Drives, "--baud", "19200", "--address", "1=v20/4", "--set", "P2014=2000")
    fast = program(Drives, "--baud", "38400", "--address", "3=mm440/4+4", "--set", "P2014=2000")
    line = hub({19200: slow.path, 38400: fast.path})
    scan = ("--standing", "scan", "--addresses", "1,3", "--rates", "19200,38400")
    process = start(line.path, *scan, baud=19200)
    found = json.loads(process.stdout.readline())
    assert {row["address"]: (row["baud"], row.get("kind")) for row in found["rows"]} == {
        1: (19200, "v20/4"), 3: (38400, "mm420/4+4"),
    }  # fmt: skip
    assert [json.loads(process.stdout.readline())["asked_on"] for _ in range(2)] == [True, True]
    time.sleep(2.5)
    for drives, address in ((slow, 1), (fast, 3)):
        report = drives.report(address)
        assert report["fault"] == "-" and report["starts"] == "0", report
    process.send_signal(signal.SIGTERM)
    ended = told(process)
    assert ended.status == 0 and [one["asked_on"] for one in ended.trips] == [False, False]


def test_a_motor_that_its_master_has_left_running_runs_on(tmp_path):
    """Its master is paused: reading, scanning and saving command nothing."""
    world = World({1: "mm420"})
    world.plc.commands({1: 0x047E})
    world.run(0.5)
    world.plc.commands({1: 0x047F})
    world.run(0.5)
    world.plc.pause()
    world.run(0.2)
    mm420 = ("--kind", "mm420")
    assert world.uss(*mm420, "read", "P0700", "r0021").status == 0
    found = world.uss(*mm420, "scan", "--addresses", "0-2", "--rates", "19200,9600")
    assert found.rows[0]["motor"] == "runs" and {row["baud"] for row in found.rows} == {19200}
    assert "other rates are not tried" in found.json["remarks"][0]
    assert world.uss(*mm420, "backup", str(tmp_path / "a"), "--numbers", "0-1099").status == 0
    shown = world.uss(*mm420, "monitor", "--for", "0.4", "--every", "0.2")
    assert shown.json["state"] == "running"
    refused = world.uss(*mm420, "restore", str(tmp_path / "a"))
    assert refused.status == 1 and "runs" in refused.error
    drive = world.drives[1]
    assert (drive.state, drive.stw, drive.starts) == ("running", 0x047F, 1)


def test_beside_a_master_that_talks_nothing_is_sent_and_sniff_shows_it(program, hub, tmp_path):
    drives = program(Drives, *FAST)
    line = hub(drives.path)
    run(drives, line)
    asked = [
        start(line.path, "sniff", "--for", "1.2", "--save", str(tmp_path / "heard"), baud=115200)
    ]
    for _ in range(60):
        line.say(ON)
        try:
            asked[0].wait(0.04)
        except subprocess.TimeoutExpired:
            pass
    heard = told(asked[0])
    assert heard.status == 0, heard.error
    (row,) = heard.rows
    assert row["address"] == 1 and row["stw"] == "047F" and row["state"] == "running"
    assert row["answered_per_s"] > 1 and row["net"] == 12
    assert uss(None, "decode", "--capture", str(tmp_path / "heard")).status == 0
    reader = start(line.path, "read", "P0700")
    while reader.poll() is None:
        line.say(ON)
        try:
            reader.wait(0.05)
        except subprocess.TimeoutExpired:
            pass
    refused = told(reader)
    assert refused.status == 1 and "another master talks on this line" in refused.error
    assert drives.report()["stw"] == "047F"


def test_values_over_time_as_a_table_and_a_picture(tmp_path):
    world = World({1: "mm420"})
    csv, svg = tmp_path / "values.csv", tmp_path / "values.svg"
    kept = world.uss("--standing", "record", str(csv), "--values", "hertz,zsw,r0027", "--for", "9",
                     "--every", "0.2", "--svg", str(svg))  # fmt: skip
    assert kept.status == 0, kept.error
    lines = csv.read_text().splitlines()
    assert lines[0] == "time_s,hertz (Hz),zsw,r0027[0] Output current (A)"
    assert len(lines) == 1 + kept.json["rows"] and lines[1].split(",")[2] == str(0xFBC1)
    assert svg.read_text().count("<polyline") == 3


def test_a_trace_is_shown_and_kept(program, tmp_path):
    drives = program(Drives, *FAST)
    shown = uss(
        drives.path,
        "--standing",
        "trace",
        "P0700",
        "--for",
        "0.6",
        "--save",
        str(tmp_path / "kept"),
    )
    assert shown.status == 0, shown.error
    said = [one["summary"] for one in shown.all]
    assert any("read P0700[0], nothing commanded" in one for one in said)
    assert any("a word P0700[0] = 5" in one for one in said)
    explained = uss(None, "decode", "--capture", str(tmp_path / "kept"))
    assert explained.status == 0 and len(explained.all) == len(shown.all)


def test_a_drive_is_commissioned_by_the_steps_of_the_catalogue(program):
    drives = program(Drives, *FAST, "--set", "P1082=60")
    done = uss(drives.path, "--standing", "commission", "mm420", "--yes", "--set", "P2000=60")
    assert done.status == 0, done.error + done.output
    assert done.json["left"] == 0 and done.json["done"] > 8
    assert drives.asked("param 1 P2000[0]") == "P2000[0]=60.0"
    assert drives.asked("param 1 P2014[0]") == "P2014[0]=2000"
    asked = start(drives.path, "--standing", "commission", "mm420", stdin=subprocess.PIPE)
    output, _ = asked.communicate("\ns\nq\n", timeout=60)
    assert asked.returncode == 1 and '"done": 1' in output and "left out" in output
    other = uss(drives.path, "--standing", "commission", "g110", "--yes")
    assert other.status == 1 and "is a MICROMASTER 420" in other.error


def test_settings_come_from_options_the_environment_or_a_file(program, tmp_path):
    drives = program(Drives, *FAST, "--address", "7")
    (tmp_path / "uss.toml").write_text('port = "%s"\naddress = 7\nbaud = 115200\n' % drives.path)
    command = [*COMMAND, "--json", "mirror"]

    def run(**environment):
        return subprocess.run(command, cwd=tmp_path, env={**ENVIRONMENT, **environment},
                              capture_output=True, text=True, timeout=60)  # fmt: skip

    assert json.loads(run().stdout)["address"] == 7
    assert "drive 8" in run(USS_ADDRESS="8").stderr
    (tmp_path / "uss.toml").write_text("prot = 1\n")
    assert "no setting prot" in run().stderr


@pytest.mark.parametrize(
    "status, words, said",
    (
        (1, ("mirror",), "which port?"),
        (5, ("--port", "/dev/nothing-is-here", "mirror"), "there is no port"),
        (5, ("--port", "/dev/null", "mirror"), "is no serial port"),
        (5, ("--port", "/etc/hostname", "mirror"), "is no serial port"),
        (2, ("--baud", "12345", "mirror"), "no rate of USS"),
        (2, ("--baud", "fast", "mirror"), "is no number"),
        (2, ("--address", "32", "mirror"), "not within 0...31"),
        (2, ("--address", "x", "mirror"), "no list"),
        (2, ("--address", "1,2", "--port", "x", "mirror"), "about one drive"),
        (2, ("--kind", "mm999", "mirror"), "no family mm999"),
        (2, ("--reply-timeout", "5", "mirror"), "20...2000 ms"),
        (2, ("--config", "/nowhere.toml", "mirror"), "No such file"),
        (2, ("--port", "x", "read", "hello"), "no parameter"),
        (2, ("--port", "x", "scan", "--rates", "1,2"), "no list of rates"),
        (2, ("--port", "x", "run"), "wants one speed"),
        (2, ("send", "xyz"), "hexadecimal"),
        (1, ("send", "02 06 00 04 7E 20 00 00"), "BCC is 00, should be"),
        (1, ("compare", "/etc/hostname"), "no parameter set"),
        (1, ("compare", "/nowhere"), "No such file"),
        (1, ("restore", "/nowhere"), "No such file"),
    ),
)
def test_bad_input_gets_one_clear_line(status, words, said):
    refused = uss(None, *words, baud=9600) if words[0] != "--baud" else uss(None, *words)
    assert refused.status == status, (refused.status, refused.error)
    assert said in refused.error and refused.error.count("\n") == 0
    assert refused.json == {"error": refused.error}


def test_a_port_that_another_has_is_said_to_be_in_use(program):
    drives = program(Drives, *FAST)
    holder = start(drives.path, "--standing", "monitor", "--for", "3")
    holder.stdout.readline()
    assert uss(drives.path, "mirror").error.endswith("is in use by another program")
    holder.kill()
    told(holder)


def test_values_that_make_no_sense_are_refused():
    world = World({1: "mm420"})
    for words, said in (
        (("P1082", "fast"), "is not a number"),
        (("P1082", "nan"), "is not a number"),
        (("P1082", "9999"), "beyond the limits"),
        (("P1082", "1e99"), "no single-precision number"),
        (("P0700", "1.5"), "is not an integer"),
        (("P0700", "70000", "--sure"), "is not within"),
        (("P9999", "1"), "no such parameter"),
        (("r0021", "1"), "read-only"),
    ):
        refused = world.uss("--kind", "mm420", "write", *words)
        assert refused.status in (1, 2) and said in refused.error, (words, refused.error)


def test_help_is_instant_and_installs_nothing():
    command = os.path.join(TOP, "tools", "uss")
    for words, said in (
        (("--help",), "usage: tools/uss"),
        (("run", "--help"), "usage: tools/uss run"),
        ((), "tools/uss: the following arguments are required: COMMAND\n"),
    ):
        shown = subprocess.run([command, *words], text=True, capture_output=True, env=ENVIRONMENT)
        assert (shown.stdout or shown.stderr).startswith(said)
        assert "installing" not in shown.stderr
    if os.path.exists(os.path.join(TOP, "build", "uss")) or strict():
        shown = subprocess.run([command, "decode", "02"], text=True, capture_output=True)
        assert shown.returncode == 1 and "ends behind the first" in shown.stdout, shown.stderr
