# SPDX-License-Identifier: MIT
"""A simulated drive on the line: the electronics, the inverter and the motor behind them.

It behaves as the manuals and the USS specification say a drive of its family does, a MICROMASTER
420 unless told otherwise, written from those documents alone: it shares no code with the panel's
protocol. Currents, voltages and torque are plausible, no more. Everything happens at the instant
it would, in virtual time.

    drive = Drive(clock, wire, 1)           # set up for USS on its RS-485 terminals, address 1
    drive.read(1082)                        # 50.0
    drive.write(1120, 0, 5.0)               # as from its keypad: RAM and EEPROM
    drive.fault(1)                          # trips with F0001
    drive.load(80)                          # percent; r0027 and the like go by it
    drive.plant.coast_s = 20.0              # a flywheel: pulses off, 50...0 Hz
    drive.report()                          # "address=1 state=fault hz=0.00 stw=047E ..."
    Drive(clock, wire, 2, family=g110)      # another family: a module such as mm420
"""

from boards.sim.drives.words import RUNNING, STOPPING
from boards.sim.clock import Event
from boards.sim.drives.switches import Switches
from boards.sim.drives.power.plant import FAN, INERTIA_S
from boards.sim.drives.power.inverter import Inverter  # noqa: F401  or `process` does, too deep
from boards.sim.drives.parameters import Parameters
from boards.sim.drives.operations import Operations
from boards.sim.drives.families import mm420, setting_of
from boards.sim.drives.readings import Readings
from boards.sim.drives.supply import Supply
from boards.sim.drives.parameter_channel import ALL_ELEMENTS, ParameterChannel
from boards.sim.drives.process import Process
from boards.sim.drives.slave import (
    BROADCAST,
    MIRROR,
    RESIDUAL_TIME,
    WATCHDOG,
    Slave,
    words_of,
)

REPLY_DELAY_CHARACTERS = 3  # measured on a MICROMASTER 420 at 2400 baud

USS = 1  # the protocol, where a family has the choice

# Settings of the link that take effect when the reply to the write is out.
LATE = ("baud", "address", "pzd words", "pkw words")


class Drive:
    """One drive. `parameters` are further settings of its commissioning, {number: value} or
    {(number, index): value}; the wire tells the baud rate. ValueError where a value does not fit,
    KeyError where there is no such parameter.

    family          what it is: the module of a family, see families/__init__.py
    reports         it sends change reports, which none of the listed families does
    reply_delay_us  from the last character heard to the reply, 3 characters if None; any value may
                    be set, illegal ones too
    any_baud        True: it talks at the line's rate whatever its P2010 says, for lines that this
                    family does not know
    layout          PKW and PZD words that it is set up for; None: those of its family's
                    commissioning
    factory         True: as delivered, nobody has commissioned it. It has the address, the baud
                    rate and all else that it has left the factory with, but for `parameters`
    switches        {name: value} of what the documents leave open, see switches.py; then
                    an object with an attribute for each
    eeprom_writes   how often something was written into its EEPROM, P0971 counts once
    plugged         whether the RS-485 connector is in
    silent          whether it is busy with P0970 or the like, and deaf
    plant           what hangs on it, mains, motor and load: plant.py
    slave, channel, parameters, readings, process
                    its parts: telegrams, PKW, what it keeps and measures, PZD and the motor
    """

    def __init__(
        self,
        clock,
        wire,
        address,
        parameters=None,
        reply_delay_us=None,
        any_baud=False,
        family=mm420,
        reports=False,
        switches=None,
        layout=None,
        factory=False,
    ):
        self.family = family
        self.factory = factory
        self.switches = Switches(switches)
        self._clock = clock
        self.wire = wire
        self.name = "drive %d" % address
        self._usual_delay = reply_delay_us is None
        self.reply_delay_us = usual_delay_us(wire.baud) if self._usual_delay else reply_delay_us
        self._any_baud = any_baud
        self.plugged = True
        self._connected = False
        link = family.LINK
        self.parameters = Parameters(family, self._reading)
        self.process = Process(clock, self.parameters, family, self.switches)
        self.slave = Slave(wire, self.switches)
        self.slave.takes_broadcast = link["broadcast"]
        self.channel = ParameterChannel(
            self.parameters, family, self._change_state, self._changed, self.switches, reports
        )
        self.readings = Readings(family, self.parameters, self.process, self.slave)
        self._operations = Operations(family, self.parameters, self.process, self.switches)
        self._off_time = self.parameters.ram[link["off time"]]
        self._index = link["index"]  # of its numbers
        self._off_time_unit_us = link["unit us"]
        self._needs_process_data = link["from process data"]
        self._reply = Event(self._send_reply)
        self._failure = Event(self._telegram_failure)
        self._end_of_silence = Event(self._speak_again)
        self._heard_us = None  # the last telegram, None before the first one
        self._mirrored = None  # what to send back unchanged
        self._with_pkw = True  # variable length: whether the request had PKW words
        self._speaks_uss = True  # what the connector does is chosen at power-up
        self._silent = False  # busy with something that a parameter started
        self._unsettled = False  # writes wait for the end of the exchange to take effect
        self._buffer = bytearray(256)
        self._supply = Supply(clock, self.switches, self.process, self._start_up, self._go_dark)
        settings = {} if factory else self._commissioning(address)
        settings.update(self._layout_settings(layout))
        settings.update(parameters or {})
        self._set_up(settings)
        self._supply.begin()

    # Looking at it

    @property
    def address(self):
        """The address it answers to now."""
        return self.slave.address

    @property
    def state(self):
        """inhibited, ready, ready to run, running, stopping, fault or off."""
        self.process.hz()  # works out what has happened meanwhile
        return self.process.state

    @property
    def powered(self):
        """Whether its electronics have power. They may still be booting; until they have booted
        the state is "off".
        """
        return self._supply.powered

    @property
    def mains(self):
        """Whether its mains are there."""
        return self._supply.mains

    @property
    def stw(self):
        """The control word that came last."""
        return self.process.image[0]

    @property
    def starts(self):
        """How often the motor went from not being driven to being driven."""
        return self.process.starts

    @property
    def plant(self):
        return self.process.plant

    @property
    def silent(self):
        return self._silent

    @property
    def stale_replies(self):
        return self.switches.stale_replies

    @stale_replies.setter
    def stale_replies(self, count):
        self.switches.stale_replies = count

    @property
    def reexecute(self):
        return self.switches.reexecute

    @reexecute.setter
    def reexecute(self, on):
        self.switches.reexecute = on

    @property
    def eeprom_writes(self):
        return self.parameters.eeprom_writes

    @property
    def layout(self):
        """PKW words (0, 3, 4 or 127, variable) and PZD words, as it is set up now."""
        return self.slave.pkw_words, self.slave.pzd_words

    @property
    def error_status(self):
        """The error status word of the specification, A-5.2.3: since the last good telegram."""
        return self.slave.error_status()

    @property
    def residual_time_errors(self):
        """Telegrams that were not over in time. No parameter shows this number, nor that of
        watchdog_errors.
        """
        return self.slave.counters()[RESIDUAL_TIME]

    @property
    def watchdog_errors(self):
        """How often the telegram failure time has expired."""
        return self.slave.counters()[WATCHDOG]

    def hz(self):
        """The frequency of the motor, negative to the left."""
        return self.process.hz()

    def report(self):
        """One line of key=value, for people and for scripts."""
        process = self.process
        counters = self.slave.counters()
        fault = process.faults[0]
        hiw = process.words(2)[1] if self._supply.booted else 0
        return (
            "address=%d state=%s hz=%.2f stw=%04X zsw=%04X hsw=%04X hiw=%04X good=%d rejected=%d "
            "fault=%s starts=%d"
        ) % (
            self.address, self.state, round(self.hz(), 2) + 0.0, self.stw, process.zsw(),
            process.image[1], hiw, counters[0], counters[1], "F%04d" % fault if fault else "-",
            self.starts,
        )  # fmt: skip

    # What people do to it

    def read(self, number, index=0):
        """A parameter's value: an int, or a float. KeyError: no such number or index."""
        return self.parameters.get(number, index)

    def write(self, number, index, value):
        """Change a parameter at the drive's own keypad: RAM and EEPROM, in any state, at once.

        index ALL_ELEMENTS: `value` has one for each. KeyError: no such number or index.
        ValueError: read-only, or not a value for it.
        """
        if index == ALL_ELEMENTS:
            for i, one in enumerate(value):
                self.parameters.set(number, i, one)
        else:
            self.parameters.set(number, index, value)
        self.channel.report(number, index)
        self._changed(number)
        self._settle()

    def fault(self, number, value=0, lasting=False):
        """Trip with this fault number. ValueError: the drive is off.

        value: r0949. lasting: its cause stays until `clear_cause`, and so does the fault: neither
        an acknowledgement nor a power cycle helps. Otherwise the cause is gone at once.
        """
        if not self._supply.booted:
            raise ValueError(self.name + " is off")
        self.process.trip(number, value, lasting)

    def clear_cause(self, number=None):
        """End the cause of a lasting fault; without a number, of all of them."""
        self.process.clear_cause(number)

    def warn(self, number, on=True):
        """A warning with this number comes, or goes."""
        self.process.memory.warn(number, on)

    def load(self, percent, kind=FAN, inertia_s=INERTIA_S):
        """Set the load of the motor, in percent of its rated torque.

        kind: CONSTANT, LINEAR or FAN (plant.py): how it depends on the frequency; `percent` is the
        load at the rated frequency. inertia_s: how long rated torque takes to reach the rated
        frequency. Under a load beyond what it can give, the drive warns, and trips in the end.
        """
        self.process.load(percent, kind, inertia_s)

    def supply(self, volts):
        """Set the voltage of the mains; 400 at first. Below 248 the drive cannot run. For 0 V use
        `power_off`.
        """
        self._supply.set_volts(volts)

    def plug(self):
        """Put the RS-485 connector in."""
        self.plugged = True
        self._connect()

    def unplug(self):
        """Pull the RS-485 connector. The drive goes on with its last command; P2014 applies."""
        self.plugged = False
        self._connect()

    def power_off(self):
        """Mains off. After a while (supply.py) the motor coasts, and RAM is lost: the parameters
        are those of the EEPROM again.
        """
        self._supply.off()

    def power_on(self):
        """Mains on. If its electronics were off, they boot: no process data yet, inhibited."""
        self._supply.on()

    def _go_dark(self):
        self._clock.cancel(self._reply)
        self._clock.cancel(self._failure)
        self._clock.cancel(self._end_of_silence)
        self._silent = False
        self._heard_us = None  # or a new P2014 would trip what is off
        self.process.power_off()
        self.parameters.load()
        self._connect()

    def _start_up(self):
        self._operations.forget()
        self._unsettled = False
        self.slave.reset()
        self.channel.reset()
        self._heard_us = None
        protocol = self.family.LINK["protocol"]
        self._speaks_uss = protocol is None or self.parameters.ram[protocol][0] == USS
        self.process.power_on()
        self._configure_link()
        self._connect()

    # The line

    def hear(self, burst):
        """Called by the wire at the end of a burst."""
        if self._silent:
            return
        form = self.slave.hear(burst)
        if form is None:
            return
        if self._retriggers(form):
            self._heard_us = self._clock.now_us
            self._supervise()
        if form == BROADCAST:
            self._take_broadcast()
            return
        self._mirrored = None
        if form == MIRROR:
            self._mirrored = self.slave.telegram[: self.slave.length]
        else:
            self._take_request()
            if self._silent or self.switches.silent_refusals and self.channel.refuses():
                return
        self._clock.schedule(self._reply, burst.end_us + self.reply_delay_us)

    def _retriggers(self, form):
        """Whether the telegram failure time starts anew with this telegram."""
        if form == BROADCAST and not self.switches.broadcast_retriggers:
            return False
        # The process data of a mirror telegram are for no drive.
        return not self._needs_process_data or form != MIRROR and self.slave.pzd_words > 0

    def _net_words(self):
        """The PKW and the PZD words of the telegram received."""
        telegram = self.slave.telegram
        end = self.slave.length - 1
        pzd_at = end - 2 * self.slave.pzd_words
        return words_of(telegram, 3, pzd_at), words_of(telegram, pzd_at, end)

    def _take_request(self):
        pkw, pzd = self._net_words()
        self.process.accept(pzd)  # process data have priority
        self._with_pkw = bool(pkw)
        if pkw:
            self.channel.accept(pkw, self.slave.pkw_words)

    def _take_broadcast(self):
        enable, pzd = self._net_words()
        if len(enable) == 4:  # a broadcast exists only with a PKW area of 4 words
            self.process.accept_broadcast(enable, pzd)

    def _send_reply(self):
        """Build the reply when it is sent, so that it carries the newest values."""
        if self._mirrored is not None:
            self.wire.talk(self, self._mirrored, len(self._mirrored))
        else:
            slave = self.slave
            words = self.process.words(slave.pzd_words)
            if self._with_pkw and slave.pkw_words:  # it may have been changed meanwhile
                words = self.channel.reply(slave.pkw_words, slave.pzd_words) + words
            self.wire.talk(self, self._buffer, self.slave.frame(self._buffer, words))
        self._settle()

    def _connect(self):
        """Be on the line while plugged and powered. What it is sending when it leaves is cut."""
        connected = self.plugged and self._supply.booted and self._speaks_uss
        if connected and not self._connected:
            self.wire.attach(self, self.slave.baud)
        elif self._connected and not connected:
            self.wire.detach(self)
        self._connected = connected

    def _supervise(self):
        """Start the telegram failure time anew; it runs from the first telegram on."""
        limit = self._off_time[self._index]
        if limit and self._heard_us is not None:
            limit_us = limit * self._off_time_unit_us
            self._clock.schedule(self._failure, self._heard_us + limit_us)
        else:
            self._clock.cancel(self._failure)

    def _telegram_failure(self):
        self.slave.watchdog_expired()
        self.process.trip(self.family.LINK["fault"])

    # Parameters

    def _commissioning(self, address):
        """What somebody sets who has the drive obey USS, at the line's baud rate."""
        family = self.family
        codes = [code for code, baud in family.BAUD_CODES.items() if baud == self.wire.baud]
        if not codes and not self._any_baud:
            raise ValueError("a %s has no code for %d baud" % (family.NAME, self.wire.baud))
        settings = dict(family.COMMISSIONED)
        if codes:
            settings[setting_of(family, "baud")] = codes[0]
        settings[setting_of(family, "address")] = address
        return settings

    def _layout_settings(self, layout):
        """What sets it up for so many PKW and PZD words. ValueError: the family cannot."""
        link = self.family.LINK
        if layout is None or layout == link["layout"]:
            return {}
        if link["layout"] is not None:
            raise ValueError("a %s has %d+%d words" % ((self.family.NAME,) + link["layout"]))
        names = "pkw words", "pzd words"
        return {setting_of(self.family, names[place]): layout[place] for place in range(2)}

    def _set_up(self, settings):
        """Set it up as delivered, but for these settings."""
        family = self.family
        for connects in (True, False):  # P0700 before P0840, which it sets
            for key in settings:
                number, index = key if isinstance(key, tuple) else (key, 0)
                if (number in family.SOURCES["sets"]) == connects:
                    self.parameters.set(number, index, settings[key])
        self.parameters.eeprom_writes = 0

    def _reading(self, number, index):
        return self.readings.value(number, index)

    def _change_state(self):
        """C, U or T: what the parameter lists call commissioning, running and ready."""
        if self.state in (RUNNING, STOPPING):
            return "U"
        return "C" if self.process.commissioning else "T"

    def _changed(self, number):
        """A parameter was written. Most take effect at once, some when the reply is out."""
        link = self.family.LINK
        if number in [link[name] for name in LATE]:
            self._unsettled = True
            if self.switches.layout_at_once:
                self._configure_layout()
        elif number == link["off time"]:
            self._supervise()
        elif self._operations.note(number):
            self._unsettled = True
            if self.switches.silent_at_once and self._operations.seconds():
                self._settle()
        self.process.refresh()

    def _settle(self):
        """Do what had to wait for the end of the exchange: settings of the link, operations."""
        if self._unsettled:
            self._unsettled = False
            self._configure_link()
            self._operate()

    def _operate(self):
        """Carry out what parameters have started. The drive is silent while that takes time."""
        operations = self._operations
        while not self._silent and operations.seconds() is not None:
            seconds = operations.seconds()
            if seconds:
                self._silent = True
                self._clock.cancel(self._reply)
                self._clock.cancel(self._failure)  # the supervision waits too: a choice
                end_us = self._clock.now_us + round(seconds * 1_000_000)
                self._clock.schedule(self._end_of_silence, end_us)
            else:
                self._complete()

    def _speak_again(self):
        self._silent = False
        if self._heard_us is not None:
            self._heard_us = self._clock.now_us
        self._complete()
        self._operate()

    def _complete(self):
        self._operations.carry_out()
        self.process.refresh()
        self._configure_link()
        self._supervise()

    def _configure_link(self):
        slave = self.slave
        link = self.family.LINK
        ram = self.parameters.ram
        codes = self.family.BAUD_CODES
        baud = self.wire.baud if self._any_baud else codes[ram[link["baud"]][self._index]]
        if baud != slave.baud:
            slave.set_baud(baud)
            self.wire.set_rate(self, baud)
            if self._usual_delay:
                self.reply_delay_us = usual_delay_us(baud)
        slave.address = ram[link["address"]][self._index]
        self._configure_layout()

    def _configure_layout(self):
        slave = self.slave
        link = self.family.LINK
        ram = self.parameters.ram
        if link["layout"] is None:
            slave.pkw_words = ram[link["pkw words"]][self._index]
            slave.pzd_words = ram[link["pzd words"]][self._index]
        else:
            slave.pkw_words, slave.pzd_words = link["layout"]


def usual_delay_us(baud):
    """From the last character heard to the reply, where nobody has set another time."""
    return -(-REPLY_DELAY_CHARACTERS * 11_000_000 // baud)
