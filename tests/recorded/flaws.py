"""What can be wrong with a random ecology."""

from __future__ import annotations

from collections.abc import Callable

from tests.recorded.drafts import ROBOTS, Draft

Flaw = Callable[[Draft], None]


def nobody_of_a_kind(draft: Draft) -> None:
    """Every component of a role's kind is gone, or of a kind that is spelt otherwise."""
    role = draft.chance.one(draft.roles)
    alike = [one for one in draft.components if one.kind == role.kind]
    if draft.chance.often(0.5):
        draft.components = [one for one in draft.components if one not in alike]
    for one in alike:
        one.kind = f":{draft.chance.one(('Better', 'Best', 'Un'))}{role.kind[1:]}"


def one_is_gone(draft: Draft) -> None:
    """Somebody of the cast is missing."""
    cast = draft.chance.one([cast for cast in draft.casts if cast] or [draft.components])
    gone = draft.chance.one(cast)
    draft.components = [one for one in draft.components if one is not gone]


def too_much_is_asked(draft: Draft) -> None:
    """A role asks for more components than there are, or a pair of roles does."""
    role = draft.chance.one(draft.roles)
    role.minimum, role.maximum, role.counted = role.minimum + 1 + draft.chance.below(3), None, True


def roles_share(draft: Draft) -> None:
    """Two roles ask for one kind, of which there may be too few."""
    first, second = draft.chance.shuffled(draft.roles)[:2]
    second.kind, second.shapes = first.kind, list(first.shapes)


def no_such_signal(draft: Draft) -> None:
    """An output of everybody has a signal of another type."""
    if draft.edges:
        _, _, signal = draft.chance.one(draft.edges)
        other = draft.chance.one((f":Fine{signal}", f":{signal}Too", ":Rare"))
        for component in draft.components:
            component.outputs = [(name, other if was == f":{signal}" else was) for name, was in component.outputs]


def not_fed(draft: Draft) -> None:
    """An interaction is missing."""
    feeding = [role for role in draft.roles if role.feeds]
    if feeding:
        role = draft.chance.one(feeding)
        role.feeds.pop(draft.chance.below(len(role.feeds)))


def a_source_asks_for_nobody(draft: Draft) -> None:
    """A role that others need is optional."""
    if draft.edges:
        source, _, _ = draft.chance.one(draft.edges)
        draft.roles[source].minimum, draft.roles[source].counted = 0, True


def several_robots(draft: Draft) -> None:
    """The cast is mounted on different robots."""
    for component in draft.components:
        component.said = [
            f":support {draft.chance.one(ROBOTS)}" if said.startswith(":support ") else said for said in component.said
        ]


def nothing_to_set(draft: Draft) -> None:
    """A parameter is set and has no value."""
    role = draft.chance.one(draft.roles)
    role.sets.append("sc:sets [ sc:parameterType :Level ; sc:value :level ]")
    draft.parameters.append(':level a sc:Parameter ; sc:name "level" ; sh:datatype xsd:integer .\n')
    looked_for, stated = draft.chance.often(0.9), draft.chance.one((0.0, 0.0, 0.6))
    if looked_for:
        role.sets.append("sh:property [ sh:path :level-of ; sh:in ( :level ) ]")
    for component in draft.components:
        component.said.append('sc:hasParameter [ sc:name "level" ; sc:parameterType :Level ]')
        if looked_for and draft.chance.often(stated):
            component.said.append(f":level-of {draft.chance.below(3)}")


def unlike_partners(draft: Draft) -> None:
    """Each player gets what it needs from another partner: signals differ pairwise along an interaction."""
    if draft.edges:
        source, sink, signal = draft.chance.one(draft.edges)
        for number, component in enumerate(draft.components):
            dialect = f":{signal}{'xy'[number % 2]}"
            if draft.roles[source].kind[1:] in component.kind:
                component.outputs = [(n, dialect if s == f":{signal}" else s) for n, s in component.outputs]
            if draft.roles[sink].kind[1:] in component.kind:
                component.inputs = [(n, dialect if s == f":{signal}" else s) for n, s in component.inputs]


def two_dialects(draft: Draft) -> None:
    """The only source gives either of two signals, and the sinks between them want both."""
    if draft.edges:
        source, sink, signal = draft.chance.one(draft.edges)
        kinds = draft.roles[source].kind, draft.roles[sink].kind
        players = [one for one in draft.components if one.kind == kinds[0]]
        for number, component in enumerate(players):
            component.outputs = [(n, f":{signal}{number}" if s == f":{signal}" else s) for n, s in component.outputs]
        for component in draft.components:
            if component.kind == kinds[1]:
                component.inputs += [(f"dialect{number}", f":{signal}{number}") for number in range(len(players[:2]))]


FLAWS: tuple[Flaw, ...] = (
    *(nobody_of_a_kind,) * 4, *(one_is_gone,) * 6, *(too_much_is_asked,) * 3, *(roles_share,) * 9,
    *(no_such_signal,) * 4, *(not_fed,) * 4, *(a_source_asks_for_nobody,) * 4, *(several_robots,) * 9,
    *(nothing_to_set,) * 6, *(unlike_partners,) * 3, *(two_dialects,) * 9,
)  # fmt: skip
"""Some are more frequent than others, so that every reason occurs."""
MALFORMED = (
    'a sc:Component, :K0 ; sc:hasOutput [ sc:name "out" ]',
    "a sc:Component, :K1 ; sc:hasInput [ sc:signalType :S0 ]",
    'a sc:Component, :K0 ; sc:preference "high"',
    "a sc:Component",
    'a sc:Component, :K2 ; sc:hasOutput [ sc:name "o" ; sc:signalType :S0 ], [ sc:name "o" ; sc:signalType :S1 ]',
    "a sc:Component, :K1 ; sc:preference 1, 2",
    'a sc:Component, "K1"',
    'a sc:Component, :K3 ; sc:hasOutput [ sc:name "o", "p" ; sc:signalType :S0 ]',
    "a sc:Component, :K0 ; sc:grounding [ sc:command 5 ]",
)
"""Advertisements that are left out."""
TROUBLES = ("syntax", "role", "unbound", "unknown parameter", "literal signal", "empty")
"""What makes an ecology unreadable, or a task not a task."""
