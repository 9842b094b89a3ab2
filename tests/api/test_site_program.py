"""A site as a program refuses what it cannot serve before it opens anything."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.site_program import serve


@pytest.mark.parametrize(
    ("path", "ecology", "name"),
    [("no-such-folder", "home", None), ("examples/clock", "no/name", None), ("examples/clock", "home", "no/name")],
)
def test_a_path_that_is_not_there_and_a_name_that_is_none_end_it(path: str, ecology: str, name: str | None) -> None:
    said: list[str] = []
    with pytest.raises(sc.SelfconfError):
        serve([Path(path)], ecology, name, None, (), said.append)
    assert said == []
    assert sc.sites() == ()
