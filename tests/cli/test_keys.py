"""`keys`: from an authority to a holder and back, in words that say what to do next."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from selfconf.access import DAYS
from selfconf.cli.main import parser
from tests.cli.command import run


@pytest.fixture
def authority(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    """The folder of an authority."""
    made = run(capsys, "keys", "init", str(tmp_path / "keys"))
    assert made.code == 0
    assert "keep it to yourself" in made.out
    return tmp_path / "keys"


@pytest.mark.parametrize("command", [("issue", "read.alice", "--out", "keys"), ("renew", "keys")])
def test_a_certificate_is_good_for_as_long_as_one_from_the_library(command: tuple[str, ...]) -> None:
    assert parser(["keys"]).parse_args(["keys", *command]).days == DAYS


def test_a_holder_is_issued_shown_renewed_and_revoked(
    authority: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, keys = str(tmp_path / "attic"), ("--keys", str(authority))
    issued = run(capsys, "keys", "issue", "site.attic", *keys, "--host", "10.0.0.7", "--out", folder, "--days", "2")
    assert (issued.code, issued.err) == (0, "")
    assert "speaks for site.attic, until" in issued.out
    shown = run(capsys, "keys", "show", folder, "--format", "json").body
    (certificate,) = shown["certificates"]
    assert not shown["authority"]
    assert (certificate["name"], certificate["fault"]) == ("site.attic", "")
    assert "10.0.0.7" in certificate["hosts"]
    assert run(capsys, "keys", "show", folder).code == 0
    assert run(capsys, "keys", "renew", folder, *keys, "--days", "9").code == 0
    renewed = run(capsys, "keys", "show", folder, "--format", "json").body["certificates"][0]
    assert renewed["ends"] > certificate["ends"]
    revoked = run(capsys, "keys", "revoke", "site.attic", *keys)
    assert "revoked 2 certificates of site.attic" in revoked.out
    assert "copy" in revoked.out
    assert "too" not in revoked.out
    assert run(capsys, "keys", "revoke", "conf.main", *keys).code == 0  # the first that is listed
    whole = run(capsys, "keys", "show", str(authority))
    assert whole.code == 0
    assert "was revoked" in whole.out
    assert run(capsys, "keys", "show", folder).code == 1


def test_what_is_revoked_is_known_in_the_folders_that_were_issued(
    authority: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keys = ("--keys", str(authority))
    for holder, folder in (("site.attic", "attic"), ("site.moved", "moved"), ("conf.carl", "carl")):
        run(capsys, "keys", "issue", holder, *keys, "--out", str(tmp_path / folder))
    (tmp_path / "moved").rename(tmp_path / "elsewhere")
    said = run(capsys, "keys", "revoke", "conf.carl", *keys).out
    assert f"copy it into the folder of site.moved too, which is not in {tmp_path / 'moved'} any more" in said
    assert "site.attic" not in said
    assert (tmp_path / "attic/revoked.pem").is_file()


def test_no_folder_knows_what_is_revoked_where_none_is_left(
    authority: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keys = ("--keys", str(authority))
    run(capsys, "keys", "issue", "conf.carl", *keys, "--out", str(tmp_path / "carl"))
    (tmp_path / "carl").rename(tmp_path / "elsewhere")
    said = run(capsys, "keys", "revoke", "conf.carl", *keys).out.splitlines()
    assert said == [
        "revoked 1 certificate of conf.carl",
        f"copy {authority / 'revoked.pem'} into the folder of keys of every site on another machine",
    ]


def test_what_is_wrong_with_a_holder_is_shown(
    authority: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = str(tmp_path / "alice")
    run(capsys, "keys", "issue", "read.alice", "--keys", str(authority), "--out", folder, "--days", "0.000001")
    patience = time.monotonic() + 10.0
    while (shown := run(capsys, "keys", "show", folder)).code == 0 and time.monotonic() < patience:
        pass  # certificates tell whole seconds
    assert shown.code == 1
    assert "has expired" in shown.out


def test_a_key_that_is_broken_is_shown(authority: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "alice"
    run(capsys, "keys", "issue", "read.alice", "--keys", str(authority), "--out", str(folder))
    (folder / "certificate.key").write_bytes(b"")
    shown = run(capsys, "keys", "show", str(folder))
    assert shown.code == 2
    assert "certificate.key: holds no private key in PEM" in shown.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("issue", "boss", "--out", "x"), ("'boss' names no holder of a certificate", "site.NAME")),
        (("issue", "read.a", "--out", "."), ("not empty",)),
        (("issue", "site.a", "--host", "a b", "--out", "x"), ("neither the name of a host",)),
        (("renew", "nowhere"), ("there is no folder nowhere",)),
        (("revoke", "read.nobody"), ("nothing to revoke",)),
        (("show", "nowhere"), ("there is no folder nowhere here; name that of your keys", "keys init")),
        (("issue", "read.a", "--out", "x", "--days", "0"), ("no number of days",)),
        (("issue", "read.a", "--out", "x", "--days", "nan"), ("no number of days",)),
    ],
)
def test_misuse_has_its_sentence(
    arguments: tuple[str, ...], words: tuple[str, ...], authority: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keys = () if arguments[0] == "show" else ("--keys", str(authority))
    assert run(capsys, "keys", *arguments, *keys).is_one_sentence(*words)


def test_an_authority_is_needed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "keys", "issue", "read.a", "--out", str(tmp_path / "x")).is_one_sentence("which authority?")
    assert run(capsys, "keys", "init", str(tmp_path)).code == 0
    assert run(capsys, "keys", "init", str(tmp_path)).is_one_sentence("not empty")
