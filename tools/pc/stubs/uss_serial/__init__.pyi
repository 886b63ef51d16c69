# SPDX-License-Identifier: MIT
from collections.abc import Callable
from typing import Any

from uss.bus import Master as _Master

class PortError(Exception): ...

class SerialLink:
    port: str
    baud: int
    watch: Callable[[bool, bytes, int], object] | None
    clock: Any
    is_cut: bool
    notices: list[str]
    parity_errors: int
    frame_errors: int
    stopped: tuple[int, ...]
    def __init__(
        self,
        port: str,
        baud: int,
        watch: Callable[[bool, bytes, int], object] | None = None,
    ) -> None: ...
    def close(self) -> None: ...

class Master(_Master):
    def __init__(
        self, link: SerialLink, baud: int = 19200, reply_timeout_ms: int = 60, **others: Any
    ) -> None: ...

def ports() -> list[tuple[str, str]]: ...
