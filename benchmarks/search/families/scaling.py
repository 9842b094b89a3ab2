"""Families that grow in one number, by which the search is compared with other engines and its thresholds are tuned."""

from __future__ import annotations

import random
from collections.abc import Iterator

from benchmarks.search.families.wiring import iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.template import Task
from selfconf.search.problem import Problem

NAVIGATION = ((0, 3), (1, 3), (2, 3), (3, 4))


def navigation(candidates: int, seed: int, solvable: bool = True) -> Problem:
    """The paper's template: sonar, encoder, position, control, drive. Few different ports, as in a real ecology.

    Every third sensor speaks an older dialect, every fourth controller wants a signal that is rare: only the last
    position sensor has it, so that the first candidates do not just fit. Unsolvable: nobody issues what drives want.
    """
    rng = random.Random(seed)
    dialect = [["scan", "range"], ["odometry", "ticks"], ["pose", "place"]]
    sensors = [
        [
            Candidate(profile(f"{kinds[0]}{k:06}", outputs=[kinds[0] if rng.random() < 0.67 else kinds[1]]))
            for k in range(candidates)
        ]
        for kinds in dialect
    ]
    sensors[2][-1] = Candidate(profile(f"pose{candidates:06}", outputs=["map", "pose"]))
    wanted = ["scan", "odometry", "map"]
    control = [
        Candidate(profile(f"control{k:06}", wanted if rng.random() < 0.25 else ["range", "ticks", "map"], ["velocity"]))
        for k in range(candidates)
    ]
    drive = [Candidate(profile(f"drive{k:06}", ["velocity" if solvable else "torque"])) for k in range(candidates)]
    return made([*sensors, control, drive], NAVIGATION)


def graph(kind: str, roles: int, candidates: int, signals: int, seed: int) -> Problem:
    """A chain, a tree or a random acyclic graph: everybody issues and wants one of a few signals per neighbour."""
    rng = random.Random(seed)
    edges = list(_edges(kind, roles, rng))
    feeders = [[a for a, b in edges if b == role] for role in range(roles)]
    parts = [
        [
            Candidate(
                profile(
                    f"c{role:03}.{k:05}",
                    [f"{source}.{rng.randrange(signals)}" for source in feeders[role]],
                    [f"{role}.{rng.randrange(signals)}"],
                )
            )
            for k in range(candidates)
        ]
        for role in range(roles)
    ]
    return made(parts, edges)


def _edges(kind: str, roles: int, rng: random.Random) -> Iterator[tuple[int, int]]:
    for role in range(1, roles):
        if kind == "chain":
            yield role - 1, role
        elif kind == "tree":
            yield role, (role - 1) // 2
        else:
            for source in sorted(rng.sample(range(role), min(role, 2))):
                yield source, role


def distinct(roles: int, components: int) -> Problem:
    """So many roles that share so many components, and nothing else."""
    everybody = [Candidate(profile(f"c{k:04}")) for k in range(components)]
    return made([everybody] * roles, ())


def scarce(roles: int, share: float, seed: int) -> Problem:
    """As many components as roles, and each role takes a share of them, so that all can be matched."""
    rng = random.Random(seed)
    everybody = [Candidate(profile(f"c{k:04}")) for k in range(roles)]
    sure = rng.sample(range(roles), roles)
    return made([[c for k, c in enumerate(everybody) if k == own or rng.random() < share] for own in sure], ())


def satisfiability(variables: int, ratio: float, seed: int) -> Problem:
    """Random 3-SAT as one sink: a feeder role per variable with two candidates, an input per clause."""
    rng = random.Random(seed)
    gives: dict[tuple[int, bool], list[str]] = {(v, sign): [] for v in range(variables) for sign in (False, True)}
    clauses = round(variables * ratio)
    for clause in range(clauses):
        for variable in rng.sample(range(variables), 3):
            gives[variable, rng.random() < 0.5].append(f"clause{clause}")
    feeders = [
        [Candidate(profile(f"x{v:04}.{int(sign)}", outputs=gives[v, sign])) for sign in (False, True)]
        for v in range(variables)
    ]
    sink = [Candidate(profile("sink", [f"clause{k}" for k in range(clauses)]))]
    return made([*feeders, sink], [(v, variables) for v in range(variables)])


def missing(roles: int, candidates: int, seed: int) -> Problem:
    """A random graph in which one signal that every candidate of the last role wants is issued by nobody."""
    problem = graph("graph", roles, candidates, 2, seed)
    last = [Candidate(profile(f"last{k:05}", ["nothing", f"{roles - 2}.0"])) for k in range(candidates)]
    template = problem.task.template
    partition = Partition((*problem.candidates[:-1], tuple(last)))
    return Problem(Task(template), partition)


def fleet(robots: int, candidates: int, seed: int) -> Problem:
    """The paper's template with the robot left unbound; only the last robot has every part; candidates per role."""
    rng = random.Random(seed)
    domain = tuple(iri(f"robot{k:04}") for k in range(robots))
    variable = Variable(iri("robot"), domain)
    lacks = [rng.randrange(5) if k < robots - 1 else None for k in range(robots)]
    told: list[tuple[list[str], list[str]]] = [
        ([], ["scan"]),
        ([], ["odometry"]),
        ([], ["pose"]),
        (["scan", "odometry", "pose"], ["velocity"]),
        (["velocity"], []),
    ]
    only, any_robot = [(1 << k,) for k in range(robots)], (ANY_VALUE,)
    parts = []
    for role, (inputs, outputs) in enumerate(told):
        owners = [k for k in range(robots) if lacks[k] != role]
        part = []
        for k in range(candidates):
            robot = owners[k % len(owners)]
            admits = any_robot if role == 2 and k % 10 == 0 else only[robot]
            part.append(Candidate(profile(f"part{role}.{k:06}", inputs, outputs), admits))
        parts.append(part)
    return made(parts, NAVIGATION, (variable,))
