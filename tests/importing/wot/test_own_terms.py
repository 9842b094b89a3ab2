"""What things say in the terms of selfconf itself."""

from __future__ import annotations

from typing import Any

from selfconf.importing.imported import ImportedOperation, ImportedPort, NestedNode
from selfconf.importing.wot.contexts import TermMeanings
from selfconf.importing.wot.own_terms import OwnTerms, stated_rate
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import ROB, SC, UNIT, XSD

MEANINGS = TermMeanings({"sc": SC.base, "rob": ROB.base, "unit": UNIT.base})
POSE: dict[str, Any] = {"@id": "rob:PlanarPose2D"}


def test_inputs_operations_and_parameters_are_read() -> None:
    own = OwnTerms(
        {
            "sc:hasInput": {
                "sc:name": "pose",
                "sc:signalType": [POSE],
                "sc:unit": {"@id": "unit:M"},
                "sc:optional": True,
            },
            f"{SC.needsOperation}": [{"sc:name": "lamp", "sc:request": POSE, "sc:optional": True}],
            "sc:hasOperation": [{"sc:name": "photo", "sc:response": POSE}],
            "sc:hasParameter": [{"sc:name": "goal", "sc:parameterType": {"@id": "rob:BehaviouralGoal"}}],
        },
        MEANINGS,
    )
    assert list(own.inputs()) == [ImportedPort("pose", (ROB.PlanarPose2D,), UNIT.M, optional=True)]
    assert list(own.operations(SC.needsOperation)) == [ImportedOperation("lamp", ROB.PlanarPose2D, optional=True)]
    assert list(own.operations(SC.hasOperation)) == [ImportedOperation("photo", None, ROB.PlanarPose2D)]
    assert list(own.parameters()) == [("goal", ROB.BehaviouralGoal)]
    assert own.unread == 0


def test_what_has_no_name_of_its_own_or_says_more_is_counted() -> None:
    nodes = [{"sc:name": "a"}, {"sc:name": "a"}, {"sc:name": "b()"}, {}, 5, {"sc:name": "c", "sc:depth": 3}]
    own = OwnTerms({"sc:hasInput": nodes, "sc:hasParameter": {"sc:name": "goal"}}, MEANINGS)
    assert [port.name for port in own.inputs({"d"})] == ["a", "c"]
    assert own.unread == 5
    assert list(own.parameters()) == []
    assert own.unread == 6
    assert [port.name for port in own.inputs({"a"})] == ["c"]


def test_a_rate_is_a_number_with_its_unit() -> None:
    rate = NestedNode(((SC.value, (Literal("12.5", XSD.double),)), (SC.unit, (IRI(UNIT.HZ),))))
    said = {"sc:rate": {"sc:value": 12.5, "sc:unit": {"@id": "unit:HZ"}}}
    assert stated_rate(said, MEANINGS) == ((SC.rate, rate),)
    for nothing in ({}, {"sc:rate": 5}, {"sc:rate": {"sc:value": 5}}, {"sc:rate": []}):
        assert stated_rate(nothing, MEANINGS) == ()
    for value, unit in ((0, "HZ"), (-1, "HZ"), ("5", "HZ"), (5, "SEC")):  # no advertisement could hold these
        assert stated_rate({"sc:rate": {"sc:value": value, "sc:unit": {"@id": f"unit:{unit}"}}}, MEANINGS) == ()
