# SPDX-License-Identifier: MIT
"""Parameter sets: the parameters of a drive as a file on the panel's flash, and back.

    set_file    the file: how it is written, and read with every check
    pump        parameter tasks one after the other, so that every telegram carries one
    saving      from a drive into a file
    writing     from a file into a drive: what differs, compared before and after

README.md says how the file is made up, for programs that write and read it elsewhere.
"""
