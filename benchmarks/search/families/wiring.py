"""What families of problems are made of: components, and templates that wire them.

Two roles that must not be played by certain pairs are wired through a named input: a candidate of the one issues a
signal for each candidate of the other that it goes with, which is all that a template can say of pairs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from selfconf.model.partition import Candidate, Partition, Variable
from selfconf.model.profile import Input, Output, Profile, shared_ports
from selfconf.model.template import Interaction, Parameter, Role, Task, Template
from selfconf.model.term import IRI
from selfconf.search.problem import Problem


@dataclass(frozen=True)
class Instance:
    """A problem and what to call it; made when asked for, as the big ones should not all be in memory at once."""

    family: str
    name: str
    size: int
    """What grows in the family: candidates per role, roles, or variables."""
    make: Callable[[], Problem]


def iri(name: object) -> IRI:
    """A name in the namespace of the benchmarks."""
    return IRI(f"urn:bench:{name}")


def profile(name: object, inputs: Sequence[object] = (), outputs: Sequence[object] = ()) -> Profile:
    """A component with a port for each signal."""
    return Profile(
        iri(name),
        ports=shared_ports(  # as whoever reads an advertisement does
            tuple(Input(f"i{k}", (iri(s),)) for k, s in enumerate(inputs)),
            tuple(Output(f"o{k}", (iri(s),)) for k, s in enumerate(outputs)),
        ),
    )


def made(
    roles: Sequence[Sequence[Candidate]],
    edges: Sequence[tuple[int, int]],
    variables: tuple[Variable, ...] = (),
) -> Problem:
    """A problem with one component per role."""
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{k}")) for k in range(len(roles))),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}")) for a, b in edges),
        tuple(Parameter(v.parameter, v.parameter.short, in_shape=True) for v in variables),
    )
    return Problem(Task(template), Partition(tuple(map(tuple, roles)), variables))


Goes = Callable[[int, int], bool]
"""Whether a value of one role goes with a value of another."""


def in_pairs(domains: Sequence[Sequence[int]], pairs: Mapping[tuple[int, int], Goes]) -> Problem:
    """A role for each domain, a component for each value; the values of a pair of roles have to go together."""
    inputs: list[list[list[Input]]] = [[[] for _ in domain] for domain in domains]
    outputs: list[list[list[Output]]] = [[[] for _ in domain] for domain in domains]
    for (sink, source), goes in pairs.items():
        for k, value in enumerate(domains[sink]):
            signal = iri(f"{source}.{sink}.{value}")
            inputs[sink][k].append(Input(f"from{source}", (signal,)))
            for n, other in enumerate(domains[source]):
                if goes(value, other):
                    outputs[source][n].append(Output(f"to{sink}.{value}", (signal,)))
    candidates = tuple(
        tuple(
            Candidate(Profile(iri(f"c{role:03}.{value:04}"), ports=shared_ports(tuple(wanted), tuple(issued))))
            for value, wanted, issued in zip(domain, inputs[role], outputs[role], strict=True)
        )
        for role, domain in enumerate(domains)
    )
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{role}")) for role in range(len(domains))),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}"), None, f"from{a}") for b, a in pairs),
    )
    return Problem(Task(template), Partition(candidates))


def counted(
    roles: Sequence[Sequence[Candidate]],
    asked: Sequence[int],
    edges: Iterable[tuple[int, int]],
    variables: tuple[Variable, ...] = (),
) -> Problem:
    """A problem whose roles ask for so many components each."""
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{k}"), count, count) for k, count in enumerate(asked)),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}")) for a, b in edges),
        tuple(Parameter(v.parameter, v.parameter.short, in_shape=True) for v in variables),
    )
    return Problem(Task(template), Partition(tuple(map(tuple, roles)), variables))


Family = tuple[tuple[str, Callable[[int], Problem]], ...]
"""What each size is called, and how an instance is made from a seed."""


def instances(families: Mapping[str, Family], seeds: Iterable[int]) -> Iterator[Instance]:
    """The instances of some families, one for each seed."""
    for family, sizes in families.items():
        for size, (name, make) in enumerate(sizes):
            for seed in seeds:
                yield Instance(family, f"{name}, seed {seed}", size, partial(make, seed))


def hearing(name: str, heard: Mapping[int, object], issued: Iterable[object]) -> Candidate:
    """A component that hears some roles, each by an input of its own, with the signals that it wants of them."""
    wanted = tuple(Input(f"from{role}", (iri(signal),)) for role, signal in heard.items())
    return Candidate(Profile(iri(name), ports=shared_ports(wanted, tuple(Output(f"{s}", (iri(s),)) for s in issued))))


def heard_by_name(roles: Sequence[Sequence[Candidate]], edges: Iterable[tuple[int, int]]) -> Problem:
    """A problem with one component per role, in which each role feeds the inputs that are named after it."""
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{k}")) for k in range(len(roles))),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}"), None, f"from{a}") for a, b in edges),
    )
    return Problem(Task(template), Partition(tuple(map(tuple, roles))))
