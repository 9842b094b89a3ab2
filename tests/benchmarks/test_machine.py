"""The statistics of all tables of benchmarks."""

from __future__ import annotations

import pytest

from benchmarks.machine import quantile


@pytest.mark.parametrize("share", [0.05, 0.5, 0.95, 0.99, 1.0])
def test_a_quantile_is_the_least_value_that_so_many_values_do_not_exceed(share: float) -> None:
    for number in range(1, 201):
        found = quantile(range(number, 0, -1), share)  # as many values are at most `found`
        assert found - 1 < share * number <= found
