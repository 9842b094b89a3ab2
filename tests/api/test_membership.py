"""Who may run tasks, and under which names."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.membership import check_may_run, configurator_name
from selfconf.bus.credentials import Credentials
from selfconf.errors import NetworkError


def shown(name: str) -> Credentials:
    """Credentials of a name."""
    return Credentials(name, Path("c"), Path("k"), Path("a"), Path("f"))


def test_a_configurator_is_called_as_its_certificate_says() -> None:
    first, second = configurator_name(shown("conf.alice")), configurator_name(shown("conf.alice"))
    assert first.startswith("alice-")
    assert first != second
    assert configurator_name(None) == configurator_name(shown("site.home")) == ""


def test_who_looks_on_runs_nothing() -> None:
    with pytest.raises(NetworkError, match=r"read.alice may look on only"):
        check_may_run(shown("read.alice"))
    for may in (None, shown("conf.alice"), shown("site.home")):
        check_may_run(may)
