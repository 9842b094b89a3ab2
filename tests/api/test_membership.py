"""Who may run tasks, and under which names."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.membership import Membership
from selfconf.bus.credentials import Credentials
from selfconf.errors import NetworkError


def member(name: str | None) -> Membership:
    """A member with credentials of a name, or with none."""
    shown = None if name is None else Credentials(name, Path("c"), Path("k"), Path("a"), Path("f"))
    return Membership("home", (), shown)


def test_a_configurator_is_called_as_its_certificate_says() -> None:
    first, second = (member("conf.alice").configurator_name() for _ in range(2))
    assert first.startswith("alice-")
    assert first != second
    assert member(None).configurator_name() == member("site.home").configurator_name() == ""


def test_who_looks_on_runs_nothing() -> None:
    with pytest.raises(NetworkError, match=r"read.alice may look on only"):
        member("read.alice").check_may_run()
    for name in (None, "conf.alice", "site.home"):
        member(name).check_may_run()
