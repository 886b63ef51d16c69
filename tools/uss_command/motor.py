# SPDX-License-Identifier: MIT
"""run, jog, stop and ack: the only commands that turn or stop a motor.

However such a command ends, it stops the motor first. If it hangs or is killed, the small program
that holds its port does that (`uss_serial.keeper`).
"""

import time

from tools.uss_command.errors import Failure, Misused
from tools.uss_command.line import Line, in_words
from uss import pzd
from uss.bus import STATES
from uss.errors import NotStarted, UssError

SHOW_S = 0.5
STOP_S = 60.0  # a motor may take so long to ramp down
TRIES_S = 2.0
OFFS = {"1": pzd.OFF1, "2": pzd.OFF2, "3": pzd.OFF3}
SIDES = {"right": "jog_right", "left": "jog_left"}


def add(commands):
    parser = commands.add_parser("run", help="turn the motor: 25.0 Hz, until Ctrl-C")
    parser.add_argument("hertz", nargs="?", type=float, metavar="HZ", help="negative turns left")
    parser.add_argument("--percent", type=float, help="of the reference, instead of Hz")
    parser.set_defaults(run=run)
    add_times(parser)
    parser = commands.add_parser("jog", help="turn it at its own jog frequency, until Ctrl-C")
    parser.add_argument("side", choices=SIDES)
    parser.set_defaults(run=jog)
    add_times(parser)
    parser = commands.add_parser("stop", help="stop the motor, and wait until it stands")
    parser.add_argument("--off", choices=OFFS, default="1", help="OFF1 ramps, 2 coasts, 3 is fast")
    parser.set_defaults(run=stop)
    parser = commands.add_parser("ack", help="acknowledge a fault, and say what is left")
    parser.set_defaults(run=acknowledge)


def add_times(parser):
    parser.add_argument(
        "--for", dest="seconds", type=float, metavar="S", help="stop after so long"
    )
    parser.add_argument("--supervise", type=float, metavar="S",
                        help="write P2014 first (RAM): it stops by itself then")  # fmt: skip
    parser.add_argument("--unsupervised", action="store_true",
                        help="although P2014 is 0, and nothing may stop it")  # fmt: skip
    parser.add_argument("--ack", action="store_true", help="acknowledge a fault first")


def run(screen, settings, chosen):
    if (chosen.hertz is None) == (chosen.percent is None):
        raise Misused("run wants one speed: run 25.0, or run --percent 50")
    if chosen.percent is None:
        turn(screen, settings, chosen, lambda drive: drive.run(chosen.hertz))
    else:
        turn(screen, settings, chosen, lambda drive: drive.run(percent=chosen.percent))


def jog(screen, settings, chosen):
    turn(screen, settings, chosen, lambda drive: getattr(drive, SIDES[chosen.side])())


def turn(screen, settings, chosen, start):
    """Start the motor, show what it does, and stop it at the end."""
    with Line(screen, settings, chosen) as line:
        line.listen()
        line.command()
        node = line.node(settings.the_address())
        drive = line.drive(node, chosen.unsupervised)
        if chosen.ack and in_words(lambda: drive.fault):
            _acknowledge(line, drive)
        _check_fault(node, drive)
        try:
            if chosen.supervise is not None:
                in_words(drive.supervise, chosen.supervise)
            _start(start, drive)
            _watch(screen, line, drive, chosen.seconds)
        finally:
            _stop(screen, line, drive, pzd.OFF1)


def stop(screen, settings, chosen):
    with Line(screen, settings, chosen) as line:
        line.listen()
        line.command()
        drive = line.drive(line.node(settings.the_address()))
        _stop(screen, line, drive, OFFS[chosen.off])
        if drive.is_running or not drive.contact:
            raise Failure("drive %d has not stopped: %s" % (drive.address, drive.state))


def acknowledge(screen, settings, chosen):
    with Line(screen, settings, chosen) as line:
        line.listen()
        line.command()
        node = line.node(settings.the_address())
        drive = line.drive(node)
        before = in_words(lambda: drive.fault)
        if not before:
            screen.event("drive %d has no fault" % drive.address, address=drive.address, fault=0)
            return
        _acknowledge(line, drive)
        _check_fault(node, drive)
        name = node.facts.fault(before)["fault"] if before > 0 else "a fault"
        screen.event(
            "drive %d: %s is acknowledged" % (drive.address, name), address=drive.address,
            fault=0, acknowledged=before,
        )  # fmt: skip


def _acknowledge(line, drive):
    drive.acknowledge()
    line.bus.wait(TRIES_S, lambda: not drive.zsw or not drive.zsw & pzd.ZSW_FAULT)


def _start(start, drive):
    """Failure: it was not started, and why."""
    try:
        start(drive)
    except NotStarted as reason:
        told, is_about_p2014, _ = str(reason).partition("run on if this program died")
        if not is_about_p2014:
            raise Failure(str(reason)) from None
        raise Failure(
            "%srun on if this computer died (P2014): --supervise 2 sets it, --unsupervised takes "
            "the risk" % told
        ) from None
    except (UssError, ValueError) as reason:
        raise Failure(str(reason)) from None


def _check_fault(node, drive):
    fault = in_words(lambda: drive.fault)
    if fault:
        told = node.facts.fault(fault) if fault > 0 else {"fault": "a fault"}
        words = [told[name] for name in ("name", "cause", "remedy") if told.get(name)]
        raise Failure(
            "drive %d has tripped with %s: ack clears it when its cause is gone; run --ack does "
            "both" % (drive.address, " - ".join([told["fault"]] + words))
        )


def _watch(screen, line, drive, seconds):
    """Until the time is over, or Ctrl-C. Failure: the motor was stopped by something else."""
    until_s = None if seconds is None else time.monotonic() + seconds
    with screen.live() as show:
        while until_s is None or time.monotonic() < until_s:
            show("Ctrl-C stops it", ("address", "state", "speed", "unit"), [state(drive)])
            left_s = SHOW_S if until_s is None else min(SHOW_S, until_s - time.monotonic())
            line.bus.wait(max(left_s, 0), lambda: not drive.is_on())
            if not drive.is_on():
                raise Failure(_why_not_on(line, drive))


def _why_not_on(line, drive):
    if line.link.notices:  # it may be back by now
        told = line.link.notices[0], drive.address
        return "%s. Drive %d is stopped by its P2014 alone" % told
    if line.link.stopped:
        return "this program stood still: its port was told to stop drive %d" % drive.address
    return "drive %d was stopped: it is %s" % (drive.address, drive.state)


def state(drive):
    """A row about a drive that is commanded."""
    row = {"address": drive.address, "state": drive.state}
    for name, unit in (("hertz", "Hz"), ("percent", "%")):
        if drive.contact and "speed" not in row:
            try:
                row.update(speed=round(getattr(drive, name), 2), unit=unit)
            except (UssError, ValueError) as reason:  # it does not tell its scale, or was lost
                row["why"] = str(reason)
    return row


def _stop(screen, line, drive, off):
    """Tell it to stop, and wait until it stands; a second Ctrl-C ends the waiting alone."""
    drive.stop(off)
    try:
        line.bus.wait(STOP_S, lambda: line.link.is_cut or _rests(drive))
    except KeyboardInterrupt:
        pass
    rests = _rests(drive)
    text = "drive %d is %s" % (
        drive.address,
        STATES[pzd.state(drive.zsw)] if rests else drive.state,
    )
    screen.event(text, address=drive.address, state=drive.state, stopped=rests)


def _rests(drive):
    return drive.contact and drive.engine.answered_off() and not drive.is_running
