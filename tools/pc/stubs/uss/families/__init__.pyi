# SPDX-License-Identifier: MIT
from collections.abc import Callable, Container, Sequence
from typing import Any

from uss.layout import Layout

class GENERIC:
    name: str
    layout: Layout
    pkw_choices: Container[int]
    pzd_choices: Container[int]
    takes_broadcast: bool
    has_indices: bool
    has_eeprom_tasks: bool
    first_index: int
    has_array_tasks: bool
    baud_codes: dict[int, int]
    baud: int
    has_bop_link: bool
    link_index: int
    linked: Sequence[int]
    com: type[GENERIC] | None
    baud_number: int | None
    address_number: int | None
    pzd_words_number: int | None
    pkw_words_number: int | None
    off_time_number: int | None
    off_time_unit_ms: int
    off_time_fault: int | None
    fault_number: int | None
    warning_number: int | None
    fault_format: str
    motor: tuple[int, int] | None
    access: tuple[int, int] | None
    protocol: tuple[int, int] | None
    save: tuple[int, int] | None
    shown: Sequence[tuple[int, int | None]]
    survey: Sequence[Any]
    meaning: Sequence[Any]
    absolute_value: int | None
    on: int
    on_reverse: int
    jog_right: int
    jog_left: int
    hsw_is_signed: bool
    hiw_is_signed: bool
    is_cumulative: bool
    zsw_says: Sequence[tuple[int, int, int]] | None
    takes_no_control: bool
    stw_bits: Any
    zsw_bits: Any
    stw2_bits: Any
    zsw2_bits: Any
    integer_doubles: Container[int] | str | None
    ask_first: dict[int, str]
    permanent: Sequence[int]

class MM3(GENERIC): ...
class MM420(GENERIC): ...
class MM410(MM420): ...
class MM440(MM420): ...
class MM430(MM440): ...
class G110(MM420): ...
class V20(MM440): ...
class CU240S(MM440): ...
class G120(GENERIC): ...

MM4 = MM420
NAMES: list[str]
FAMILIES: tuple[type[GENERIC], ...]

def on_bop(family: type[GENERIC]) -> type[GENERIC]: ...
def baud_code(family: type[GENERIC], baud: int) -> int: ...
def drive_maker(family: type[GENERIC], control: bool = True) -> Callable[..., Any]: ...
def can_be_set_to(family: type[GENERIC], layout: Layout) -> bool: ...
def value(job: Any, kind: int, is_fine: bool = False) -> float: ...
def is_float(family: type[GENERIC], number: int) -> bool: ...
