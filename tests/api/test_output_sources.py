"""Who looks on at an output of a composite hears whoever issues it inside, also when that is another one."""

from __future__ import annotations

from selfconf.api.output_sources import follow_output
from selfconf.bus.port import Sample, Undo
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.testing.memory_ecology import ECOLOGY_NAME
from tests.api.test_composites import SERVED, SERVICE, House


def followed(house: House) -> tuple[list[str], Undo]:
    """Who has issued what comes from the composite's pose, and what ends that."""
    sources: list[str] = []
    keys, profile = Keys(ECOLOGY_NAME), house.ecology.advertisements[SERVED].profile
    names = {keys.output(IRI(f"urn:c:{name}"), "pose"): name for name in ("t1", "t2")}

    def heard(sample: Sample) -> None:
        sources.append(names[sample.key])

    return sources, follow_output(house.ecology.network.node(), keys, profile, "pose", heard)


def test_an_output_of_a_composite_is_heard_by_whomever_it_is_issued_inside() -> None:
    house = House()
    house.run(SERVICE)
    sources, undo = followed(house)
    house.ecology.advance(2.0)
    assert set(sources) == {"t1"}
    house.crash("t1")
    house.ecology.advance(2.0)
    assert sources[-1] == "t2"
    undo()
    number = len(sources)
    house.ecology.advance(3.0)
    assert len(sources) == number


def test_a_composite_that_does_not_act_is_heard_once_it_does() -> None:
    house = House()
    house.ecology.advertise(SERVICE)
    sources, _ = followed(house)
    house.ecology.advance(3.0)
    assert sources == []
    house.run()
    house.ecology.advance(2.0)
    assert set(sources) == {"t1"}
