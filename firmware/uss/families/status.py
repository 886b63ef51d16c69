# SPDX-License-Identifier: MIT
"""A drive whose status word has other bits than the specification's: see `zsw_says` of a family.

The engine, and whoever asks for `zsw`, gets the specification's word, made of what this one says;
`word(1)` is the word as it came. `families.drive_maker` takes this class where a family needs it.
"""

from uss.drive import Drive


class TranslatedDrive(Drive):
    """says: rows of `zsw_says`. The others are those of `Drive`."""

    def __init__(self, says, *arguments):
        super().__init__(*arguments)
        self._says = says
        self._told = 0  # ZSW as it came

    def word(self, place):
        """PZD word `place` as it came, also ZSW."""
        word = Drive.word(self, place)
        return self._told if place == 1 else word

    # --- for the engine: allocates nothing ------------------------------------------------------

    def take(self, buffer, count, now):
        """Put the specification's ZSW in place of what came, and take that."""
        if self.layout.pzd_words:
            at = count - self.layout.pzd_count - 1
            self._told = told = buffer[at] << 8 | buffer[at + 1]
            zsw = 0
            for mask, value, meant in self._says:
                if told & mask == value:
                    zsw |= meant
            buffer[at] = zsw >> 8
            buffer[at + 1] = zsw & 0xFF
        Drive.take(self, buffer, count, now)

    def foresee(self, telegram, answering):
        """Not while it answers: what its reply means is not to be seen before that is taken."""
        return None if answering else Drive.foresee(self, telegram, answering)

    def may_reply_alike(self):
        """Nobody knows which bits its status word has."""
        return True
