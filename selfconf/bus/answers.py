"""How a question is answered, and which answers of others count.

Whatever comes of a question, the asker waits for nothing more afterwards. Answers count only on their own keys: what
may speak on one key cannot answer for another.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from selfconf.bus.port import Request, Sample
from selfconf.errors import PeerError
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import Message

_M = TypeVar("_M", bound=Message)


@contextmanager
def answering(request: Request) -> Iterator[None]:
    """Answer a request: what raises PeerError is refused, with its sentence, and then the answer is over."""
    try:
        yield
    except PeerError as error:
        request.refuse(str(error))
    finally:
        request.finish()


def own_answers(samples: Iterable[Sample], kind: type[_M], key_of: Callable[[_M], str]) -> tuple[list[_M], list[str]]:
    """What others have answered, each on its own key, and what is wrong with the answers that are left out."""
    found: list[_M] = []
    rejected: list[str] = []
    for sample in samples:
        try:
            message = decode(sample.payload, kind)
        except PeerError as error:
            rejected.append(f"left out an answer: {error}")
            continue
        if sample.key == key_of(message):
            found.append(message)
        else:
            rejected.append(f"left out an answer on {sample.key}: it speaks of another")
    return found, rejected
