"""The shapes: each constraint has a sentence, a code, and a bad file that breaks it; what the manual shows conforms."""

from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import RDF, SH, Graph, Namespace, URIRef
from rdflib.term import Node

from selfconf import library
from selfconf.model.codes import BY_CODE
from selfconf.model.diagnostic import Severity
from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.read_shapes import ReadShapes
from selfconf.rdf.validation.shape_violations import reported_violations
from selfconf.rdf.validation.well_formedness import shape_of_shapes
from tests.bad_files import BAD, promised_codes
from tests.shipped import shipped_shapes

SHAPES = Namespace("https://w3id.org/selfconf/shapes#")
ALL, READ = shipped_shapes().all, shipped_shapes().read

COMPONENTS = {
    SH.minCount: SH.MinCountConstraintComponent,
    SH.maxCount: SH.MaxCountConstraintComponent,
    SH.datatype: SH.DatatypeConstraintComponent,
    SH["class"]: SH.ClassConstraintComponent,
    SH.nodeKind: SH.NodeKindConstraintComponent,
    SH.minLength: SH.MinLengthConstraintComponent,
    SH.maxLength: SH.MaxLengthConstraintComponent,
    SH.pattern: SH.PatternConstraintComponent,
    SH.minInclusive: SH.MinInclusiveConstraintComponent,
    SH.minExclusive: SH.MinExclusiveConstraintComponent,
    SH.maxExclusive: SH.MaxExclusiveConstraintComponent,
    SH.lessThanOrEquals: SH.LessThanOrEqualsConstraintComponent,
    SH["in"]: SH.InConstraintComponent,
    SH["not"]: SH.NotConstraintComponent,
    SH["or"]: SH.OrConstraintComponent,
    SH.maxInclusive: SH.MaxInclusiveConstraintComponent,
    SH.node: SH.NodeConstraintComponent,
    SH.sparql: SH.SPARQLConstraintComponent,
}
STRUCTURE = {SH.property, SH.path, SH.message, SH.severity, SH.declare, SH.targetClass, SH.targetSubjectsOf,
             SH.targetObjectsOf, RDF.type, SHAPES.code}  # fmt: skip


def constraints() -> set[tuple[Node, Node]]:
    """Every constraint of every shape with a name, as shape and constraint component."""
    found: set[tuple[Node, Node]] = set()
    for shape in ALL.subjects(SH.message):
        for predicate in set(ALL.predicates(shape)):
            if predicate not in STRUCTURE:
                found.add((shape, COMPONENTS[predicate]))
    return found


def broken(path: Path) -> set[tuple[Node, Node]]:
    """The constraints that a file breaks."""
    graph = Graph()
    try:
        graph.parse(path)
    except SyntaxError:
        return set()
    return {
        (found.shape, found.constraint) for found in reported_violations(graph, READ) if found.constraint is not None
    }


@pytest.mark.slow
def test_every_constraint_is_broken_by_a_bad_file() -> None:
    missing = constraints()
    for path in BAD:
        if promised_codes(path) & {str(ALL.value(shape, SHAPES.code)) for shape, _ in missing}:
            missing -= broken(path)
    assert not {(shape.removeprefix(SHAPES), component.removeprefix(str(SH))) for shape, component in missing}


def test_every_constraint_belongs_to_a_named_shape_with_one_sentence() -> None:
    parts = set(ALL.objects(None, SH.node))  # whose sentence is that of the shape which refers to them
    for shape in {*ALL.subjects(RDF.type, SH.NodeShape), *ALL.subjects(RDF.type, SH.PropertyShape)} - parts:
        assert isinstance(shape, URIRef)
        assert shape.startswith(SHAPES)
        if any(predicate in COMPONENTS for predicate in ALL.predicates(shape)):
            (message,) = ALL.objects(shape, SH.message)
            assert str(message).endswith(".")


def test_every_shape_with_a_sentence_states_one_code_of_the_catalogue() -> None:
    assert set(ALL.subjects(SH.message)) == set(ALL.subjects(SHAPES.code))
    for shape in ALL.subjects(SHAPES.code):
        (code,) = ALL.objects(shape, SHAPES.code)
        assert str(code) in BY_CODE


def test_a_shape_is_as_severe_as_its_code() -> None:
    for shape, code in ALL.subject_objects(SHAPES.code):
        warns = ALL.value(shape, SH.severity) == SH.Warning
        assert BY_CODE[str(code)].severity is (Severity.WARNING if warns else Severity.ERROR), shape


@pytest.mark.slow
def test_the_shapes_are_well_formed() -> None:
    assert not list(reported_violations(ALL, ReadShapes(shape_of_shapes())))


@pytest.mark.parametrize("path", library.shapes(), ids=lambda path: path.stem)
def test_each_file_of_shapes_can_be_used_alone(path: Path) -> None:
    alone = Graph().parse(path)
    for query in alone.objects(None, SH.prefixes):
        assert list(alone.objects(query, SH.declare))
    for shape in alone.objects(None, SH.property):
        assert (shape, SH.path, None) in alone


ADVERTISEMENTS = """\
@prefix sc:  <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix :    <https://example.org/peis-home#> .

:astrid-drive a sc:Component, rob:MotorDrive ;
    sc:hasInput [ sc:name "velocity" ; sc:signalType rob:Velocity2D ] ;
    rob:support :Astrid .

:thinking-cap a sc:Component, rob:NavigationControl ;
    sc:hasInput  [ sc:name "sonar" ;    sc:signalType rob:RangeScan ] ,
                 [ sc:name "position" ; sc:signalType rob:PlanarPose2D ] ,
                 [ sc:name "localize" ; sc:signalType rob:Odometry2D ] ;
    sc:hasOutput [ sc:name "set.velocity" ; sc:signalType rob:Velocity2D ] ;
    sc:hasParameter [ sc:name "goal" ; sc:parameterType rob:BehaviouralGoal ] .

:person-tracker a sc:Component, rob:PositionSensor ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] ;
    rob:place :living-room ;
    sc:preference 10 .                          # tried before absolute odometry, which has none (that is 0)

:bare a sc:Component, <https://example.org/unheard-of#Thing> .
"""
TEMPLATE = """\
@prefix sc:  <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix sh:  <http://www.w3.org/ns/shacl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix :    <https://example.org/peis-home#> .

:navigate a sc:Template ;
    rdfs:label "Drive a robot to a place"@en ;
    sc:parameter :robot, :goal ;
    sc:roles ( :sonar :encoder :position :control :drive ) .

:robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .
:goal  a sc:Parameter ; sc:name "goal"  ; sh:datatype xsd:string .

:sonar a sc:Role ; sh:class rob:SonarArray ; sc:feeds :control ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
:encoder a sc:Role ; sh:class rob:Encoder ; sc:feeds :control ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
:position a sc:Role ; sh:class rob:PositionSensor ; sc:feeds :control ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
:control a sc:Role ; sh:class rob:NavigationControl ; sc:feeds :drive ;
    sc:sets [ sc:parameterType rob:BehaviouralGoal ; sc:value :goal ] .
:drive a sc:Role ; sh:class rob:MotorDrive ;
    sh:property [ sh:path rob:support ; sh:in ( :robot ) ] .
"""


@pytest.mark.parametrize("text", [ADVERTISEMENTS, TEMPLATE, *(path.read_text() for path in library.ontologies())])
def test_what_is_right_conforms(text: str) -> None:
    assert not list(reported_violations(Graph().parse(data=text, format="turtle"), READ))


@pytest.mark.parametrize(("text", "conforms"), [("1", True), ("0", True), ("TRUE", False)])
@pytest.mark.parametrize(
    "said",
    [
        "@prefix : <#> . :r a sc:Role ; sc:recruits VALUE .",
        '[] rob:field ( [ rob:fieldName "on" ; rob:datatype xsd:boolean ; rob:optional VALUE ] ) .',
        '[] rob:field ( [ rob:fieldName "on" ; rob:datatype xsd:boolean ; rob:repeated VALUE ] ) .',
    ],
)
def test_a_truth_value_conforms_however_it_is_written(said: str, text: str, conforms: bool) -> None:
    prefixes = TEMPLATE[: TEMPLATE.index("@prefix : ")]
    data, _ = parse_with_positions(prefixes + said.replace("VALUE", f'"{text}"^^xsd:boolean'), "")
    broken = {violation.shape.removeprefix(SHAPES) for violation in reported_violations(data, READ)}
    assert conforms == broken.isdisjoint({"Recruits", "FieldOptional", "FieldRepeated"})
