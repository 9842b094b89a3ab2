"""Which node a message on a topic is from.

A message names its publisher by an identifier that each implementation of rmw_zenoh makes in its own way, so it cannot
be computed from a token. But it can be learned: the only publisher of a topic whose identifier is not known yet is the
one that an unknown identifier belongs to. Where two are unknown at once, neither is guessed.
"""

from __future__ import annotations

import threading

from selfconf.bridging.ros2.tokens import NodeIdentity

TopicPublisher = tuple[NodeIdentity, int]
"""A publisher: the node, and the number of the endpoint in its session."""


class TopicSources:
    """The publishers of one topic, with their identifiers as far as they are known; may be used on any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._identifiers: dict[TopicPublisher, bytes | None] = {}

    def add(self, publisher: TopicPublisher) -> None:
        """A publisher has come."""
        with self._lock:
            self._identifiers.setdefault(publisher, None)

    def remove(self, publisher: TopicPublisher) -> None:
        """A publisher has gone."""
        with self._lock:
            self._identifiers.pop(publisher, None)

    def __len__(self) -> int:
        return len(self._identifiers)

    def node(self, identifier: bytes) -> NodeIdentity | None:
        """The node whose publisher has an identifier; None if that cannot be said."""
        with self._lock:
            unknown = []
            for publisher, known in self._identifiers.items():
                if known == identifier:
                    return publisher[0]
                if known is None:
                    unknown.append(publisher)
            if len(unknown) != 1:
                return None
            self._identifiers[unknown[0]] = identifier
            return unknown[0][0]
