"""What tests of the search have in common."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.search.without_solvers import without_solvers


@pytest.fixture
def no_solvers() -> Iterator[None]:
    """A test in which the extra `solvers` is not installed; one of Hypothesis calls `without_solvers` itself."""
    with without_solvers():
        yield
