"""In how large an ecology the tests of lives run."""

from __future__ import annotations

import pytest

from selfconf.discovery import ecology_view


@pytest.fixture(params=["all lives", "selected lives"])
def followed(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether a configurator follows all lives, or, as in a large ecology, those that it has selected."""
    if request.param == "selected lives":
        monkeypatch.setattr(ecology_view, "MANY_LIVES", 0)
