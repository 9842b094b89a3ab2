"""What a person has said about whose a component is stays, and is read as it was written."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from selfconf.access.disputed_components import FILE, believe, believed, claims
from selfconf.errors import AuthorError
from selfconf.model.term import IRI


def test_what_was_said_is_kept(tmp_path: Path) -> None:
    assert believed(tmp_path) == {}
    believe(tmp_path, IRI("urn:lamp"), "attic")
    believe(tmp_path, IRI("urn:bell"), "cellar")
    believe(tmp_path, IRI("urn:lamp"), "cellar")
    assert believed(tmp_path) == {IRI("urn:lamp"): "cellar", IRI("urn:bell"): "cellar"}


@pytest.mark.parametrize("content", ["", "[]", '{"urn:a": 1}', '{"urn:a": "attic", "urn:b": 1}', "{"])
def test_what_cannot_be_read_is_named(content: str, tmp_path: Path) -> None:
    (tmp_path / FILE).write_text(content)
    with pytest.raises(AuthorError, match=FILE):
        believed(tmp_path)


def test_what_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(AuthorError, match="cannot be written"):
        believe(tmp_path / "nowhere", IRI("urn:lamp"), "attic")


LAMP, BELL = IRI("urn:lamp"), IRI("urn:bell")


@pytest.mark.parametrize(
    ("decided", "owned", "disputed"),
    [
        ({}, {"attic": {LAMP, BELL}, "cellar": set()}, {LAMP: ["attic", "cellar"]}),
        ({LAMP: "cellar"}, {"attic": {BELL}, "cellar": {LAMP}}, {}),
        ({LAMP: "attic", BELL: "cellar"}, {"attic": {LAMP, BELL}, "cellar": set()}, {}),
        ({LAMP: "garage"}, {"attic": {LAMP, BELL}, "cellar": set()}, {LAMP: ["attic", "cellar"]}),
    ],
    ids=["nothing is said", "it is the other's", "it is one's own", "it is that of a site without it"],
)
def test_of_two_sites_with_one_component_the_believed_one_has_it_or_on_its_own_host_each(
    decided: Mapping[IRI, str], owned: Mapping[str, set[IRI]], disputed: Mapping[IRI, list[str]]
) -> None:
    advertised = {"attic": frozenset((LAMP, BELL)), "cellar": frozenset((LAMP,))}
    assert claims(advertised, decided, here="attic") == (owned, disputed)


@pytest.mark.parametrize(
    ("decided", "owner"), [({}, "cellar"), ({LAMP: "attic"}, "attic")], ids=["nothing is said", "it is believed"]
)
def test_a_site_that_is_gone_has_no_claim_against_one_that_is_there_unless_it_is_believed(
    decided: Mapping[IRI, str], owner: str
) -> None:
    advertised = {"attic": frozenset((LAMP, BELL)), "cellar": frozenset((LAMP,))}
    owned, disputed = claims(advertised, decided, here="garage", gone={"attic"})
    assert not disputed
    assert [site for site, some in owned.items() if LAMP in some] == [owner]
    assert BELL in owned["attic"], "no other claims it"


def test_what_is_believed_to_be_that_of_a_site_that_was_not_seen_yet_is_no_others() -> None:
    cellar = {"cellar": frozenset((LAMP, BELL))}
    owned, disputed = claims(cellar, {LAMP: "attic"}, here="garage")
    assert (owned, disputed) == ({"cellar": {BELL}}, {LAMP: ["cellar"]})
    owned, disputed = claims({**cellar, "attic": frozenset()}, {LAMP: "attic"}, here="garage")
    assert (owned["cellar"], disputed) == ({LAMP, BELL}, {}), "it has moved"
