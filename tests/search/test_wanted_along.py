"""What interactions ask of the ports of a role, in one way for each choice of ports of its neighbours."""

from __future__ import annotations

from selfconf.model.partition import Candidate, Partition
from selfconf.model.port_likeness import WantedPorts
from selfconf.model.profile import Input, Output, Ports, Profile
from selfconf.model.template import Interaction, Role, Task, Template
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.wanted_along import ways_along_interactions

ROLES = GIVER, MIDDLE, TAKER, OTHER = tuple(IRI(f"urn:{name}") for name in ("giver", "middle", "taker", "other"))
A, B, C, D = (IRI(f"urn:sig:{name}") for name in "ABCD")


def player(name: str, inputs: tuple[IRI, ...] = (), outputs: tuple[IRI, ...] = ()) -> Candidate:
    taken = tuple(Input(f"in{n}", (one,)) for n, one in enumerate(inputs))
    return Candidate(
        Profile(IRI(f"urn:{name}"), ports=Ports(taken, tuple(Output(f"o{n}", (s,)) for n, s in enumerate(outputs))))
    )


def problem(interactions: tuple[Interaction, ...], **candidates: tuple[Candidate, ...]) -> Problem:
    template = Template(IRI("urn:t"), tuple(map(Role, ROLES)), interactions)
    return Problem(Task(template, {}), Partition(tuple(candidates.get(role.short, ()) for role in ROLES)))


FEEDS = Interaction(GIVER, MIDDLE), Interaction(MIDDLE, TAKER)


def test_what_sinks_lack_is_wanted_and_what_sources_issue_is_given() -> None:
    given = problem(FEEDS, giver=(player("g", (), (A,)),), taker=(player("k", (B, C)),))
    assert ways_along_interactions(given, 1) == [WantedPorts(((B,), (C,)), ((A,),))]
    assert ways_along_interactions(given, 0) == []  # nobody of the middle is known
    assert ways_along_interactions(given, 2) == []


def test_of_a_source_that_issues_nothing_nothing_is_known() -> None:
    given = problem(FEEDS, giver=(player("g"),), taker=(player("k", (B,)),))
    assert ways_along_interactions(given, 1) == [WantedPorts(((B,),), None)]


def test_each_choice_of_ports_is_a_way() -> None:
    given = problem(
        FEEDS, giver=(player("g", (), (A,)), player("h", (), (D,))), taker=(player("k", (B,)), player("l", (C,)))
    )
    assert len(ways_along_interactions(given, 1)) == 4


def test_of_what_another_role_issues_and_of_other_inputs_nothing_is_asked() -> None:
    links = (Interaction(MIDDLE, TAKER, input="in0"), Interaction(OTHER, TAKER))
    given = problem(links, taker=(player("k", (B, C)),), other=(player("o", (), (C,)),))
    assert ways_along_interactions(given, 1) == [WantedPorts(((B,),), None)]
    served = problem(links, taker=(player("k", (B, C)),), other=(player("o", (), (B,)),))
    assert ways_along_interactions(served, 1) == []
