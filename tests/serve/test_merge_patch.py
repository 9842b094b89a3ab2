"""A patch leads from the one object to the other."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from selfconf.serve.merge_patch import merge_patch


def objects(values: st.SearchStrategy[Any]) -> st.SearchStrategy[dict[str, Any]]:
    return st.dictionaries(st.sampled_from("abc"), values, max_size=3)


VALUES = st.recursive(
    st.booleans() | st.integers(0, 2) | st.just("x"), lambda inner: st.lists(inner, max_size=2) | objects(inner)
)


def applied(patch: Any, target: Any) -> Any:
    """What the algorithm of RFC 7396, section 2, makes of a target."""
    if not isinstance(patch, dict):
        return patch
    found = dict(target) if isinstance(target, dict) else {}
    for name, value in patch.items():
        if value is None:
            found.pop(name, None)
        else:
            found[name] = applied(value, found.get(name))
    return found


def test_it_says_what_is_other_new_and_gone() -> None:
    before = {"id": "a", "title": "lamp", "properties": {"on": {"unit": "x"}, "off": {}}, "same": [1]}
    after = {"id": "a", "title": "Lamp", "properties": {"on": {}}, "same": [1], "new": True}
    patch = {"title": "Lamp", "properties": {"on": {"unit": None}, "off": None}, "new": True}
    assert merge_patch(before, after) == patch
    assert merge_patch(after, after) == {}


@given(objects(VALUES), objects(VALUES))
def test_it_leads_from_one_to_the_other(before: dict[str, Any], after: dict[str, Any]) -> None:
    assert json.dumps(applied(merge_patch(before, after), before), sort_keys=True) == json.dumps(after, sort_keys=True)
