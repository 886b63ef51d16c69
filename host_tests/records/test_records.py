# SPDX-License-Identifier: MIT
"""What the line carries and what the display shows while some panels work: as it was recorded.

A change of the firmware that does something else, or at another time, shows here. If it is meant,
write the records anew and read what has changed in them: `runner.py unix64 THIS_FILE write_them`.
"""

import os

from record_bench import made

INTERPRETERS = "unix64"

FOLDER = "host_tests/records/"


def read(name):
    with open(FOLDER + name + ".txt", encoding="utf-8") as file:
        return file.read()


def write_them():
    for name in sorted(os.listdir(FOLDER)):
        if name.endswith(".txt"):
            text = made(read(name[:-4]))
            with open(FOLDER + name, "w", encoding="utf-8") as file:
                file.write(text)


def is_as_recorded(name):
    recorded = read(name)
    anew = made(recorded)
    command = ""
    for line, line_anew in zip(recorded.split("\n"), anew.split("\n")):
        command = line if line.startswith(">") else command
        assert line == line_anew, "%s.txt, %s: it was %r, now it is %r" % (
            name, command, line, line_anew,
        )  # fmt: skip
    assert recorded == anew


def test_one_drive_from_start_to_stop_and_with_a_trip():
    is_as_recorded("one_drive")


def test_thirty_one_drives_of_all_families():
    is_as_recorded("full_line")


def test_whatever_can_happen_on_a_line():
    is_as_recorded("bad_line")


def test_motors_run_on_a_line_that_fails_now_and_then():
    is_as_recorded("bad_line_with_stop")


def test_the_lists_of_the_diagnosis():
    is_as_recorded("diagnosis")


def test_parameters_are_looked_up_and_written():
    is_as_recorded("parameters")


def test_a_drive_is_found_and_another_one_commissioned():
    is_as_recorded("commission")


def test_a_set_is_saved_compared_and_written():
    is_as_recorded("sets")


def test_each_setting_is_changed():
    is_as_recorded("settings")
