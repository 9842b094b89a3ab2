"""A parameter that is left free: what it may take, of what components state and of what a new one could state."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.partition import Mention, Partition
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf import rdflib_terms
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.eligibility.free_values import Suitable
from selfconf.rdf.eligibility.judgements import another_value
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.tasks import bindings, parameters, templates
from selfconf.rdf.tasks.templates import TaskDocument
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import RDF, XSD
from selfconf.search.problem import Problem
from selfconf.search.strategies import first as solve
from tests.lab import PREFIXES, iri
from tests.rdf.eligibility.test_partitioner import partitioner, read
from tests.rdf.eligibility.test_shape_compiler import COMPONENTS, ecology

PARAMETER = ":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :v . :v a sc:Parameter ; sc:name 'v'"
SETS = "; sc:sets [ sc:parameterType :T ; sc:value :v ]"
POSITIVE = (
    "[ sh:path :p ; sh:hasValue :v ]",
    "[ sh:path :q ; sh:in ( :v :y ) ]",
    "[ sh:path :p ; sh:minCount 1 ; sh:in ( :v ) ]",
)
PROPERTIES = st.sampled_from(
    (
        *POSITIVE,
        "[ sh:path ( :near :place ) ; sh:hasValue :v ]",
        "[ sh:path [ sh:alternativePath ( :p :r ) ] ; sh:hasValue :v ]",
        "[ sh:path [ sh:zeroOrMorePath :p ] ; sh:hasValue :v ]",
        "[ sh:path :near ; sh:minCount 1 ; sh:class :v ]",
        "[ sh:path :p ; sh:not [ sh:in ( :v ) ] ]",
        "[ sh:path :p ; sh:qualifiedValueShape [ sh:hasValue :v ] ; sh:qualifiedMaxCount 1 ]",
    )
)
SHAPES = st.one_of(
    PROPERTIES.map("sh:property {}".format),
    PROPERTIES.map("sh:not [ sh:property {} ]".format),
    PROPERTIES.map("sh:or ( [ sh:property {} ] [ sh:class :D ] )".format),
    st.just("sh:not [ sh:hasValue :v ]"),
)


def document(text: str) -> TaskDocument:
    """A task."""
    return templates.read_task(turtle.parse(f"{PREFIXES} {text}", "t.ttl"))


def bound(task: TaskDocument, value: Term) -> TaskDocument:
    """The same with a value for its parameter."""
    text = f"<{value}>" if isinstance(value, IRI) else rdflib_terms.rdflib_term(value).n3()
    return bindings.complete(bindings.bind(task, [("v", text)]))


@given(SHAPES, COMPONENTS)
@example("sh:not [ sh:property [ sh:path :p ; sh:hasValue :v ] ]", [(":A", [(":p", "1")], False)])
def test_a_candidate_allows_the_values_with_which_it_is_eligible(
    shape: str, components: list[tuple[str, list[tuple[str, str]], bool]]
) -> None:
    task = document(f"{PARAMETER} . :r a sc:Role ; {shape} .")
    ads = ecology([(kind, [p for p in said if p[1][0] != "["], talks) for kind, said, talks in components])
    partition = Partitioner(bindings.complete(task)).partition(ads)
    allowed = {c.profile.component: c.admits[0] if c.admits else -1 for c in partition.candidates[0]}
    domain = partition.variables[0].domain if partition.variables else ()
    another = another_value(iri("v"))
    for number, value in enumerate((*domain, another)):
        (eligible,) = Partitioner(bound(task, value)).partition(ads).candidates
        names = {candidate.profile.component for candidate in eligible}
        if value == another:
            assert {component for component, mask in allowed.items() if mask < 0} == names
        else:
            assert {component for component, mask in allowed.items() if mask >> number & 1} == names


def test_a_value_is_found_where_only_the_query_of_a_constraint_component_looks_for_it() -> None:
    task = document(
        f"{PARAMETER} . :r a sc:Role ; :standsIn :v ."
        ":Standing a sh:ConstraintComponent ; sh:parameter [ sh:path :standsIn ] ;"
        f" sh:validator [ a sh:SPARQLAskValidator ; sh:ask 'ASK {{ $value <{iri('place')}> $standsIn }}' ] ."
    )
    ads = read([f":{name} a sc:Component, :Lamp ; :place :{place} ." for name, place in (("a", "hall"), ("b", "bath"))])
    partition = Partitioner(bindings.complete(task)).partition(ads)
    assert partition.variables[0].domain == (iri("bath"), iri("hall"))
    assert [candidate.admits for candidate in partition.candidates[0]] == [(2,), (1,)]


@pytest.mark.parametrize("constraint", ["sh:nodeKind sh:IRI", "sh:in ( :x )", "sh:datatype xsd:anyURI"])
def test_a_free_parameter_takes_no_value_that_it_could_not_be_bound_to(constraint: str) -> None:
    task = document(f"{PARAMETER} ; {constraint} . :r a sc:Role ; sh:property [ sh:path :p ; sh:in ( :v ) ] .")
    ads = ecology([(":A", [(":p", '"abc"')], False), (":A", [(":p", ":x")], False), (":A", [], False)])
    partition = Partitioner(bindings.complete(task)).partition(ads)
    names = [candidate.profile.component.short for candidate in partition.candidates[0]]
    assert names == (["c2"] if "datatype" in constraint else ["c1", "c2"])


def test_a_parameter_that_lists_its_values_has_no_others() -> None:
    text = f"{PARAMETER} ; sh:in ( :x :y ) . :r a sc:Role ; sh:not [ sh:property [ sh:path :p ; sh:hasValue :v ] ] ."
    ads = ecology([(":A", [(":p", ":x"), (":p", ":y")], False), (":A", [(":p", ":x")], False), (":A", [], False)])
    partition = Partitioner(bindings.complete(document(text))).partition(ads)
    assert [(c.profile.component.short, c.admits) for c in partition.candidates[0]] == [("c1", (2,)), ("c2", (3,))]


def test_a_role_that_must_not_have_the_value_of_another_is_not_played_by_its_like() -> None:
    text = (
        ":t a sc:Template ; sc:roles ( :r :s ) ; sc:parameter :v . :v a sc:Parameter ; sc:name 'v' ."
        " :r a sc:Role ; sh:class :A ; sh:not [ sh:property [ sh:path :p ; sh:hasValue :v ] ] ."
        " :s a sc:Role ; sh:class :B ; sh:property [ sh:path :p ; sh:minCount 1 ; sh:in ( :v ) ] ."
    )
    task = bindings.complete(document(text))
    here, there = (":A", [(":p", ":x")], False), (":A", [(":p", ":y")], False)
    other = (":B", [(":p", ":x")], False)
    refused = solve.search(Problem(task.task, Partitioner(task).partition(ecology([here, other]))))
    assert isinstance(refused, Refusal)
    found = solve.search(Problem(task.task, Partitioner(task).partition(ecology([here, other, there]))))
    assert isinstance(found, Configuration)
    assert [component.short for component in found.components] == ["c2", "c1"]


def test_a_role_that_may_stay_empty_may_set_what_has_no_value() -> None:
    text = (
        f"{PARAMETER} . :r a sc:Role ; sc:minCount 0 ; sh:property [ sh:path :p ; sh:in ( :v ) ] ;"
        " sc:sets [ sc:parameterType :T ; sc:value :v ] ."
    )
    task = bindings.complete(document(text))
    component = f"{PREFIXES} :c a sc:Component, :A ; sc:hasParameter [ sc:name 'q' ; sc:parameterType :T ] ."
    partition = Partitioner(task).partition(advertisements.read_document(turtle.parse(component, "a.ttl"))[0])
    assert len(partition.candidates[0]) == 1
    found = solve.search(Problem(task.task, partition))
    assert isinstance(found, Configuration)
    assert found.components == ()


@pytest.mark.parametrize("shape", ["{}", "sh:and ( [ {} ] )"])
def test_a_parameter_that_lists_its_values_has_them_though_no_component_states_any(shape: str) -> None:
    looked_at = shape.format("sh:property [ sh:path :p ; sh:in ( :v ) ]")
    task = bindings.complete(document(f"{PARAMETER} ; sh:in ( :y :x ) . :r a sc:Role ; {looked_at} {SETS} ."))
    text = f'{PREFIXES} :a a sc:Component, :A ; sc:hasParameter [ sc:name "k" ; sc:parameterType :T ] .'
    ads = advertisements.read_document(turtle.parse(text, "a.ttl"))[0]
    found = solve.search(Problem(task.task, Partitioner(task).partition(ads)))
    assert isinstance(found, Configuration)
    assert [setting.value for setting in found.settings] == list(found.bindings.values()) == [iri("x")]


TERMS = (
    IRI("urn:x"),
    BlankNode("_:b"),
    Literal("abc"),
    Literal("abc", RDF.langString, "en"),
    Literal("7", XSD.integer),
)
SAID = (
    "sh:nodeKind sh:IRI", "sh:nodeKind sh:IRIOrLiteral", "sh:datatype xsd:integer", "sh:minLength 4", 'sh:pattern "^a"',
    "sh:minInclusive 5", "sh:in ( 'abc' 7 )", "sh:not [ sh:datatype xsd:string ]", "sh:hasValue 7",
)  # fmt: skip


@given(st.lists(st.sampled_from(SAID), max_size=2, unique_by=lambda each: each.partition(" ")[0]))
def test_compiled_tests_and_pyshacl_agree_on_which_values_suit_a_parameter(said: list[str]) -> None:
    given = document(" ; ".join([PARAMETER, *said]) + " . :r a sc:Role .")
    (parameter,) = given.task.template.parameters
    found = Suitable({parameter.iri: parameter}, given.document).of(parameter.iri, frozenset(TERMS))
    assert found == set(TERMS) - bindings.misfits(parameter, TERMS, given.document).keys()


def test_a_plain_constraint_on_many_values_is_not_a_question_for_pyshacl(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parameters, "_judged", None)
    given = document(f"{PARAMETER} ; sh:nodeKind sh:IRI . :r a sc:Role .")
    (parameter,) = given.task.template.parameters
    suitable = Suitable({parameter.iri: parameter}, given.document)
    assert suitable.of(parameter.iri, frozenset(TERMS)) == {IRI("urn:x")}


HEAD = """
    :t a sc:Template ; sc:roles ( :role ) ; sc:parameter :par .
    :par a sc:Parameter ; sc:name "par" ; sh:nodeKind sh:IRI .
"""
ONE_OF = "sh:property [ sh:path rob:support ; sh:in ( :par ) ]"


def partition(shape: str, bound: bool = False) -> Partition:
    """The partition by a role of some shape of an ecology that states Astrid and a literal."""
    given = partitioner(
        f"{HEAD} :role a sc:Role ; {shape} .",
        Hierarchy([], [(iri("under"), iri("over"))]),
        bound=(("par", ":Astrid"),) if bound else (),
    )
    return given.partition(read([":here a sc:Component, :Other ; rob:support :Astrid ."]))


def asked(shape: str) -> Mention:
    """What the shape of the role says of the parameter."""
    ((mention,),) = partition(shape).mentions
    return mention


def values(*names: str) -> frozenset[str]:
    """IRIs by their short names."""
    return frozenset(map(iri, names))


@pytest.mark.parametrize(
    ("shape", "mention"),
    [
        (ONE_OF, Mention(iri("par"))),
        ("sh:property [ sh:path rob:support ; sh:hasValue :par ]", Mention(iri("par"), required=True)),
        ("sh:property [ sh:path rob:support ; sh:in ( :par ) ; sh:minCount 1 ]", Mention(iri("par"), required=True)),
        ("sh:property [ sh:path rob:support ; sh:in ( :par :Emil ) ; sh:minCount 1 ]", Mention(iri("par"))),
        (
            f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:in ( :Pippi :Emil 1 ) ]",
            Mention(iri("par"), values("Pippi", "Emil")),
        ),
        (
            f"{ONE_OF} ; sh:and ( [ sh:property [ sh:path rob:support ; sh:in ( :Pippi :Emil ) ] ] )",
            Mention(iri("par"), values("Pippi", "Emil")),
        ),
        (
            f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:hasValue :Pippi ]",
            Mention(iri("par"), values("Pippi"), required=True),
        ),
        (
            f'{ONE_OF} ; sh:property [ sh:path rob:support ; sh:pattern "Pippi$" ]',
            Mention(iri("par")),
        ),
        (
            "sh:property [ sh:path :under ; sh:in ( :par ) ] ; sh:property [ sh:path :over ; sh:in ( :Pippi ) ]",
            Mention(iri("par"), values("Pippi")),
        ),
        (
            "sh:property [ sh:path :over ; sh:in ( :par ) ] ; sh:property [ sh:path :under ; sh:in ( :Pippi ) ]",
            Mention(iri("par")),
        ),
        (
            "sh:property [ sh:path :over ; sh:in ( :par ) ] , [ sh:path :over ; sh:hasValue :Emil ]",
            Mention(iri("par"), values("Emil"), required=True),
        ),
    ],
)
def test_the_rest_of_a_shape_says_what_may_be_stated(shape: str, mention: Mention) -> None:
    assert asked(shape) == mention
    assert not partition(shape).unaddable


def test_of_the_values_that_candidates_state_those_that_fail_another_test_are_told() -> None:
    other = """
        :t a sc:Template ; sc:roles ( :role :any ) ; sc:parameter :par . :par a sc:Parameter ; sc:name "par" .
        :any a sc:Role ; sh:property [ sh:path rob:support ; sh:in ( :par ) ] .
    """
    shape = f':role a sc:Role ; {ONE_OF} ; sh:property [ sh:path rob:support ; sh:pattern "Pippi$" ] .'
    found = partitioner(other + shape).partition(read([":here a sc:Component, :Other ; rob:support :Astrid ."]))
    assert found.mentions[0] == (Mention(iri("par"), never=values("Astrid")),)


def test_a_value_of_which_it_takes_too_long_to_find_out_is_like_one_that_fails() -> None:
    other = """
        :t a sc:Template ; sc:roles ( :role :any ) ; sc:parameter :par . :par a sc:Parameter ; sc:name "par" .
        :any a sc:Role ; sh:property [ sh:path rob:support ; sh:in ( :par ) ] .
    """
    costly = f"{'a' * 60}!"
    shape = rf':role a sc:Role ; {ONE_OF} ; sh:property [ sh:path rob:support ; sh:pattern "^(?=(\\w+)+$)" ] .'
    found = partitioner(other + shape).partition(read([f':here a sc:Component, :Other ; rob:support "{costly}" .']))
    assert found.mentions[0] == (Mention(iri("par"), never=frozenset((Literal(costly),))),)


@pytest.mark.parametrize(
    "shape",
    [
        f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:in ( :Pippi ) ; sh:minCount 1 ]",
        "sh:property [ sh:path rob:support ; sh:hasValue :Pippi ] , [ sh:path rob:support ; sh:in ( :par ) ]",
        "sh:property [ sh:path rob:support ; sh:hasValue :par ; sh:maxCount 0 ]",
        'sh:property [ sh:path rob:support ; sh:hasValue :par ; sh:pattern "Pippi$" ]',
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:minInclusive 5 ; sh:maxInclusive 3 ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:minExclusive 5 ] , [ sh:path :p ; sh:maxInclusive 5.0 ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:minLength 5 ; sh:maxLength 3 ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:nodeKind sh:IRI ; sh:datatype xsd:string ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:datatype xsd:date ] , [ sh:path :p ; sh:datatype xsd:string ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:datatype xsd:string ; sh:minInclusive 3 ]",
        'sh:property [ sh:path :p ; sh:minCount 1 ; sh:minInclusive 3 ; sh:maxInclusive "2026-01-01"^^xsd:date ]',
    ],
)
def test_a_shape_may_contradict_itself_by_the_value_that_is_bound(shape: str) -> None:
    assert partition(shape, bound=True).unaddable == {0}


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path rob:support ; sh:in ( :par ) ; sh:minCount 2 ]",
        "sh:property [ sh:path rob:support ; sh:in ( :par ) ; sh:hasValue :Pippi , :Emil ]",
        "sh:property [ sh:path rob:support ; sh:hasValue :par ; sh:in ( 1 2 ) ]",
    ],
)
def test_a_shape_may_contradict_itself_whatever_a_parameter_is(shape: str) -> None:
    assert partition(shape).unaddable == {0}


@pytest.mark.parametrize(
    ("shape", "unaddable"),
    [
        ("sh:in ( :here :there )", True),
        ("sh:hasValue :here", True),
        ("sh:and ( [ sh:in ( :here :there ) ] )", True),
        ("sh:or ( [ sh:in ( :here ) ] [ sh:class :Other ] )", False),
        ("sh:not [ sh:in ( :here ) ]", False),
    ],
)
def test_none_can_be_added_for_a_role_that_lists_its_components(shape: str, unaddable: bool) -> None:
    assert bool(partition(shape).unaddable) is unaddable


@pytest.mark.parametrize(
    "shape",
    [
        "sh:minInclusive 5 ; sh:maxInclusive 3",
        "sh:minCount 1 ; sh:minInclusive 3 ; sh:maxInclusive 3.0",
        "sh:minCount 1 ; sh:minLength 3 ; sh:maxLength 3 ; sh:nodeKind sh:IRI",
    ],
)
def test_what_may_be_satisfied_is_no_contradiction(shape: str) -> None:
    assert not partition(f"sh:property [ sh:path :p ; {shape} ]", bound=True).unaddable


def test_a_component_that_may_state_nothing_can_be_eligible_whatever_the_lists_are() -> None:
    shape = f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:in ( :Pippi ) ]"
    assert not partition(shape, bound=True).unaddable
