"""Partitions: candidates in order, and what the free parameters may be."""

from __future__ import annotations

from decimal import Decimal

import pytest

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.obstacle import WrongComponent
from selfconf.model.partition import (
    ANY_VALUE,
    Candidate,
    Mention,
    NearMiss,
    Partition,
    Recruit,
    Variable,
    candidate_order,
    ordered,
)
from selfconf.model.profile import Ports, Profile, needed_operation
from selfconf.model.term import IRI

LOW, HIGH, TEXT = IRI("urn:Low"), IRI("urn:High"), IRI("urn:Text")
ABOVE = Hierarchy([(LOW, HIGH)])
LOOK, RESET = needed_operation("look", LOW, TEXT), needed_operation("reset", None, TEXT)
CALLER = Profile(IRI("urn:caller"), ports=Ports((LOOK, RESET)))
SILENT = Profile(IRI("urn:silent"), ports=Ports((RESET,)))


def test_candidates_are_tried_by_preference_and_then_by_iri() -> None:
    wishes = ("b", 0), ("a", 0), ("z", 10), ("y", -1)
    profiles = [Profile(IRI(f"urn:{name}"), preference=Decimal(wish)) for name, wish in wishes]
    in_order = [candidate.profile.component for candidate in ordered([Candidate(profile) for profile in profiles])]
    assert in_order == ["urn:z", "urn:a", "urn:b", "urn:y"]
    assert candidate_order(profiles[2]) < candidate_order(profiles[0])


def test_the_preferred_come_first_and_names_decide_between_equals() -> None:
    said = {"b": "2", "a": "2", "c": "10", "d": "-1", "e": "2.0000000000000000000000000000001"}
    profiles = [Profile(IRI(f"urn:{name}"), frozenset(), preference=Decimal(value)) for name, value in said.items()]
    assert [one.component[4:] for one in sorted(profiles, key=candidate_order)] == ["c", "e", "a", "b", "d"]


def test_a_partition_without_the_lost_keeps_everybody_else_in_order() -> None:
    a, b, c = (Candidate(Profile(IRI(f"urn:{name}")), (1,)) for name in "abc")
    partition = Partition(((a, b), (b, c)), (Variable(IRI("urn:p"), (IRI("urn:x"),)),))
    assert partition.without(frozenset({IRI("urn:b")})) == Partition(((a,), (c,)), partition.variables)


def test_a_component_can_be_left_out_of_one_role_or_as_a_recruit_alone() -> None:
    a, b = (Candidate(Profile(IRI(f"urn:{name}"))) for name in "ab")
    recruits = tuple(Recruit(one.profile, frozenset({0})) for one in (a, b))
    partition = Partition(((a, b), (a, b)), recruits=recruits)
    assert partition.without({(1, IRI("urn:a")), (None, IRI("urn:b"))}) == Partition(
        ((a, b), (b,)), recruits=recruits[:1]
    )


def test_values_that_only_the_lost_stated_are_lost_with_them() -> None:
    profiles = [Profile(IRI(f"urn:{name}")) for name in "abc"]
    masks = ((0b001, 1), (~0b010, -1), (0b110, -1))
    candidates = tuple(Candidate(profile, mask) for profile, mask in zip(profiles, masks, strict=True))
    x, y, z = (IRI(f"urn:{name}") for name in "xyz")
    partition = Partition((candidates,), (Variable(IRI("urn:p"), (x, y, z)), Variable(IRI("urn:q"), (x,))))
    assert partition.without(frozenset({IRI("urn:a")})) == Partition(
        ((Candidate(profiles[1], (~0b01,)), Candidate(profiles[2], (0b11,))),), (Variable(IRI("urn:p"), (y, z)),)
    )


def test_a_variable_takes_the_first_value_that_a_mask_allows() -> None:
    variable = Variable(IRI("urn:p"), (IRI("urn:a"), IRI("urn:b"), IRI("urn:c")))
    assert variable.first(0b110) == IRI("urn:b")
    assert variable.first(ANY_VALUE) is None
    # A near miss may state a value that no candidate states: a bit of its own beyond the domain.
    assert variable.first(1 << len(variable.domain)) is None


def test_a_partition_with_one_candidate_for_a_role_keeps_the_others_and_the_values_that_are_stated() -> None:
    a, b, c = (Candidate(Profile(IRI(f"urn:{name}")), (mask,)) for name, mask in (("a", 0b01), ("b", 0b10), ("c", -1)))
    variables = (Variable(IRI("urn:p"), (IRI("urn:x"), IRI("urn:y"))),)
    partition = Partition(((a, b), (c,)), variables)
    assert partition.with_only(0, IRI("urn:b")) == Partition(((b,), (c,)), variables)


def test_what_shapes_mention_stays_whatever_is_lost() -> None:
    a, b = (Candidate(Profile(IRI(f"urn:{name}")), (mask,)) for name, mask in (("a", 0b1), ("b", -1)))
    mention = Mention(IRI("urn:p"))
    partition = Partition(((a, b),), (Variable(IRI("urn:p"), (IRI("urn:x"),)),), mentions=((mention,),))
    assert partition.without(frozenset({IRI("urn:a")})).mentioned(0) == (mention,)
    assert partition.without(frozenset({IRI("urn:b")})).mentioned(0) == (mention,)
    assert partition.mentioned(1) == ()  # what is outside of a composite is no role of its template


def test_what_a_near_miss_would_allow_does_not_change() -> None:
    allows = {IRI("urn:p"): frozenset((IRI("urn:x"),))}
    miss = NearMiss(IRI("urn:r"), IRI("urn:a"), WrongComponent(frozenset()), allows)
    assert miss.allows == allows
    with pytest.raises(TypeError):
        miss.allows[IRI("urn:q")] = frozenset()  # type: ignore[index]  # that is what is tested


def test_two_mentions_of_a_parameter_ask_for_what_both_ask_for() -> None:
    p, (x, y, z) = IRI("urn:p"), (IRI(f"urn:{name}") for name in "xyz")
    some, other = Mention(p, frozenset((x, y)), frozenset((z,))), Mention(p, frozenset((y, z)), required=True)
    assert some.beside(other) == Mention(p, frozenset((y,)), frozenset((z,)), True)
    assert some.beside(Mention(p)) == Mention(p).beside(some) == some
    assert some.among(frozenset((x,))) == Mention(p, frozenset((x,)), frozenset((z,)))


def kinds(profile: Profile) -> list[frozenset[str] | None]:
    """What each request of a component is known to be."""
    conditions = [port.condition for port in profile.inputs]
    return [None if one is None or one.sent is None else one.sent.kinds for one in conditions]


def test_a_request_is_all_that_lies_above_it_for_players_and_recruits() -> None:
    partition = Partition(((Candidate(CALLER), Candidate(SILENT)),), recruits=(Recruit(CALLER, frozenset((0,))),))
    raised = partition.with_sent_requests(ABOVE)
    caller, silent = raised.candidates[0]
    assert kinds(caller.profile) == kinds(raised.recruits[0].profile) == [{LOW, HIGH}, frozenset()]
    assert silent is partition.candidates[0][1]


def test_where_nothing_lies_above_or_nothing_is_sent_all_stays_as_it_is() -> None:
    partition = Partition(((Candidate(CALLER),),))
    assert partition.with_sent_requests(NOTHING_ABOVE) is partition
    silent = Partition(((Candidate(SILENT),),))
    assert silent.with_sent_requests(ABOVE) is silent
