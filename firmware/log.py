# SPDX-License-Identifier: MIT
"""A second pair of eyes: every second a line of JSON on the serial port, for a PC that logs.

The manual's section "The log" has the fields. A line is made and sent in pieces, one thing in each
step of the loop. It goes as far as it fits without waiting. If nobody reads, it is dropped and
counted, and what has gone of it ends in a line of its own.

    log = Log(panel, serial, now_ms)
    log.step(now_ms)                    # in each step that has time
"""

from micropython import const

import on_demand
from panel import wording
from uss.master import LISTENING, OFF
from uss.timing import elapsed
from version import VERSION

_LINE_MS = const(1_000)
_STUCK_MS = const(500)  # nothing has gone for so long: nobody reads
_COUNT_MASK = const(0xFFFF)

_PANEL = (
    b'{"panel":{"version":"%s","board":"%s","line":%d,"dropped":%d,"shown":%d,"restart":"%s",'
    b'"heap":%d},"drives":['
)
_DRIVE = b'%s{"address":%d,"state":"%s","on":%s,'
_SPEED = b'"setpoint":%d,"actual":%s,"percent":%s,'
_FROM_DRIVE = b'"zsw":%s,"hiw":%s,"fault":%d,"good":%d,"missed":%d,"silent":%d}'
_BUS = b'],"bus":{"state":"%s","baud":%d,"exchanges":%d,"foreign":%d,"failures":%d,"hung":%d}}\r\n'
_TRUTH = (b"false", b"true")
_NULL = b"null"


class Log:
    """panel: the `Panel`. serial: of the board."""

    def __init__(self, panel, serial, now_ms):
        self._panel = panel
        self._serial = serial
        self._began_at_ms = now_ms  # the last line
        self._sent_at_ms = now_ms  # the last character
        self._lines = 0
        self._dropped = 0
        self._pieces = None  # of the line that goes out, those that are still to be made
        self._piece = b""
        self._at = 0  # so much of it has gone
        self._is_torn = False  # a line was begun, and did not end
        self._exchanges = panel.bus.turns.exchanges
        # To count it takes 10 ms, which no motor that runs is to wait for.
        self._heap = 0 if panel.any_runs() else on_demand.free_bytes()

    def step(self, now_ms):
        """One thing: send some characters, make a piece, or begin a line."""
        left = len(self._piece) - self._at
        if left >= self._serial.packet or left and self._pieces is None:
            self._send(now_ms)
        elif self._pieces is None:
            self._serial.hear()
            late_ms = elapsed(now_ms, self._began_at_ms, self._panel.mask) - _LINE_MS
            if late_ms >= 0:
                self._begin(now_ms, late_ms)
        else:
            piece = next(self._pieces, None)
            if piece is None:
                self._pieces = None
            else:
                self._piece = self._piece[self._at :] + piece
                self._at = 0

    def _send(self, now_ms):
        """Some characters, if the PC has taken those before; or drop the line."""
        at = self._serial.send(self._piece, self._at)
        if at != self._at:
            self._at = at
            self._sent_at_ms = now_ms
            self._is_torn = self._pieces is not None or at < len(self._piece)
        elif elapsed(now_ms, self._sent_at_ms, self._panel.mask) >= _STUCK_MS:
            self._dropped += 1
            self._pieces = None
            self._piece = b""
            self._at = 0

    def _begin(self, now_ms, late_ms):
        missed = late_ms // _LINE_MS  # while the last one went out
        self._dropped += missed
        self._lines += 1 + missed
        self._began_at_ms = now_ms - late_ms % _LINE_MS & self._panel.mask
        self._sent_at_ms = now_ms
        self._pieces = self._made()

    def _made(self):
        """The line, a piece for each step."""
        if self._is_torn:
            yield b"\r\n"
        panel = self._panel
        board = panel.board
        yield _PANEL % (
            VERSION.encode(), board.name.encode(), self._lines, self._dropped,
            panel.selected.drive.address, board.reset_cause.encode(), self._heap,
        )  # fmt: skip
        comma = b""
        for control in panel.controls:
            yield _drive(control, comma)
            yield _speed(control)
            yield _from_drive(control)
            comma = b","
        yield self._bus()

    def _bus(self):
        bus = self._panel.bus
        exchanges = bus.turns.exchanges
        passed, self._exchanges = exchanges - self._exchanges & _COUNT_MASK, exchanges
        state = b"off" if bus.phase == OFF else b"listening" if bus.phase == LISTENING else b"on"
        numbers = bus.timing.baud, passed, bus.foreign, bus.failures, bus.dead_man_trips
        return _BUS % ((state,) + numbers)


def _drive(control, comma):
    """What the panel makes of a drive."""
    drive = control.drive
    return _DRIVE % (comma, drive.address, wording.text(control), _TRUTH[drive.is_on()])


def _speed(control):
    actual = control.actual_centihertz()
    setpoint = control.setpoint.centihertz
    return _SPEED % (
        -setpoint if control.reversed else setpoint,
        _NULL if actual is None else b"%d" % actual,
        _TRUTH[control.survey.is_percent()],
    )


def _from_drive(control):
    """What came from it, and how often."""
    drive = control.drive
    good = drive.counters[0]
    zsw = hiw = _NULL
    if drive.contact:
        zsw, hiw = b"%d" % drive.zsw, b"%d" % drive.hiw
    missed = sum(drive.counters) - good & _COUNT_MASK
    return _FROM_DRIVE % (zsw, hiw, control.fault.number, good, missed, drive.silent)
