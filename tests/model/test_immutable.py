"""A class that is made immutable behaves as a frozen data class with slots does."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
import re
from collections.abc import Mapping
from dataclasses import FrozenInstanceError, asdict, dataclass, field, fields
from pathlib import Path

import pytest

import selfconf
from selfconf.model.configuration import Connection
from selfconf.model.diagnostic import Report
from selfconf.model.immutable import FIRST_VALUES, FrozenMapping, immutable, recast, replace
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI


@immutable
class Lamp:
    """A lamp, which is like another whatever its note."""

    name: str
    watts: float = 5.0
    tags: list[str] = field(default_factory=list, hash=False)
    note: str = field(default="", kw_only=True, compare=False, repr=False)


@immutable
class Spot(Lamp):
    """A lamp with an angle; its angle is positive."""

    angle: float = 30.0

    def __post_init__(self) -> None:
        if self.angle <= 0:
            raise ValueError("an angle is positive")

    def __repr__(self) -> str:
        return f"a spot of {self.angle:g} degrees"


@dataclass(frozen=True, slots=True)
class Usual:
    """What the standard library makes of the fields of `Lamp`."""

    name: str
    watts: float = 5.0
    tags: list[str] = field(default_factory=list, hash=False)
    note: str = field(default="", kw_only=True, compare=False, repr=False)


@immutable
class Nothing:
    """A value without fields."""


def lamp_class() -> type:
    """A class like `Lamp` that has had no value yet."""
    return immutable(type("Fresh", (Lamp,), {}))


ARGUMENTS: list[tuple[tuple[object, ...], Mapping[str, object]]] = [
    (("a",), {}),
    (("a", 7.0), {}),
    (("a", 5.0, ["x"]), {}),
    (("a",), {"note": "n", "watts": 7.0}),
    (("b",), {}),
]


def test_a_value_is_recast_with_the_fields_of_what_both_are() -> None:
    spot = recast(Lamp("a", 7.0, note="n"), Spot, Lamp, angle=1.0)
    assert (spot, spot.note) == (Spot("a", 7.0, angle=1.0), "n")
    assert type(recast(spot, Lamp, Lamp)) is Lamp


def test_values_compare_hash_and_print_as_those_of_the_standard_library() -> None:
    ours = [Lamp(*given, **named) for given, named in ARGUMENTS]  # type: ignore[arg-type]
    theirs = [Usual(*given, **named) for given, named in ARGUMENTS]  # type: ignore[arg-type]
    for one, usual in zip(ours, theirs, strict=True):
        assert repr(one) == repr(usual).replace("Usual", "Lamp")
        assert hash(one) == hash(usual)
        assert asdict(one) == asdict(usual)
        assert [one == other for other in ours] == [usual == other for other in theirs]
    assert ours[0] != theirs[0]
    assert Lamp.__match_args__ == Usual.__match_args__


@pytest.mark.parametrize(
    ("given", "named"),
    [((), {}), (("a", 1.0, [], "n"), {}), (("a",), {"name": "b"}), (("a",), {"colour": "red"})],
)
@pytest.mark.parametrize("times", [1, FIRST_VALUES + 1])
def test_what_the_standard_library_refuses_is_refused(
    given: tuple[object, ...], named: Mapping[str, object], times: int
) -> None:
    fresh = lamp_class()
    for _ in range(times - 1):
        fresh("a")
    said = []
    for kind in (Usual, fresh):
        with pytest.raises(TypeError) as refused:
            kind(*given, **named)
        said.append(str(refused.value).rpartition(".")[2])
    assert said[0] == said[1]


@pytest.mark.parametrize(("given", "named"), ARGUMENTS)
def test_the_first_values_of_a_class_are_made_as_those_after_them(
    given: tuple[object, ...], named: Mapping[str, object]
) -> None:
    fresh = lamp_class()
    made = [fresh(*given, **named) for _ in range(2 * FIRST_VALUES)]
    assert len({repr(one) for one in made}) == 1
    assert [asdict(one) for one in made] == [asdict(Usual(*given, **named))] * len(made)  # type: ignore[arg-type]


def test_an_init_can_be_looked_at_before_there_is_a_value() -> None:
    assert list(inspect.signature(lamp_class()).parameters) == ["name", "watts", "tags", "note"]


def test_nothing_is_assigned_or_deleted() -> None:
    lamp = Lamp("a")
    with pytest.raises(FrozenInstanceError, match="watts"):
        lamp.watts = 6.0  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError, match="colour"):
        lamp.colour = "red"  # type: ignore[attr-defined]
    with pytest.raises(FrozenInstanceError, match="name"):
        del lamp.name
    assert not hasattr(lamp, "__dict__")


def test_a_default_is_made_anew_for_each_value() -> None:
    assert Lamp("a").tags is not Lamp("a").tags


def test_a_class_below_has_the_fields_above_and_its_own_methods() -> None:
    spot = Spot("a", angle=10.0, note="n")
    assert [one.name for one in fields(spot)] == ["name", "watts", "tags", "note", "angle"]
    assert (spot.name, spot.watts, spot.angle, spot.note) == ("a", 5.0, 10.0, "n")
    assert repr(spot) == "a spot of 10 degrees"
    assert spot != Lamp("a")
    assert spot == Spot("a", angle=10.0)
    with pytest.raises(ValueError, match="positive"):
        Spot("a", angle=0.0)
    with pytest.raises(ValueError, match="positive"):
        replace(spot, angle=-1.0)


@pytest.mark.parametrize("changes", [{}, {"watts": 7.0}, {"name": "b", "note": "n"}, {"tags": ["x"], "name": "c"}])
@pytest.mark.parametrize("kind", [Lamp, Spot])
def test_replacing_gives_what_the_standard_library_gives(kind: type[Lamp], changes: Mapping[str, object]) -> None:
    one = kind("a", 6.0, ["y"], note="m")
    ours, theirs = (replaced(one, **changes) for replaced in (replace, dataclasses.replace))
    assert ours.__class__ is kind
    assert [getattr(ours, f.name) for f in fields(kind)] == [getattr(theirs, f.name) for f in fields(kind)]
    assert one == kind("a", 6.0, ["y"], note="m")


def test_replacing_refuses_what_is_no_field() -> None:
    with pytest.raises(TypeError, match="a Lamp has no field 'colour'"):
        replace(Lamp("a"), colour="red")  # type: ignore[call-arg]  # that is what is tested


def test_values_are_copied_and_pickled() -> None:
    for one in (Lamp("a", tags=["x"], note="n"), Spot("b", angle=1.0), Nothing()):
        for again in (copy.copy(one), copy.deepcopy(one), pickle.loads(pickle.dumps(one))):
            assert again == one
            assert again.__class__ is one.__class__
    assert pickle.loads(pickle.dumps(Lamp("a", note="n"))).note == "n"


def test_a_value_has_no_other_attributes_than_its_fields() -> None:
    for value in (Connection(IRI("urn:a"), "x", IRI("urn:b"), "y"), Refusal(IRI("urn:t"), ()), Report()):
        with pytest.raises(FrozenInstanceError, match="cannot assign to field 'note'"):
            value.note = ""  # type: ignore[union-attr]  # that is what is tested


def test_a_frozen_mapping_is_a_dictionary_that_does_not_change() -> None:
    source = {"a": 1}
    frozen = FrozenMapping(source)
    source["a"] = 2
    assert (frozen["a"], frozen.get("b"), list(frozen), len(frozen), repr(frozen)) == (1, None, ["a"], 1, "{'a': 1}")
    assert frozen == {"a": 1} == frozen == FrozenMapping({"a": 1}) != FrozenMapping({"a": 2})
    assert hash(frozen) == hash(FrozenMapping({"a": 1}))
    for again in (copy.copy(frozen), copy.deepcopy(frozen), pickle.loads(pickle.dumps(frozen))):
        assert again == frozen
    with pytest.raises(TypeError, match="does not support item assignment"):
        frozen["a"] = 2  # type: ignore[index]  # that is what is tested
    with pytest.raises(FrozenInstanceError):
        frozen._items = {}  # type: ignore[misc]  # that is what is tested


def test_every_class_of_values_with_slots_is_made_by_it() -> None:
    folder = Path(selfconf.__file__).parent
    made = [path for path in folder.rglob("*.py") if "@dataclass(frozen=True, slots=True" in path.read_text("utf-8")]
    assert made == []


def test_every_module_replaces_by_it() -> None:
    folder = Path(selfconf.__file__).parent
    slow = re.compile(r"^from dataclasses import .*\breplace\b", re.MULTILINE)
    assert [path for path in folder.rglob("*.py") if slow.search(path.read_text("utf-8"))] == []


def test_values_without_fields_are_equal() -> None:
    assert Nothing() == Nothing()
    assert hash(Nothing()) == hash(Nothing())
    assert repr(Nothing()) == "Nothing()"
