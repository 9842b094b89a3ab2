"""A certificate and its key are written as a pair, and read as one that fits."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from selfconf.access.certificate_files import (
    exclusive,
    read_certificate,
    read_pair,
    read_pair_of_this_user,
    write_holder,
    write_pair,
)
from selfconf.access.certificates import new_authority
from selfconf.errors import AuthorError


def test_a_pair_is_read_as_it_was_written(tmp_path: Path) -> None:
    certificate, key = new_authority("an authority")
    write_pair(tmp_path / "authority", certificate, key)
    assert read_certificate(tmp_path / "authority.pem") == certificate
    found, secret = read_pair(tmp_path / "authority")
    assert found == certificate
    assert found.belongs_to(secret)


def test_a_pair_that_does_not_fit_is_refused_by_its_file(tmp_path: Path) -> None:
    write_pair(tmp_path / "one", *new_authority("one"))
    write_pair(tmp_path / "other", *new_authority("other"))
    (tmp_path / "one.key").write_bytes((tmp_path / "other.key").read_bytes())
    (tmp_path / "one.key").chmod(0o600)
    with pytest.raises(AuthorError, match=r"one.key is not the key of one.pem beside it"):
        read_pair(tmp_path / "one")
    assert read_pair_of_this_user(tmp_path / "one") is None


def test_a_pair_that_others_may_read_is_none_of_this_user(tmp_path: Path) -> None:
    write_pair(tmp_path / "one", *new_authority("one"))
    assert read_pair_of_this_user(tmp_path / "one") is not None
    (tmp_path / "one.key").chmod(0o644)
    assert read_pair_of_this_user(tmp_path / "one") is None
    assert read_pair_of_this_user(tmp_path / "none") is None


def test_a_holder_has_the_authority_beside_its_own(tmp_path: Path) -> None:
    authority, _ = new_authority("an authority")
    certificate, key = new_authority("a holder")
    write_holder(tmp_path / "holder", authority, certificate, key)
    assert read_certificate(tmp_path / "holder/authority.pem") == authority
    assert read_pair(tmp_path / "holder/certificate")[0] == certificate


def test_who_shares_a_folder_writes_after_the_other(tmp_path: Path) -> None:
    order: list[str] = []

    def write() -> None:
        with exclusive(tmp_path):
            order.append("second")

    with exclusive(tmp_path):
        thread = threading.Thread(target=write)
        thread.start()
        thread.join(0.05)
        order.append("first")
    thread.join()
    assert order == ["first", "second"]
    with pytest.raises(AuthorError, match="none"), exclusive(tmp_path / "none"):
        pass
