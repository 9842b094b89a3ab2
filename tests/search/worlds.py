"""Small random problems, built from model values alone: a strategy, and short ways to write one by hand."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.template import Interaction, Parameter, Role, Setting, Task, Template
from selfconf.model.term import IRI, Literal, Term
from selfconf.search.problem import Problem

NIGHTLY = os.environ.get("HYPOTHESIS_PROFILE") == "nightly"


def agreement(share: float = 1.0) -> settings:
    """How many worlds a test sees: 500 where every push runs, 10,000 at night (HYPOTHESIS_PROFILE=nightly)."""
    return settings(
        max_examples=max(1, int((10_000 if NIGHTLY else 500) * share)),
        deadline=None,
        derandomize=not NIGHTLY,
        database=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    )


def iri(name: str) -> IRI:
    """A name in the namespace of these tests."""
    return IRI(f"urn:test:{name}")


def component(name: str, inputs: str = "", outputs: str = "", preference: float = 0.0) -> Profile:
    """A component by its ports: `component("cap", "sonar:Scan pose:Pose", "velocity:Velocity")`."""
    return Profile(
        iri(name),
        ports=Ports(
            tuple(Input(port, iri(signal)) for port, signal in _ports(inputs)),
            tuple(Output(port, iri(signal)) for port, signal in _ports(outputs)),
        ),
        parameters=(OperationalParameter("goal", iri("Goal")),),
        preference=preference,
    )


def _ports(text: str) -> list[tuple[str, str]]:
    return sorted((port.split(":")[0], port.split(":")[-1]) for port in text.split())


def feeds(text: str) -> tuple[Interaction, ...]:
    """Interactions such as `"sonar>control cap.velocity>drive.speed"`."""
    return tuple(_interaction(*part.split(">")) for part in text.split())


def _interaction(source: str, sink: str) -> Interaction:
    first, _, output = source.partition(".")
    second, _, wanted = sink.partition(".")
    return Interaction(iri(first), iri(second), output or None, wanted or None)


def problem(
    roles: Mapping[str, Sequence[Profile]],
    interactions: str = "",
    counts: Mapping[str, tuple[int, int | None]] | None = None,
    values: Mapping[str, Mapping[str, int]] | None = None,
    domain: Sequence[str] = (),
    hierarchy: Hierarchy = NOTHING_ABOVE,
) -> Problem:
    """A problem written by hand: candidates by role, `"a>b"` interactions, (minCount, maxCount) by role.

    `values` gives, per role and component, the bit mask of values of the one free parameter `robot`.
    """
    asked = counts or {}
    template = Template(
        iri("template"),
        tuple(Role(iri(name), *asked.get(name, (1, 1))) for name in roles),
        feeds(interactions),
        (Parameter(iri("robot"), "robot", in_shape=True),) if domain else (),
    )
    variables = (Variable(iri("robot"), tuple(iri(name) for name in domain)),) if domain else ()
    candidates = tuple(
        tuple(Candidate(profile, _mask(values, name, profile) if domain else ()) for profile in profiles)
        for name, profiles in roles.items()
    )
    return Problem(Task(template), Partition(candidates, variables), hierarchy)


def _mask(values: Mapping[str, Mapping[str, int]] | None, role: str, profile: Profile) -> tuple[int, ...]:
    return ((values or {}).get(role, {}).get(profile.component.short, ANY_VALUE),)


SIGNALS = [iri(name) for name in ("S", "T", "U", "V")]
CLASSES = [*SIGNALS, iri("Goal")]
NAMES = ["p", "q", "r"]


def _once(ports: Ports, shared: dict[Ports, Ports] | None) -> Ports:
    return ports if shared is None else shared.setdefault(ports, ports)


@st.composite
def problems(draw: st.DrawFn, roles: int = 4, components: int = 5) -> Problem:
    """Problems small enough to enumerate, with everything that a template can say.

    Roles share candidates and order them each in their own way; components may share what is equal of their ports;
    cardinalities include none, two and without end; interactions may form cycles, feed a role from itself and name
    ports; free parameters may also be set.
    """
    signals = st.sampled_from(SIGNALS[: draw(st.integers(1, 4))])
    shared: dict[Ports, Ports] | None = {} if draw(st.booleans()) else None
    outputs = st.dictionaries(st.sampled_from(NAMES), signals, max_size=2)
    inputs = st.one_of(st.just({}), st.dictionaries(st.sampled_from(NAMES), signals, max_size=2))
    profiles = [
        Profile(
            iri(f"c{number}"),
            ports=_once(
                Ports(
                    tuple(Input(*port) for port in sorted(draw(inputs).items())),
                    tuple(Output(*port) for port in sorted(draw(outputs).items())),
                ),
                shared,
            ),
            parameters=tuple(
                OperationalParameter("goal", kind) for kind in draw(st.sets(st.sampled_from(CLASSES[3:]), max_size=1))
            ),
        )
        for number in range(draw(st.integers(0, components)))
    ]
    count = draw(st.integers(1, roles))
    variables = tuple(
        Variable(iri(f"v{number}"), tuple(iri(f"value{k}") for k in range(draw(st.integers(1, 3)))))
        for number in range(draw(st.sampled_from([0, 0, 1, 1, 2])))
    )
    parameters = tuple(
        Parameter(v.parameter, v.parameter.short, in_shape=True, is_set=draw(st.booleans())) for v in variables
    )
    parts = tuple(_role(draw, number, parameters) for number in range(count))
    pairs = [(a, b) for a in range(count) for b in range(count)]
    chosen = draw(st.lists(st.sampled_from(pairs), min_size=count - 1, max_size=3 * count, unique=True))
    port = st.sampled_from([None, None, None, *NAMES[:2]])
    interactions = tuple(Interaction(parts[a].iri, parts[b].iri, draw(port), draw(port)) for a, b in chosen)
    edges = draw(st.lists(st.tuples(st.sampled_from(CLASSES), st.sampled_from(CLASSES)), max_size=3))
    hierarchy = Hierarchy(edges) if draw(st.booleans()) else NOTHING_ABOVE
    candidates = tuple(_candidates(draw, profiles, variables) for _ in parts)
    template = Template(iri("template"), parts, interactions, (*parameters, Parameter(iri("goal"), "goal")))
    task = Task(template, {iri("goal"): Literal("(AT BEDROOM)")})
    return Problem(task, Partition(candidates, variables), hierarchy)


def _role(draw: st.DrawFn, number: int, parameters: Sequence[Parameter]) -> Role:
    minimum = draw(st.sampled_from([1, 1, 1, 1, 0, 2]))
    maximum = draw(st.sampled_from([minimum, minimum, minimum + 1, None]))
    value: Term = Literal("1") if draw(st.booleans()) else iri("goal")
    settings_: tuple[Setting, ...] = (Setting(iri("Goal"), value),) if draw(st.booleans()) else ()
    for parameter in parameters:
        if parameter.is_set and draw(st.booleans()):
            settings_ = (*settings_, Setting(iri("Goal"), parameter.iri))
    return Role(iri(f"r{number}"), minimum, maximum, settings_)


def _candidates(draw: st.DrawFn, profiles: Sequence[Profile], variables: Sequence[Variable]) -> tuple[Candidate, ...]:
    chosen = draw(st.permutations(profiles)) if draw(st.booleans()) else list(profiles)
    left_out = draw(st.sets(st.sampled_from(NUMBERS), max_size=1))
    return tuple(
        Candidate(profile, tuple(_allowed(draw, variable) for variable in variables))
        for index, profile in enumerate(chosen)
        if index not in left_out
    )


NUMBERS = range(5)


def _allowed(draw: st.DrawFn, variable: Variable) -> int:
    some = draw(st.integers(0, (1 << len(variable.domain)) - 1))
    return ~some if not some or draw(st.integers(0, 3)) == 0 else some
