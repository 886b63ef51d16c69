# SPDX-License-Identifier: MIT
from uss.families import GENERIC

VARIABLE: int
PKW_WORDS: tuple[int, ...]
PZD_WORDS_MAX: int
WORDS_MAX: int
ENABLE_WORDS: int

class Layout:
    pkw_words: int
    pzd_words: int
    variable: bool
    short: bool
    longest: int
    pzd_count: int
    net_count: int
    net_max: int
    def __init__(
        self, pkw_words: int = 4, pzd_words: int = 2, longest: int = 10, short: bool = False
    ) -> None: ...
    def fits(self, net_count: int) -> bool: ...
    def is_like(self, other: Layout) -> bool: ...
    def suits(self, family: type[GENERIC]) -> bool: ...
    def takes_broadcast(self) -> bool: ...

STANDARD: Layout
