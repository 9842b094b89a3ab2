"""How a question is answered: whatever comes of it, the asker waits for nothing more afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from selfconf.bus.port import Request
from selfconf.errors import PeerError


@contextmanager
def answering(request: Request) -> Iterator[None]:
    """Answer a request: what raises PeerError is refused, with its sentence, and then the answer is over."""
    try:
        yield
    except PeerError as error:
        request.refuse(str(error))
    finally:
        request.finish()
