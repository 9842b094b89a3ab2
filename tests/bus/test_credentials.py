"""What a session shows is a value."""

from __future__ import annotations

from pathlib import Path

from selfconf.bus.credentials import Credentials


def test_it_holds_places_and_no_secrets() -> None:
    own = Path("keys")
    shown = Credentials("read.main", own / "certificate.pem", own / "certificate.key", own / "authority.pem", own)
    assert "PRIVATE" not in repr(shown)
    assert shown == Credentials(
        "read.main", own / "certificate.pem", own / "certificate.key", own / "authority.pem", own
    )
