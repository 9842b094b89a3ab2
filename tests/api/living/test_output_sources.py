"""Who looks on at an output of a composite hears whoever issues it inside, also when that is another one."""

from __future__ import annotations

import re

import pytest

from selfconf.api.living.output_sources import check_output, follow_output
from selfconf.api.task import template
from selfconf.bus.port import Sample, Undo
from selfconf.errors import AuthorError
from selfconf.model.profile import Output, Ports, Profile
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.sdk import Component
from selfconf.testing import Faults, MemoryEcology
from selfconf.testing.memory_ecology import ECOLOGY_NAME
from tests.composites.composite_house import PREFIXES, SERVED, SERVICE, House


def followed(house: House) -> tuple[list[str], Undo]:
    """Who has issued what comes from the composite's pose, and what ends that."""
    sources: list[str] = []
    keys, profile = Keys(ECOLOGY_NAME), house.ecology.advertisements[SERVED].profile
    names = {keys.output(IRI(f"urn:c:{name}"), "pose"): name for name in ("t1", "t2")}

    def heard(sample: Sample) -> None:
        sources.append(names[sample.key])

    return sources, follow_output(house.ecology.network.node(), keys, profile, "pose", heard)


@pytest.mark.parametrize(
    ("output", "said"),
    [
        ("grind()", "grind() is an operation of mill: it answers calls, and issues nothing"),
        ("grind", "mill has no output 'grind'; its outputs: 'noise'"),
    ],
)
def test_an_operation_is_no_output_that_issues_signals(output: str, said: str) -> None:
    profile = Profile(IRI("urn:c:mill"), ports=Ports((), (Output("grind()", ()), Output("noise", ()))))
    check_output(profile, "noise")
    with pytest.raises(AuthorError, match=f"^{re.escape(said)}$"):
        check_output(profile, output)


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


DOORBELL = IRI("urn:c:bell")
BELL = f'{PREFIXES}:bell a sc:Component, :Bell ; sc:hasOutput [ sc:name "rung" ; sc:signalType :Ring ] .'
CHIME = f'{PREFIXES}:chime a sc:Component, :Chime ; sc:hasInput [ sc:name "rung" ; sc:signalType :Ring ] .'
ANSWER_THE_DOOR = f"""{PREFIXES}
:answer a sc:Template ; sc:roles ( :bells :chimes ) .
:bells a sc:Role ; sh:class :Bell ; sc:feeds :chimes .
:chimes a sc:Role ; sh:class :Chime ."""


class Bell(Component):
    """Rings once as it begins to act, and then when it is told to."""

    def started(self) -> None:
        self.emit("rung", 1)


def heard_of_bell(ecology: MemoryEcology) -> list[bytes]:
    """What a reader that begins now hears of the doorbell."""
    heard: list[bytes] = []
    profile = ecology.advertisements[DOORBELL].profile
    bus = ecology.network.node()
    follow_output(bus, Keys(ECOLOGY_NAME), profile, "rung", lambda sample: heard.append(sample.payload))
    return heard


def test_every_reader_gets_the_last_signal_once_whoever_else_follows_the_output() -> None:
    ecology = MemoryEcology()
    bell = ecology.add(Bell(), BELL)
    ecology.add(Component(), CHIME)
    alone = heard_of_bell(ecology)
    ecology.run(template(ANSWER_THE_DOOR)).started()
    ecology.advance(1.0)
    assert alone == [b"1"]
    beside = heard_of_bell(ecology)
    ecology.advance(1.0)
    assert beside == [b"1"]
    bell.emit("rung", 2)
    ecology.advance(1.0)
    assert (alone, beside) == ([b"1", b"2"], [b"1", b"2"])


def test_what_was_issued_meanwhile_is_not_followed_by_an_older_signal() -> None:
    ecology = MemoryEcology(faults=Faults(most_delay=0.2))
    bell = ecology.add(Bell(), BELL)
    ecology.add(Component(), CHIME)
    ecology.run(template(ANSWER_THE_DOOR)).started()
    for number in range(2, 40):
        heard = heard_of_bell(ecology)
        bell.emit("rung", number)
        ecology.advance(1.0)
        assert heard[-1] == b"%d" % number
        assert sorted(set(heard), key=int) == heard
