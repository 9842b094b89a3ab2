"""Which recruits are usable, and in which order they become so."""

from __future__ import annotations

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import Recruit
from selfconf.model.profile import Condition, Profile, WantedSignal
from selfconf.search.supply import Supply
from tests.search.worlds import component, iri


def supply(*profiles: Profile, hierarchy: Hierarchy = NOTHING_ABOVE) -> Supply:
    """A supply of components that may feed any player of role 0."""
    return Supply([Recruit(profile, frozenset((0,))) for profile in profiles], hierarchy)


def test_each_usable_recruit_comes_after_what_feeds_it() -> None:
    found = supply(component("c", "t:T", "u:U"), component("b", "s:S", "t:T"), component("a", "", "s:S"))
    assert found.usable([]) == [2, 1, 0]


def test_a_cycle_is_usable_only_once_something_else_feeds_it() -> None:
    found = supply(component("a", "t:T", "s:S"), component("b", "s:S", "t:T"))
    assert found.usable([]) == []
    assert sorted(found.usable(component("player", "", "t:T").outputs)) == [0, 1]


def test_an_answer_is_remembered_and_not_handed_out_to_be_changed() -> None:
    found = supply(component("a", "", "s:S"), component("b", "s:S", "t:T"))
    found.usable([]).clear()
    assert found.usable([]) == [0, 1]


def test_an_optional_input_is_not_waited_for_and_a_condition_is() -> None:
    eager = component("a", "s:S", "t:T")
    port = eager.inputs[0]._replace(optional=True)
    strict = component("b", "s:S", "t:T")
    asking = strict.inputs[0]._replace(condition=Condition(unit=iri("M")))
    some = [
        Profile(one.component, ports=one.ports._replace(inputs=(wanted,)))
        for one, wanted in ((eager, port), (strict, asking))
    ]
    centimetres = component("player", "", "s:S").outputs[0]._replace(unit=iri("CM"))
    assert supply(*some).usable([centimetres]) == [0]
    assert sorted(supply(*some).usable([centimetres._replace(unit=iri("M"))])) == [0, 1]


def test_a_second_output_of_a_signal_is_asked_by_those_with_a_condition() -> None:
    strict = component("a", "s:S", "t:T")
    asking = strict.inputs[0]._replace(condition=Condition(unit=iri("M")))
    some = supply(Profile(strict.component, ports=strict.ports._replace(inputs=(asking,))))
    output = component("player", "", "s:S").outputs[0]
    for unit in ("CM", "M"):
        assert some.usable([output._replace(unit=iri("CM")), output._replace(unit=iri(unit))]) == [0] * (unit == "M")


def test_a_signal_serves_every_class_above_it() -> None:
    above = Hierarchy([(iri("S"), iri("A"))])
    found = supply(component("a", "", "s:S"), hierarchy=above)
    issued = found.issued([0])
    assert [one.members for one in issued.serving(WantedSignal((iri("A"),)), role=0)] == [[0]]
    assert not issued.serves(WantedSignal((iri("A"),)), role=1)


def test_the_order_does_not_depend_on_that_of_the_classes_above_a_signal() -> None:
    classes = [f"A{number:02}" for number in range(30)]
    above = Hierarchy([(iri("S"), iri(name)) for name in classes])
    fed = [component(f"c{name}", f"s:{name}", "t:T") for name in reversed(classes)]
    found = supply(*fed, hierarchy=above).usable(component("player", "", "s:S").outputs)
    assert found == list(reversed(range(30)))
