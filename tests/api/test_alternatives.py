"""What would come of each candidate: against every configuration that there is."""

from __future__ import annotations

from fractions import Fraction

import selfconf as sc
from selfconf.api.alternatives import MOST_TRIED, alternatives
from selfconf.api.configuring import Inquiry
from selfconf.api.method import Method
from selfconf.model.alternative import Alternative

HEAD = """\
@prefix : <https://example.org/x#> . @prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
"""
TEMPLATE = (
    HEAD
    + """
:t a sc:Template ; sc:roles ( :a :b ) %s .
:a a sc:Role ; sh:class :A ; sc:feeds :b . :b a sc:Role ; sh:class :B .
"""
)
COST = "; sc:cost ( [ sc:term [ sc:property :price ] ] )"


def component(name: str, kind: str, said: str, signal: str = "") -> str:
    port = "hasOutput" if kind == "A" else "hasInput"
    ports = f'; sc:{port} [ sc:name "p" ; sc:signalType :{signal} ]' if signal else ""
    return f":{name} a sc:Component, :{kind} {ports} {said} ."


ECOLOGY = HEAD + "\n".join(
    (
        component("a1", "A", "; :price 5 ; sc:preference 9", "S"),
        component("a2", "A", "; :price 1", "T"),
        component("a3", "A", "; :price 2", "Nothing"),
        component("b1", "B", "; :price 1", "S"),
        component("b2", "B", "; :price 2", "T"),
        component("b3", "B", "", "T"),
    )
)


def found(cost: str = COST, ecology: str = ECOLOGY, template: str = TEMPLATE) -> dict[str, Alternative]:
    inquiry = Inquiry(sc.template(template % cost), sc.read(ecology), Method.of("best"))
    return {one.component.short: one for several in alternatives(inquiry).values() for one in several}


def test_each_candidate_is_told_with_its_cost_and_that_of_the_cheapest_configuration_with_it() -> None:
    one = found()
    assert list(one) == ["a1", "a2", "a3", "b1", "b2", "b3"]
    assert [name for name in one if one[name].chosen] == ["a2", "b2"]
    assert one["a2"].total == (Fraction(3),)
    assert (one["a1"].outcome, one["a1"].cost, one["a1"].total) == ("possible", (Fraction(5),), (Fraction(6),))
    assert one["a1"].extra(one["a2"]) == (Fraction(3),)
    assert one["b1"].total == (Fraction(6),)
    assert (one["a3"].outcome, one["a3"].total) == ("impossible", ())
    assert (one["b3"].unknown_terms, one["b3"].total_unknown_terms, one["b3"].total) == (1, 1, (Fraction(1),))


def test_without_a_cost_it_is_told_whether_there_is_a_configuration_with_it() -> None:
    one = found("")
    assert {name: each.outcome for name, each in one.items()} == {
        "a1": "possible",
        "a2": "possible",
        "a3": "impossible",
        "b1": "possible",
        "b2": "possible",
        "b3": "possible",
    }
    assert [name for name in one if one[name].chosen] == ["a1", "b1"]
    assert not any(each.cost or each.total for each in one.values())


def test_a_value_that_another_candidate_states_will_do_for_what_the_role_sets() -> None:
    template = """
:t a sc:Template ; sc:roles ( :a ) ; sc:parameter :robot %s . :robot a sc:Parameter ; sc:name "robot" .
:a a sc:Role ; sh:class :A ; sh:property [ sh:path :on ; sh:in ( :robot ) ] ;
    sc:sets [ sc:parameterType :Goal ; sc:value :robot ] .
"""
    said = {"a1": ":on :Astrid ; :price 9", "a2": ":price 1", "a3": ":price 2"}
    goal = '; sc:hasParameter [ sc:name "goal" ; sc:parameterType :Goal ]'
    ecology = HEAD + "\n".join(component(name, "A", f"{goal} ; {what}") for name, what in said.items())
    one = found(ecology=ecology, template=HEAD + template)
    assert [name for name in one if one[name].chosen] == ["a2"]
    assert {name: (each.outcome, *each.total) for name, each in one.items()} == {
        "a1": ("possible", 9),
        "a2": ("possible", 1),
        "a3": ("possible", 2),
    }


def test_without_any_configuration_none_is_chosen() -> None:
    one = found(ecology=HEAD + component("a1", "A", "", "S") + component("b1", "B", "", "T"))
    assert {each.outcome for each in one.values()} == {"impossible"}


def test_of_many_candidates_and_of_roles_for_several_not_all_are_tried() -> None:
    many = "\n".join(component(f"a{number:02}", "A", "; :price 1", "S") for number in range(MOST_TRIED + 3))
    one = found(ecology=f"{HEAD}{many}\n{component('b1', 'B', '; :price 1', 'S')}")
    assert [name for name in one if one[name].outcome == "not tried"] == ["a12", "a13", "a14"]
    several = TEMPLATE.replace("sh:class :A ;", "sh:class :A ; sc:minCount 2 ; sc:maxCount 2 ;")
    one = found(ecology=f"{HEAD}{many}\n{component('b1', 'B', '; :price 1', 'S')}", template=several)
    assert {one[name].outcome for name in one if not one[name].chosen} == {"not tried"}


def test_what_could_play_beside_others_alone_is_not_told_to_be_impossible() -> None:
    feeding = [component(name, "A", "", signal) for name, signal in (("a1", "S"), ("a2", "S"), ("a3", "T"))]
    sink = component("b1", "B", "", "S").replace(" .", ' ; sc:hasInput [ sc:name "o" ; sc:signalType :T ; %s ] .')
    ads = "\n".join([HEAD, *feeding, sink % "sc:optional true"])
    several = TEMPLATE.replace("sh:class :A ;", "sh:class :A ; sc:minCount 1 ; sc:maxCount 2 ;")
    one = found("", ads, several)
    assert {name: each.outcome for name, each in one.items() if not each.chosen} == {"a3": "not tried"}
    fewer = sc.configure(sc.template(several % ""), sc.read(ads.replace(feeding[1], "")))
    assert fewer["a"] == (sc.IRI("https://example.org/x#a1"), sc.IRI("https://example.org/x#a3"))
    assert found("", ads)["a3"].outcome == "impossible"


def test_when_the_time_is_up_nothing_is_decided() -> None:
    inquiry = Inquiry(sc.template(TEMPLATE % COST), sc.read(ECOLOGY), Method.of("best"))
    outcomes = {one.outcome for several in alternatives(inquiry, 0.0).values() for one in several}
    assert outcomes == {"undecided"}
