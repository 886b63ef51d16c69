"""A simulated drive on the line: the electronics, the inverter and the motor behind them.

It behaves as the manuals and the USS specification say a drive of its family does, a MICROMASTER
420 unless told otherwise, written from those documents alone: it shares no code with the panel's
protocol. It models no currents, no voltages and no torque. Everything happens at the instant it
would, in virtual time.

    drive = Drive(clock, wire, 1)           # set up for USS on its RS-485 terminals, address 1
    drive.read(1082)                        # 50.0
    drive.write(1120, 0, 5.0)               # as from its keypad: RAM and EEPROM
    drive.fault(1)                          # trips with F0001
    drive.report()                          # "address=1 state=fault hz=0.00 stw=047E ..."
    Drive(clock, wire, 2, family=g110)      # another family: a module such as mm420
"""

from boards.sim import mm420
from boards.sim.clock import Event
from boards.sim.drive_parameters import DEFAULT, TYPE, Parameters
from boards.sim.parameter_channel import ALL_ELEMENTS, ParameterChannel
from boards.sim.process import (
    ACTUAL,
    CONTROL_1,
    CONTROL_2,
    COUNTERS,
    FAULTS,
    RECEIVED,
    RUNNING,
    STATUS_1,
    STATUS_2,
    STOPPING,
    WANTED,
    Process,
)
from boards.sim.slave import BROADCAST, MIRROR, STANDARD, Slave

REPLY_DELAY_CHARACTERS = 3  # measured on a MICROMASTER 420 at 2400 baud

# Settings of the link that take effect when the reply to the write is out.
LATE = ("baud", "address", "pzd words", "pkw words", "save", "acknowledge")


class Drive:
    """One drive. `parameters` are further settings of its commissioning, {number: value} or
    {(number, index): value}; the wire tells the baud rate. ValueError where a value does not fit,
    KeyError where there is no such parameter.

    family          what it is: the module of a family, mm420, mm440, mm3, g110, v20, g120, generic
    reports         it sends change reports, which none of the listed families does
    reply_delay_us  from the last character heard to the reply, 3 characters if None; any value may
                    be set, illegal ones too
    any_baud        True: it talks at the line's rate whatever its P2010 says, for lines that this
                    family does not know
    stale_replies   telegrams for which a new parameter task still gets the old reply
    reexecute       a parameter task that stands is carried out with every telegram
    eeprom_writes   how often something was written into its EEPROM, P0971 counts once
    plugged         whether the RS-485 connector is in
    powered         whether it has mains
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
    ):
        self.family = family
        self._clock = clock
        self._wire = wire
        self.name = "drive %d" % address
        if reply_delay_us is None:
            reply_delay_us = -(-REPLY_DELAY_CHARACTERS * 11_000_000 // wire.baud)
        self.reply_delay_us = reply_delay_us
        self._any_baud = any_baud
        self.plugged = True
        self.powered = False
        self._connected = False
        link = family.LINK
        self._parameters = Parameters(
            family.ROWS, family.PERMITTED, self._reading, link["retained"]
        )
        self._process = Process(clock, self._parameters, family)
        self._slave = Slave(wire)
        self._slave.takes_broadcast = link["broadcast"]
        self._channel = ParameterChannel(
            self._parameters, family, self._change_state, self._changed, reports
        )
        self._off_time = self._parameters.ram[link["off time"]]
        self._off_time_unit_us = link["unit us"]
        self._needs_process_data = link["from process data"]
        self._reply = Event(self._send_reply)
        self._failure = Event(self._telegram_failure)
        self._heard_us = None  # the last telegram, None before the first one
        self._mirrored = None  # what to send back unchanged
        self._with_pkw = True  # variable length: whether the request had PKW words
        self._unsettled = False  # writes wait for the end of the exchange to take effect
        self._buffer = bytearray(256)
        self._commission(address, parameters or {})
        self.power_on()

    # Looking at it

    @property
    def address(self):
        """The address it answers to now."""
        return self._slave.address

    @property
    def state(self):
        """inhibited, ready, ready to run, running, stopping, fault or off."""
        self._process.hz()  # what time has done meanwhile
        return self._process.state

    @property
    def starts(self):
        """How often the motor went from not being driven to being driven."""
        return self._process.starts

    @property
    def stale_replies(self):
        return self._channel.stale_replies

    @stale_replies.setter
    def stale_replies(self, count):
        self._channel.stale_replies = count

    @property
    def reexecute(self):
        return self._channel.reexecute

    @reexecute.setter
    def reexecute(self, on):
        self._channel.reexecute = on

    @property
    def eeprom_writes(self):
        return self._parameters.eeprom_writes

    @property
    def layout(self):
        """PKW words (0, 3, 4 or 127, variable) and PZD words, as it is set up now."""
        return self._slave.pkw_words, self._slave.pzd_words

    def hz(self):
        """The frequency of the motor, negative to the left."""
        return self._process.hz()

    def report(self):
        """One line of key=value, for people and for scripts."""
        process = self._process
        counters = self._slave.counters
        fault = process.faults[0]
        hiw = process.words(2)[1] if self.powered else 0
        return (
            "address=%d state=%s hz=%.2f stw=%04X zsw=%04X hsw=%04X hiw=%04X good=%d rejected=%d "
            "fault=%s starts=%d"
        ) % (
            self.address, self.state, round(self.hz(), 2) + 0.0, process.image[0], process.zsw(),
            process.image[1], hiw, counters[0], counters[1], "F%04d" % fault if fault else "-",
            self.starts,
        )  # fmt: skip

    # What people do to it

    def read(self, number, index=0):
        """A parameter's value: an int, or a float. KeyError: no such number or index."""
        return self._parameters.get(number, index)

    def write(self, number, index, value):
        """Change a parameter at the drive's own keypad: RAM and EEPROM, in any state, at once.

        index ALL_ELEMENTS: `value` has one for each. KeyError: no such number or index.
        ValueError: read-only, or not a value for it.
        """
        if index == ALL_ELEMENTS:
            for i, one in enumerate(value):
                self._parameters.set(number, i, one)
        else:
            self._parameters.set(number, index, value)
        self._channel.report(number, index)
        self._changed(number)
        self._settle()

    def fault(self, number):
        """Trip with this fault number; its cause is gone at once. ValueError: the drive is off."""
        if not self.powered:
            raise ValueError(self.name + " is off")
        self._process.trip(number)

    def plug(self):
        """Put the RS-485 connector in."""
        self.plugged = True
        self._connect()

    def unplug(self):
        """Pull the RS-485 connector. The drive goes on as it was told last; P2014 applies."""
        self.plugged = False
        self._connect()

    def power_off(self):
        """Mains off: the motor coasts, RAM is lost."""
        if self.powered:
            self.powered = False
            self._clock.cancel(self._reply)
            self._clock.cancel(self._failure)
            self._process.power_off()
            self._connect()

    def power_on(self):
        """Mains on: parameters from the EEPROM, no process data yet, inhibited."""
        if not self.powered:
            self.powered = True
            self._parameters.load()
            self._slave.reset()
            self._channel.reset()
            self._heard_us = None
            self._process.power_on()
            self._configure_link()
            self._connect()

    # The line

    def hear(self, burst):
        """The end of a burst on the line: called by the wire."""
        form = self._slave.hear(burst)
        if form is None:
            return
        if not self._needs_process_data or self._has_process_data(form):
            self._heard_us = self._clock.now_us
            self._supervise()
        if form == BROADCAST:
            self._take_broadcast()
            return
        self._mirrored = None
        if form == MIRROR:
            self._mirrored = self._slave.telegram[: self._slave.length]
        else:
            self._take_request()
        self._clock.schedule(self._reply, burst.end_us + self.reply_delay_us)

    def _has_process_data(self, form):
        return form == STANDARD and self._slave.pzd_words > 0

    def _net_words(self):
        """The PKW and the PZD words of the telegram received."""
        telegram = self._slave.telegram
        end = self._slave.length - 1
        words = [telegram[i] << 8 | telegram[i + 1] for i in range(3, end, 2)]
        pkw_count = len(words) - self._slave.pzd_words
        return words[:pkw_count], words[pkw_count:]

    def _take_request(self):
        pkw, pzd = self._net_words()
        self._process.accept(pzd)  # process data have priority
        self._with_pkw = bool(pkw)
        if pkw:
            self._channel.accept(pkw, self._slave.pkw_words)

    def _take_broadcast(self):
        enable, pzd = self._net_words()
        if len(enable) == 4:  # a broadcast exists only with a PKW area of 4 words
            self._process.accept_broadcast(enable, pzd)

    def _send_reply(self):
        """Build the reply when it is sent, so that it carries the newest values."""
        if self._mirrored is not None:
            self._wire.talk(self, self._mirrored, len(self._mirrored))
        else:
            slave = self._slave
            words = self._process.words(slave.pzd_words)
            if self._with_pkw:
                words = self._channel.reply(slave.pkw_words, slave.pzd_words) + words
            self._wire.talk(self, self._buffer, self._slave.frame(self._buffer, words))
        self._settle()

    def _connect(self):
        """Be on the line while plugged and powered. What it is sending when it leaves is cut."""
        connected = self.plugged and self.powered
        if connected and not self._connected:
            self._wire.attach(self)
        elif self._connected and not connected:
            self._wire.detach(self)
        self._connected = connected

    def _supervise(self):
        """Start the telegram failure time anew; it runs from the first telegram on."""
        limit = self._off_time[0]
        if limit and self._heard_us is not None:
            limit_us = limit * self._off_time_unit_us
            self._clock.schedule(self._failure, self._heard_us + limit_us)
        else:
            self._clock.cancel(self._failure)

    def _telegram_failure(self):
        self._process.trip(self.family.LINK["fault"])

    # Parameters

    def _commission(self, address, parameters):
        """Set it up as delivered, then for USS at the line's baud rate, then as asked for."""
        family = self.family
        link = family.LINK
        codes = [code for code, baud in family.BAUD_CODES.items() if baud == self._wire.baud]
        if not codes and not self._any_baud:
            raise ValueError("a %s has no code for %d baud" % (family.NAME, self._wire.baud))
        settings = dict(family.COMMISSIONED)
        if codes:
            settings[link["baud"]] = codes[0]
        settings[link["address"]] = address
        settings.update(parameters)
        for number, value in settings.items():
            index = 0
            if isinstance(number, tuple):
                number, index = number
            self._parameters.set(number, index, value)
        self._parameters.eeprom_writes = 0

    def _reading(self, number, index):
        """The value of a read-only parameter: shown as a frequency, a word or a list."""
        what, detail = self.family.READINGS.get(number, (None, 0))
        process = self._process
        if what in (ACTUAL, WANTED):
            hz = process.hz() if what == ACTUAL else process.setpoint_hz()
            if self._parameters.rows[number][TYPE] == "F":
                return hz * detail
            return round(abs(hz) * process.steps_per_hz())
        if what == STATUS_1:
            return process.zsw()
        if what == STATUS_2:
            return process.zsw2()
        if what == CONTROL_1:
            return process.command_word()
        if what == CONTROL_2:
            return process.image[3]
        if what == RECEIVED:
            return process.image[detail + index]
        if what == FAULTS:
            return process.faults[detail + index]
        if what == COUNTERS:
            return 0 if index else self._slave.counters[detail]  # [1] is the BOP link
        return self._parameters.rows[number][DEFAULT]

    def _change_state(self):
        """C, U or T: what the parameter lists call commissioning, running and ready."""
        if self.state in (RUNNING, STOPPING):
            return "U"
        return "C" if self._process.commissioning else "T"

    def _changed(self, number):
        """A parameter was written: most take effect at once, some when the reply is out."""
        link = self.family.LINK
        if number in [link[name] for name in LATE]:
            self._unsettled = True
        elif number == link["off time"]:
            self._supervise()
        self._process.refresh()

    def _settle(self):
        """What had to wait for the end of the exchange: the settings of the link, P0971."""
        if not self._unsettled:
            return
        self._unsettled = False
        parameters = self._parameters
        save, acknowledge = self.family.LINK["save"], self.family.LINK["acknowledge"]
        if save is not None and parameters.ram[save][0]:
            parameters.store(save, 0, 0, False)
            parameters.save()
        if acknowledge is not None and parameters.ram[acknowledge][0]:
            parameters.store(acknowledge, 0, 0, False)
            self._process.acknowledge()
        self._configure_link()

    def _configure_link(self):
        slave = self._slave
        link = self.family.LINK
        ram = self._parameters.ram
        codes = self.family.BAUD_CODES
        slave.baud = self._wire.baud if self._any_baud else codes[ram[link["baud"]][0]]
        slave.address = ram[link["address"]][0]
        if link["layout"] is None:
            slave.pkw_words = ram[link["pkw words"]][0]
            slave.pzd_words = ram[link["pzd words"]][0]
        else:
            slave.pkw_words, slave.pzd_words = link["layout"]
