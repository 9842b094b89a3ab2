"""Immutable values: `immutable` does to a class what `dataclass(frozen=True, slots=True)` does, in a fifth of the time.

A data class compiles six methods for each class, one by one, which for the 150 classes of a site was a quarter of the
time in which it starts. Here only `__init__` is compiled, and that when the class has had a few values: most programs
make values of some classes only. The other methods are the same functions for all classes, or closures over the names
of the fields. What `dataclasses` offers for data classes (`fields`, `replace`, `asdict`) works as usual, and type
checkers see a frozen data class. The `replace` of this module does the same in a third of the time, as a configurator
makes its state anew at each step. A value holds what it maps in a `FrozenMapping`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, Field, FrozenInstanceError
from functools import cache, partial
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, TypeVar

Class = TypeVar("Class", bound=type)
_Made = TypeVar("_Made")
_Key = TypeVar("_Key")
_Mapped = TypeVar("_Mapped", covariant=True)
Methods = dict[str, Callable[..., Any]]
FIRST_VALUES = 8
"""How many values of a class are made before its `__init__` is compiled."""

if TYPE_CHECKING:
    from dataclasses import replace as replace

    from typing_extensions import dataclass_transform

    @dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
    def immutable(cls: Class) -> Class:
        """Make a class an immutable value, compared and hashed by its fields."""

else:

    def immutable(cls):
        """Make a class an immutable value, compared and hashed by its fields."""
        own = frozenset(vars(cls))
        made = dataclasses.dataclass(init=False, repr=False, eq=False, slots=True)(cls)
        fields = dataclasses.fields(made)
        methods = {**_SHARED, "__init__": _Initializer(made), **_comparison(fields)}
        for name, method in methods.items():
            if name not in own:
                setattr(made, name, method)
        return made

    def replace(value, /, **changes):
        """Return a value like another one, but for the fields that are named."""
        copied, setters = _copying(value.__class__)
        made = copied(value)
        for name, given in changes.items():
            if name not in setters:
                raise TypeError(f"a {value.__class__.__qualname__} has no field {name!r}")
            setters[name](made, given)
        if hasattr(made, "__post_init__"):
            made.__post_init__()
        return made


def recast(value: object, kind: type[_Made], base: type, **more: Any) -> _Made:
    """Return a value of another class with the fields of `base`, which both have, and with more."""
    return kind(**{field.name: getattr(value, field.name) for field in dataclasses.fields(base)}, **more)


class _Initializer:
    """Stands for the `__init__` of a class until that has had a few values, and is then replaced by a compiled one.

    To compile one takes as long as thirty values do without it, and most programs make few values of most classes.
    """

    __slots__ = ("_cls", "_left")

    def __init__(self, cls: type) -> None:
        self._cls, self._left = cls, FIRST_VALUES

    def __get__(self, value: object, owner: type | None = None) -> Any:
        if self._left <= 0 or not isinstance(value, self._cls):  # it is looked at, as by `inspect.signature`
            return self._compiled().__get__(value, owner)
        self._left -= 1
        return partial(self._initialize, value)

    def _compiled(self) -> Callable[..., None]:
        made = _initializer(self._cls)
        type.__setattr__(self._cls, "__init__", made)
        return made

    def _initialize(self, value: Any, *given: Any, **named: Any) -> None:
        """Store the fields of a value; if the arguments are wrong, the compiled `__init__` raises what that is."""
        fields = sorted(dataclasses.fields(self._cls), key=_by_keyword_only)
        arguments = {**{field.name: one for field, one in zip(fields, given, strict=False)}, **named}
        right = len(arguments) == len(given) + len(named) and not any(one.kw_only for one in fields[: len(given)])
        for field in fields:
            if field.name in arguments:
                made = arguments.pop(field.name)
            elif field.default is not MISSING:
                made = field.default
            elif field.default_factory is not MISSING:
                made = field.default_factory()
            else:
                right = False
                break
            getattr(self._cls, field.name).__set__(value, made)
        if arguments or not right:
            self._compiled()(value, *given, **named)
        elif hasattr(value, "__post_init__"):
            value.__post_init__()


def _initializer(cls: type) -> Callable[..., None]:
    """Return an `__init__` that stores its arguments by the descriptors of the slots, which nothing can forbid."""
    known: dict[str, Any] = {"_missing": MISSING}
    parameters, body = ["self"], []
    for field in sorted(dataclasses.fields(cls), key=_by_keyword_only):
        name = given = field.name
        if field.kw_only and "*" not in parameters:
            parameters.append("*")
        known[f"_set_{name}"] = getattr(cls, name).__set__
        if field.default is not MISSING:
            known[f"_default_{name}"] = field.default
            parameters.append(f"{name}=_default_{name}")
        elif field.default_factory is not MISSING:
            known[f"_make_{name}"] = field.default_factory
            parameters.append(f"{name}=_missing")
            given = f"_make_{name}() if {name} is _missing else {name}"
        else:
            parameters.append(name)
        body.append(f"_set_{name}(self, {given})")
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    exec(f"def __init__({', '.join(parameters)}): {'; '.join(body) or 'pass'}", known)
    made: Callable[..., None] = known["__init__"]
    made.__qualname__ = f"{cls.__qualname__}.__init__"
    return made


@cache
def _copying(cls: type) -> tuple[Callable[[Any], Any], Methods]:
    """Return a function that copies a value of a class, and what sets each field of the copy."""
    setters: Methods = {field.name: getattr(cls, field.name).__set__ for field in dataclasses.fields(cls)}
    known: dict[str, Any] = {"_cls": cls, "_new": object.__new__, **{f"_set_{name}": s for name, s in setters.items()}}
    body = ["made = _new(_cls)", *(f"_set_{name}(made, value.{name})" for name in setters), "return made"]
    exec(f"def copied(value): {'; '.join(body)}", known)
    return known["copied"], setters


def _by_keyword_only(field: Field[Any]) -> bool:
    return bool(field.kw_only)


def _comparison(fields: Sequence[Field[Any]]) -> Methods:
    """Return the methods that compare and hash a value by its fields, as a tuple of them would be."""
    compared = _values_of([field.name for field in fields if field.compare])
    hashed = _values_of([field.name for field in fields if (field.compare if field.hash is None else field.hash)])

    def __eq__(self: Any, other: Any) -> Any:
        return compared(self) == compared(other) if other.__class__ is self.__class__ else NotImplemented

    def __hash__(self: Any) -> int:
        return hash(hashed(self))

    return {"__eq__": __eq__, "__hash__": __hash__}


def _values_of(names: Sequence[str]) -> Callable[[Any], Any]:
    return attrgetter(*names) if names else lambda _: ()


@recursive_repr()
def _repr(self: Any) -> str:
    shown = (f"{field.name}={getattr(self, field.name)!r}" for field in dataclasses.fields(self) if field.repr)
    return f"{self.__class__.__qualname__}({', '.join(shown)})"


def _refuse_assignment(self: object, name: str, assigned: object) -> None:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_deletion(self: object, name: str) -> None:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: Any) -> list[Any]:
    return [getattr(self, field.name) for field in dataclasses.fields(self)]


def _restore(self: Any, state: Sequence[Any]) -> None:
    for field, restored in zip(dataclasses.fields(self), state, strict=True):
        object.__setattr__(self, field.name, restored)


_SHARED: Methods = {
    "__repr__": _repr,
    "__setattr__": _refuse_assignment,
    "__delattr__": _refuse_deletion,
    "__getstate__": _state,
    "__setstate__": _restore,
}


@immutable
class FrozenMapping(Mapping[_Key, _Mapped]):
    """A mapping that does not change; it compares and prints as a dictionary, and is hashed by what it maps."""

    _items: Mapping[_Key, _Mapped]

    def __post_init__(self) -> None:
        object.__setattr__(self, "_items", dict(self._items))

    def __getitem__(self, key: _Key) -> _Mapped:
        return self._items[key]

    def __iter__(self) -> Iterator[_Key]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __eq__(self, other: object) -> bool:
        return self._items == other

    def __hash__(self) -> int:
        return hash(frozenset(self._items.items()))

    def __repr__(self) -> str:
        return repr(self._items)
