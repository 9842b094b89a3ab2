"""An output that is to conform to a shape is not supposed to have the unit or the frame that another input asks for."""

from __future__ import annotations

from selfconf.model.profile import Condition, Output
from selfconf.model.term import IRI
from selfconf.search.relaxations.supposed_outputs import supposed

SIGNAL, METRE = IRI("urn:t:S"), IRI("urn:t:M")
SHAPED = Output("o", (SIGNAL,), conforms=frozenset(("shape",)))


def test_what_is_to_conform_to_a_shape_meets_that_and_no_other_condition() -> None:
    (output,) = supposed([SHAPED])
    assert Condition(accepts="shape").met_by(output)
    assert not Condition(unit=METRE).met_by(output)
    assert not Condition(frame=METRE).met_by(output)
    assert not Condition(unit=METRE, accepts="shape").met_by(output)


def test_a_unit_that_it_is_to_state_is_supposed() -> None:
    (output,) = supposed([SHAPED._replace(unit=METRE)])
    assert Condition(unit=METRE).met_by(output)
    assert not Condition(frame=METRE).met_by(output)


def test_what_is_to_conform_to_nothing_is_supposed_as_it_is_worded() -> None:
    plain = Output("o", (SIGNAL,))
    assert supposed([plain]) == (plain,)
