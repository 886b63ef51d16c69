# SPDX-License-Identifier: MIT
"""The operator's panel: drives and keys on one side, two rows of sixteen characters on the other.

    panel       the keys that act on every page, and the page that is shown
    keys        what is down now -> pressed, repeated, held
    keys.stop_key, keys.jog_keys        what these do while they are held
    control     one drive under the operator's hand: start, stop, jog, reverse
    phases      what becomes of a START or a JOG
    permits     why START and JOG are refused
    command     a START or JOG that was obeyed, and what took it back
    setpoint, fault, stop_watch, wording    what is known of a drive and said of it
    risks       what START asks before a motor turns
    neighbours  the drives that are not shown
    reading, writer             ask a parameter, write one, follow a drive to another address
    supervision the telegram off time that is offered to a drive
    pages       one file for each page, what they keep to, and the table of them
    view        what is shown whatever the page is
    announcer   what has to be said of drives besides what the page tells, one after the other
    screen      the picture of 2 x 16 characters
    texts       every word that can be seen
    languages   the same words in another language, from languages/words.tsv

Knows no pins and no telegram bytes; time is an argument.
"""
