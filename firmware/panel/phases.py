# SPDX-License-Identifier: MIT
"""What becomes of a START or a JOG: the phases of a `Control`.

    phase       what goes on                                ends when
    IDLE        OFF is sent                                 START: CHECKING; a jog key: JOGGING
    CHECKING    START was obeyed, and the drive is asked    all is confirmed: RUNNING
                for its settings                            there is a risk: ASKING
                                                            there is an obstacle: IDLE
    ASKING      START waits for the operator, who may       START: CHECKING
                take a risk                                 any other key, another risk: IDLE
    RUNNING     ON is sent                                  it leads to nothing, or the engine
                                                            took it back: IDLE
    JOGGING     JOG is sent                                 its key goes up, or likewise: IDLE

STOP leads from each of them to IDLE.
"""

IDLE, CHECKING, ASKING, RUNNING, JOGGING = range(5)
