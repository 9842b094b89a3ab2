"""Folders of keys are for their owner alone, and errors name what is in them."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from selfconf.access.private_files import (
    check_private,
    check_unwritable,
    content,
    make_private_folder,
    named_in_errors,
    read_file,
)
from selfconf.atomic_write import write_atomically
from selfconf.errors import AuthorError, PeerError


def mode(path: Path) -> int:
    """Who may do what with a file."""
    return stat.S_IMODE(path.stat().st_mode)


def test_a_folder_is_made_for_its_owner_alone_with_those_above_it(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "b"
    make_private_folder(folder)
    assert [mode(one) for one in (folder.parent, folder)] == [0o700, 0o700]


def test_a_key_that_others_may_read_is_refused(tmp_path: Path) -> None:
    write_atomically(tmp_path / "key", b"secret")
    check_private(tmp_path / "key")
    check_private(tmp_path / "none")
    (tmp_path / "key").chmod(0o640)
    with pytest.raises(AuthorError, match=r"others may read .*key, so it is no secret"):
        check_private(tmp_path / "key")


@pytest.mark.parametrize("others", [0o777, 0o775, 0o702])
def test_a_folder_of_keys_that_others_may_write_into_is_refused(tmp_path: Path, others: int) -> None:
    make_private_folder(tmp_path / "keys")
    check_unwritable(tmp_path / "keys")
    (tmp_path / "keys").chmod(0o755)
    check_unwritable(tmp_path / "keys")
    (tmp_path / "keys").chmod(others)
    with pytest.raises(AuthorError, match=r"others may write into .*keys, .*`chmod go-w .*keys`"):
        check_unwritable(tmp_path / "keys")


def test_nothing_is_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "certificate.pem")
    assert content(tmp_path / "certificate.pem") == b""
    with pytest.raises(AuthorError, match=r"certificate.pem is no file"):
        read_file(tmp_path / "certificate.pem")


def test_what_cannot_be_read_is_an_error_or_nothing_as_the_caller_wants(tmp_path: Path) -> None:
    assert content(tmp_path / "none") == content(tmp_path) == b""
    with pytest.raises(AuthorError, match=r"there is no none in .*; is it a folder of keys"):
        read_file(tmp_path / "none")
    with pytest.raises(AuthorError, match="directory"):
        read_file(tmp_path)


@pytest.mark.parametrize("wrong", [PeerError("it is forged"), AuthorError("it is forged")], ids=["peer", "author"])
def test_what_is_wrong_with_a_file_names_it_once(tmp_path: Path, wrong: Exception) -> None:
    def read() -> bytes:
        raise wrong

    with pytest.raises(AuthorError) as caught:
        named_in_errors(tmp_path / "key", read)
    assert str(caught.value) == f"{tmp_path / 'key'}: it is forged"
    with pytest.raises(AuthorError) as again:
        named_in_errors(tmp_path / "key", lambda: read_file(tmp_path / "none"))
    assert str(again.value).count(str(tmp_path)) == 1
