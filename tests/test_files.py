"""Which files a path stands for, and what is said of those that cannot be read."""

from __future__ import annotations

import io
import os
import socket
import sys
from codecs import BOM_UTF8
from collections.abc import Iterator
from pathlib import Path

import pyoxigraph as ox
import pytest

from selfconf import files
from selfconf.errors import AuthorError, TurtleError
from selfconf.model.term import IRI
from selfconf.rdf.vocabulary import ROB, XSD
from selfconf.site import Shelf

CLOCK = "@prefix sc: <https://w3id.org/selfconf#> . @prefix : <urn:x:> . :clock a sc:Component, :Clock ."


class Folder(io.RawIOBase):
    """Standard input as a shell gives it by `< folder`."""

    def readable(self) -> bool:
        return True

    def readinto(self, into: object) -> int:
        raise IsADirectoryError(21, "Is a directory")


@pytest.fixture
def ads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with one in it that may not be read; root may read everything, so it is refused here."""
    for name in ("open", "closed", "open/folder.ttl"):
        (tmp_path / name).mkdir()
    for name in ("open/a.ttl", "open/notes.txt", "closed/b.ttl", "z.ttl"):
        (tmp_path / name).write_text(CLOCK)
    scandir = os.scandir

    def guarded(path: str) -> Iterator[os.DirEntry[str]]:
        if Path(path).name == "closed":
            raise PermissionError(13, "Permission denied", path)
        return scandir(path)

    monkeypatch.setattr(os, "scandir", guarded)
    return tmp_path


def test_a_folder_stands_for_the_turtle_files_below_it(ads: Path) -> None:
    assert files.within(ads / "open") == [ads / "open" / "a.ttl"]
    assert files.within(ads / "z.ttl") == [ads / "z.ttl"]


def test_hidden_folders_are_passed_over_unless_they_are_what_is_named(tmp_path: Path) -> None:
    hidden = tmp_path / ".venv" / "deeper"
    hidden.mkdir(parents=True)
    (hidden / "shapes.ttl").touch()
    (tmp_path / ".lamp.ttl").touch()
    assert files.within(tmp_path) == [tmp_path / ".lamp.ttl"]
    assert files.within(tmp_path / ".venv") == [hidden / "shapes.ttl"]


def test_a_folder_that_cannot_be_read_is_not_passed_over_in_silence(ads: Path) -> None:
    with pytest.raises(AuthorError, match=r"cannot read the folder .*closed: Permission denied"):
        files.within(ads)


def test_a_folder_that_goes_while_its_parent_is_looked_at_holds_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "gone").mkdir()
    (tmp_path / "z.ttl").write_text(CLOCK)
    scandir = os.scandir

    def late(path: str) -> Iterator[os.DirEntry[str]]:
        if path.endswith("gone"):
            (tmp_path / "gone").rmdir()
        return scandir(path)

    monkeypatch.setattr(os, "scandir", late)
    assert files.within(tmp_path) == [tmp_path / "z.ttl"]


def test_a_site_says_once_what_it_cannot_read_and_serves_the_rest(ads: Path) -> None:
    (ads / "z.ttl").unlink()
    said: list[str] = []
    shelf = Shelf([ads], said.append)
    assert shelf.refresh()
    assert not shelf.refresh()
    (sentence,) = said
    assert sentence.startswith("left out: cannot read the folder")
    assert list(shelf.advertisements) == ["urn:x:clock"]


def test_an_ontology_may_be_in_any_format_of_rdf(tmp_path: Path) -> None:
    for name in ("a.ttl", "b.rdf", "c.owl", "d.nt", "e.nq", "f.trig", "g.jsonld", "h.txt", "i.TTL"):
        (tmp_path / name).touch()
    assert [path.name for path in files.within(tmp_path, endings=files.ONTOLOGY)] == [
        "a.ttl",
        "b.rdf",
        "c.owl",
        "d.nt",
        "e.nq",
        "f.trig",
        "g.jsonld",
    ]
    assert files.ontology_files([tmp_path, tmp_path / "b.rdf"]) == files.within(tmp_path, endings=files.ONTOLOGY)
    assert [path.name for path in files.within(tmp_path)] == ["a.ttl"]
    with pytest.raises(AuthorError, match="there is no file or folder nowhere"):
        files.ontology_files([Path("nowhere")])


@pytest.mark.parametrize("form", [ox.RdfFormat.TURTLE, ox.RdfFormat.RDF_XML, ox.RdfFormat.JSON_LD])
def test_the_fields_of_a_signal_are_read_in_any_format_of_rdf(form: ox.RdfFormat, tmp_path: Path) -> None:
    words = f'<urn:t:Switch> <{ROB.field}> ( [ <{ROB.fieldName}> "on" ; <{ROB.datatype}> <{XSD.boolean}> ] ) .'
    ox.serialize(ox.parse(words.encode(), format=ox.RdfFormat.TURTLE), tmp_path / f"words.{form.file_extension}", form)
    found = files.signal_fields(files.ontology_files([tmp_path]), [IRI("urn:t:Switch")])
    assert [field.name for one in found.values() for field in one.fields] == ["on"]


def test_a_file_means_one_thing_with_and_without_a_mark_and_by_any_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "deep").mkdir()
    path = tmp_path / "deep" / "lamp.ttl"
    path.write_bytes(BOM_UTF8 + b"<lamp> a <https://w3id.org/selfconf#Component> , <urn:Lamp> .")
    (tmp_path / "link.ttl").symlink_to(path)
    monkeypatch.chdir(tmp_path)
    found = {files.advertisements(each)[0][0].component for each in (path, Path("deep/lamp.ttl"), Path("link.ttl"))}
    assert found == {(tmp_path / "deep").resolve().as_uri() + "/lamp"}


def test_what_cannot_be_read_as_turtle_is_said(tmp_path: Path) -> None:
    (tmp_path / "binary.ttl").write_bytes(b"<urn:a>\0")
    (tmp_path / "wide.ttl").write_bytes("<urn:a> a <urn:B> .".encode("utf-16"))
    (tmp_path / "latin.ttl").write_bytes(b"# caf\xe9\n")
    for path, kind, words in (
        (tmp_path, AuthorError, "is a folder; a file is needed here"),
        (tmp_path / "nowhere.ttl", AuthorError, "no file or folder"),
        (tmp_path / "binary.ttl", TurtleError, "binary file"),
        (tmp_path / "wide.ttl", TurtleError, "this is UTF-16, and Turtle is UTF-8"),
        (tmp_path / "latin.ttl", TurtleError, r"latin\.ttl:1:6: this is not UTF-8: the byte 0xE9"),
    ):
        with pytest.raises(kind, match=words):
            files.advertisements(path)


def test_standard_input_that_is_closed_or_cannot_be_read_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(CLOCK.encode())))
    assert files.standard_input() == CLOCK.encode()
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(AuthorError, match=r"^standard input is closed$"):
        files.standard_input()
    with io.TextIOWrapper(io.BufferedReader(Folder())) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        with pytest.raises(AuthorError, match=r"^cannot read standard input: Is a directory$"):
            files.standard_input()


def test_what_is_neither_file_nor_folder_is_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.ttl")
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(tmp_path / "socket.ttl"))
    (tmp_path / "link.ttl").symlink_to("/dev/zero")
    for name, kind in (("pipe", "a named pipe"), ("socket", "a socket"), ("link", "a device")):
        path = tmp_path / f"{name}.ttl"
        for read in (files.octets, files.check_kind):
            with pytest.raises(AuthorError, match=f"cannot read {path}: it is {kind} and no file"):
                read(path)
    assert files.within(tmp_path) == []


def test_a_stream_that_a_program_was_given_is_read_as_a_file() -> None:
    """As `<(command)` of a shell is."""
    for folder in ("/dev/fd", "/proc/self/fd", f"/proc/{os.getpid()}/fd"):
        reads, writes = os.pipe()
        os.write(writes, CLOCK.encode())
        os.close(writes)
        try:
            files.check_kind(Path(folder) / str(reads))
            assert files.octets(Path(folder) / str(reads)) == CLOCK.encode()
        finally:
            os.close(reads)


def test_no_more_is_read_than_can_be_meant(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    large = tmp_path / "large.ttl"
    with large.open("wb") as file:
        file.truncate(files.MOST_READ + 1)
    with pytest.raises(AuthorError, match=f"cannot read {large}: it is larger than 1024 MiB, which cannot be meant"):
        files.octets(large)
    monkeypatch.setattr(files, "MOST_READ", 3 << 20)
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b" " * (3 << 20))))
    assert len(files.standard_input()) == 3 << 20
    with Path("/dev/zero").open() as endless:
        monkeypatch.setattr(sys, "stdin", endless)
        with pytest.raises(AuthorError, match="cannot read standard input: it is larger than 3 MiB"):
            files.standard_input()


def test_a_link_that_leads_nowhere_is_named_and_the_lock_of_an_editor_passed_over(tmp_path: Path) -> None:
    (tmp_path / "a.ttl").write_text("<urn:a> a <urn:b> .")
    (tmp_path / ".#a.ttl").symlink_to("author@host.4711:1795663100")
    assert files.within(tmp_path) == [tmp_path / "a.ttl"]
    link = tmp_path / "z.ttl"
    link.symlink_to("gone.ttl")
    assert files.within(tmp_path) == [tmp_path / "a.ttl", link]
    with pytest.raises(AuthorError, match=f"^cannot read {link}: it is a link to gone.ttl, which is not there$"):
        files.octets(link)
    said: list[str] = []
    shelf = Shelf([tmp_path], said.append)
    shelf.refresh()
    assert said == [f"left out: cannot read {link}: it is a link to gone.ttl, which is not there"]
    (tmp_path / "gone.ttl").write_text("<urn:c> a <https://w3id.org/selfconf#Component>, <urn:T> .")
    assert shelf.refresh()
