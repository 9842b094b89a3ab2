"""What a search does where the extra `solvers` is not installed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from selfconf.search.engines import clause_learning


@contextmanager
def without_solvers() -> Iterator[None]:
    """Let the solvers not be found, and be looked for anew before and after, as whether they are is remembered."""
    clause_learning.solver_available.cache_clear()
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(clause_learning, "find_spec", lambda name: None)
            yield
    finally:
        clause_learning.solver_available.cache_clear()
