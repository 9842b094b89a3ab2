"""Signals are checked against the fields of their kind: what is wrong is found and worded, and it costs little."""

from __future__ import annotations

import json
import math
import sys
import time
import timeit
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.literal_values import DATATYPES, WHOLE_NUMBERS
from selfconf.model.signal_fields import SignalField, SignalFields
from selfconf.model.term import IRI, XSD_NAMESPACE

SCAN = SignalFields(
    IRI("urn:signals#RangeScan"),
    (
        SignalField("ranges", IRI(XSD_NAMESPACE + "double"), repeated=True),
        SignalField("max_range", IRI(XSD_NAMESPACE + "double")),
        SignalField("count", IRI(XSD_NAMESPACE + "unsignedByte"), required=False),
        SignalField("frame", IRI(XSD_NAMESPACE + "string"), required=False),
    ),
)
GOOD: dict[str, Any] = {"ranges": [1.0, 2, 2.5], "max_range": 4}


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"ranges": []},
        {"ranges": (1.0, 2.0)},
        {"count": 255},
        {"count": 2.0},
        {"count": None},
        {"frame": "map"},
        {"further": [{"members": "are allowed"}]},
    ],
)
def test_a_value_with_all_its_fields_is_right(more: dict[str, Any]) -> None:
    assert SCAN.problem({**GOOD, **more}) is None


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (
            {"rng": [1.0], "max_range": 4},
            "lacks 'ranges' (a list of xsd:double), which RangeScan has; it has 'rng', 'max",
        ),
        ({**GOOD, "ranges": None}, "has None as 'ranges', which is a list of xsd:double"),
        ({**GOOD, "ranges": 3.0}, "has 3.0 as 'ranges', which is a list of xsd:double"),
        ({**GOOD, "ranges": "abc"}, "has 'abc' as 'ranges'"),
        ({**GOOD, "ranges": [1.0, "far"]}, "has 'far' at 1 in 'ranges'"),
        ({**GOOD, "ranges": [1.0, True]}, "has True at 1 in 'ranges'"),
        ({**GOOD, "ranges": [1.0, math.nan, 2.0]}, "has nan at 1 in 'ranges'"),
        ({**GOOD, "ranges": [1, math.nan]}, "has nan at 1 in 'ranges'"),
        ({**GOOD, "max_range": True}, "has True as 'max_range', which is xsd:double"),
        ({**GOOD, "max_range": math.nan}, "has nan as 'max_range', which is xsd:double"),
        ({**GOOD, "max_range": -math.inf}, "has -inf as 'max_range'"),
        ({**GOOD, "max_range": 10**400}, "has 1000000"),
        ({**GOOD, "ranges": [1.0, 10**400, 2.0]}, "at 1 in 'ranges'"),
        ({**GOOD, "count": 256}, "has 256 as 'count', which is xsd:unsignedByte"),
        ({**GOOD, "count": -1}, "has -1 as 'count'"),
        ({**GOOD, "count": 1.5}, "has 1.5 as 'count'"),
        ({**GOOD, "frame": 7}, "has 7 as 'frame', which is xsd:string"),
        ({}, "it has no members"),
        ([1.0], "is [1.0], where RangeScan is an object with 'ranges', 'max_range'"),
        (None, "is None"),
    ],
)
def test_what_is_wrong_with_a_value_is_said(value: object, words: str) -> None:
    assert words in (SCAN.problem(value) or "")


@pytest.mark.parametrize("repeated", [False, True])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 10**400])
def test_a_decimal_is_a_number_that_a_double_holds_too(value: float, repeated: bool) -> None:
    level = SignalFields(
        IRI("urn:signals#Level"), (SignalField("level", IRI(XSD_NAMESPACE + "decimal"), True, repeated),)
    )
    assert "xsd:decimal" in (level.problem({"level": [1.5, value] if repeated else value}) or "")
    assert level.problem({"level": [1.5, 2] if repeated else 2}) is None


def test_what_a_stranger_writes_does_not_make_a_problem_long() -> None:
    for value in ({"x" * 10_000 + str(n): 1 for n in range(1000)}, {**GOOD, "ranges": "y" * 10_000}, "z" * 10_000):
        assert len(SCAN.problem(value) or "") < 600


@pytest.mark.parametrize(
    ("fields", "right"),
    [
        (SCAN.fields, True),
        ((SignalField("pixels", IRI(XSD_NAMESPACE + "base64Binary")),), True),
        ((), True),
        ((SignalField("celsius", IRI(XSD_NAMESPACE + "double")),), False),
    ],
)
def test_bytes_are_a_signal_of_a_kind_that_holds_bytes_or_many_values(
    fields: tuple[SignalField, ...], right: bool
) -> None:
    problem = SignalFields(IRI("urn:signals#Kind"), fields).problem_of_bytes()
    assert problem == (None if right else "is bytes, where Kind is an object with 'celsius'")


@pytest.mark.parametrize(
    ("datatype", "right", "wrong"),
    [
        ("dateTime", "2026-02-28T23:59:59.5+14:00 -0044-03-15T12:00:00 2026-01-01T24:00:00Z", "2026-01-01 today 5"),
        ("dateTimeStamp", "2026-02-28T23:59:59Z", "2026-02-28T23:59:59"),
        ("date", "2026-12-31 12026-01-01Z", "2026-13-01 2026-1-1 01.02.2026"),
        ("time", "00:00:00 12:30:05.25-03:00", "12:30 25:00:00 24:00:01"),
        ("duration", "P1Y2M3DT4H5M6.7S -PT1S P1D PT5M", "P PT 1D P1S P1H P-1D"),
        ("dayTimeDuration", "P1DT1H PT0S", "P1M P1Y P"),
        ("yearMonthDuration", "P1Y P14M", "P1D P"),
        ("language", "en de-CH zh-Hant-TW", "en_GB englishlanguage -"),
    ],
)
def test_a_text_of_a_datatype_is_written_as_one(datatype: str, right: str, wrong: str) -> None:
    kind = IRI(XSD_NAMESPACE + datatype)
    fields = SignalFields(IRI("urn:s"), (SignalField("f", kind), SignalField("g", kind, repeated=True)))
    for text in right.split():
        assert fields.problem({"f": text, "g": [text]}) is None, text
    for text in (*wrong.split(), ""):
        assert fields.problem({"f": text, "g": []}) == f"has {text!r} as 'f', which is xsd:{datatype}"
        assert f"has {text!r} at 1 in 'g'" in str(
            fields.problem({"f": right.split()[0], "g": [right.split()[0], text]})
        )
    assert fields.problem({"f": 7, "g": []}) is not None


def test_a_datatype_that_json_cannot_tell_is_not_checked() -> None:
    fields = SignalFields(IRI("urn:S"), (SignalField("any", IRI("urn:datatype")),))
    for value in (1, "a", None, [1], {"b": 2}):
        assert (fields.problem({"any": value}) is None) == (value is not None)
    assert fields.problem({}) is not None


NAMES = (
    "boolean",
    "string",
    "dateTime",
    "base64Binary",
    "double",
    "float",
    "decimal",
    "integer",
    "byte",
    "unsignedInt",
)
FIELDS = st.lists(
    st.builds(
        SignalField,
        st.sampled_from("abcd"),
        st.sampled_from([IRI(XSD_NAMESPACE + name) for name in NAMES]),
        st.booleans(),
        st.booleans(),
    ),
    max_size=4,
    unique_by=lambda one: one.name,
)
SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(-300, 300), st.integers(), st.floats(allow_nan=False), st.text(max_size=3)
)
VALUES = st.dictionaries(st.sampled_from("abcde"), st.one_of(SCALARS, st.lists(SCALARS, max_size=3)), max_size=5)


def is_of(value: object, datatype: IRI) -> bool:
    """The same judgement of one value, spelt out."""
    if datatype == XSD_NAMESPACE + "boolean":
        return value is True or value is False
    if datatype not in DATATYPES:
        return isinstance(value, str)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    if datatype not in WHOLE_NUMBERS:
        return abs(value) <= sys.float_info.max
    least, greatest = WHOLE_NUMBERS[datatype]
    whole = math.isfinite(value) and value == math.floor(value)
    return whole and (least is None or value >= least) and (greatest is None or value <= greatest)


def conforms(value: dict[str, Any], one: SignalField) -> bool:
    """Whether a value has a field as it should."""
    found = value.get(one.name)
    if found is None:
        return not one.required
    if one.repeated:
        return isinstance(found, list) and all(is_of(item, one.datatype) for item in found)
    return is_of(found, one.datatype)


@given(FIELDS, VALUES)
def test_a_value_has_a_problem_if_and_only_if_a_field_of_it_is_wrong(
    fields: list[SignalField], value: dict[str, Any]
) -> None:
    problem = SignalFields(IRI("urn:S"), tuple(fields)).problem(value)
    wrong = [one.name for one in fields if not conforms(value, one)]
    assert (problem is None) == (not wrong)
    assert problem is None or repr(wrong[0]) in problem


@given(st.lists(st.one_of(st.floats(), st.sampled_from([sys.float_info.max, -sys.float_info.max])), max_size=6))
def test_doubles_are_right_where_each_is_finite_whatever_their_sum_is(values: list[float]) -> None:
    problem = SCAN.problem({"ranges": values, "max_range": 4.0})
    assert (problem is None) == all(map(math.isfinite, values))


@given(FIELDS, VALUES)
def test_what_is_right_stays_right_on_the_way(fields: list[SignalField], value: dict[str, Any]) -> None:
    checked = SignalFields(IRI("urn:S"), tuple(fields))
    try:
        travelled = json.loads(json.dumps(value, allow_nan=False))
    except ValueError:
        return
    assert (checked.problem(value) is None) == (checked.problem(travelled) is None)


@pytest.mark.parametrize(
    "value",
    [
        {"ranges": [], "max_range": 4.0},
        {"ranges": [1.0 + n / 100 for n in range(360)], "max_range": 4.0, "count": 7, "frame": "map"},
        {"ranges": [n / 7 for n in range(20_000)], "max_range": 4.0},
    ],
    ids=["small", "scan", "large"],
)
def test_to_check_a_signal_costs_less_than_to_write_it(value: dict[str, Any]) -> None:
    number = max(3, 20_000 // len(value["ranges"] or [1]))
    timed = partial(timeit.repeat, timer=time.thread_time, number=number, repeat=5)  # whatever else the machine does
    checked = min(timed(lambda: SCAN.problem(value)))
    written = min(timed(lambda: json.dumps(value, separators=(",", ":"))))
    assert checked < written
