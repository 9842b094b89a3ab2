"""A role compiled to tests and the same role judged by pySHACL alone give one partition, in every reasoning mode."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import assume, example, given
from hypothesis import strategies as st

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy, Reasoning
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.advertisement import Advertisement
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.eligibility.role_tests import ParameterTest
from selfconf.rdf.reasoning import closure
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES

ONTOLOGY = PREFIXES + (
    "@prefix owl: <http://www.w3.org/2002/07/owl#> . :A rdfs:subClassOf :B . :B owl:equivalentClass :C ."
    " :p rdfs:subPropertyOf :q . :Place rdfs:subClassOf :Thing ."
)
HIERARCHIES = (NOTHING_ABOVE, closure.hierarchy([turtle.parse(ONTOLOGY, "o.ttl")], Reasoning.SUBCLASS))
CLASSES = st.sampled_from((":A", ":B", ":C", ":D"))
PATHS = st.sampled_from((":p", ":q", ":r"))
TERMS = st.sampled_from(
    (
        ":x", ":y", ":c1", '"abc"', '"Abc"@en', '""', "1", "2", "-3", "1.5", "2e0", '"01"^^xsd:integer',
        '"x"^^xsd:integer', "true", '"2020-01-01"^^xsd:date', '"2021-02-30"^^xsd:date',
        '"2020-01-01T00:00:00Z"^^xsd:dateTime', '"2"^^xsd:int', '"a"^^:own', '"NaN"^^xsd:double',
    )
)  # fmt: skip
VALUES = st.one_of(TERMS, st.just("[ :q 1 ]"))
LISTS = st.lists(TERMS, min_size=1, max_size=3).map(lambda terms: f"( {' '.join(terms)} )")
KINDS = st.sampled_from(("IRI", "Literal", "BlankNode", "BlankNodeOrIRI", "BlankNodeOrLiteral", "IRIOrLiteral"))
DATATYPES = st.sampled_from(
    ("xsd:integer", "xsd:decimal", "xsd:double", "xsd:boolean", "xsd:string", "xsd:date", "xsd:dateTime", ":own",
     "<http://www.w3.org/1999/02/22-rdf-syntax-ns#langString>", "xsd:int", "rdfs:Literal")
)  # fmt: skip
LIMITS = st.sampled_from(
    ("0", "1", "1.5", "2e0", '"b"', '"2020-06-01"^^xsd:date', '"2020-06-01T00:00:00Z"^^xsd:dateTime')
)
BOUNDS = st.sampled_from(("minInclusive", "maxInclusive", "minExclusive", "maxExclusive"))
CONSTRAINTS = st.one_of(
    st.builds("sh:in {}".format, LISTS),
    st.builds("sh:hasValue {}".format, TERMS),
    st.builds("sh:minCount {}{}".format, st.sampled_from(("", "+", "0")), st.integers(0, 2)),
    st.builds("sh:maxCount {}".format, st.integers(0, 2)),
    st.builds("sh:nodeKind sh:{}".format, KINDS),
    st.builds("sh:datatype {}".format, DATATYPES),
    st.builds("sh:{} {}".format, BOUNDS, LIMITS),
    st.builds("sh:{} {}".format, st.sampled_from(("minLength", "maxLength")), st.integers(0, 4)),
    st.builds('sh:pattern "{}"'.format, st.sampled_from(("^a", "b$", "x|y", ".", "^$"))),
    st.just('sh:pattern "^A" ; sh:flags "i"'),
    st.just("sh:deactivated true"),
    st.just('sh:message "so" ; sh:severity sh:Warning'),
    st.sampled_from(("sh:class :Thing", "sh:equals :r", "sh:disjoint :q", 'sh:languageIn ( "en" )')),
    st.sampled_from(("sh:lessThan :r", "sh:lessThanOrEquals :q")),
    st.just("sh:uniqueLang true"),
    st.sampled_from(
        ("sh:node [ sh:disjoint :q ]", "sh:not [ sh:equals :p ]", "sh:or ( [ sh:class :A ] [ sh:closed true ] )")
    ),
)
QUALIFYING = (
    "sh:nodeKind sh:IRI", "sh:in ( :x 1 )", "sh:hasValue :x", "sh:datatype xsd:integer", "sh:minInclusive 1",
    'sh:pattern "^a"', 'sh:nodeKind sh:Literal ; sh:pattern "^A" ; sh:flags "i"', "sh:class :Place", "sh:minLength 2",
    'sh:languageIn ( "en" )', "sh:deactivated true ; sh:hasValue :x", "sh:property [ sh:path :q ; sh:minCount 1 ]",
    "sh:not [ sh:hasValue :x ]", "sh:maxExclusive 2 ; sh:in ( 1 2 :y )", "sh:disjoint :q", "",
)  # fmt: skip
BOUNDARIES = (
    "sh:qualifiedMinCount 1", "sh:qualifiedMinCount 2", "sh:qualifiedMaxCount 0", "sh:qualifiedMaxCount 1",
    "sh:qualifiedMinCount 1 ; sh:qualifiedMaxCount 1", "sh:qualifiedMinCount 0",
    "sh:qualifiedMinCount 1 ; sh:qualifiedValueShapesDisjoint true",
)  # fmt: skip
QUALIFIED = [f"sh:qualifiedValueShape [ {said} ] ; {bounds}" for said in QUALIFYING for bounds in BOUNDARIES]
CONSTRAINTS |= st.integers(0, len(QUALIFIED) - 1).map(lambda number: QUALIFIED[number])  # printed in short


def predicate(constraint: str) -> str:
    """Which SHACL constraint it is; most may stand only once in a shape."""
    return constraint.partition(" ")[0]


PROPERTY_SHAPES = st.builds(
    lambda path, constraints: f"[ sh:path {path} ; {' ; '.join(constraints)} ]",
    PATHS,
    st.lists(CONSTRAINTS, min_size=1, max_size=3, unique_by=predicate),
)
LEAVES = st.one_of(
    st.builds("sh:class {}".format, CLASSES),
    st.builds("sh:property {}".format, PROPERTY_SHAPES),
    st.sampled_from(("sh:in ( :c1 :c2 )", "sh:hasValue :c3", "sh:nodeKind sh:IRI")),
)


def logic(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Constraints over shapes of some constraints, or over property shapes."""
    nodes = st.lists(inner, min_size=1, max_size=2, unique_by=predicate).map(lambda c: f"[ {' ; '.join(c)} ]")
    shapes = st.one_of(nodes, PROPERTY_SHAPES)
    several = st.lists(shapes, min_size=1, max_size=3).map(" ".join)
    return st.one_of(
        st.builds("sh:{} ( {} )".format, st.sampled_from(("and", "or", "xone")), several),
        st.builds("sh:not {}".format, shapes),
        st.builds("sh:node {}".format, nodes),
    )


SHAPES = st.lists(st.recursive(LEAVES, logic, max_leaves=4), min_size=1, max_size=3, unique_by=predicate).map(
    " ; ".join
)
COMPONENTS = st.lists(
    st.tuples(CLASSES, st.lists(st.tuples(PATHS, VALUES), max_size=3), st.booleans()), min_size=1, max_size=4
)


def ecology(components: list[tuple[str, list[tuple[str, str]], bool]]) -> list[Advertisement]:
    """Advertisements of those classes and properties; some also speak of a place, and of each other."""
    found = []
    for number, (kind, properties, talkative) in enumerate(components):
        said = "".join(f" ; {path} {value}" for path, value in properties)
        gossip = " ; :near :x , :c1 . :x a :Place . :c1 :p 1 ." if talkative else " ."
        text = f"{PREFIXES} :c{number} a sc:Component, {kind}{said}{gossip}"
        good, bad = advertisements.read_document(turtle.parse(text, f"{number}.ttl"))
        assert not bad
        found += good
    return found


def eligible(partitioner: Partitioner, ads: list[Advertisement]) -> dict[IRI, object]:
    """Who is eligible for the only role, and the values that it allows."""
    (found,) = partitioner.eligible(AdvertisementIndex.of(ads))
    return {e.profile.component: (dict(e.allows), {p: v for p, v in e.forbids.items() if v}) for e in found}


def by_pyshacl(partitioner: Partitioner) -> Partitioner:
    """The same with no test but what is not in the shape."""
    (role,) = partitioner.roles
    tests = tuple(test for test in role.tests if isinstance(test, ParameterTest))
    partitioner.roles = (replace(role, tests=tests, complete=False, local=False),)
    return partitioner


@given(SHAPES, COMPONENTS, st.sampled_from(HIERARCHIES))
@example("sh:property [ sh:path :p ; sh:minCount 1 ]", [(":A", [], True), (":A", [], False)], NOTHING_ABOVE)
@example(
    "sh:class :A ; sh:property [ sh:path :p ; sh:node [ sh:disjoint :q ] ]",
    [(":A", [(":p", ":c1")], False), (":B", [(":q", ":c1")], False)],
    NOTHING_ABOVE,
)
def test_compiled_tests_and_pyshacl_agree(
    shape: str, components: list[tuple[str, list[tuple[str, str]], bool]], hierarchy: Hierarchy
) -> None:
    text = f"{PREFIXES} :t a sc:Template ; sc:roles ( :role ) . :role a sc:Role ; {shape} ."
    task = bindings.complete(templates.read_task(turtle.parse(text, "t.ttl")))
    ads = ecology(components)
    alone = eligible(by_pyshacl(Partitioner(task, hierarchy)), ads)
    assert eligible(Partitioner(task, hierarchy), ads) == alone


@given(COMPONENTS, st.sampled_from(HIERARCHIES), st.sampled_from(("sh:in ( :v )", "sh:in ( :v :y )", "sh:hasValue :v")))
def test_a_free_parameter_has_the_values_that_pyshacl_lets_it_have(
    components: list[tuple[str, list[tuple[str, str]], bool]], hierarchy: Hierarchy, constraint: str
) -> None:
    assume(not any(value.startswith("[") for _, properties, _ in components for _, value in properties))
    text = (
        f"{PREFIXES} :t a sc:Template ; sc:roles ( :role ) ; sc:parameter :v . :v a sc:Parameter ; sc:name 'v' ."
        f" :role a sc:Role ; sh:property [ sh:path :q ; {constraint} ] ."
    )
    task = bindings.complete(templates.read_task(turtle.parse(text, "t.ttl")))
    ads = ecology(components)
    alone = eligible(by_pyshacl(Partitioner(task, hierarchy)), ads)
    assert eligible(Partitioner(task, hierarchy), ads) == alone
