"""The file of credentials: read if only its owner can, told to the origin it names, shown nowhere."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from selfconf.bridging.wot.credentials import read_credentials
from selfconf.errors import AuthorError


def written(folder: Path, text: str, mode: int = 0o600) -> Path:
    path = folder / "things.json"
    path.write_text(text)
    path.chmod(mode)
    return path


def test_a_credential_is_told_to_its_origin_alone(tmp_path: Path) -> None:
    text = json.dumps({"http://192.0.2.7": {"token": "t"}, "https://[2001:db8::1]:8443/": {"key": "k"}})
    told = read_credentials(written(tmp_path, text))
    assert told.for_url("http://192.0.2.7:80/lamp?on") == {"token": "t"}
    assert told.for_url("https://[2001:DB8::1]:8443/x") == {"key": "k"}
    for other in ("https://192.0.2.7/", "http://192.0.2.7:8080/", "http://192.0.2.70/", "http://x@192.0.2.8/"):
        assert told.for_url(other) == {}
    assert "t'" not in repr(told)


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o660, 0o610])
def test_a_file_that_others_can_read_is_refused(tmp_path: Path, mode: int) -> None:
    with pytest.raises(AuthorError, match="chmod 600"):
        read_credentials(written(tmp_path, "{}", mode))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"http://a": {"token": "secret"}', r"things\.json:1:33: this is not JSON"),
        ("[]", "a member for each origin"),
        ('{"lamp": {"token": "secret"}}', "no origin"),
        ('{"http://u:secret@a": {"token": "x"}}', "no origin"),
        ('{"http://a/path": {"token": "secret"}}', "no origin: more than http://a stands there"),
        ('{"http://a:x": {"token": "secret"}}', "no origin"),
        ('{"http://a": "secret"}', "an object with texts"),
        ('{"http://a": {}}', "an object with texts"),
        ('{"http://a": {"token": 7}}', "an object with texts"),
        ('{"http://a": {"token": "secret\\r\\nX: y"}}', "texts, each on one line"),
        ('{"http://a": {"passwort": "secret"}}', "other than key, password, token, username: passwort"),
        ("[" * 100_000, "not JSON"),
    ],
)
def test_what_is_wrong_is_said_without_the_secret(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(AuthorError, match=words) as raised:
        read_credentials(written(tmp_path, text))
    assert "secret" not in str(raised.value)


def test_a_file_that_is_not_there_is_said_to_be(tmp_path: Path) -> None:
    with pytest.raises(AuthorError, match="No such file"):
        read_credentials(tmp_path / "none.json")
