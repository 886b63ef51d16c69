# SPDX-License-Identifier: MIT
"""USS, the serial protocol of Siemens drives: a bus master without clock, machine or I/O.

Time and characters are arguments, so it runs anywhere and is tested to the microsecond. README.md
beside this file shows how it is used.

The telegrams:
    telegram         frame: build into a buffer, judge what was received
    layout           how the net data are divided between PKW and PZD
    timing           character, start interval, residual run time from the baud rate
    pkw              parameter channel: tasks, replies, numbers, values, jobs
    pzd              process data: control and status words, scaling in integers

The engine, which may run in interrupts:
    master           the exchange: silence, request, reply; supervision of the loop
    turns            who talks when: the circulating list, and what goes before it
    deadlines        drives that need more turns
    silence          how much of the line's time silent drives may cost
    receiver         bursts of a link -> the one telegram awaited
    drive            one slave: commands, process image, counters
    channel          the parameter channel of one drive: jobs wait, one task is on the line
    outside          telegrams outside the list: mirror, broadcast, special
    going_on         the next telegram is made ready while the one before is on the line
    errors           why something was not done, as exceptions
    leave            how a program ends: every drive is stopped, then the line is left
    fast             the loops over characters: machine code, or else plain Python

What is known of a drive:
    families         what differs between the drive families: data, loaded when it is named
    survey           what must be known of a drive before it may be started
    telegram_count   whether a drive was without its mains
    finding          who is on the line, and how its telegrams are divided

For programs that need more than the panel:
    bits             the bits of control and status words by name
    scaling          PZD2 in percent, Hz and 1/min, floating point

Wings on top of that. Neither the panel nor the modules above import them:
    br               for people who write PLC programs: the blocks of a B&R project
    bus              for people who write Python: the master in a few words, plain errors, a scan
    s7               for people who write PLC programs: the blocks of the S7-200's USS library
    tasks            jobs of more than one value, for both: arrays, descriptions, texts; change
                     reports

Source: Universal Serial Interface, specification E20125-D0001-S302-A1-7600, edition 09.94.
"""
