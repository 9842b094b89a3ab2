"""Which outputs that do not exist yet could conform to the shape of an input."""

from __future__ import annotations

import pytest

from selfconf.model.hierarchy import NOTHING_ABOVE
from selfconf.model.profile import Output
from selfconf.model.term import IRI
from selfconf.rdf.eligibility.output_shapes import OutputShape

PROPERTY = "[ <http://www.w3.org/ns/shacl#property> [ %s ] ]"
UNIT = IRI("urn:x:metre")


def possible(said: str, named: bool = False, unit: IRI | None = None) -> bool:
    """Whether an output of the type urn:x:S, called `out`, could conform to what is said of one property."""
    words = {"path": "path", "has": "hasValue", "in": "in", "most": "maxCount", "pattern": "pattern"}
    for word, local in words.items():
        said = said.replace(f"sh:{word} ", f"<http://www.w3.org/ns/shacl#{local}> ")
    said = said.replace("sc:", "https://w3id.org/selfconf#")
    shape = OutputShape(PROPERTY % said, NOTHING_ABOVE)
    return shape.possible_for(Output("out", (IRI("urn:x:S"),), unit=unit), named)


SIGNAL, NAME, OF_UNIT = (f"sh:path <sc:{one}>" for one in ("signalType", "name", "unit"))


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        (f"{SIGNAL} ; sh:has <urn:x:S>", True),
        (f"{SIGNAL} ; sh:has <urn:x:T>", True),  # it may issue both
        (f"{SIGNAL} ; sh:has <urn:x:T> ; sh:most 1", False),
        (f"{SIGNAL} ; sh:in ( <urn:x:T> )", False),
        (f"{SIGNAL} ; sh:pattern 'T$'", False),
    ],
)
def test_what_is_issued_is_known(said: str, expected: bool) -> None:
    assert possible(said) is expected


@pytest.mark.parametrize(
    ("said", "named", "expected"),
    [
        (f"{NAME} ; sh:has 'other'", False, True),
        (f"{NAME} ; sh:has 'other'", True, False),
        (f"{NAME} ; sh:has 'out'", True, True),
        (f"{NAME} ; sh:pattern '^o'", True, True),
        (f"{NAME} ; sh:pattern '^x'", True, False),
        (f"{NAME} ; sh:pattern '^x'", False, True),
    ],
)
def test_a_name_is_known_where_an_interaction_asks_for_it(said: str, named: bool, expected: bool) -> None:
    assert possible(said, named) is expected


@pytest.mark.parametrize(
    ("said", "unit", "expected"),
    [
        (f"{OF_UNIT} ; sh:has <urn:x:foot>", None, True),
        (f"{OF_UNIT} ; sh:has <urn:x:foot>", UNIT, False),
        (f"{OF_UNIT} ; sh:in ( <urn:x:foot> <urn:x:metre> )", UNIT, True),
        (f"{OF_UNIT} ; sh:most 0", UNIT, False),
        (f"{OF_UNIT} ; sh:most 0", None, True),
    ],
)
def test_a_unit_is_known_where_the_input_asks_for_one(said: str, unit: IRI | None, expected: bool) -> None:
    assert possible(said, unit=unit) is expected


def test_what_takes_too_long_to_find_out_could_not_conform() -> None:
    shape = f"{OF_UNIT} ; sh:pattern '^urn:(?=([a-z:]+)+$)'"
    assert possible(shape, unit=UNIT)
    assert not possible(shape, unit=IRI(f"urn:{'a' * 60}!"))


def test_of_what_is_not_known_it_states_what_is_asked_for() -> None:
    assert possible("sh:path <urn:x:latency> ; sh:has 3")
    assert possible("sh:path <urn:x:latency> ; sh:most 0")
