"""Who is eligible for a role: the same whether the shape is compiled or judged by pySHACL as a whole."""

from __future__ import annotations

from collections.abc import Iterable

import pyshacl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from selfconf.errors import TemplateError
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import ANY_VALUE, Partition
from selfconf.model.term import IRI
from selfconf.rdf import rdflib_terms
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.advertisement import Advertisement
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.pyshacl_corrections import only_ordered
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import RDF, SC
from tests.harness.effort import examples
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri

CLASSES = ("rob:MotorDrive", "rob:Encoder", ":Other")
CLOSED = " ; sh:closed true"
IGNORED = "<http://www.w3.org/1999/02/22-rdf-syntax-ns#type>"
PATHS = ("rob:support", "rob:place", "rdfs:label")
VALUES = (":Astrid", ":Pippi", '"x"', '"xyz"', '"x"@en', "1", '"01"^^xsd:integer', "2.5", "true")
PARAMETER = iri("par")
ONE_PARAMETER = ":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :par . :par a sc:Parameter ; sc:name 'par' ."


def read(texts: Iterable[str]) -> list[Advertisement]:
    """The advertisements that some texts are."""
    return [one for text in texts for one in advertisements.read_document(turtle.parse(PREFIXES + text, "ads.ttl"))[0]]


def partitioner(
    text: str, hierarchy: Hierarchy = NOTHING_ABOVE, bound: tuple[tuple[str, str], ...] = ()
) -> Partitioner:
    """The partitioner of a template."""
    task = templates.read_task(turtle.parse(PREFIXES + text, "template.ttl"))
    return Partitioner(bindings.complete(bindings.bind(task, bound)), hierarchy)


def names(partition: Partition) -> list[list[str]]:
    """Who is eligible for each role, in order, by short names."""
    return [[candidate.profile.component.short for candidate in role] for role in partition.candidates]


# The paper's ecology.


def test_the_papers_ecology_is_partitioned_as_in_the_paper() -> None:
    task = templates.read_task(turtle.parse(NAVIGATE, "navigate.ttl"))
    bound = bindings.complete(bindings.bind(task, [("robot", ":Astrid"), ("goal", "(AT BEDROOM)")]))
    assert names(Partitioner(bound).partition(read(ADVERTISEMENTS.values()))) == [
        ["sonar-array"],
        ["wheels"],
        ["person-tracker", "absolute-odometry"],
        ["thinking-cap"],
        ["astrid-drive"],
    ]


def test_a_property_that_a_component_does_not_have_is_not_asked_for_unless_it_must_be_there() -> None:
    ads = read([":a a sc:Component, :Lamp .", ":b a sc:Component, :Lamp ; rob:place :hall ."])
    shape = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ; sh:property [ sh:path rob:place ; "
    assert names(partitioner(shape + "sh:in ( :hall ) ] .").partition(ads)) == [["a", "b"]]
    assert names(partitioner(shape + "sh:in ( :hall ) ; sh:minCount 1 ] .").partition(ads)) == [["b"]]
    assert names(partitioner(shape + "sh:in ( :kitchen ) ] .").partition(ads)) == [["a"]]


def test_a_role_that_sets_a_parameter_needs_a_component_that_declares_one_of_its_type() -> None:
    ads = read([ADVERTISEMENTS["control"], ":other a sc:Component, rob:NavigationControl ."])
    text = (
        ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:NavigationControl ;"
        ' sc:sets [ sc:parameterType rob:BehaviouralGoal ; sc:value "x" ] .'
    )
    assert names(partitioner(text).partition(ads)) == [["thinking-cap"]]


def test_a_free_parameter_is_what_each_candidate_allows_it_to_be() -> None:
    ads = read([ADVERTISEMENTS["drive"], ADVERTISEMENTS["pippi"], ":free a sc:Component, rob:MotorDrive ."])
    text = (
        ':t a sc:Template ; sc:roles ( :r ) ; sc:parameter :par . :par a sc:Parameter ; sc:name "par" .'
        " :r a sc:Role ; sh:class rob:MotorDrive ; sh:property [ sh:path rob:support ; sh:in ( :par ) ] ."
    )
    partition = partitioner(text).partition(ads)
    (variable,) = partition.variables
    assert variable.domain == (iri("Astrid"), iri("Pippi"))
    assert {c.profile.component.short: c.admits for c in partition.candidates[0]} == {
        "astrid-drive": (1,),
        "pippi-drive": (2,),
        "free": (ANY_VALUE,),
    }


def test_what_an_advertisement_says_about_another_component_counts_for_nothing() -> None:
    ads = read(
        [
            ":drive a sc:Component, rob:MotorDrive .",
            ":liar a sc:Component, :Liar ; :knows :drive . :drive rob:support :Astrid ; a :Approved .",
        ]
    )
    for shape in ("sh:class :Approved", "sh:property [ sh:path rob:support ; sh:minCount 1 ]"):
        for judged in ("", "; sh:closed false", '; sh:sparql [ sh:select "SELECT $this WHERE { FILTER (1 = 2) }" ]'):
            text = f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:MotorDrive ; {shape} {judged} ."
            assert names(partitioner(text).partition(ads)) == [[]]


def test_a_shape_that_nests_without_end_is_refused_in_a_sentence() -> None:
    shape = f"{'sh:not [ ' * 2000} sh:class :A {']' * 2000}"
    with pytest.raises(TemplateError, match="nests too deeply"):
        partitioner(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; {shape} .")


def test_a_shape_that_sees_others_is_shown_all_of_them() -> None:
    ads = read([":lamp a sc:Component, :Lamp ; :near :x .", ":map a sc:Component, :Map ; :knows :x . :x a :Place ."])
    for shape in ("[ sh:path :near ; sh:class :Place ]", "[ sh:path :near ; sh:class :Place ; sh:in ( :x :y ) ]"):
        assert names(
            partitioner(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:property {shape} .").partition(ads)
        ) == [["lamp", "map"]]
    text = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:property [ sh:path :near ; sh:class :Place ; "
    assert names(partitioner(f"{text} sh:minCount 1 ] .").partition(ads)) == [["lamp"]]


def test_a_hierarchy_counts_for_types_and_for_properties() -> None:
    ads = read([":a a sc:Component, :Lamp ; :hangsIn :hall ."])
    text = (
        ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Light ;"
        " sh:property [ sh:path rob:place ; sh:hasValue :hall ] "
    )
    above = Hierarchy(
        [(iri("Lamp"), iri("Light"))], [(iri("hangsIn"), IRI("https://w3id.org/selfconf/robotics#place"))]
    )
    for rest in (".", '; sh:sparql [ sh:select "SELECT $this WHERE { FILTER (1 = 2) }" ] .'):
        assert names(partitioner(text + rest).partition(ads)) == [[]]
        assert names(partitioner(text + rest, above).partition(ads)) == [["a"]]


def test_a_property_above_those_of_ports_settings_and_types_has_their_values() -> None:
    lamp = ":a a sc:Component, :Lamp ; sc:preference 5 ; sc:hasOutput [ sc:name 'o' ; sc:signalType rob:Text ] ."
    ads = read([lamp, ":b a sc:Component, :Lamp ; :rank 5 ; :port :x ; :kind :Lamp .", ":c a sc:Component, :Lamp ."])
    above = [(SC.hasOutput, iri("port")), (SC.preference, iri("rank")), (RDF.type, iri("kind"))]
    text = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ; sh:property [ sh:path "
    for asked, found in (
        (":port ; sh:minCount 1", ["a", "b"]),
        (":rank ; sh:minInclusive 3 ; sh:minCount 1", ["a", "b"]),
        (":kind ; sh:hasValue :Lamp", ["a", "b", "c"]),
    ):
        task = partitioner(f"{text}{asked} ] .")
        assert names(task.under(Hierarchy([], above)).partition(ads)) == [found]
        assert names(task.partition(ads)) == [["b"]]


def test_sparql_in_a_role_is_judged() -> None:
    ads = read([":a a sc:Component, :Lamp ; :watts 5 .", ":b a sc:Component, :Lamp ; :watts 50 ."])
    text = (
        ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ; sh:sparql [ sh:select "
        '"SELECT $this WHERE { $this <https://example.org/peis-home#watts> ?w FILTER (?w > 10) }" ] .'
    )
    assert names(partitioner(text).partition(ads)) == [["a"]]


@pytest.mark.parametrize("text", ['\\"x\\"', '\\"x\\"^^xsd:string'])
@pytest.mark.parametrize("pattern", ["{ $this rdfs:label TEXT }", "{ FILTER EXISTS { $this rdfs:label TEXT } }"])
def test_a_string_in_a_query_is_the_string_of_an_advertisement(text: str, pattern: str) -> None:
    ads = read([":a a sc:Component, :Lamp ; rdfs:label 'x' .", ":b a sc:Component, :Lamp ; rdfs:label 'y' ."])
    prefixes = "PREFIX rdfs: <http://www.w3.org/2000/01/rdf-schema#> PREFIX xsd: <http://www.w3.org/2001/XMLSchema#> "
    shape = f'sh:sparql [ sh:select "{prefixes}SELECT $this WHERE {pattern.replace("TEXT", text)}" ]'
    asked = partitioner(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ; {shape} .")
    assert names(asked.partition(ads)) == [["b"]]


OWN_COMPONENT = """
:AtMost a sh:ConstraintComponent ; sh:parameter [ sh:path :atMost ; sh:datatype xsd:integer ] ;
    sh:validator [ a sh:SPARQLAskValidator ; sh:ask "ASK { FILTER ($value <= $atMost) }" ] .
"""


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path :p ; :atMost 1 ]",
        "sh:node [ sh:property [ sh:path :p ; :atMost 1 ] ]",
        "sh:not [ sh:not [ sh:property [ sh:path :p ; :atMost 1 ] ] ]",
        "sh:property [ sh:path :p ; sh:qualifiedMinCount 1 ; sh:qualifiedValueShape [ :atMost 1 ] ]",
    ],
)
def test_a_constraint_component_that_the_template_brings_along_is_judged(shape: str) -> None:
    ads = read([":a a sc:Component, :Lamp ; :p 1 .", ":b a sc:Component, :Lamp ; :p 2 ."])
    role = f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ; {shape} ."
    assert names(partitioner(role + OWN_COMPONENT).partition(ads)) == [["a"]]


@pytest.mark.parametrize(("bound", "eligible"), [("1", ["a"]), ("2", ["a", "b"]), ("0", [])])
def test_a_parameter_of_such_a_component_is_replaced_by_its_value(bound: str, eligible: list[str]) -> None:
    ads = read([":a a sc:Component, :Lamp ; :p 1 .", ":b a sc:Component, :Lamp ; :p 2 ."])
    role = ":r a sc:Role ; sh:class :Lamp ; sh:property [ sh:path :p ; :atMost :k ] ."
    text = ':t a sc:Template ; sc:parameter :k ; sc:roles ( :r ) . :k a sc:Parameter ; sc:name "k" . ' + role
    assert names(partitioner(text + OWN_COMPONENT, bound=(("k", bound),)).partition(ads)) == [eligible]


@pytest.mark.parametrize("constraint", ['sh:pattern "("', "sh:minCount 1", "sh:property [ sh:minCount 1 ]"])
def test_a_shape_that_is_none_is_the_authors_error(constraint: str) -> None:
    ads = read([":a a sc:Component, :Lamp ."])
    with pytest.raises(TemplateError, match=r"template\.ttl"):
        partitioner(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Lamp ; {constraint} .").partition(
            ads
        )


# Two ways, one partition.

some_values = st.lists(st.sampled_from(VALUES), min_size=1, max_size=3, unique=True)


@st.composite
def value_constraints(draw: st.DrawFn, free: bool) -> str:
    """A constraint on the values of a property."""
    number = draw(st.integers(0, 3))
    value = draw(st.sampled_from((*VALUES, ":par"))) if free else draw(st.sampled_from(VALUES))
    members = " ".join([*draw(some_values), *([":par"] if free and draw(st.booleans()) else [])])
    return draw(
        st.sampled_from(
            [
                f"sh:in ( {members} )",
                f"sh:hasValue {value}",
                f"sh:minCount {number}",
                f"sh:maxCount {number}",
                "sh:datatype xsd:integer",
                "sh:datatype xsd:string",
                "sh:nodeKind sh:IRI",
                "sh:minInclusive 1",
                "sh:maxExclusive 2",
                "sh:minLength 2",
                'sh:pattern "^x"',
                "sh:class :Other",
                f"sh:not [ sh:hasValue {draw(st.sampled_from(VALUES))} ]",
                f"sh:or ( [ sh:nodeKind sh:IRI ] [ sh:in ( {members} ) ] )",
            ]
        )
    )


@st.composite
def roles(draw: st.DrawFn, free: bool = False) -> str:
    """The shape of a role, in Turtle."""
    parts = [f"sh:class {kind}" for kind in draw(st.lists(st.sampled_from(CLASSES), max_size=1))]
    for _ in range(draw(st.integers(0, 2))):
        path = draw(st.sampled_from(PATHS))
        constraints = draw(st.lists(value_constraints(free), min_size=1, max_size=2, unique_by=lambda c: c.split()[0]))
        shape = f"sh:property [ sh:path {path} ; {' ; '.join(constraints)} ]"
        kind = draw(st.integers(0, 9))
        if kind == 0 and not free:  # a value that a component forbids is none that a parameter can be found to be
            shape = f"sh:not [ {shape} ]"
        elif kind == 1:
            shape = f"sh:or ( [ {shape} ] [ sh:class {draw(st.sampled_from(CLASSES))} ] )"
        parts.append(shape)
    return " ; ".join(["a sc:Role", *parts])


@st.composite
def components(draw: st.DrawFn) -> list[str]:
    """Advertisements of a few components."""
    texts = []
    for number in range(draw(st.integers(1, 4))):
        kinds = draw(st.lists(st.sampled_from(CLASSES), min_size=1, max_size=2, unique=True))
        said = [
            f"{path} {value}"
            for path in PATHS
            for value in draw(st.lists(st.sampled_from(VALUES), max_size=2, unique=True))
        ]
        texts.append(f":c{number} a sc:Component, {', '.join(kinds)} {''.join(f' ; {s}' for s in said)} .")
    return texts


def conforming(texts: list[str], role: str, value: str = ":par") -> set[str]:
    """Who conforms to a role, judged by pySHACL alone, with the parameter replaced in the text."""
    # Not by rdflib's parser, which takes "01"^^xsd:integer for another spelling of 1: SHACL compares RDF terms.
    text = f"{PREFIXES} :r {role.replace(':par', value)} ; a sh:NodeShape ."
    shapes = rdflib_terms.to_rdflib(turtle.parse(text, "shape").triples())
    subjects = rdflib_terms.to_rdflib(turtle.parse(PREFIXES + "\n".join(texts), "ads").triples())
    found = set()
    for number in range(len(texts)):
        node = iri(f"c{number}")
        with only_ordered():  # pySHACL finds an order between true and 1
            conforms, _, _ = pyshacl.validate(
                subjects, shacl_graph=shapes, focus_nodes=[str(node)], use_shapes=[str(iri("r"))], inference="none"
            )
        if conforms:
            found.add(f"c{number}")
    return found


@settings(max_examples=examples(100), suppress_health_check=[HealthCheck.too_slow])
@given(components(), roles())
def test_a_compiled_role_takes_the_components_that_pyshacl_takes(texts: list[str], role: str) -> None:
    (eligible,) = names(partitioner(f":t a sc:Template ; sc:roles ( :r ) . :r {role} .").partition(read(texts)))
    assert set(eligible) == conforming(texts, role)


@settings(max_examples=examples(60), suppress_health_check=[HealthCheck.too_slow])
@given(components(), roles(free=True), st.sampled_from((*VALUES, ":somebody")))
def test_a_role_with_a_free_parameter_takes_the_components_that_pyshacl_takes_for_each_value(
    texts: list[str], role: str, value: str
) -> None:
    text = f':t a sc:Template ; sc:roles ( :r ) ; sc:parameter :par . :par a sc:Parameter ; sc:name "par" . :r {role} .'
    partition = partitioner(text).partition(read(texts))
    (term,) = turtle.parse(f"{PREFIXES} :s :p {value} .", "value").values(iri("s"), iri("p"))
    taken = set()
    for candidate in partition.candidates[0]:
        masks = dict(zip((v.parameter for v in partition.variables), candidate.admits, strict=True))
        domains = {v.parameter: v.domain for v in partition.variables}
        mask = masks.get(PARAMETER, ANY_VALUE)
        inside = PARAMETER in domains and term in domains[PARAMETER]
        if mask == ANY_VALUE or (inside and mask >> domains[PARAMETER].index(term) & 1):
            taken.add(candidate.profile.component.short)
    assert taken == conforming(texts, role, value)


@pytest.mark.parametrize(
    ("shape", "value", "eligible"),
    [
        ("sh:property [ sh:path :par ; sh:uniqueLang true ; sh:minCount 1 ]", ":p", True),
        ("sh:property [ sh:path :par ; sh:languageIn ( 'en' ) ]", ":p", False),
        ("sh:property [ sh:path ( :y :par ) ; sh:minCount 1 ]", ":w", True),
        ("sh:property [ sh:path ( :par :w ) ; sh:maxCount 0 ]", ":y", False),
        ("sh:property [ sh:path [ sh:alternativePath ( :z :par ) ] ; sh:minCount 1 ]", ":p", True),
        ("sh:property [ sh:path ( :y [ sh:inversePath :par ] ) ; sh:minCount 1 ]", ":y", True),
        ("sh:property [ sh:path [ sh:zeroOrOnePath :par ] ; sh:maxCount 1 ]", ":p", False),
    ],
)
def test_a_bound_parameter_stands_for_its_value_in_a_path(shape: str, value: str, eligible: bool) -> None:
    ads = [":c0 a sc:Component, :X ; :p 1 ; :y [ :w 1 ] ."]
    found = partitioner(f"{ONE_PARAMETER} :r a sc:Role ; {shape} .", bound=(("par", value),)).partition(read(ads))
    assert bool(*names(found)) == bool(conforming(ads, shape, value)) == eligible


@pytest.mark.parametrize(("value", "eligible"), [(":Labelled", False), (":Placed", True), (":Nested", False)])
def test_a_bound_parameter_stands_for_a_shape(value: str, eligible: bool) -> None:
    shapes = """
        :Labelled sh:property [ sh:path :p ; sh:languageIn ( 'en' ) ] .
        :Placed sh:property [ sh:path ( :y :w ) ; sh:minCount 1 ] .
        :Nested sh:property [ sh:path ( :y :w ) ; sh:minCount 2 ] .
    """
    ads = [":c0 a sc:Component, :X ; :p 1 ; :y [ :w 1 ] ."]
    text = f"{ONE_PARAMETER} {shapes} :r a sc:Role ; sh:node :par ."
    assert bool(*names(partitioner(text, bound=(("par", value),)).partition(read(ads)))) == eligible


@settings(max_examples=examples(40), suppress_health_check=[HealthCheck.too_slow])
@given(
    components(),
    roles(free=True),
    st.sampled_from(VALUES),
    st.sampled_from(VALUES),
    st.sampled_from(("1", "2")),
    st.sampled_from(
        (
            "",
            CLOSED,
            f"{CLOSED} ; sh:ignoredProperties ( {IGNORED} rdfs:label rob:support )",
            f"{CLOSED} ; sh:ignoredProperties ( {IGNORED} )",
        )
    ),
)
def test_free_parameters_of_their_own_may_stand_beside_what_pyshacl_judges(
    texts: list[str], role: str, value: str, other: str, most: str, closed: str
) -> None:
    judged = f"[ sh:path [ sh:zeroOrOnePath rdfs:label ] ; sh:maxCount {most} ]"
    rest = f"sh:property [ sh:path rob:place ; sh:in ( :other ) ] , {judged}{closed}"
    text = (
        ":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :par , :other . :par a sc:Parameter ; sc:name 'par' ."
        f" :other a sc:Parameter ; sc:name 'other' . :r {role} ; {rest} ."
    )
    partition = partitioner(text).partition(read(texts))
    document = turtle.parse(f"{PREFIXES} :s :p {value} ; :q {other} .", "value")
    bound = {PARAMETER: document.value(iri("s"), iri("p")), iri("other"): document.value(iri("s"), iri("q"))}
    taken = set()
    for candidate in partition.candidates[0]:
        masks = zip(candidate.admits, partition.variables, strict=True)
        admitted = (
            mask >> variable.domain.index(one) & 1
            if (one := bound[variable.parameter]) in variable.domain
            else mask < 0
            for mask, variable in masks
        )
        if all(admitted):
            taken.add(candidate.profile.component.short)
    assert taken == conforming(texts, f"{role} ; {rest.replace(':other', other)}", value)


@pytest.mark.parametrize(
    ("shape", "parameters"),
    [
        ("sh:property [ sh:path :on ; sh:in ( :p ) ] , [ sh:path :at ; sh:in ( :q ) ]", set()),
        ("sh:property [ sh:path :on ; sh:in ( :p ) ] , [ sh:path ( :at :near ) ; sh:in ( :q ) ]", {"q"}),
        ("sh:property [ sh:path :on ; sh:in ( :p ) ] , [ sh:path ( :at :near ) ; sh:in ( :p ) ]", {"p"}),
        ("sh:property [ sh:path :on ; sh:in ( :p ) ] ; sh:closed true", set()),
        ("sh:property [ sh:path :on ; sh:in ( :p ) ; sh:hasValue :q ] , [ sh:path ( :at :b ) ; sh:in ( :p ) ]", None),
        ("sh:property [ sh:path :on ; sh:in ( :p ) ] , [ sh:path :at ; sh:in ( :q ) ] ; sh:closed true", set()),
    ],
)
def test_a_parameter_is_tried_value_by_value_only_where_pyshacl_judges_it(
    shape: str, parameters: set[str] | None
) -> None:
    found = partitioner(
        ":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p , :q . :p a sc:Parameter ; sc:name 'p' ."
        " :q a sc:Parameter ; sc:name 'q' ."
        f" :r a sc:Role ; sh:property [ sh:path ( :a :b ) ; sh:minCount 1 ] ; {shape} ."
    )
    (role,) = found.roles
    assert not role.complete
    if parameters is None:
        with pytest.raises(TemplateError, match="mentions the free parameters p and q"):
            found.judge.mentioned(role)
    else:
        assert found.judge.mentioned(role) == next(map(iri, parameters), None)


@pytest.mark.parametrize("path", [":p", "[ sh:alternativePath ( :p :q ) ]"], ids=["compiled", "judged by pySHACL"])
def test_a_value_that_has_no_order_with_a_limit_does_not_pass_it(path: str) -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:property [ sh:path {path} ; sh:minInclusive 5 ] ."
    values = ('"2024-01-01"^^xsd:date', "true", '"10"^^:own', "10.5")
    ads = [f":c{number} a sc:Component, :Lamp ; :p {value} ." for number, value in enumerate(values)]
    assert names(partitioner(text).partition(read(ads))) == [["c3"]]


@pytest.mark.parametrize(
    ("shape", "addable"),
    [
        ("sh:property [ sh:path :on ; sh:hasValue :robot ]", True),
        ("sh:property [ sh:path :on ; sh:hasValue :robot ] ; sh:property [ sh:path :at ; sh:node :in-doors ]", True),
        ("sh:not [ sh:property [ sh:path :on ; sh:hasValue :robot ] ]", False),  # not on the robot of the others
        ("sh:property [ sh:path :on ; sh:node [ sh:in ( :robot ) ] ]", False),
    ],
)
def test_no_component_is_asked_for_where_pyshacl_alone_can_tell_which_value_it_has_to_state(
    shape: str, addable: bool
) -> None:
    text = f"""{PREFIXES} :t a sc:Template ; sc:roles ( :r ) ; sc:parameter :robot .
        :robot a sc:Parameter ; sc:name "robot" . :in-doors a sh:NodeShape ; sh:nodeKind sh:IRI .
        :r a sc:Role ; sh:class :A ; {shape} ."""
    task = templates.read_task(turtle.parse(text, "t.ttl"))
    assert (not Partitioner(task).partition({}).unaddable) is addable


def test_a_partition_tells_which_free_parameters_a_shape_mentions_whatever_components_state() -> None:
    text = """
        :t a sc:Template ; sc:roles ( :one :two ) ; sc:parameter :par , :other .
        :par a sc:Parameter ; sc:name "par" . :other a sc:Parameter ; sc:name "other" .
        :one a sc:Role ; sh:class :Other ; sh:property [ sh:path rob:place ; sh:in ( :other ) ] ;
            sh:property [ sh:path rob:support ; sh:in ( :par ) ] .
        :two a sc:Role ; sh:class :Other ; sh:property [ sh:path rob:support ; sh:hasValue :par ] .
    """
    ecology = read([":silent a sc:Component, :Other ."])
    free = partitioner(text).partition(ecology)
    assert [[mention.parameter for mention in role] for role in free.mentions] == [
        [iri("other"), iri("par")],
        [iri("par")],
    ]
    bound = partitioner(text, bound=(("par", ":Astrid"), ("other", ":here"))).partition(ecology)
    assert bound.mentions == ()
