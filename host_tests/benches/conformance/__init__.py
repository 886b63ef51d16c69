# SPDX-License-Identifier: MIT
"""A plain USS master, to try drives with: written from the specification, for a serial port.

It shares no code with the firmware's master (firmware/uss) nor with the simulated drives
(boards/sim), so that a mistake they have in common shows here. It is made for tests, patient and
slow; it drives no motors that anybody needs.

    telegrams   what a telegram looks like: characters and words
    master      Master: a serial port, requests out, replies in; Node: one drive of it
    kinds       who is tried: families, layouts, and the parameters they are asked for
    program     Drives: ./tools/drive as a process for each rate, its ptys and its commands
"""
