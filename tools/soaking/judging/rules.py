# SPDX-License-Identifier: MIT
"""The rules that a soak holds the panel to, in plain words, and the exception for a broken one.

They are those of the panel's own promises (firmware/panel/README.md, "What it promises"), of the
RS-485 line and of the display. The judge and the reader say when one is broken; a rule is named by
its key here.

    raise Broken("STOP", "drive 3 was sent ON 62 ms after STOP")
"""

RULES = {
    # what makes a motor turn
    "START": "ON goes only to a drive started by START since power-on, loss, trip or STOP",
    "JOG": "JOG goes only to the drive shown, while its one jog key is held, by a fresh press",
    "REFUSED": "START and JOG do nothing with a fault, an inhibit, or a source that is not USS",
    "UNSUPERVISED": "with P2014 = 0, or long, JOG is refused, and START asks first",
    "LOST": "no ON and no JOG goes to a drive that has not answered for the lost time",
    "DEAD MAN": "no ON and no JOG is sent once the main loop has stood still for 300 ms",
    "TURNS": "a motor is switched on only by an ON or a JOG just sent, and once for each START",
    "RISES": "while a drive runs nothing raises its setpoint but UP, and SET after digits",
    # what makes it stop
    "STOP": "STOP is in the next telegram to that drive, beats START, and holds until START",
    "SECOND STOP": "OFF2 or OFF3, as the settings say, when STOP was held for 1.5 s; until heard",
    "STOP ALL": "STOP held for 4 s sends OFF to every drive",
    "WITHOUT REASON": "a drive that was started runs until STOP, a loss, a trip, or a hung loop",
    "ACKNOWLEDGE": "a fault is acknowledged only by a STOP",
    # what is sent
    "CONTROL": "bit 10 of the control word is never 0, and no unknown control word is sent",
    "TELEGRAM": "every telegram of the panel is well formed, in the layout that is told or found",
    "MIRROR": "mirror telegrams say nothing, and go to silent drives, or where somebody looks",
    "ADDRESS": "a drive that moved gets no telegram more at the address that it has left",
    "SEARCH": "the panel leaves the line for a search when SET confirmed that, and not otherwise",
    "SETPOINT": "the setpoint sent is within the limits of the drive and of the settings",
    "WRITE": "a parameter is written only when SET confirmed the question about this very value",
    "SET": "a set that is saved has what the drive has; one that is written and equal is in it",
    "LOCK": "while the lock is closed START, STOP, the setpoint and the choice of a drive act, and"
    " nothing else does; its code opens it, and nothing else",
    "EEPROM": "the EEPROM is written only when SET was held or an offer says so, but for what"
    " must be permanent",
    "BUS OFF": "the panel leaves the line when SET says so and every drive was told to stop, and"
    " sends nothing until PARAM or STOP",
    "LISTEN": "nothing is sent before the line was silent for 100 ms after power-on",
    "LIST": "drives stand in the list in the order, and as often, as SET and PARAM kept them",
    # the line
    "LINE": "start interval, no collision, driver enable within a character of the telegram",
    "SILENT PANEL": "as long as it lives the panel keeps talking",
    "NEGLECTED": "running drives are asked in time, silent ones again and again, at a fifth of it",
    "TASK": "a parameter task that a drive answers with silence is taken back after 3 telegrams",
    # the panel itself
    "EXCEPTION": "nothing in the firmware raises an exception",
    "WATCHDOG": "the watchdog bites when the loop has hung, or the bus stands, and only then",
    "FLASH": "settings are written only while no drive is told to run",
    # the display
    "DISPLAY": "the display's controller has nothing to complain about",
    "MAY RUN": "a drive that ran and is lost reads NO CONTACT, MAY RUN, never its last state",
    "UNCONFIRMED": "a STOP that no answer confirms is an alarm after a second, and no other is",
    "SHOWN": "what the display says of the drive shown is so",
    "ANNOUNCED": "n drives in trouble are each announced for a second within 2 n seconds",
    "RECOVERS": "when all faults are over the panel controls every drive again",
}


class Broken(Exception):
    """A rule is broken. args: its key in RULES, and what happened."""

    def __str__(self):
        return "%s: %s" % self.args
