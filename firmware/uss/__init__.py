"""USS, the serial protocol of Siemens drives: a bus master without clock, machine or I/O.

Time and characters are arguments, so it runs anywhere and is tested to the microsecond:

    telegram   frame: build into a buffer, judge what was received
    timing     character, start interval, residual run time from the baud rate
    receiver   bursts of a link -> the one telegram awaited
    pkw        parameter channel: tasks, replies, numbers, values, jobs
    pzd        process data: control and status words, scaling
    channel    the parameter channel of one drive: jobs wait, one task is on the line
    drive      one slave: commands, process image, counters
    master     the bus: who talks when, supervision
    profiles   what differs between drive families: data
    survey     what must be known of a drive before it may be started

Source: Universal Serial Interface, specification E20125-D0001-S302-A1-7600, edition 09.94.
"""
