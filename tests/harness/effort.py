"""How many examples a property sees, by the environment variable HYPOTHESIS_PROFILE, and which tests are thorough.

`quick` is a tenth of the usual number (`make quick`), `nightly` twenty times as many (`make nightly`); anything else
is two fifths of it (`make test`), or three twentieths where every example is solved several times, by enumeration
too, so that the tests end in time on two processors. The examples of a usual or quick run are the same each time.

Tests that are marked as thorough take seconds to show by more examples, larger ones or a whole demo what other tests
show by less, or run a benchmark for a moment: `make test` leaves them out, `make thorough` runs them alone, and `make
check` both.
"""

from __future__ import annotations

import os

import pytest
from _pytest.mark.structures import ParameterSet

PROFILE = os.environ.get("HYPOTHESIS_PROFILE", "selfconf")
NIGHTLY = PROFILE == "nightly"
at_night = pytest.mark.skipif(not NIGHTLY, reason="takes long, and goes wrong where others do: `make nightly` runs it")
thorough = pytest.mark.thorough
of_keys = pytest.mark.skipif(
    not NIGHTLY and "SELFCONF_TEST_KEYS" not in os.environ,
    reason="takes long, and is about keys alone: `make test-keys` and `make nightly` run it",
)
_SHARES = {"quick": 0.1, "nightly": 20.0}


def examples(usual: int) -> int:
    """Return the number of examples under this profile of a property that usually sees `usual` of them."""
    return max(1, int(usual * _SHARES.get(PROFILE, 0.4)))


def solved_examples(usual: int) -> int:
    """Return the number of examples of a property whose examples are solved by several searches: at least 25."""
    return max(25, int(usual * _SHARES.get(PROFILE, 0.15)))


def batches(end: int, size: int, usual: int = 1) -> list[ParameterSet]:
    """Return the first seed of each batch, as parameters of a test; the batches after the usual ones are thorough."""
    return [
        pytest.param(seed, marks=() if number < usual else thorough) for number, seed in enumerate(range(0, end, size))
    ]
