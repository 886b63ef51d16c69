# SPDX-License-Identifier: MIT
"""The texts of commissioning, in memory only while it is open. See `panel.texts`."""

PROCEDURES = (b"FOR USS", b"FACTORY RESET", b"THE MOTOR", b"FOR EXPERTS")
NO_STEPS = b"NO STEPS FOR IT"  # the catalogue has none for the family
IS = b"IS %s"  # what the drive has,
NEEDS = b"%s NEEDS %s"  # and what it is to have
ALL_DONE = b"ALL DONE"  # in the list of steps,
LEFT = b"%d LEFT"
LEFT_FIRST = b"FIRST P%04d"
LEAVES_DONE = b"A%d: ALL DONE"  # and when it is left
LEAVES_LEFT = b"A%d: %d LEFT"
ASK = b"%s SET=YES"
RESCALES = b"RESCALES SPEED"  # the setpoint means another one, once this is written
WRITES = b"WRITING ..."
STOP_IT = b"STOP A%d FIRST"
IS_RIGHT = b"IT IS RIGHT"  # SET was pressed on a step that is done
