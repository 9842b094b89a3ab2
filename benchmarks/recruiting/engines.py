"""The fewest services that answer a request, by general solvers: each gets the problem as its users would write it.

Both get concepts only where an input or the request asks for them or for what lies above, and services only where they
can be fed and lead to the request: what any user would leave out before writing a model. They are asked for the fewest,
not for the first of these. Building the model is part of the time, importing a library is not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec

from benchmarks.recruiting.services import Services

LIMIT = 20.0
"""Seconds for an answer."""


@dataclass(frozen=True)
class Relevant:
    """The services that can be fed and lead to the request, with the concepts that matter to these."""

    inputs: Mapping[str, frozenset[int]]
    outputs: Mapping[str, frozenset[int]]
    """Of each service the concepts that its outputs serve, as far as one is asked for."""
    wanted: frozenset[int]

    @classmethod
    def of(cls, given: Services) -> Relevant:
        """Forward chaining from what needs nothing, then backward from the request."""
        served = {
            name: frozenset(high for low in outputs for high in given.above(low))
            for name, (_, outputs) in given.services.items()
        }
        waiting: dict[int, list[str]] = {}
        lacking = {name: len(set(inputs)) for name, (inputs, _) in given.services.items()}
        for name, (inputs, _) in given.services.items():
            for concept in set(inputs):
                waiting.setdefault(concept, []).append(name)
        fed = [name for name, count in lacking.items() if not count]
        known: set[int] = set()
        for name in fed:  # grows as services become fed
            for concept in served[name] - known:
                known.add(concept)
                for other in waiting.get(concept, ()):
                    lacking[other] -= 1
                    if not lacking[other]:
                        fed.append(other)
        issuers: dict[int, list[str]] = {}
        for name in fed:
            for concept in served[name]:
                issuers.setdefault(concept, []).append(name)
        asked = list(given.wanted)
        leading: set[str] = set()
        seen = set(asked)
        while asked:
            for name in set(issuers.get(asked.pop(), ())) - leading:
                leading.add(name)
                more = set(given.services[name][0]) - seen
                seen |= more
                asked += more
        return cls(
            {name: frozenset(given.services[name][0]) for name in sorted(leading)},
            {name: served[name] & seen for name in sorted(leading)},
            frozenset(given.wanted),
        )

    @cached_property
    def issuers(self) -> Mapping[int, list[str]]:
        """For each concept the services that issue it."""
        found: dict[int, list[str]] = {}
        for name, concepts in self.outputs.items():
            for concept in concepts:
                found.setdefault(concept, []).append(name)
        return found


PROGRAM = """
{ use(S) } :- service(S), known(C) : in(S,C).
known(C) :- use(S), out(S,C).
:- wanted(C), not known(C).
#minimize { 1,S : use(S) }.
"""


def clingo(given: Services) -> list[str] | None:
    """Answer set programming (Potassco): that nothing is known in a circle is what its semantics says by itself."""
    import clingo as asp

    relevant = Relevant.of(given)
    number = {name: k for k, name in enumerate(relevant.inputs)}
    facts = [f"service({k})." for k in number.values()]
    facts += [f"in({number[name]},{c})." for name, concepts in relevant.inputs.items() for c in concepts]
    facts += [f"out({number[name]},{c})." for name, concepts in relevant.outputs.items() for c in concepts]
    facts += [f"wanted({c})." for c in relevant.wanted]
    control = asp.Control(["--warn=none"])
    control.add("base", [], PROGRAM + "\n".join(facts))
    control.ground([("base", [])])
    found: list[str] | None = None
    names = list(number)
    with control.solve(yield_=True) as models:
        for model in models:
            used = [one.arguments[0].number for one in model.symbols(atoms=True) if one.name == "use"]
            found = [names[k] for k in used]
    return found


def cp_sat(given: Services) -> list[str] | None:
    """CP-SAT (OR-Tools) with one thread: a place for each service, and each input has a source that comes before."""
    from ortools.sat.python import cp_model

    relevant = Relevant.of(given)
    model = cp_model.CpModel()
    use = {name: model.new_bool_var("") for name in relevant.inputs}
    place = {name: model.new_int_var(0, len(use), "") for name in use}
    for name, concepts in relevant.inputs.items():
        for concept in concepts:
            sources = []
            for issuer in relevant.issuers[concept]:
                if issuer != name:
                    source = model.new_bool_var("")
                    model.add_implication(source, use[issuer])
                    model.add(place[issuer] < place[name]).only_enforce_if(source)
                    sources.append(source)
            model.add_bool_or([use[name].negated(), *sources])
    for concept in relevant.wanted:
        model.add_bool_or([use[name] for name in relevant.issuers[concept]])
    model.minimize(sum(use.values()))
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    if solver.solve(model) != cp_model.OPTIMAL:
        return None
    return [name for name, literal in use.items() if solver.value(literal)]


Engine = Callable[[Services], "list[str] | None"]
_ALL: Mapping[str, tuple[Engine, str]] = {"clingo": (clingo, "clingo"), "CP-SAT": (cp_sat, "ortools")}
"""The general solvers, each with its package."""
ENGINES: Mapping[str, Engine] = {name: engine for name, (engine, package) in _ALL.items() if find_spec(package)}
"""Those that are installed."""
PACKAGES = tuple(_ALL[name][1] for name in ENGINES)
