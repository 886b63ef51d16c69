# SPDX-License-Identifier: MIT
"""The setpoint channel of a simulated drive: from the sources that it obeys to its ramp generator.

motor.py makes the ramp; process.py knows the states and decides when the setpoint is used.

    channel.hz(0x047F)      # Hz, signed: what the ramp generator is given, r0020
    channel.jog_hz(0x057E)  # the same for a jog
    channel.total_hz()      # all sources, r1078

The order is that of the MM4 parameter lists: main and additional setpoint, direction, skip
frequencies, limits.
"""

from boards.sim.drives.words import (
    ALWAYS,
    THIS_BUS,
    CONTROL_WORD_2,
    FIXED_FREQUENCY,
    JOG_LEFT,
    LEFT,
    MOP,
    REVERSE,
    RIGHT,
)

FIXED_SELECTION = 4  # bits of control word 2, one for each fixed frequency, which add up


class SetpointChannel:
    """settings: has the frequencies, see Process. image: the process data in force, by word.
    potentiometer: the motor potentiometer. sources: which are chosen. style: of the family.

    absolute  whether the main setpoint is in 0.01 Hz
    """

    def __init__(self, settings, image, potentiometer, sources, style):
        self.absolute = False
        self._settings = settings
        self._image = image
        self._potentiometer = potentiometer
        self._sources = sources
        self._two_directions = style["two directions"]

    def hz(self, stw):
        """Within P1080 and P1082."""
        if self._two_directions:
            if stw & (RIGHT | LEFT) not in (RIGHT, LEFT):
                return 0.0  # neither, or both
            stw = REVERSE if stw & LEFT else 0
        hz = self.total_hz()
        return self._limited(-hz if stw & REVERSE else hz, stw & REVERSE)

    def jog_hz(self, stw):
        settings = self._settings
        return self._limited(-settings.jog_left_hz if stw & JOG_LEFT else settings.jog_right_hz, 0)

    def total_hz(self):
        """Of all sources, r1078: before direction and limits."""
        sources = self._sources
        if self._settings.controller and sources.bit(self._settings.controller, self._image):
            return self._controlled_hz()
        hz = self._source_hz(sources.main, sources.place)
        additional = sources.additional
        return hz + self._source_hz(additional, 1) if additional else hz

    def fixed_hz(self):
        """The sum of the fixed frequencies that are selected, r1024."""
        selected = self._image[CONTROL_WORD_2]
        hz = 0.0
        for bit in range(FIXED_SELECTION):
            if selected >> bit & 1:
                hz += self._settings.fixed_hz[bit]
        return hz

    def _controlled_hz(self):
        """The output of the PID controller: only its proportional part, with a feedback of 0, as
        from an analog input without a signal.
        """
        settings = self._settings
        source, place = self._sources.setpoint(settings.controller_source)
        percent = settings.gain * self._source_hz(source, place) * 100 / settings.reference_hz
        percent = min(max(percent, settings.lowest_percent), settings.highest_percent)
        return percent * settings.reference_hz / 100

    def _source_hz(self, source, place):
        if source == THIS_BUS:
            if place >= len(self._image):
                return 0.0
            word = self._image[place]
            if word & 0x8000:
                word -= 0x10000
            if self.absolute and place == 1:
                return word / 100
            return word * self._settings.reference_hz / 16384
        if source == MOP:
            return self._potentiometer.output_hz
        return self.fixed_hz() if source == FIXED_FREQUENCY else 0.0

    def _limited(self, hz, reverse):
        settings = self._settings
        if settings.no_reverse == ALWAYS:
            hz = max(hz, 0.0)
            reverse = 0
        size = self._beside_gaps(abs(hz)) if settings.skipped_hz else abs(hz)
        size = min(max(size, settings.minimum_hz), settings.maximum_hz)
        if not size:
            return 0.0
        return -size if hz < 0 or not hz and reverse else size

    def _beside_gaps(self, size):
        """Keep a setpoint in a skipped band below it, from whichever side it came: a choice."""
        band_hz = self._settings.skip_band_hz
        for skip_hz in self._settings.skipped_hz:
            if skip_hz - band_hz < size < skip_hz + band_hz:
                size = max(skip_hz - band_hz, 0.0)
        return size
