"""Handlers of signals that are not left before their end: what they have to note would be lost with the signal.

An alarm may ring while a handler of another signal runs on the main thread, and what its own handler raises would leave
that one too. So it rings in vain within what is marked here, and rings again (`selfconf.rdf.deadline`).
"""

from __future__ import annotations

from collections.abc import Callable
from types import CodeType, FrameType
from typing import Any, TypeVar

Handler = TypeVar("Handler", bound=Callable[..., Any])
_MARKED: set[CodeType] = set()


def run_to_its_end(handler: Handler) -> Handler:
    """Mark a handler of a signal, a function, as one that no alarm ends."""
    _MARKED.add(handler.__code__)
    return handler


def is_handler(frame: FrameType) -> bool:
    """Whether a frame is that of a handler which is marked."""
    return frame.f_code in _MARKED
