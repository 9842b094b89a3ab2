"""The door of each room of the search says what it exports."""

from __future__ import annotations

from types import ModuleType

import pytest

from selfconf.search import engines, recruiting, reduction, relaxations, strategies


@pytest.mark.parametrize(
    "door", [engines, recruiting, reduction, relaxations, strategies], ids=lambda door: door.__name__
)
def test_every_name_that_a_door_exports_is_explained_there(door: ModuleType) -> None:
    explained = door.__doc__ or ""
    assert [name for name in door.__all__ if f"`{name}`" not in explained] == []
