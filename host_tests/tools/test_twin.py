# SPDX-License-Identifier: MIT
"""A copy of the process tries what would change it, as the tests of the menu do."""

import os

from twin import TwinFailed, twin

INTERPRETERS = "cpython"  # it forks


def fail():
    raise KeyError("of the twin")


def told_by(function, *arguments):
    try:
        twin(function, *arguments)
    except TwinFailed as error:
        return str(error)
    raise AssertionError("nothing was told")


def test_it_answers_and_nothing_changes_here():
    seen = [1]
    assert twin(lambda: seen.append(2) or list(seen)) == [1, 2]
    assert seen == [1]


def test_what_it_raises_is_told_once_however_many_twins_away():
    for function, arguments in ((fail, ()), (twin, (fail,))):
        told = told_by(function, *arguments)
        assert told.count("Traceback") == 1 and "KeyError: 'of the twin'" in told, told


def test_one_that_dies_is_told():
    assert told_by(os._exit, 0) == "a copy of the process has died"


def test_a_file_that_it_reads_is_read_on_here_where_it_was():
    with open(__file__, "rb", buffering=0) as file:
        begin = file.read(20)
        assert twin(file.read, 20) == twin(file.read, 20)
        file.seek(0)
        assert file.read(20) == begin
        file.seek(20)
        assert twin(file.read, 5) == file.read(5)
