"""When a program of selfconf ends: SIGINT, SIGTERM, or because the program that started it is gone.

A program that starts others puts `environment()` into their environment; they look at intervals whether it is still
there, so that a parent that is killed with -9 leaves nobody behind.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Mapping
from types import FrameType

from selfconf.bus.port import Bus

LOOK = 0.5
"""How often, in seconds, a program looks whether the one that started it is still there."""
_PARENT = "SELFCONF_PARENT"


def environment() -> Mapping[str, str]:
    """What a started program needs to know in order to end with this one."""
    return {_PARENT: str(os.getpid())}


def orphaned() -> bool:
    """Whether this program was started by another one that is gone."""
    parent = os.environ.get(_PARENT)
    return parent is not None and parent.isdigit() and os.getppid() != int(parent)


class Ending:
    """Holds, when called, once the program is to end; `then` is called once, on the bus's thread."""

    def __init__(self, bus: Bus, then: Callable[[], None] = lambda: None) -> None:
        self._bus, self._then, self._told = bus, then, False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._signalled)
        if _PARENT in os.environ:
            self._look()

    def __call__(self) -> bool:
        return self._told

    def _signalled(self, _: int, __: FrameType | None) -> None:
        self._bus.wake_up(self._tell)

    def _tell(self) -> None:
        if not self._told:
            self._told = True
            self._then()

    def _look(self) -> None:
        if orphaned():
            self._tell()
        else:
            self._bus.later(LOOK, self._look)
