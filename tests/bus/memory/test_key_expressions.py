"""Key expressions meet in memory where they meet in Zenoh."""

from __future__ import annotations

import zenoh
from hypothesis import given
from hypothesis import strategies as st

from selfconf.bus.memory.key_expressions import intersects

chunks = st.sampled_from(["a", "b", "ab", "a$*", "ab$*", "@ctl", "*", "**"])


@given(st.lists(chunks, min_size=1, max_size=5), st.lists(chunks, min_size=1, max_size=5))
def test_the_memory_bus_matches_keys_as_zenoh_does(left: list[str], right: list[str]) -> None:
    one, other = zenoh.KeyExpr.autocanonize("/".join(left)), zenoh.KeyExpr.autocanonize("/".join(right))
    assert intersects(str(one), str(other)) == one.intersects(other)
