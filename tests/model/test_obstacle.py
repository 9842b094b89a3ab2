"""Obstacles word themselves: after the name of a component, and as a clause of their own."""

from __future__ import annotations

from typing import get_args

import pytest

from selfconf.model.obstacle import (
    Excluded,
    NoAlternative,
    NoCommonValue,
    NotFedItself,
    NotJudged,
    Obstacle,
    ParameterForbids,
    ParameterUndeclared,
    PropertyUnmet,
    ShapeViolated,
    TypeRelation,
    UnfitOutput,
    UnlikePorts,
    WrongComponent,
    WrongType,
)
from selfconf.model.profile import Operation
from selfconf.model.property_fault import (
    Ambiguous,
    ConstraintFailed,
    Fault,
    Missing,
    NotAmong,
    WrongCount,
    WrongShareOfValues,
)
from selfconf.model.signal_likeness import Degree, SignalMatch
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal
from selfconf.rdf.vocabulary import UNIT

SH = "http://www.w3.org/ns/shacl#"
CAMERA, SENSOR, PLACE, HALL, CELLAR = (
    IRI(f"https://example.org/home#{name}") for name in ("Camera", "Sensor", "place", "hall", "cellar")
)
FIVE = Literal("5", IRI(XSD_NAMESPACE + "integer"))


def unmet(*faults: Fault) -> PropertyUnmet:
    """Something that is wrong with the place."""
    return PropertyUnmet(PLACE, faults)


def failed(constraint: str, wanted: IRI | Literal = FIVE) -> ConstraintFailed:
    """The hall fails a constraint."""
    return ConstraintFailed(frozenset((HALL,)), IRI(SH + constraint), wanted)


WORDED: list[tuple[Obstacle, str, str]] = [
    (WrongType(CAMERA), "is no Camera", "it is no Camera"),
    (WrongComponent(frozenset((HALL,))), "is not hall", "it is not hall"),
    (unmet(Missing()), "has no place", "it has no place"),
    (unmet(WrongCount(3, True)), "has 3 of place, too many", "it has 3 of place, too many"),
    (unmet(WrongCount(1, False)), "has 1 of place, too few", "it has 1 of place, too few"),
    (
        unmet(NotAmong(frozenset((HALL,)), frozenset((CELLAR,)))),
        "place is hall, not cellar",
        "its place is hall, not cellar",
    ),
    (unmet(failed("minInclusive")), "place is hall, not at least 5", "its place is hall, not at least 5"),
    (
        unmet(failed("minInclusive", Literal("5"))),
        'place is hall, not at least "5"',
        'its place is hall, not at least "5"',
    ),
    (
        unmet(ConstraintFailed(frozenset((FIVE,)), IRI(SH + "datatype"), IRI(XSD_NAMESPACE + "double"))),
        "place is 5, an integer, not a double",
        "its place is 5, an integer, not a double",
    ),
    (
        unmet(
            ConstraintFailed(frozenset((FIVE, Literal("x", FIVE.datatype))), IRI(SH + "datatype"), FIVE.datatype),
        ),
        'place is "x"^^integer or 5, not an integer',
        'its place is "x"^^integer or 5, not an integer',
    ),
    (
        unmet(Ambiguous(IRI("urn:room"))),
        "place has several values, so that no one room fits",
        "its place has several values, so that no one room fits",
    ),
    (ParameterUndeclared(SENSOR), "declares no parameter of type Sensor", "it declares no parameter of type Sensor"),
    (
        NoAlternative((WrongType(CAMERA), unmet(Missing()))),
        "is no Camera and has no place",
        "it is no Camera and it has no place",
    ),
    (Excluded(), "is what it must not be", "it is what it must not be"),
    (
        Excluded(classes=(CAMERA, SENSOR)),
        "is what it must not be: a Camera and a Sensor",
        "it is what it must not be: a Camera and a Sensor",
    ),
    (
        Excluded(several=True, classes=(CAMERA,), paths=(PLACE,)),
        "is several things of which it must be one: a Camera, by its place",
        "it is several things of which it must be one: a Camera, by its place",
    ),
    (
        PropertyUnmet(PLACE, (Missing(),), "Ask\nAnna"),
        "has no place (Ask\\nAnna)",
        "it has no place (Ask\\nAnna)",
    ),
    (
        Excluded(several=True),
        "is several things of which it must be one",
        "it is several things of which it must be one",
    ),
    (ShapeViolated("too hot"), "violates: too hot", "it violates: too hot"),
    (
        NoCommonValue(),
        "leaves no value for a free parameter that its statements agree on",
        "it leaves no value for a free parameter that its statements agree on",
    ),
    (
        ParameterForbids(IRI("urn:room"), frozenset((Literal("hall"),))),
        'wants room to be "hall", which it may not be',
        'it wants room to be "hall", which it may not be',
    ),
    (
        UnlikePorts(
            (
                SignalMatch(IRI("urn:Pose"), IRI("urn:Pose"), Degree.EXACT, 1.0),
                SignalMatch(IRI("urn:Scan"), IRI("urn:Sonar"), Degree.SUBSUMES, 0.6),
            ),
            (SignalMatch(IRI("urn:Map"), None, Degree.FAIL, 0.0),),
        ),
        "issues Sonar, which lies above Scan and needs Map, which it would not be given",
        "it issues Sonar, which lies above Scan and needs Map, which it would not be given",
    ),
    (UnlikePorts(), "has other ports", "it has other ports"),
    (
        UnlikePorts(
            (SignalMatch(Operation.of(IRI("urn:Map")), Operation.of(IRI("urn:Plan")), Degree.SUBSUMES, 0.6),),
            unfit=(UnfitOutput("draw()", requests=(IRI("urn:Room"), None)),),
        ),
        (
            "offers operation -> Plan, which lies above operation -> Map "
            "and offers what takes Room and would be sent nothing (operation 'draw')"
        ),
        (
            "it offers operation -> Plan, which lies above operation -> Map "
            "and offers what takes Room and would be sent nothing (operation 'draw')"
        ),
    ),
    (
        UnlikePorts(given=(SignalMatch(IRI("urn:Map"), IRI("urn:Plan"), Degree.OVERLAP, 0.4),)),
        "needs Map and would be given Plan, which is akin to it",
        "it needs Map and would be given Plan, which is akin to it",
    ),
    (
        NotFedItself("raw", (IRI("urn:Echo"), IRI("urn:Ping"))),
        "is not fed itself: no component that can be recruited issues an Echo or Ping for its input 'raw'",
        "it is not fed itself: no component that can be recruited issues an Echo or Ping for its input 'raw'",
    ),
    (
        NotFedItself("raw", (IRI("urn:Echo"),), (IRI("urn:b"), IRI("urn:a")), True),
        "is fed only in a circle: its input 'raw' by b by a",
        "it is fed only in a circle: its input 'raw' by b by a",
    ),
    (
        NotFedItself("raw", (IRI("urn:Echo"),), (IRI("urn:b"),)),
        "is not fed itself: b, which issues an Echo for its input 'raw', is not fed either",
        "it is not fed itself: b, which issues an Echo for its input 'raw', is not fed either",
    ),
    (
        unmet(WrongShareOfValues(1, 2, False), WrongShareOfValues(3, 1, True)),
        "has 1 of place that are as asked for, not at least 2; has 3 of place that are as asked for, not at most 1",
        (
            "it has 1 of place that are as asked for, not at least 2; "
            "it has 3 of place that are as asked for, not at most 1"
        ),
    ),
    (NotJudged("too much"), "is not judged: too much", "it is not judged: too much"),
    *(
        (UnfitOutput("d", units, frames, wrong), f"{said} (output 'd')", f"it {said} (output 'd')")
        for units, frames, wrong, said in (
            (
                (UNIT.MilliM, UNIT.M),
                None,
                None,
                "issues what is in MilliM, not in M, a unit of the same dimension",
            ),
            (
                (UNIT.Zorkmid, UNIT.M),
                (Literal("map"), Literal("odom")),
                None,
                'issues what is in Zorkmid, not in M and is in the frame "map", not in "odom"',
            ),
            (
                (UNIT.KiloGM, UNIT.M),
                None,
                unmet(Missing()),
                "issues what is in KiloGM, not in M, a unit of another dimension and is not accepted: it has no place",
            ),
        )
    ),
]


def test_every_obstacle_and_fault_is_worded() -> None:
    assert {type(obstacle) for obstacle, _, _ in WORDED} == set(get_args(Obstacle))
    faults = {
        type(fault) for obstacle, _, _ in WORDED if isinstance(obstacle, PropertyUnmet) for fault in obstacle.faults
    }
    assert faults == set(get_args(Fault))


@pytest.mark.parametrize(
    ("obstacle", "said", "clause"), WORDED, ids=lambda value: value if isinstance(value, str) else ""
)
def test_an_obstacle_is_a_predicate_and_a_clause(obstacle: Obstacle, said: str, clause: str) -> None:
    assert (str(obstacle), obstacle.clause) == (said, clause)


def test_codes_are_stable_and_different() -> None:
    assert sorted(kind.code for kind in get_args(Obstacle)) == [
        "excluded",
        "no-alternative",
        "no-common-value",
        "not-fed-itself",
        "not-judged",
        "parameter-forbids",
        "parameter-undeclared",
        "property-unmet",
        "shape-violated",
        "unfit-output",
        "unlike-ports",
        "wrong-component",
        "wrong-type",
    ]


@pytest.mark.parametrize(
    ("offered", "relation", "words"),
    [
        (SENSOR, TypeRelation.SIMILAR, "but a Sensor (is one of them misspelt?)"),
        (SENSOR, TypeRelation.BELOW, "but a Sensor, which lies below it (see reasoning='subclass')"),
        (SENSOR, TypeRelation.ABOVE, "but a Sensor, which lies above it"),
    ],
)
def test_a_type_that_is_related_is_named(offered: IRI, relation: TypeRelation, words: str) -> None:
    assert str(WrongType(CAMERA, offered, relation)) == f"is no Camera {words}"


def test_types_of_one_name_are_told_apart_by_their_namespaces() -> None:
    offered = IRI("urn:other#Camera")
    assert str(WrongType(CAMERA, offered, TypeRelation.SIMILAR)) == (
        f"is no {CAMERA!r} but a <urn:other#Camera> (is one of them misspelt?)"
    )


def test_several_faults_of_a_property_are_one_obstacle() -> None:
    several = unmet(Missing(), failed("maxInclusive"))
    assert str(several) == "has no place; place is hall, not at most 5"
    assert several.clause == "it has no place; its place is hall, not at most 5"
    limits = unmet(failed("minInclusive"), failed("maxInclusive"))
    assert limits.clause == "its place is hall, not at least 5; its place is hall, not at most 5"


def test_alternatives_that_lack_the_same_say_it_once() -> None:
    assert str(NoAlternative((WrongType(CAMERA), WrongType(CAMERA)))) == "is no Camera"
