"""Chance: one number decides all of it, and every consumer has a stream of its own.

So a sensor that is read more often than before does not change what another sensor reads.
"""

from __future__ import annotations

import numpy as np


def stream(seed: int, consumer: str) -> np.random.Generator:
    """Return the stream of random numbers that belongs to a consumer, such as "sonar", under a seed."""
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=tuple(consumer.encode())))
