"""What libraries of RDF look up in their modules and classes, replaced for as long as a block lasts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager


@contextmanager
def replaced(replacements: Sequence[tuple[object, str, object]]) -> Iterator[None]:
    """In the block, each module or class has something else under a name; afterwards, what it had, whatever happens.

    It holds for the whole process: threads that use the libraries meanwhile see it too.
    """
    before = [vars(owner)[name] for owner, name, _ in replacements]
    for owner, name, replacement in replacements:
        setattr(owner, name, replacement)
    try:
        yield
    finally:
        for (owner, name, _), original in zip(replacements, before, strict=True):
            setattr(owner, name, original)
