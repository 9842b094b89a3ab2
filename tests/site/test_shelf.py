"""The shelf of a site: which files it reads, what it leaves out and says, and how it notices changes."""

from __future__ import annotations

import errno
import os
import timeit
from pathlib import Path

import pytest

from selfconf import files
from selfconf.api.reading import read
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, MalformedAdvertisement, SegmentCache
from selfconf.site import Shelf
from tests.lab import ADVERTISEMENTS, PREFIXES, iri, write_advertisements


def touch(path: Path, text: str) -> None:
    """Write a file so that its time of change differs for sure."""
    path.write_text(text)
    status = path.stat()
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns + 1_000_000))


def test_a_shelf_holds_what_lies_in_its_files_and_folders(tmp_path: Path) -> None:
    write_advertisements(tmp_path / "deep" / "deeper", "tracker")
    write_advertisements(tmp_path / "other", "drive", "pippi")
    complaints: list[str] = []
    shelf = Shelf([tmp_path / "deep", tmp_path / "other" / "drive.ttl"], complaints.append)
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker"), iri("astrid-drive")}
    assert not shelf.refresh()
    assert complaints == []


def test_a_file_that_comes_changes_or_goes_is_noticed(tmp_path: Path) -> None:
    shelf = Shelf([write_advertisements(tmp_path, "tracker")], print)
    shelf.refresh()
    write_advertisements(tmp_path, "drive")
    assert shelf.refresh()
    assert len(shelf.advertisements) == 2
    touch(tmp_path / "drive.ttl", PREFIXES + ADVERTISEMENTS["drive"].replace("Astrid", "Pippi"))
    assert shelf.refresh()
    (tmp_path / "drive.ttl").unlink()
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker")}


def test_a_file_means_what_it_means_to_a_command(tmp_path: Path) -> None:
    lamp = PREFIXES + "<#lamp> a sc:Component, :Lamp ."
    (tmp_path / "marked.ttl").write_bytes(b"\xef\xbb\xbf" + lamp.encode())
    complaints: list[str] = []
    shelf = Shelf([tmp_path], complaints.append)
    assert shelf.refresh()
    assert set(shelf.advertisements) == {IRI(f"{(tmp_path / 'marked.ttl').as_uri()}#lamp")}
    assert shelf.advertisements.keys() == read(tmp_path).advertisements().keys()
    assert complaints == []


def test_a_folder_that_is_called_like_a_file_is_a_folder(tmp_path: Path) -> None:
    write_advertisements(tmp_path / "lamps.ttl", "tracker")
    complaints: list[str] = []
    shelf = Shelf([tmp_path], complaints.append)
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker")}
    assert complaints == []


def test_a_file_of_the_same_size_and_time_is_noticed(tmp_path: Path) -> None:
    """What copies or unpacks a version sets the times of its files, and may make a link lead to another one."""
    old, new, link = tmp_path / "1" / "lamp.ttl", tmp_path / "2" / "lamp.ttl", tmp_path / "now"
    for path, name in ((old, "a"), (new, "b")):
        path.parent.mkdir()
        path.write_text(f"<#{name}> a <https://w3id.org/selfconf#Component> , <urn:Lamp> .")
        os.utime(path, (1, 1))
    link.symlink_to(old.parent)
    shelf = Shelf([link], print)
    shelf.refresh()
    assert list(shelf.advertisements) == [old.as_uri() + "#a"]
    link.unlink()
    link.symlink_to(new.parent)
    assert shelf.refresh()
    assert list(shelf.advertisements) == [new.as_uri() + "#b"]
    new.write_text(new.read_text().replace("#b", "#c"))
    os.utime(new, (1, 1))
    assert shelf.refresh()
    assert list(shelf.advertisements) == [new.as_uri() + "#c"]


def test_a_folder_that_cannot_be_seen_for_now_stays_and_one_that_has_gone_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    complaints: list[str] = []
    folder, real = tmp_path / "ads", Path.stat
    folder.mkdir()
    other = write_advertisements(tmp_path / "other", "drive")
    shelf = Shelf([write_advertisements(folder, "tracker"), other], complaints.append)
    shelf.refresh()

    def hidden(path: Path, **options: bool) -> os.stat_result:
        if path == folder:
            raise PermissionError(errno.EACCES, "Permission denied")
        return real(path, **options)

    with monkeypatch.context() as denied:
        denied.setattr(Path, "stat", hidden)
        assert not shelf.refresh()
        (other / "drive.ttl").unlink()
        assert shelf.refresh()
    assert complaints == [f"cannot read {folder}: Permission denied; what it advertised before stays"]
    assert set(shelf.advertisements) == {iri("person-tracker")}
    folder.rename(tmp_path / "elsewhere")
    assert shelf.refresh()
    assert shelf.advertisements == {}
    assert complaints[1:] == [f"left out: there is no file or folder {folder}"]
    (tmp_path / "elsewhere").rename(folder)
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker")}


def test_a_complaint_is_made_once_until_it_changes(tmp_path: Path) -> None:
    complaints: list[str] = []
    shelf = Shelf([write_advertisements(tmp_path, "tracker")], complaints.append)
    (tmp_path / "lamp.ttl").write_text("no turtle")
    shelf.refresh()
    assert len(complaints) == 1
    write_advertisements(tmp_path, "drive")
    assert shelf.refresh()
    assert len(complaints) == 1
    touch(tmp_path / "lamp.ttl", "\nno turtle")
    shelf.refresh()
    assert len(complaints) == 2
    touch(tmp_path / "lamp.ttl", PREFIXES)
    shelf.refresh()
    touch(tmp_path / "lamp.ttl", "\nno turtle")
    shelf.refresh()
    assert len(complaints) == 3


def test_a_file_that_is_broken_is_named_and_the_others_stay(tmp_path: Path) -> None:
    complaints: list[str] = []
    shelf = Shelf([write_advertisements(tmp_path, "tracker", "drive")], complaints.append)
    shelf.refresh()
    touch(tmp_path / "drive.ttl", "this is no turtle")
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker")}
    assert "drive.ttl:1" in complaints[0]
    touch(tmp_path / "drive.ttl", PREFIXES + ADVERTISEMENTS["drive"])
    assert shelf.refresh()
    assert len(shelf.advertisements) == 2


def test_what_cannot_be_read_for_now_stays_as_it_was_and_is_read_as_soon_as_it_can_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    complaints: list[str] = []
    write_advertisements(tmp_path / "deep", "tracker")
    shelf = Shelf([write_advertisements(tmp_path, "drive")], complaints.append)
    with monkeypatch.context() as few_files:
        few_files.setattr(Path, "open", no_more_files)
        assert not shelf.refresh()
    assert [complaint.partition(":")[0] for complaint in complaints] == ["left out"] * 2
    assert shelf.refresh()
    everything = set(shelf.advertisements)
    assert len(everything) == 2
    touch(tmp_path / "drive.ttl", PREFIXES + ADVERTISEMENTS["drive"].replace("Astrid", "Pippi"))
    with monkeypatch.context() as few_files:
        few_files.setattr(Path, "open", no_more_files)
        few_files.setattr(os, "scandir", no_more_files)
        assert not shelf.refresh()
    assert complaints[2:] == [
        f"cannot read the folder {tmp_path}: Too many open files; what it advertised before stays"
    ]
    with monkeypatch.context() as few_files:
        few_files.setattr(Path, "open", no_more_files)
        assert not shelf.refresh()
    assert set(shelf.advertisements) == everything
    assert "drive.ttl: Too many open files; what it advertised before stays" in complaints[3]
    assert shelf.refresh()
    assert not shelf.refresh()
    assert len(complaints) == 4


def no_more_files(*_: object, **__: object) -> None:
    """Open no file, as the system does for a program that has opened all that it may."""
    raise OSError(errno.EMFILE, "Too many open files")


def test_an_advertisement_that_does_not_conform_is_named_with_what_it_lacks(tmp_path: Path) -> None:
    complaints: list[str] = []
    (tmp_path / "bad.ttl").write_text(PREFIXES + ":lamp a sc:Component .\n" + ADVERTISEMENTS["drive"])
    shelf = Shelf([tmp_path], complaints.append)
    shelf.refresh()
    assert set(shelf.advertisements) == {iri("astrid-drive")}
    assert len(complaints) == 1
    assert "bad.ttl" in complaints[0]
    assert "needs a type of its own" in complaints[0]


def test_of_two_advertisements_of_one_component_the_first_counts_and_the_other_is_named(tmp_path: Path) -> None:
    complaints: list[str] = []
    (tmp_path / "a.ttl").write_text(PREFIXES + ADVERTISEMENTS["tracker"])
    (tmp_path / "b.ttl").write_text(PREFIXES + ADVERTISEMENTS["tracker"].replace("10", "20"))
    shelf = Shelf([tmp_path], complaints.append)
    shelf.refresh()
    assert shelf.advertisements[iri("person-tracker")].profile.preference == 10
    first, other = tmp_path / "a.ttl", tmp_path / "b.ttl"
    assert complaints == [f"{other}: left out {iri('person-tracker')}: it is advertised in {first} already"]


def test_a_file_that_is_given_by_two_paths_advertises_once(tmp_path: Path) -> None:
    write_advertisements(tmp_path / "ads", "tracker")
    (tmp_path / "link.ttl").symlink_to(tmp_path / "ads" / "tracker.ttl")
    complaints: list[str] = []
    shelf = Shelf([tmp_path / "ads", tmp_path / "link.ttl"], complaints.append)
    shelf.refresh()
    assert (set(shelf.advertisements), complaints) == ({iri("person-tracker")}, [])


def test_an_empty_folder_that_is_called_like_a_file_is_no_trouble(tmp_path: Path) -> None:
    (tmp_path / "folder.ttl").mkdir()
    complaints: list[str] = []
    shelf = Shelf([tmp_path], complaints.append)
    shelf.refresh()
    assert shelf.advertisements == {}


def test_only_what_has_changed_is_read_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shelf = Shelf([write_advertisements(tmp_path)], print)
    shelf.refresh()
    before = dict(shelf.advertisements)
    read: list[Path] = []
    door = files.advertisements

    def noted(path: Path, segments: SegmentCache) -> tuple[list[Advertisement], list[MalformedAdvertisement]]:
        read.append(path)
        return door(path, segments)

    monkeypatch.setattr(files, "advertisements", noted)
    touch(tmp_path / "drive.ttl", PREFIXES + ADVERTISEMENTS["drive"].replace("Astrid", "Pippi"))
    assert shelf.refresh()
    assert read == [tmp_path / "drive.ttl"]
    assert {c for c in before if shelf.advertisements[c] is not before[c]} == {iri("astrid-drive")}


def test_to_look_at_many_files_costs_little(tmp_path: Path) -> None:
    for number in range(1000):
        (tmp_path / f"c{number}.ttl").write_text("")
    shelf = Shelf([tmp_path], print)
    first = timeit.timeit(shelf.refresh, number=1)
    assert min(timeit.repeat(shelf.refresh, number=1, repeat=5)) < first / 4
