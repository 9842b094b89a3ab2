"""What a session shows is a value."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.credentials import Credentials
from selfconf.errors import NetworkError


def test_it_holds_places_and_no_secrets() -> None:
    own = Path("keys")
    shown = Credentials("read.main", own / "certificate.pem", own / "certificate.key", own / "authority.pem", own)
    assert "PRIVATE" not in repr(shown)
    assert shown == Credentials(
        "read.main", own / "certificate.pem", own / "certificate.key", own / "authority.pem", own
    )


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    for name in ("certificate.pem", "certificate.key", "authority.pem"):
        (tmp_path / name).write_text("")
    shown = Credentials(
        "read.main",
        *(tmp_path / name for name in ("certificate.pem", "certificate.key")),
        tmp_path / "authority.pem",
        tmp_path,
    )
    shown.check()
    (tmp_path / "certificate.key").unlink()
    with pytest.raises(NetworkError, match=r"certificate\.key cannot be read: No such file or directory"):
        shown.check()
