"""Discovery: what lives, what is advertised, which sites did not answer, and what strangers try to pass in."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.memory import Faults, MemoryBus, MemoryRequest
from selfconf.bus.port import Request
from selfconf.discovery import Discovery
from selfconf.discovery.inquiry import DISCOVERY, LARGEST_ADVERTISEMENT
from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Page, Release
from selfconf.rdf.vocabulary import RDFS
from selfconf.site import Shelf, Site
from tests.discovery.field import KEYS, TRACKER, Field
from tests.lab import ADVERTISEMENTS, PREFIXES, iri, write_advertisements


def test_everything_that_lives_is_found_at_its_site(field: Field) -> None:
    field.site("living-room", "tracker")
    field.site("astrid", "drive", "pippi")
    discovery = field.discover()
    assert {component.short: found.site for component, found in discovery.found.items()} == {
        "person-tracker": "living-room",
        "astrid-drive": "astrid",
        "pippi-drive": "astrid",
    }
    assert (discovery.sites, discovery.missing, discovery.complaints) == (("astrid", "living-room"), (), [])


def test_what_is_found_is_what_was_advertised(field: Field) -> None:
    site = field.site("living-room", "tracker")
    found = field.discover().found[TRACKER]
    assert found.advertisement.profile == site.shelf.advertisements[TRACKER].profile
    assert found.source.endswith("tracker.ttl")
    assert not found.startable


def test_an_ecology_without_sites_is_discovered_at_once(field: Field) -> None:
    assert field.discover() == Discovery()
    assert field.network.time < 1.0


def test_a_node_that_has_no_hub_as_it_asks_asks_again(field: Field, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MemoryBus, "link", property(lambda node: "hub" if node.now() > 0.1 else ""))
    field.ecology.bus.later(0.2, lambda: field.site("living-room", "tracker"))
    assert set(field.discover().found) == {TRACKER}


def test_a_site_without_advertisements_has_answered(field: Field) -> None:
    (field.folder / "empty").mkdir()
    Site(field.network.node(), "lab", "empty", Shelf([field.folder / "empty"], print))
    discovery = field.discover()
    assert (discovery.sites, discovery.missing, discovery.found) == (("empty",), (), {})


def test_a_site_is_not_read_again_as_long_as_its_advertisements_are_the_same(
    field: Field, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = field.site("living-room", "tracker")
    field.site("astrid", "drive", "pippi")
    replied: list[str] = []
    reply = MemoryRequest.reply

    def counted(request: MemoryRequest, key: str, payload: bytes, attachment: bytes = b"") -> None:
        replied.append(key)
        reply(request, key, payload, attachment)

    monkeypatch.setattr(MemoryRequest, "reply", counted)
    first = field.discover()
    assert len(replied) == 3
    again = field.discover()
    assert (again.found, again.sites, again.missing) == (first.found, first.sites, ())
    assert len(replied) == 3 + 2
    write_advertisements(field.folder / "living-room", "tracker", "sonar")
    field.network.run(lambda: len(site.shelf.advertisements) == 2, 5.0)
    assert iri("sonar-array") in field.discover().found
    assert len(replied) == 3 + 2 + 1 + 2


def test_what_a_site_has_said_to_hold_still_holds_though_another_discovery_forgets_it(
    field: Field, monkeypatch: pytest.MonkeyPatch
) -> None:
    field.site("living-room", "tracker")
    first, found, work = field.discover(), [], []
    monkeypatch.setattr(field.ecology, "aside", work.append)
    field.ecology.discover(found.append)
    assert field.network.run(lambda: bool(work), DISCOVERY)
    field.ecology.known = {}  # as by a discovery to which the site has not answered
    work.pop()()
    assert field.network.run(lambda: bool(found), DISCOVERY)
    assert found[0].found == first.found


def test_two_pages_of_one_number_are_not_both_passed_over(field: Field) -> None:
    def answer(request: Request) -> None:
        for name in ("tracker", "drive"):
            component = iri({"tracker": "person-tracker", "drive": "astrid-drive"}[name])
            page = encode(Page(0, 1, 1, component, "x.ttl"))
            payload = (PREFIXES + ADVERTISEMENTS[name]).encode()
            request.reply(KEYS.advertisement("liar", component), payload, page)

    field.stranger("liar", answer)
    discovery = field.discover()
    assert list(discovery.found) == [TRACKER]
    assert any("astrid-drive" in complaint for complaint in discovery.complaints)


# Sites that do not answer, or not in full.


def test_a_site_that_lives_but_does_not_answer_is_named_missing(field: Field) -> None:
    field.site("living-room", "tracker")
    node = field.network.node()
    node.announce(KEYS.site_life("stuck", "1"))
    node.serve(KEYS.advertisements("stuck"), lambda _: None)
    discovery = field.discover()
    assert discovery.missing == ("stuck",)
    assert set(discovery.found) == {TRACKER}


def test_a_site_that_is_killed_in_the_middle_of_its_answer_is_named_missing(field: Field) -> None:
    field.site("living-room", "tracker")
    node = field.network.node()
    node.announce(KEYS.site_life("astrid", "1"))

    def answer(request: Request) -> None:
        payload = (PREFIXES + ADVERTISEMENTS["drive"]).encode()
        page = encode(Page(0, 2, 1, iri("astrid-drive"), "drive.ttl"))
        request.reply(KEYS.advertisement("astrid", iri("astrid-drive")), payload, page)
        field.network.run(lambda: False, 0.01)
        node.close()

    node.serve(KEYS.advertisements("astrid"), answer)
    discovery = field.discover()
    assert discovery.missing == ("astrid",)
    assert set(discovery.found) == {TRACKER, iri("astrid-drive")}


def test_a_site_that_answers_in_part_is_named_missing_though_it_was_not_there_at_the_roll_call(field: Field) -> None:
    node = field.network.node()

    def answer(request: Request) -> None:
        payload = (PREFIXES + ADVERTISEMENTS["drive"]).encode()
        page = encode(Page(0, 2, 1, iri("astrid-drive"), "drive.ttl"))
        request.reply(KEYS.advertisement("astrid", iri("astrid-drive")), payload, page)
        request.finish()

    node.serve(KEYS.advertisements("astrid"), answer)
    discovery = field.discover()
    assert (discovery.sites, discovery.missing) == (("astrid",), ("astrid",))
    assert set(discovery.found) == {iri("astrid-drive")}


def test_a_site_whose_answer_was_cut_short_is_asked_again(field: Field) -> None:
    asked: list[int] = []

    def answer(request: Request) -> None:
        asked.append(1)
        for index, name in enumerate(("drive", "tracker")[: len(asked)]):
            component = {"drive": iri("astrid-drive"), "tracker": TRACKER}[name]
            payload = (PREFIXES + ADVERTISEMENTS[name]).encode()
            request.reply(KEYS.advertisement("s", component), payload, encode(Page(index, 2, 1, component, "")))

    field.stranger("s", answer)
    discovery = field.discover()
    assert len(asked) == 2
    assert discovery.missing == ()
    assert len(discovery.found) == 2


def test_a_site_that_is_always_incomplete_is_not_asked_for_ever(field: Field) -> None:
    asked: list[int] = []

    def answer(request: Request) -> None:
        asked.append(1)
        page = encode(Page(0, 5, 1, TRACKER, ""))
        request.reply(KEYS.advertisement("s", TRACKER), (PREFIXES + ADVERTISEMENTS["tracker"]).encode(), page)

    field.stranger("s", answer)
    assert field.discover().missing == ("s",)
    assert len(asked) == 3


def test_advertisements_that_change_in_the_middle_are_taken_from_one_revision(field: Field) -> None:
    def answer(request: Request) -> None:
        for name, component, page in (
            ("drive", iri("astrid-drive"), Page(0, 2, 1, iri("astrid-drive"), "")),
            ("tracker", TRACKER, Page(0, 1, 2, TRACKER, "")),
            ("pippi", iri("pippi-drive"), Page(1, 2, 1, iri("pippi-drive"), "")),
        ):
            payload = (PREFIXES + ADVERTISEMENTS[name]).encode()
            request.reply(KEYS.advertisement("s", component), payload, encode(page))

    field.stranger("s", answer)
    discovery = field.discover()
    assert set(discovery.found) == {TRACKER}
    assert discovery.missing == ()


# Strangers.


@pytest.mark.parametrize(
    ("turtle", "complaint"),
    [
        ("this is no turtle", "not Turtle"),
        (b"\xff\xfe\x00", "not Turtle"),
        (b"\x00" * 10, "not Turtle"),
        ("", "does not advertise"),
        (ADVERTISEMENTS["drive"], "does not advertise"),
        (":person-tracker a sc:Component .", "a component needs a type of its own"),
        (":person-tracker a sc:Component, rob:PositionSensor ; sc:hasOutput [ sc:signalType :Pose ] .", "sc:name"),
    ],
)
def test_what_is_no_advertisement_of_its_component_is_left_out_and_named(
    field: Field, turtle: str | bytes, complaint: str
) -> None:
    field.lie("stranger", TRACKER, turtle)
    discovery = field.discover()
    assert discovery.found == {}
    assert complaint in discovery.complaints[0]
    assert "stranger" in discovery.complaints[0]
    assert discovery.missing == ()


def test_an_advertisement_speaks_for_its_own_component_only(field: Field) -> None:
    field.lie("stranger", TRACKER, ADVERTISEMENTS["tracker"] + "\n" + ADVERTISEMENTS["drive"])
    discovery = field.discover()
    assert set(discovery.found) == {TRACKER}
    subjects = {subject for subject, _, _ in discovery.found[TRACKER].advertisement.triples}
    assert iri("astrid-drive") not in subjects


def test_axioms_and_shapes_in_an_advertisement_are_left_out(field: Field) -> None:
    field.lie(
        "stranger",
        TRACKER,
        ADVERTISEMENTS["tracker"]
        + " :person-tracker :see :x . :x rdfs:subClassOf rob:MotorDrive ; rdfs:subPropertyOf rob:support ;"
        " rdfs:domain rob:MotorDrive ; <http://www.w3.org/2002/07/owl#sameAs> :astrid-drive ;"
        " a sh:NodeShape, <http://www.w3.org/2002/07/owl#Class> ; sh:targetClass sc:Component ; sh:maxCount 0 .",
    )
    triples = field.discover().found[TRACKER].advertisement.triples
    said = {predicate for subject, predicate, _ in triples if subject == iri("x")}
    assert said == set()
    assert RDFS.subClassOf not in {predicate for _, predicate, _ in triples}


def test_an_advertisement_that_is_too_large_is_left_out(field: Field) -> None:
    field.lie("stranger", TRACKER, ADVERTISEMENTS["tracker"] + "#" * LARGEST_ADVERTISEMENT)
    discovery = field.discover()
    assert discovery.found == {}
    assert "too many" in discovery.complaints[0]


@pytest.mark.parametrize("attachment", [b"", b"\xff", encode(Release(1, "x")), b'{"kind":"page","index":"x"}'])
def test_a_reply_without_a_page_is_named_and_its_site_missing(field: Field, attachment: bytes) -> None:
    payload = (PREFIXES + ADVERTISEMENTS["tracker"]).encode()
    field.stranger("s", lambda request: request.reply(KEYS.advertisement("s", TRACKER), payload, attachment))
    discovery = field.discover()
    assert discovery.found == {}
    assert discovery.missing == ("s",)
    assert "is none" in discovery.complaints[0]


@pytest.mark.parametrize("page", [Page(0, -1, 1, TRACKER), Page(-5, 1, 1, TRACKER), Page(0, 1 << 60, -3, TRACKER)])
def test_a_page_with_absurd_numbers_harms_only_its_own_site(field: Field, page: Page) -> None:
    payload = (PREFIXES + ADVERTISEMENTS["tracker"]).encode()
    field.stranger("s", lambda request: request.reply(KEYS.advertisement("s", TRACKER), payload, encode(page)))
    field.site("astrid", "drive")
    discovery = field.discover()
    assert iri("astrid-drive") in discovery.found
    assert "astrid" not in discovery.missing


def test_a_component_that_two_sites_advertise_is_taken_from_one_and_the_other_is_named(field: Field) -> None:
    field.site("a", "tracker")
    field.site("b", "tracker")
    discovery = field.discover()
    assert discovery.found[TRACKER].site == "a"
    assert "left out" in discovery.complaints[0]
    assert "site b" in discovery.complaints[0]


def test_a_lossy_network_shows_as_missing_sites_never_as_wrong_ones(tmp_path: Path) -> None:
    for seed in range(20):
        field = Field(tmp_path, Faults(loss=0.3))
        field.network._chance.seed(seed)
        field.site("living-room", "tracker")
        field.site("astrid", "drive")
        discovery = field.discover()
        at = {found.site for found in discovery.found.values()}
        assert at | set(discovery.missing) == {"living-room", "astrid"}
        assert not at & set(discovery.missing)


def test_without_keys_a_component_of_two_sites_is_that_of_the_first(field: Field) -> None:
    for name in ("attic", "cellar"):
        field.site(name, "tracker")
    found = field.discover()
    assert found.found[TRACKER].site == "attic"
    assert found.complaints == [f"left out {TRACKER} of site cellar: site attic advertises it too"]


@pytest.mark.parametrize(
    ("believed", "site"), [({}, None), ({TRACKER: "cellar"}, "cellar"), ({TRACKER: "elsewhere"}, None)]
)
def test_with_keys_a_disputed_component_is_nobodys_until_somebody_says_whose(
    believed: dict[IRI, str], site: str | None, field: Field
) -> None:
    field.ecology.believed = lambda: believed
    field.site("attic", "tracker", "drive")
    field.site("cellar", "tracker")
    found = field.discover()
    assert iri("astrid-drive") in found.found
    assert (found.found[TRACKER].site if TRACKER in found.found else None) == site
    disputed = f"left out {TRACKER}: it is disputed, for the sites attic and cellar advertise it; say whose it is: "
    assert [one.startswith(disputed) for one in found.complaints] == [True] * (site is None)


def test_a_note_of_beliefs_that_cannot_be_read_is_told_and_believes_nobody(field: Field) -> None:
    def broken() -> dict[IRI, str]:
        raise AuthorError("is no object of components", file="believed.json")

    field.ecology.believed = broken
    for name in ("attic", "cellar"):
        field.site(name, "tracker")
    found = field.discover()
    assert TRACKER not in found.found
    assert "believed.json: is no object of components" in found.complaints
