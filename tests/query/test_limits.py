"""What is said of a query that reaches a limit."""

from __future__ import annotations

from selfconf.query.limits import too_large, too_slow


def test_the_limit_is_named_in_its_unit() -> None:
    assert too_slow(0.5) == "the query takes more than 0.5 s; ask for less"
    assert too_large(3 << 29) == "the query takes more than 1.5 GiB of memory; ask for less"
