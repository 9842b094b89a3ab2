"""Whom a certificate can speak for."""

from __future__ import annotations

import pytest

from selfconf.access import Principal, PrincipalKind
from selfconf.errors import AuthorError, PeerError
from selfconf.model.term import IRI
from selfconf.protocol.keys import component_chunk

CLOCK = IRI("https://example.org/my-home#clock")


@pytest.mark.parametrize("name", ["site.kitchen", "conf.main", "read.a-b_c.d", f"comp.{component_chunk(CLOCK)}"])
def test_a_common_name_stands_for_a_principal_and_back(name: str) -> None:
    assert Principal.of(name).common_name == name == str(Principal.written(name))


def test_the_name_of_a_configurator_has_no_hyphen() -> None:
    """The configurators of conf.a are called a-...: a conf.a-b would be one of them."""
    with pytest.raises(PeerError, match="has a hyphen"):
        Principal.of("conf.a-b")
    with pytest.raises(AuthorError, match=r"names no holder of a certificate.*conf.NAME no hyphen"):
        Principal.written("conf.a-b")
    assert Principal.of("site.a-b").name == "a-b"
    assert Principal.of("read." + "a" * 48).name == "a" * 48


@pytest.mark.parametrize(
    "name",
    [
        "",
        "site",
        "site.",
        "boss.main",
        "conf.a/b",
        "conf.*",
        "read." + "a" * 49,
        "comp.clock",
        "Site.kitchen",
        "conf.\n",
    ],
)
def test_other_names_stand_for_nobody(name: str) -> None:
    with pytest.raises(PeerError, match="no name of"):
        Principal.of(name)
    with pytest.raises(AuthorError, match="names no holder of a certificate"):
        Principal.written(name)


def test_a_component_is_written_as_its_iri() -> None:
    clock = Principal.component(CLOCK)
    assert Principal.written(CLOCK) == Principal.written(f"<{CLOCK}>") == clock
    assert clock == Principal(PrincipalKind.COMPONENT, component_chunk(CLOCK))
    assert Principal.of(clock.common_name) == clock
    for iri in (
        IRI("urn:lamp"),
        IRI("urn:dev:mac:0024befffe804ff1"),
        IRI("urn:uuid:9b1deb4d-3b7d-4bad-9bdd-2b0d7b3dcb6d"),
    ):
        assert Principal.written(iri) == Principal.component(iri)
    assert Principal.written("<x:clock>") == Principal.component(IRI("x:clock"))


@pytest.mark.parametrize(
    "text",
    [
        ":clock",
        "home:clock",
        f"comp.{CLOCK}",
        "https://example.org/my clock",
        "<:>",
        "a:",
        "<>:",
        "<clock:",
        "<1x:clock>",
    ],
)
def test_what_is_no_iri_in_full_is_not_taken_for_another_component(text: str) -> None:
    with pytest.raises(
        AuthorError, match="is no IRI of a component; write it in full, with nothing before it, such as <"
    ):
        Principal.written(text)
