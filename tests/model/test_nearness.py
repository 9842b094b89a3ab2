"""Components by how near they come: ports, then words, then their IRIs."""

from __future__ import annotations

from selfconf.model import nearness
from selfconf.model.hierarchy import NOTHING_ABOVE
from selfconf.model.nearness import ranked, words_of
from selfconf.model.port_likeness import PortLikeness, WantedPorts
from selfconf.model.profile import Output, Ports, Profile
from selfconf.model.signal_likeness import SignalLikeness
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import RDFS

PRICE = IRI("urn:Price")


def profile(name: str, comment: str = "", *outputs: IRI) -> Profile:
    said = ((RDFS.comment, Literal(comment)),) if comment else ()
    ports = Ports(outputs=tuple(Output(str(n), (one,)) for n, one in enumerate(outputs)))
    return Profile(IRI(f"urn:x:{name}"), properties=said, ports=ports)


def names(*profiles: Profile, question: tuple[str, ...] = (), ports: PortLikeness | None = None) -> list[str]:
    return [near.profile.component.short for near in ranked(profiles, ports, question)]


def test_ports_come_before_words_and_words_before_names() -> None:
    ports = PortLikeness([WantedPorts(((PRICE,),))], SignalLikeness(NOTHING_ABOVE))
    some = profile("zz", "", PRICE), profile("aa", "cars"), profile("bb", "cars"), profile("cc")
    assert names(*some, question=("car",), ports=ports) == ["zz", "aa", "bb", "cc"]
    assert names(*some, question=("car",)) == ["aa", "bb", "cc", "zz"]


def test_the_words_of_a_component_are_those_of_all_that_it_says() -> None:
    assert words_of(profile("carPrice", "Sells cars", PRICE)) == ["car", "price", "price", "sell", "car"]


def test_of_very_many_the_texts_of_the_nearest_are_compared(monkeypatch) -> None:  # type: ignore[no-untyped-def] # pytest's
    monkeypatch.setattr(nearness, "TEXTS_COMPARED", 1)
    assert names(profile("aa"), profile("zz", "cars"), question=("car",)) == ["aa", "zz"]
