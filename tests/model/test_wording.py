"""Lists in sentences."""

from __future__ import annotations

from selfconf.model.wording import MANY, listed


def test_names_are_listed_as_people_do_and_very_many_are_counted() -> None:
    assert [listed(names) for names in ("", "a", "ab", "abc")] == ["", "a", "a and b", "a, b and c"]
    assert listed(f"r{i}" for i in range(1000)).endswith("r7, r8 and 991 others")
    assert "others" not in listed("a" * MANY)
