"""Gathering what is to be imported: files, folders, and URLs on this machine."""

from __future__ import annotations

import gzip
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from selfconf.errors import AuthorError
from selfconf.importing import sources
from selfconf.importing.sources import SourceDocument, gather


class Things(BaseHTTPRequestHandler):
    """A thing that describes itself, one that has moved, and one whose description does not end."""

    def do_GET(self) -> None:
        if self.path == "/moved":
            self.send_response(302)
            self.send_header("Location", "/lamp.json")
            self.end_headers()
        elif self.path == "/lamp.json":
            self.send_response(200)
            self.end_headers()
            self.wfile.write(b"{}")
        elif self.path == "/half.json":
            self.send_response(200)
            self.send_header("Content-Length", "9")
            self.end_headers()
            self.wfile.write(b"[]")
        elif self.path == "/packed.json":
            self.send_response(200)
            self.send_header("Content-Encoding", "gzip")
            self.end_headers()
            self.wfile.write(gzip.compress(b"{}"))
        elif self.path.startswith("/things"):
            page = int(self.path.partition("?page=")[2] or 1)
            self.send_response(200)
            if page < 3:
                self.send_header("Link", f'</things?page={page + 1}>; rel="next", </things>; rel=canonical')
            self.end_headers()
            self.wfile.write(str(page).encode())
        elif self.path == "/endless":
            self.send_response(200)
            self.end_headers()
            try:
                while True:
                    self.wfile.write(b" " * 4096)
            except OSError:
                return
        else:
            self.send_error(404)

    def log_message(self, *_: object) -> None:
        """Print nothing."""


@pytest.fixture
def server() -> Iterator[str]:
    """The URL of a server on this machine."""
    with ThreadingHTTPServer(("127.0.0.1", 0), Things) as running:
        thread = threading.Thread(target=running.serve_forever, args=(0.01,))
        thread.start()
        yield f"http://127.0.0.1:{running.server_port}"
        running.shutdown()
        thread.join()


def gathered(*given: str) -> tuple[list[SourceDocument], list[AuthorError]]:
    errors: list[AuthorError] = []
    return list(gather(given, (".json",), errors.append)), errors


def test_a_folder_stands_for_its_files_of_the_format_named_by_their_paths_below_it(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    for name in ("z.json", "b/a.json", "b/c.txt"):
        (tmp_path / name).write_text("{}")
    found, errors = gathered(str(tmp_path))
    assert [source.name for source in found] == ["b/a.json", "z.json"]
    assert errors == []


def test_a_file_is_taken_whatever_its_name_ends_with(tmp_path: Path) -> None:
    (tmp_path / "lamp").write_bytes(b"\xef\xbb\xbf{}")
    (found,), _ = gathered(str(tmp_path / "lamp"))
    assert (found.name, found.text()) == ("lamp", "{}")


def test_what_is_given_twice_is_one_document(server: str, tmp_path: Path) -> None:
    (tmp_path / "lamp.json").write_text("{}")
    (tmp_path / "link.json").symlink_to("lamp.json")
    (tmp_path / "other.json").write_text("{}")
    url, lamp = f"{server}/lamp.json", str(tmp_path / "lamp.json")
    found, errors = gathered(lamp, url, lamp, str(tmp_path / ".." / tmp_path.name), url)
    assert ([one.shown for one in found], errors) == (
        [lamp, url, str(tmp_path / ".." / tmp_path.name / "other.json")],
        [],
    )


def test_what_is_not_there_is_named_and_the_rest_is_gathered(tmp_path: Path) -> None:
    (tmp_path / "lamp.json").write_text("{}")
    found, errors = gathered(str(tmp_path / "nowhere"), str(tmp_path / "lamp.json"))
    assert [source.name for source in found] == ["lamp.json"]
    assert "there is no file or folder" in str(errors[0])


def test_a_url_with_a_password_is_refused_in_words_that_do_not_tell_it() -> None:
    found, (error,) = gathered("http://me:secret@127.0.0.1:1/lamp")
    assert found == []
    assert "secret" not in str(error)
    assert "has a user name or a password in it" in str(error)


def test_an_empty_text_as_of_a_variable_that_is_not_set_is_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "lamp.json").write_text("{}")
    monkeypatch.chdir(tmp_path)
    found, errors = gathered("")
    assert found == []
    assert str(errors[0]) == "an empty text is no source; the current folder is '.'"


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "large.json").open("wb") as file:
        file.truncate(20 << 20)
    found, errors = gathered(str(tmp_path))
    assert found == []
    assert "large.json: it is over 16 MiB" in str(errors[0])


def test_text_that_is_not_utf_8_is_named_with_its_place() -> None:
    with pytest.raises(AuthorError, match="lamp:2:4: this is not UTF-8: the byte 0xFF"):
        SourceDocument("lamp", "lamp", b"{\nab\xc3\xa9\xff").text()


def test_a_url_is_fetched_and_named_after_its_last_part(server: str) -> None:
    (found,), errors = gathered(f"{server}/lamp.json")
    assert (found.name, found.octets, errors) == ("lamp.json", b"{}", [])


def test_all_pages_of_a_list_are_fetched_each_as_a_document_of_its_own(server: str) -> None:
    found, errors = gathered(f"{server}/things")
    assert [(one.shown, one.name, one.octets) for one in found] == [
        (f"{server}/things", "things", b"1"),
        (f"{server}/things?page=2", "things-2", b"2"),
        (f"{server}/things?page=3", "things-3", b"3"),
    ]
    assert [one.whole is found[0] for one in found] == [True] * 3
    assert errors == []


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("moved", "no redirect is followed"),
        ("gone", "answers 404"),
        ("packed.json", "answers in a compressed form"),
        ("half.json", "breaks off 7 bytes before its end"),
    ],
)
def test_a_url_that_answers_otherwise_is_named(server: str, path: str, words: str) -> None:
    found, errors = gathered(f"{server}/{path}")
    assert found == []
    assert words in str(errors[0])


def test_an_endless_answer_ends(server: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sources, "LARGEST_SOURCE", 1 << 20)
    found, errors = gathered(f"{server}/endless")
    assert found == []
    assert "it is over 1 MiB" in str(errors[0])


def test_a_slow_answer_ends(server: str, monkeypatch: pytest.MonkeyPatch) -> None:
    times = iter((0.0, 1.0, 1e9))
    monkeypatch.setattr(sources, "monotonic", lambda: next(times))
    _, errors = gathered(f"{server}/endless")
    assert "has not answered in full within 20 s" in str(errors[0])


def test_nobody_there_is_named() -> None:
    _, errors = gathered("http://127.0.0.1:9/")
    assert "cannot fetch http://127.0.0.1:9/" in str(errors[0])


def test_a_file_url_is_a_path_like_any_other(tmp_path: Path) -> None:
    (tmp_path / "secret.json").write_text("{}")
    found, errors = gathered((tmp_path / "secret.json").as_uri())
    assert found == []
    assert len(errors) == 1
