"""The operator's panel: drives and keys on one side, two rows of sixteen characters on the other.

    keys       what is down now -> pressed, repeated, held
    control    one drive under the operator's hand: start, stop, setpoint, what to say about it
    stop_watch whether a STOP is obeyed
    screen     the picture of 2 x 16 characters
    texts      every word that can be seen
    pages      one file for each page
    panel      the keys that act on every page, and the page that is shown

Knows no pins and no telegram bytes; time is an argument.
"""
