# SPDX-License-Identifier: MIT
"""The pages of the panel, one file each. A page draws itself and takes keys of its own.

The contract:

    whole               it takes both rows; otherwise row 1 shows the frequencies
    tells_state         its row 2 says what the drive shown does (pages that are not whole)
    obeys               START, REVERSE, JOG, address keys and PARAM act while it is shown
    take_keys(acts, now_ms)     a key was pressed, or repeats: `panel.keys.Acts`
    draw(screen, now_ms)        both rows, or row 2 in front of the address; changes nothing else
"""
