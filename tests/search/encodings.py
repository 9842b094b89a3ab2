"""The semantics as rules of answer set programming: an oracle that enumerates nothing and shares no code.

Facts are taken from the task, the partition and the hierarchy. A solution with the minima is an answer set; the
candidates of a role are weighed one level after another, so that the one that is most has the least candidate at the
first level where two solutions differ, which is the order of solutions slot by slot.
"""

from __future__ import annotations

from collections.abc import Iterator

import clingo

from selfconf.model.partition import ANY_VALUE
from selfconf.model.profile import Profile
from selfconf.search.problem import Problem

RULES = """
K { plays(R,N) : candidate(R,N,_) } K :- role(R,K).
:- component(C), 2 { plays(R,N) : candidate(R,N,C) }.
fed(R,N,I) :- plays(R,N), candidate(R,N,C), input(C,I), takes(C,I,T), feeds(Q,O,R,I), issues(Q,D,O,T),
    not unfit(D,O,C,I).
fed(R,N,I) :- plays(R,N), candidate(R,N,C), input(C,I), link_between(Q,O,R,I), plays(Q,M), candidate(Q,M,D),
    output(D,O), not both_typed(D,O,C,I), not unfit(D,O,C,I).
both_typed(D,O,C,I) :- of(D,O,_), takes(C,I,_).
issues(Q,C,O,U) :- plays(Q,N), candidate(Q,N,C), of(C,O,T), at_or_below(T,U).
unfit(D,O,C,I) :- stated(D,O,K,V), asked(C,I,K,W), V != W.
unfit(D,O,C,I) :- accepts(C,I,S), output(D,O), not conforms(D,O,S).
unfit(D,O,C,I) :- sends(C,I,S), receives(D,O,T), not at_or_below(S,T).
feeds(Q,O,R,I) :- link(Q,R), output(_,O), input(_,I).
feeds(Q,O,R,I) :- link_from(Q,O,R), input(_,I).
feeds(Q,O,R,I) :- link_to(Q,R,I), output(_,O).
feeds(Q,O,R,I) :- link_between(Q,O,R,I).
:- plays(R,N), candidate(R,N,C), input(C,I), not optional(C,I), not fed(R,N,I).
1 { value(V,K) : domain(V,K) } 1 :- variable(V).
:- plays(R,N), constrained(R,N,V), value(V,K), not allows(R,N,V,K).
#maximize { 1@L : plays(R,N), level(R,N,L) }.
#show plays/2.
"""
NOTHING = "nothing"
"""What is sent along where nothing is."""


def first(problem: Problem) -> list[tuple[int, int]] | None:
    """The least solution as pairs of a role and the number of a candidate, slot by slot; None if there is none."""
    control = clingo.Control(["--warn=none"])
    control.add("base", [], RULES + "\n".join(_facts(problem)))
    control.ground([("base", [])])
    found: list[tuple[int, int]] | None = None
    with control.solve(yield_=True) as models:
        for model in models:
            pairs = [symbol.arguments for symbol in model.symbols(shown=True)]
            found = sorted((role.number, number.number) for role, number in pairs)
    return found


def _facts(problem: Problem) -> Iterator[str]:
    task, hierarchy = problem.task, problem.hierarchy
    place = {role.iri: number for number, role in enumerate(task.template.roles)}
    described: set[str] = set()
    signals: set[str] = set()
    level = sum(len(candidates) for candidates in problem.partition.candidates)
    for number, role in enumerate(task.template.roles):
        yield f"role({number},{role.minimum})."
        for index, candidate in enumerate(problem.partition.candidates[number]):
            profile = candidate.profile
            name = f'"{profile.component}"'
            yield f"candidate({number},{index},{name}). level({number},{index},{level})."
            level -= 1
            for variable, mask in enumerate(candidate.admits):
                if mask != ANY_VALUE:
                    yield f"constrained({number},{index},{variable})."
                    values = [k for k in _values(problem, variable) if mask >> k & 1]
                    yield from (f"allows({number},{index},{variable},{k})." for k in values)
            if profile.component not in described:
                described.add(profile.component)
                yield f"component({name})."
                yield from _port_facts(profile)
                signals |= {signal for port in profile.outputs for signal in port.signals}
                signals |= {port.request for port in profile.inputs if port.request is not None}
    yield f'at_or_below("{NOTHING}","{NOTHING}").'
    for signal in signals:
        yield from (f'at_or_below("{signal}","{above}").' for above in hierarchy.superclasses(signal))
    for interaction in task.template.interactions:
        source, sink = place[interaction.source], place[interaction.sink]
        output, wanted = f'"{interaction.output}"', f'"{interaction.input}"'
        if interaction.output and interaction.input:
            yield f"link_between({source},{output},{sink},{wanted})."
        elif interaction.output:
            yield f"link_from({source},{output},{sink})."
        elif interaction.input:
            yield f"link_to({source},{sink},{wanted})."
        else:
            yield f"link({source},{sink})."
    for number in range(len(problem.partition.variables)):
        yield f"variable({number})."
        yield from (f"domain({number},{k})." for k in _values(problem, number))


def _values(problem: Problem, variable: int) -> range:
    """The numbers of the values of a variable, the last of them, unless it is set, a value that no candidate names."""
    one = problem.variables[variable]
    is_set = any(p.is_set for p in problem.task.template.parameters if p.iri == one.parameter)
    return range(len(one.domain) + (not is_set))


def _port_facts(profile: Profile) -> Iterator[str]:
    """The ports of a component: their types, what they state of unit and frame, and the shapes."""
    for port in profile.inputs:
        name = f'"{profile.component}","{port.name}"'
        yield f"input({name})."
        yield from (f'takes({name},"{signal}").' for signal in port.signals)
        if port.optional:
            yield f"optional({name})."
        unit, frame, shape, sent = port.condition or (None, None, None, None)
        if sent is not None:
            yield f'sends({name},"{sent.type or NOTHING}").'
        yield from (f'asked({name},{kind},"{value}").' for kind, value in (("unit", unit), ("frame", frame)) if value)
        if shape:
            yield f'accepts({name},"{shape}").'
    for output in profile.outputs:
        name = f'"{profile.component}","{output.name}"'
        yield f"output({name})."
        yield from (f'of({name},"{signal}").' for signal in output.signals)
        if output.signals:
            yield f'receives({name},"{output.request or NOTHING}").'
        stated = (("unit", output.unit), ("frame", output.frame))
        yield from (f'stated({name},{kind},"{value}").' for kind, value in stated if value)
        yield from (f'conforms({name},"{shape}").' for shape in output.conforms)
