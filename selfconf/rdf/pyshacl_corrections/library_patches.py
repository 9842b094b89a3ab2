"""What libraries of RDF look up in their modules and classes, replaced for as long as a block lasts."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

one_at_a_time = threading.RLock()
"""What a thread holds while pySHACL judges for it, or rdflib reads a query.

Two threads would undo what the other replaces. And pyparsing, by which rdflib reads queries, finds out at the first use
of a rule how many arguments its action takes, by trying: two threads that try at once spoil the rule for good.
"""


@contextmanager
def replaced(replacements: Sequence[tuple[object, str, object]]) -> Iterator[None]:
    """In the block, each module or class has something else under a name; afterwards, what it had, whatever happens.

    It holds for the whole process: threads that use the libraries meanwhile see it too. One thread at a time is in
    such a block; another one waits.
    """
    with one_at_a_time:
        before = [vars(owner)[name] for owner, name, _ in replacements]
        try:  # from here on, as a time limit may end the block at any step
            for owner, name, replacement in replacements:
                setattr(owner, name, replacement)
            yield
        finally:
            for (owner, name, _), original in zip(replacements, before, strict=True):
                setattr(owner, name, original)
