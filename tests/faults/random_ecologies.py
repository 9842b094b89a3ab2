"""Ecologies of random shape: what histories show in the few that are written by hand may hold in these alone.

Sources feed what converts their signals, in a circle at times, and that feeds actuators. Roles are of one component or
of several, inputs may be optional, components may be shared, tolerate to be blind, have a parameter, offer an operation
or need one, and a composite may stand for a source, or for what converts signals. The number of an ecology decides all
of it; `tests.faults.replay` plays a history in it by `--ecology random-NUMBER`.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import count

from tests.faults.ecologies import FaultyEcology
from tests.lab import PREFIXES

SOURCES, CONVERTERS, ACTUATORS = (1, 2, 3), (0, 1, 1, 2, 3), (1, 1, 2)
"""How many classes of each there may be."""
COPIES = (1, 2, 2, 3)
"""How many components of a class there may be."""
PLAYERS = ((2, 2), (1, 2), (0, 1), (2, 3))
"""The least and the greatest number of components that play a role of more than one."""
TOLERATED = (0.3, 4)
"""For how many seconds an actuator may act on although it is blind, where it says so."""
PREFIX = "random-"


@dataclass(frozen=True, slots=True)
class Wanted:
    """An input of the components of a class."""

    port: str
    signal: str
    optional: bool = False


@dataclass(frozen=True, slots=True)
class Kind:
    """A class of components that differ in nothing but how much they are preferred."""

    name: str
    inputs: tuple[Wanted, ...] = ()
    outputs: tuple[str, ...] = ()
    """The type of the signals of each output."""
    copies: int = 1
    players: tuple[int, int] | None = None
    shareable: bool = False
    settable: bool = False
    offers: bool = False
    """Whether it offers the operation that others need."""
    needs: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """The names of its components."""
        return tuple(f"{self.name.lower()}-{number}" for number in range(1, self.copies + 1))


@lru_cache(maxsize=8)
def random_ecology(number: int) -> FaultyEcology:
    """The ecology of a number."""
    chance = random.Random(f"ecology {number}")
    kinds = _with_operation(chance, _with_circle(chance, _kinds(chance)))
    whole = _needed(kinds, [kind for kind in kinds if not kind.outputs])
    part = _needed(kinds, [chance.choice([kind for kind in whole if kind.inputs])])
    advertisements = {name: text for kind in kinds for name, text in _advertisements(chance, kind)}
    composite = _composite(chance, whole) or _converting_composite(random.Random(f"composite {number}"), whole)
    advertisements |= composite
    sites: dict[str, list[str]] = {}
    places = ("hall", "kitchen", "garden")[: chance.choice((1, 2, 2, 3))]
    for name in advertisements:
        sites.setdefault(chance.choice(places), []).append(name)
    preferred = [kind.names[0] for kind in kinds if kind.copies > 1] or [kinds[0].names[0]]
    return FaultyEcology(
        f"{PREFIX}{number}",
        {site: tuple(names) for site, names in sites.items()},
        advertisements,
        ("service",) if composite else (),
        _template(chance, "whole", whole),
        _template(chance, "part", part),
        (("goal", "(AT {task})"),),
        tuple(preferred),
        tuple(f"task-{one}" for one in range(1, chance.randint(2, 5))),
        crowd=chance.random() < 0.4,
    )


def _kinds(chance: random.Random) -> list[Kind]:
    """The classes, each before those that it may feed."""
    signals, issued = (f":Signal{number}" for number in count()), list[str]()
    kinds = []
    for name, numbers in (("Source", SOURCES), ("Converter", CONVERTERS), ("Actuator", ACTUATORS)):
        for number in range(chance.choice(numbers)):
            of_late = issued if name == "Converter" or chance.random() < 0.3 else issued[-3:]
            inputs = () if name == "Source" else tuple(_inputs(chance, of_late))
            outputs = () if name == "Actuator" else tuple(sorted(_outputs(chance, issued, signals, name == "Source")))
            issued += [signal for signal in outputs if signal not in issued]
            copies = chance.choice(COPIES)
            several = not inputs and copies > 1 and chance.random() < 0.25
            kinds.append(
                Kind(
                    f"{name}{number}",
                    inputs,
                    outputs,
                    copies,
                    chance.choice(PLAYERS) if several else None,
                    shareable=chance.random() < 0.35,
                    settable=chance.random() < 0.3,
                )
            )
    return kinds


def _inputs(chance: random.Random, issued: Sequence[str]) -> Iterator[Wanted]:
    """One or two inputs of different types, of which the first has to be fed."""
    some = chance.sample(issued, min(len(issued), chance.choice((1, 1, 2))))
    for number, signal in enumerate(some):
        yield Wanted(f"in{number}", signal, optional=number > 0 and chance.random() < 0.3)


def _outputs(chance: random.Random, issued: Sequence[str], signals: Iterator[str], is_source: bool) -> set[str]:
    """The types of one or two outputs; one that another class issues as well is rare."""
    number = chance.choice((1, 1, 2)) if is_source else 1
    return {chance.choice(issued) if issued and chance.random() < 0.15 else next(signals) for _ in range(number)}


def _with_circle(chance: random.Random, kinds: list[Kind]) -> list[Kind]:
    """The same classes; in some ecologies the first that converts signals needs those of the last as well."""
    converters = [number for number, kind in enumerate(kinds) if kind.inputs and kind.outputs]
    if len(converters) > 1 and chance.random() < 0.5:
        first, last = kinds[converters[0]], kinds[converters[-1]]
        back = Wanted("back", last.outputs[0], optional=chance.random() < 0.3)
        kinds[converters[0]] = replace(first, inputs=(*first.inputs, back))
    return kinds


def _with_operation(chance: random.Random, kinds: list[Kind]) -> list[Kind]:
    """The same classes; in some ecologies one offers an operation that one after it needs."""
    offering, needing = chance.randrange(len(kinds)), chance.randrange(len(kinds))
    if chance.random() < 0.6 and offering < needing and kinds[needing].inputs:
        kinds[offering] = replace(kinds[offering], offers=True, players=None)
        kinds[needing] = replace(kinds[needing], needs=True)
    return kinds


def _feeding(kinds: Sequence[Kind], kind: Kind) -> Iterator[Kind]:
    """The classes that one is fed by, or calls; signals may go in a circle."""
    signals = {wanted.signal for wanted in kind.inputs}
    for other in kinds:
        if other is not kind and (signals & {*other.outputs} or (kind.needs and other.offers)):
            yield other


def _needed(kinds: Sequence[Kind], wanted: Iterable[Kind]) -> list[Kind]:
    """The classes that some need, and these, in their order."""
    found: list[Kind] = []
    left = list(wanted)
    while left:
        kind = left.pop()
        if kind not in found:
            found.append(kind)
            left += _feeding(kinds, kind)
    return sorted(found, key=kinds.index)


def _advertisements(chance: random.Random, kind: Kind) -> Iterator[tuple[str, str]]:
    """What each component of a class says of itself."""
    for number, name in enumerate(kind.names):
        said = [f":{name} a sc:Component, :{kind.name}"]
        said += [f"sc:preference {-number}"] if chance.random() < 0.5 else []
        said += ["sc:shareable true"] if kind.shareable else []
        if kind.inputs and chance.random() < 0.2:
            said.append(f"sc:tolerates [ sc:value {chance.choice(TOLERATED)} ; sc:unit unit:SEC ]")
        for one in kind.inputs:
            optional = " ; sc:optional true" if one.optional else ""
            said.append(f'sc:hasInput [ sc:name "{one.port}" ; sc:signalType {one.signal}{optional} ]')
        said += [
            f'sc:hasOutput [ sc:name "out{place}" ; sc:signalType {signal} ]'
            for place, signal in enumerate(kind.outputs)
        ]
        said += ['sc:hasParameter [ sc:name "mode" ; sc:parameterType :Mode ]'] if kind.settable else []
        said += ['sc:hasOperation [ sc:name "give" ; sc:response :Help ]'] if kind.offers else []
        said += ['sc:needsOperation [ sc:name "take" ; sc:response :Help ]'] if kind.needs else []
        yield name, " ; ".join(said) + " ."


def _template(chance: random.Random, name: str, kinds: Sequence[Kind]) -> str:
    """A template with a role for each class, in some order."""
    order = chance.sample(kinds, len(kinds)) if chance.random() < 0.5 else kinds
    roles = " ".join(f":role-{kind.name}" for kind in order)
    lines = [
        f"{PREFIXES}:{name} a sc:Template ; sc:parameter :goal ; sc:roles ( {roles} ) .",
        ':goal a sc:Parameter ; sc:name "goal" ; sh:datatype xsd:string .',
    ]
    for kind in kinds:
        said = [f":role-{kind.name} a sc:Role ; sh:class :{kind.name}"]
        said += [f"sc:feeds :role-{other.name}" for other in kinds if kind in _feeding(kinds, other)]
        said += ["sc:sets [ sc:parameterType :Mode ; sc:value :goal ]"] if kind.settable else []
        said += [f"sc:minCount {kind.players[0]} ; sc:maxCount {kind.players[1]}"] if kind.players else []
        lines.append(" ; ".join(said) + " .")
    return "\n".join(lines)


def _composite(chance: random.Random, kinds: Sequence[Kind]) -> dict[str, str]:
    """In some ecologies a composite that can stand for a source, and what it is made of."""
    plain = [kind for kind in kinds if not (kind.inputs or kind.settable or kind.offers or kind.players)]
    plain = [kind for kind in plain if len(kind.outputs) == 1]
    if not plain or chance.random() < 0.6:
        return {}
    kind = chance.choice(plain)
    (signal,) = kind.outputs
    port = f'sc:hasOutput [ sc:name "out0" ; sc:signalType {signal}'
    inner = {
        f"eye-{number}": f':eye-{number} a sc:Component, :Eye ; sc:hasOutput [ sc:name "out" ; sc:signalType :Seen ] .'
        for number in range(1, chance.choice((2, 3)))
    }
    inner |= {
        f"finder-{number}": f":finder-{number} a sc:Component, :Finder ;"
        f' sc:hasInput [ sc:name "in" ; sc:signalType :Seen ] ; {port} ] .'
        for number in range(1, chance.choice((2, 3)))
    }
    service = f""":service a sc:Component, :{kind.name} ; sc:preference {chance.choice((5, -5))} ; {port} ] ;
    sc:grounding [ sc:template :find ] .
:find a sc:Template ; sc:roles ( :eye :finder ) ; {port} ; sc:of :finder ] .
:eye a sc:Role ; sh:class :Eye ; sc:feeds :finder .
:finder a sc:Role ; sh:class :Finder ."""
    return {**inner, "service": service}


def _converting_composite(chance: random.Random, kinds: Sequence[Kind]) -> dict[str, str]:
    """In some ecologies a composite that can stand for what converts signals, and what it is made of."""
    plain = [kind for kind in kinds if kind.inputs and len(kind.outputs) == 1]
    plain = [kind for kind in plain if not (kind.settable or kind.offers or kind.needs)]
    if not plain or chance.random() < 0.5:
        return {}
    kind = chance.choice(plain)
    shareable = " ; sc:shareable true" if kind.shareable else ""
    inputs, of_inner = "", ""
    for one in kind.inputs:
        port = f'sc:hasInput [ sc:name "{one.port}" ; sc:signalType {one.signal}'
        inputs += f"{port}{' ; sc:optional true' if one.optional else ''} ] ; "
        of_inner += f"{port} ; sc:of :worker ] ; "
    output = f'sc:hasOutput [ sc:name "out0" ; sc:signalType {kind.outputs[0]}'
    inner = {
        f"worker-{number}": f":worker-{number} a sc:Component, :Worker{shareable} ; {inputs}{output} ] ."
        for number in range(1, chance.choice((2, 3)))
    }
    service = f""":service a sc:Component, :{kind.name}{shareable} ; sc:preference {chance.choice((5, -5))} ;
    {inputs}{output} ] ; sc:grounding [ sc:template :convert ] .
:convert a sc:Template ; sc:roles ( :worker ) ; {of_inner}{output} ; sc:of :worker ] .
:worker a sc:Role ; sh:class :Worker ."""
    return {**inner, "service": service}
