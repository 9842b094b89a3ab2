"""The types of what the library answers with can be imported from one place."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from inspect import isfunction
from typing import Any, get_args, get_origin, get_type_hints

import rdflib

import selfconf as sc
from selfconf import query, sdk, testing, values
from selfconf.api.answer import Answer
from selfconf.model.run_event import AnyRunEvent

DOORS = (sc, values, sdk, testing)
NOT_READ_BY_PROGRAMS = {
    "TaskDocument": "what was read of a template, as sites and commands hand it on",
    "Dataset": "what `query` asks",
    "Shown": "an answer in the format of a command",
    "Inquiry": "how a partition is computed",
    "Ports": "the ports of a component, which its profile has one by one",
    "Condition": "what an input asks of outputs besides their types, as the search compares it",
    "WantedSignal": "the same, with the types",
    "LogQuestion": "what a log is asked by, for a command that follows it",
    "LogPart": "what a site answers to that",
    "Wire": "where an output of a composite comes from, for the page of `serve`",
}
"""The types that a member of the library answers with and that its doors do not export, each with a reason."""


def named(hint: Any) -> Iterator[type]:
    """The classes that are named in a type."""
    parts = hint if isinstance(hint, list) else (get_origin(hint), *get_args(hint))
    for part in parts:
        if part is not None:
            yield from named(part)
    if isinstance(hint, type):
        yield hint


def hints(annotated: Any) -> dict[str, Any]:
    """The types that a class states of its fields, or a function of what it returns."""
    stated = vars(annotated).get("__annotations__", {}) if isinstance(annotated, type) else annotated.__annotations__
    names = {name: getattr(door, name) for door in DOORS for name in door.__all__}
    names |= {
        "rdflib": rdflib,
        "Self": Any,
        "Question": query.Question,
        "Shown": query.Shown,
    }  # named for type checkers alone
    names |= vars(sys.modules[annotated.__module__])
    shown = {name: hint for name, hint in stated.items() if isinstance(annotated, type) or name == "return"}
    return get_type_hints(type("Stated", (), {"__annotations__": shown}), names, names)


def answers_of(found: type) -> Iterator[tuple[str, Any]]:
    """The public fields, properties and methods of a class, each with the type that it has or answers with."""
    for base in found.__mro__:
        if base.__module__.startswith("selfconf"):
            yield from ((name, hint) for name, hint in hints(base).items() if not name.startswith("_"))
            for name, member in vars(base).items():
                function = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
                if isfunction(function) and (not name.startswith("_") or name in ("__getitem__", "__enter__")):
                    yield name, hints(function).get("return")


def test_every_name_is_a_type_of_the_library_and_no_second_one() -> None:
    assert values.Answer is Answer
    assert sorted(values.__all__) == values.__all__
    assert set(values.__all__).isdisjoint(sc.__all__)
    assert [name for name in values.__all__ if isfunction(getattr(values, name))] == ["event_body"]


def test_what_a_program_completes_is_what_the_library_says_it_has() -> None:
    assert [name for name in dir(sc) if not name.startswith("__")] == sorted(sc.__all__)
    assert {"__doc__", "__file__", "__name__"} <= set(dir(sc))


def test_the_events_of_a_run_are_all_there() -> None:
    assert {event.__name__ for event in get_args(AnyRunEvent)} <= set(values.__all__)


def test_what_the_library_answers_with_is_of_these_types() -> None:
    task, home = sc.template("examples/clock/tell-the-time.ttl"), sc.read("examples/clock")
    refusal = sc.configure(task.bind(room=":cellar"), home)
    assert not refusal
    assert isinstance(sc.configure(task, home), values.Answer)
    assert isinstance(refusal.near_misses[0], values.NearMiss)
    assert isinstance(refusal.reasons[0], get_args(values.Reason))
    assert isinstance(sc.partition(task, home), values.PartitionTable)
    assert isinstance(sc.partition(task, home)["source"], values.RolePartition)
    assert isinstance(sc.partition(task, home)["source"].excluded[0], values.Exclusion)
    assert isinstance(home.query("SELECT ?c { ?c a rob:Display }"), values.Solutions)
    assert isinstance(sc.validate("examples/clock"), values.ValidationReport)


def test_whatever_a_program_reads_of_an_answer_has_a_type_that_it_can_import() -> None:
    exported = {id(getattr(door, name)) for door in DOORS for name in door.__all__}
    waiting: list[tuple[str, type]] = []
    for name in sc.__all__:
        offered = getattr(sc, name)
        hint = offered if isinstance(offered, type) else hints(offered)["return"]
        waiting += ((name, found) for found in named(hint))
    seen: set[type] = set()
    hidden: dict[str, str] = {}
    while waiting:
        where, found = waiting.pop()
        if found in seen or not found.__module__.startswith("selfconf"):
            continue
        seen.add(found)
        if id(found) not in exported:
            hidden[found.__name__] = where
            continue
        waiting += ((f"{found.__name__}.{name}", one) for name, hint in answers_of(found) for one in named(hint))
    assert len(seen) > 100
    assert {name: where for name, where in hidden.items() if name not in NOT_READ_BY_PROGRAMS} == {}
    assert NOT_READ_BY_PROGRAMS.keys() <= hidden.keys()
