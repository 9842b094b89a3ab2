"""Small random problems, built from model values alone: a strategy, and short ways to write one by hand."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from itertools import islice
from string import ascii_lowercase

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import ANY_VALUE, Candidate, Mention, Partition, Variable
from selfconf.model.profile import (
    Condition,
    Input,
    Operation,
    OperationalParameter,
    Output,
    Ports,
    Profile,
    SentRequest,
)
from selfconf.model.refusal import Refusal
from selfconf.model.template import Interaction, Parameter, Role, Setting, Task, Template
from selfconf.model.term import IRI, Literal, Term
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction
from tests.harness.effort import NIGHTLY, solved_examples
from tests.search.chance import Chance, by_chance


def agreement(share: float = 1.0) -> settings:
    """How many problems a test draws: 75 for every push, 50 in a quick run, 10,000 at night."""
    return settings(
        max_examples=solved_examples(int(500 * share)),
        deadline=None,
        derandomize=not NIGHTLY,
        database=None,
        print_blob=True,  # a failure then says how to replay it
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    )


def explained_once(refusal: Callable[[LazyReduction], Refusal]) -> Callable[[LazyReduction], Refusal]:
    """An explanation that is found once, where a problem is solved again and again with more steps for the rest."""
    explained: tuple[Problem, Refusal] | None = None

    def explain(given: LazyReduction) -> Refusal:
        nonlocal explained
        if explained is None or explained[0] is not given.problem:
            explained = given.problem, refusal(given)
        return explained[1]

    return explain


def iri(name: str) -> IRI:
    """A name in the namespace of these tests."""
    return IRI(f"urn:test:{name}")


def component(name: str, inputs: str = "", outputs: str = "", preference: int = 0) -> Profile:
    """A component by its ports: `component("cap", "sonar:Scan pose:Pose", "velocity:Velocity")`."""
    return Profile(
        iri(name),
        ports=Ports(
            tuple(Input(port, (iri(signal),)) for port, signal in _ports(inputs)),
            tuple(Output(port, (iri(signal),)) for port, signal in _ports(outputs)),
        ),
        parameters=(OperationalParameter("goal", iri("Goal")),),
        preference=Decimal(preference),
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
    mentions = ((Mention(iri("robot")),) if domain else (),) * len(roles)
    return Problem(Task(template), Partition(candidates, variables, mentions=mentions), hierarchy)


def _mask(values: Mapping[str, Mapping[str, int]] | None, role: str, profile: Profile) -> tuple[int, ...]:
    return ((values or {}).get(role, {}).get(profile.component.short, ANY_VALUE),)


SIGNALS = [iri(name) for name in ("S", "T", "U", "V")]
CLASSES = [*SIGNALS, iri("Goal")]
PLAIN = ["plain"] * 6
"""Most ports are plain: of one type, with no condition."""
SOLVABLE = [*PLAIN, "more", "optional", "unit", "frame", "shape"]
"""Kinds of ports that do not keep apart who is meant to feed whom."""
ODD = [*SOLVABLE, "other", "untyped"]
UNITS = [iri("M"), iri("CM")]
FRAMES = [Literal("map"), Literal("base")]
SHAPE = "[ <urn:test:path> <urn:test:value> ]"
NAMES = ["p", "q", "r"]
FURTHER = (*ascii_lowercase[ascii_lowercase.index("s") :], *(f"z{number}" for number in range(20)))
"""Names for the outputs that a cast needs beyond those it happens to have."""
NUMBERS = range(5)
Cast = Sequence[Sequence[int]]
"""For each role the numbers of the components that are meant to play it."""


def problems(roles: int = 4, components: int = 5, plain: bool = False) -> st.SearchStrategy[Problem]:
    """Problems as `a_problem` makes them."""
    return by_chance(lambda chance: a_problem(chance, roles, components, plain))


def a_problem(
    chance: Chance, roles: int = 4, components: int = 5, plain: bool = False, hierarchy: Hierarchy | None = None
) -> Problem:
    """A problem small enough to enumerate, with everything that a template can say.

    Roles share candidates and order them each in their own way; components may share what is equal of their ports;
    cardinalities include none, two and without end; interactions may form cycles, feed a role from itself and name
    ports; free parameters may also be set.

    Every other problem is made around a cast: for each role as many components of their own as it asks for, which
    issue what their inputs need and allow a common value of each parameter. So it has a solution. All else is noise.
    The hierarchy is drawn, too, unless it is given. With `plain` each port has one type, each input must be fed, and
    none states a condition.
    """
    solvable = chance.flip()
    kinds_of_port = () if plain else SOLVABLE if solvable else ODD
    shared: dict[Ports, Ports] | None = {} if chance.flip() else None
    count = chance.number(1, roles)
    signals = SIGNALS[: chance.number(1, 4)]

    def ports(least: int) -> dict[str, IRI]:
        return {name: chance.one_of(signals) for name in chance.some(NAMES, least, 2)}

    made = [
        (ports(1) if chance.flip() else {}, ports(0), chance.some(CLASSES[3:], 0, 1))
        for _ in range(chance.number(min(count, components) if solvable else 0, components))
    ]
    number = len(made)
    variables = tuple(
        Variable(iri(f"v{k}"), tuple(iri(f"value{n}") for n in range(chance.number(1, 3))))
        for k in range(chance.one_of([0, 0, 1, 1, 2]))
    )
    parameters = tuple(
        Parameter(v.parameter, v.parameter.short, in_shape=True, is_set=chance.flip()) for v in variables
    )
    parts: list[Role] = []
    for k in range(count):
        parts.append(_role(chance, k, parameters, number - sum(p.minimum for p in parts) if solvable else 2))
    pairs = [(a, b) for a in range(count) for b in range(count)]
    chosen = chance.some(pairs, count - 1, 3 * count)
    port = [None, None, None, *NAMES[:2]]
    interactions = [
        Interaction(parts[a].iri, parts[b].iri, chance.one_of(port), chance.one_of(port)) for a, b in chosen
    ]
    if hierarchy is None:
        edges = [(chance.one_of(CLASSES), chance.one_of(CLASSES)) for _ in range(chance.number(0, 3))]
        hierarchy = Hierarchy(edges) if chance.flip() else NOTHING_ABOVE
    cast: Cast = [()] * count
    if solvable:
        cast = _cast(chance, parts, number)
        players = dict(zip([role.iri for role in parts], cast, strict=True))
        inputs, outputs = [one[0] for one in made], [one[1] for one in made]
        _feed(chance, players, interactions, inputs, outputs, hierarchy)
    sent, taken = ({}, {}) if plain else _requests(chance, solvable, hierarchy)
    profiles = [
        Profile(
            iri(f"c{k}"),
            ports=_once(
                Ports(
                    tuple(
                        _needing(_input(chance, *one, kinds_of_port), sent, hierarchy) for one in sorted(wanted.items())
                    ),
                    tuple(_offering(_output(chance, *one, kinds_of_port), taken) for one in sorted(issued.items())),
                ),
                shared,
            ),
            parameters=tuple(OperationalParameter("goal", kind) for kind in set_),
        )
        for k, (wanted, issued, set_) in enumerate(made)
    ]
    common = [1 << chance.below(len(variable.domain)) for variable in variables]
    candidates = tuple(_candidates(chance, profiles, variables, players, common) for players in cast)
    template = Template(
        iri("template"), tuple(parts), tuple(interactions), (*parameters, Parameter(iri("goal"), "goal"))
    )
    task = Task(template, {iri("goal"): Literal("(AT BEDROOM)")})
    stating = [
        [v for k, v in enumerate(variables) if any(c.admits[k] != ANY_VALUE for c in some)] for some in candidates
    ]
    mentions = tuple(tuple(Mention(variable.parameter) for variable in some) for some in stating)
    return Problem(task, Partition(candidates, variables, mentions=mentions), hierarchy)


def _input(chance: Chance, name: str, signal: IRI, kinds: Sequence[str]) -> Input:
    """Return an input that takes a signal; of a kind, perhaps others, perhaps nothing, and perhaps on a condition."""
    if not kinds:
        return Input(name, (signal,))
    kind = chance.one_of(kinds)
    unit, frame = _stated(chance, kind)
    condition = Condition(unit, frame, SHAPE if kind == "shape" else None)
    signals = {signal, chance.one_of(SIGNALS)} if kind == "more" else {signal}
    return Input(
        name,
        () if kind == "untyped" else tuple(sorted(signals)),
        None,
        kind == "optional",
        None if condition == Condition() else condition,
    )


def _output(chance: Chance, name: str, signal: IRI, kinds: Sequence[str]) -> Output:
    """Return an output of a signal; of a kind, perhaps of others too, with a unit, a frame or neither."""
    if not kinds:
        return Output(name, (signal,))
    kind = chance.one_of(kinds)
    unit, frame = _stated(chance, kind)
    conforms = frozenset((SHAPE,) if "other" not in kinds or chance.flip() else ())
    signals = {signal, chance.one_of(SIGNALS)} if kind == "more" else {signal}
    return Output(name, () if kind == "untyped" else tuple(sorted(signals)), None, unit, frame, conforms)


Requests = Mapping[IRI, IRI | None]
"""The signals that are answers to calls in a problem, each with what is sent along."""


def _requests(chance: Chance, solvable: bool, hierarchy: Hierarchy) -> tuple[Requests, Requests]:
    """Return which signals are answers to calls, with what is sent along, and with what is taken.

    In a problem that is to have a solution, all operations take one request, and what is sent is that or below it; and
    where there is a hierarchy, either all signals are answers or none.
    """
    some = chance.one_of([[], [], SIGNALS, SIGNALS[:2]])
    if solvable and hierarchy is not NOTHING_ABOVE and some:
        some = SIGNALS
    requests: list[IRI | None] = [None, *CLASSES]
    if not solvable:
        sent_, taken_ = ({signal: chance.one_of(requests) for signal in some} for _ in range(2))
        return sent_, taken_
    taken = chance.one_of(requests)
    sent = [None] if taken is None else [one for one in CLASSES if hierarchy.matches(one, taken)]
    return {signal: chance.one_of(sent) for signal in some}, dict.fromkeys(some, taken)


def _needing(port: Input, requests: Requests, hierarchy: Hierarchy) -> Input:
    """Return an input as an operation that is needed, if its first signal is the answer to a call."""
    if not port.signals or port.signals[0] not in requests:
        return port
    request = requests[port.signals[0]]
    sent = SentRequest(request, frozenset(() if request is None else hierarchy.superclasses(request)))
    answers = tuple(sorted(Operation.of(one) for one in port.signals if one in requests))
    return port._replace(signals=answers, condition=(port.condition or Condition())._replace(sent=sent))


def _offering(port: Output, requests: Requests) -> Output:
    """Return an output as an operation that is offered, if its first signal is the answer to a call."""
    if not port.signals or port.signals[0] not in requests:
        return port
    answers = tuple(sorted(Operation.of(one) for one in port.signals if one in requests))
    return port._replace(signals=answers, request=requests[port.signals[0]])


def _stated(chance: Chance, kind: str) -> tuple[IRI | None, Term | None]:
    """Return the unit and the frame that a port of some kind states."""
    number = int(kind == "other")
    which = chance.one_of(["unit", "frame"]) if number else kind
    return (UNITS[number] if which == "unit" else None), (FRAMES[number] if which == "frame" else None)


def _once(ports: Ports, shared: dict[Ports, Ports] | None) -> Ports:
    return ports if shared is None else shared.setdefault(ports, ports)


def _role(chance: Chance, number: int, parameters: Sequence[Parameter], most: int) -> Role:
    minimum = min(most, chance.one_of([1, 1, 1, 1, 0, 2]))
    maximum = chance.one_of([minimum, minimum, minimum + 1, None])
    value: Term = Literal("1") if chance.flip() else iri("goal")
    settings_: tuple[Setting, ...] = (Setting(iri("Goal"), value),) if chance.flip() else ()
    for parameter in parameters:
        if parameter.is_set and chance.flip():
            settings_ = (*settings_, Setting(iri("Goal"), parameter.iri))
    return Role(iri(f"r{number}"), minimum, maximum, settings_)


def _cast(chance: Chance, roles: Sequence[Role], number: int) -> Cast:
    """As many components of their own for each role as it asks for."""
    order = iter(chance.order(range(number)))
    return [list(islice(order, role.minimum)) for role in roles]


def _feed(
    chance: Chance,
    players: Mapping[IRI, Sequence[int]],
    interactions: list[Interaction],
    inputs: Sequence[Mapping[str, IRI]],
    outputs: Sequence[dict[str, IRI]],
    hierarchy: Hierarchy,
) -> None:
    """Give a cast the outputs that its inputs need, and a plain interaction where there is none that could do."""
    for role, some in players.items():
        for wanted, signal in [port for player in some for port in inputs[player].items()]:
            below = [one for one in SIGNALS if hierarchy.matches(one, signal)]
            ways = [
                way
                for interaction in interactions
                if interaction.sink == role and interaction.input in (None, wanted)
                for way in _ways(interaction, players, outputs, below)
            ]
            if not ways:
                source = chance.one_of([one for one, others in players.items() if others])
                interactions.append(Interaction(source, role))
                ways = _ways(interactions[-1], players, outputs, below)
            issued, name = chance.one_of(ways)
            issued.setdefault(name, chance.one_of(below))


def _ways(
    interaction: Interaction,
    players: Mapping[IRI, Sequence[int]],
    outputs: Sequence[dict[str, IRI]],
    signals: Sequence[IRI],
) -> list[tuple[dict[str, IRI], str]]:
    """The outputs, there or not yet, by which a player may issue one of some signals along an interaction."""
    ways = []
    for issued in [outputs[player] for player in players[interaction.source]]:
        name = interaction.output or next(one for one in FURTHER if one not in issued)
        if issued.get(name) in (None, *signals):
            ways.append((issued, name))
    return ways


def _candidates(
    chance: Chance,
    profiles: Sequence[Profile],
    variables: Sequence[Variable],
    players: Sequence[int],
    common: Sequence[int],
) -> tuple[Candidate, ...]:
    """Return the candidates of a role in an order of its own.

    Components that are meant to play it are among them, and admit the common value of each variable.
    """
    order = chance.order(range(len(profiles))) if chance.flip() else range(len(profiles))
    left_out = set(chance.some(NUMBERS, 0, 1)) - set(players)
    return tuple(
        Candidate(
            profiles[number],
            tuple(
                _allowed(chance, variable) | (bit if number in players else 0)
                for variable, bit in zip(variables, common, strict=True)
            ),
        )
        for number in order
        if number not in left_out
    )


def _allowed(chance: Chance, variable: Variable) -> int:
    some = chance.below(1 << len(variable.domain))
    return ~some if not some or chance.below(4) == 0 else some


def packings() -> st.SearchStrategy[Problem]:
    """Problems as `a_packing` makes them."""
    return by_chance(a_packing)


def a_packing(chance: Chance) -> Problem:
    """A problem of one or two roles of several slots, whose candidates mostly admit values of their own.

    So two exclude each other where they constrain one variable, as dominoes do that would lie on one field.
    """
    sizes = [chance.number(2, 7) for _ in range(chance.number(1, 2))]
    many, each = chance.number(2, 6), chance.number(1, 3)
    own = [0] * many
    parts = []
    for role, size in enumerate(sizes):
        some = []
        for number in range(size):
            masks = [ANY_VALUE] * many
            for variable in chance.some(range(many), min(each, many), min(each + chance.below(2), many)):
                masks[variable] = 1 << own[variable]
                own[variable] += 1
                if not chance.below(30):
                    masks[variable] |= 1  # a value that another one has, too
            some.append(Candidate(Profile(iri(f"c{role}.{number}")), tuple(masks)))
        parts.append(tuple(some))
    width = max(own)
    variables = tuple(Variable(iri(f"v{k}"), tuple(iri(f"v{k}.{n}") for n in range(width))) for k in range(many))
    asked = [chance.number(1, min(4, size)) for size in sizes]
    template = Template(
        iri("template"),
        tuple(Role(iri(f"r{k}"), slots, slots) for k, slots in enumerate(asked)),
        (),
        tuple(Parameter(one.parameter, one.parameter.short, in_shape=True) for one in variables),
    )
    return Problem(Task(template), Partition(tuple(parts), variables))


def rivalries(roles: int = 5, values: int = 4) -> st.SearchStrategy[Problem]:
    """Problems as `a_rivalry` makes them."""
    return by_chance(lambda chance: a_rivalry(chance, roles, values))


def a_rivalry(chance: Chance, roles: int = 5, values: int = 4) -> Problem:
    """A problem whose roles exclude each other's candidates, pair by pair, through named inputs; some share components.

    Half of the pairs must differ, as pigeons do; what the others may not be together is drawn.
    """
    count, size = chance.number(2, roles), chance.number(2, values)
    domains = [sorted(chance.some(range(size), 1, size)) for _ in range(count)]
    pairs = [(a, b) for a in range(count) for b in range(a) if chance.below(4)]
    shared = {chance.below(size)} if chance.flip() else set()
    inputs: dict[tuple[int, int], list[Input]] = {}
    outputs: dict[tuple[int, int], list[Output]] = {}
    for sink, source in pairs:
        differ = chance.flip()
        for value in domains[sink]:
            signal = iri(f"s{source}.{sink}.{value}")
            inputs.setdefault((sink, value), []).append(Input(f"from{source}", (signal,)))
            for other in domains[source]:
                if value != other if differ else chance.below(4):
                    outputs.setdefault((source, other), []).append(Output(f"to{sink}.{value}", (signal,)))
    candidates = []
    for role, domain in enumerate(domains):
        some = []
        for value in domain:
            ports = Ports(tuple(inputs.get((role, value), ())), tuple(outputs.get((role, value), ())))
            # One component has the same ports in all roles: so only those without any can be shared here.
            name = f"c{value}" if value in shared and ports == Ports() else f"c{role}.{value}"
            some.append(Candidate(Profile(iri(name), ports=ports)))
        candidates.append(tuple(some))
    asked = [2 if len(domain) > 1 and not chance.below(10) else 1 for domain in domains]
    template = Template(
        iri("template"),
        tuple(Role(iri(f"r{k}"), minimum, minimum) for k, minimum in enumerate(asked)),
        tuple(Interaction(iri(f"r{b}"), iri(f"r{a}"), None, f"from{b}") for a, b in pairs),
    )
    return Problem(Task(template), Partition(tuple(candidates)))
