"""One engine on one instance, in a process of its own, with a time limit.

Before its time begins, an engine solves some small problems: what a process pays for doing something for the first
time (importing, loading a shared library, copying pages after a fork) is in nobody's time.
"""

from __future__ import annotations

import gc
import multiprocessing
import resource
import time
import tracemalloc
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection

from benchmarks.search.engines import ENGINES, SMALL
from benchmarks.search.families import scaling as f
from benchmarks.search.families.coverage import cover
from benchmarks.search.first import First
from selfconf.model.profile import Input, Output
from selfconf.search.problem import Problem

Engine = Callable[[Problem], First]

WARMING = (
    f.navigation(3, 7001),
    f.navigation(2, 7001, solvable=False),
    f.satisfiability(50, 4.26, 7001),
    cover(60, 40, 9, 0.2, 500),
)
"""The last two for the engines that are not hopeless on them; on the very last one selfconf has all its solvers."""
QUICK = 0.3
"""Seconds; what is quicker is measured several times, and the shortest time counts."""


@dataclass(frozen=True)
class Measured:
    """Seconds, the answer (None: none within the limit) and the growth of memory in megabytes."""

    seconds: float
    answer: First | None
    memory: float = 0.0


def made(make: Callable[[], Problem]) -> Problem:
    """Make a problem once what is left of others is gone: the processes that are to solve it have a copy of all."""
    gc.collect()
    return make()


def measure(
    engine: str,
    problem: Problem,
    limit: float,
    times: int = 3,
    engines: Mapping[str, Engine] = ENGINES,
    traced: bool = True,
) -> Measured:
    """The time from the problem to the answer, building a model of it included, importing a library not.

    What selfconf allocates is counted in a second run of it, if that is `traced`, as long again as the limit at most.
    What is measured once is only to be seen to work, so its engine solves just one problem before.
    """
    traced = traced and engine == "selfconf"  # what it needs may fit into what making the problem has left free
    warming = WARMING[:1] if times == 1 else WARMING[:2] if engine in SMALL else WARMING
    found = _once(engines[engine], problem, limit, warming, traced)
    for _ in range(times - 1):
        if found.answer is not None and found.seconds < QUICK:
            again = _once(engines[engine], problem, limit, warming, traced)
            found = min(found, again, key=lambda one: (one.answer is None, one.seconds))
    return found


def _once(solved: Engine, problem: Problem, limit: float, warming: Sequence[Problem], traced: bool) -> Measured:
    context = multiprocessing.get_context("fork")
    receiving, sending = context.Pipe(duplex=False)
    gc.freeze()  # so that the child does not copy the pages of the problem as it counts references to nothing
    process = context.Process(target=_child, args=(solved, problem, sending, warming, traced))
    process.start()
    sending.close()
    found = Measured(limit, None)
    with suppress(EOFError):
        if receiving.poll(60) and receiving.recv() and receiving.poll(limit):
            found = receiving.recv()
            if traced and receiving.poll(limit):
                found = replace(found, memory=max(found.memory, receiving.recv()))
    process.kill()
    process.join()
    gc.unfreeze()
    return found


def _child(solved: Engine, problem: Problem, sending: Connection, warming: Sequence[Problem], traced: bool) -> None:
    _own(problem)
    for small in warming:
        solved(small)
    sending.send(True)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.perf_counter()
    answer = solved(problem)
    seconds = time.perf_counter() - start
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    sending.send(Measured(seconds, answer, grown))
    if traced:
        tracemalloc.start()
        solved(problem)
        sending.send(tracemalloc.get_traced_memory()[1] / 1024**2)
    sending.close()


def _own(problem: Problem) -> None:
    """Touch all of a problem, so that its pages are this process's own before anybody's time begins.

    A process that was forked off copies each page when it first counts a reference to something on it. Whoever has a
    problem in memory does not pay for that; every engine would, in proportion to what it looks at.
    """
    for role in (*problem.links, *problem.sources, *problem.sinks):
        _ = list(role)
    for candidates in problem.candidates:
        for candidate in candidates:
            profile = candidate.profile
            _ = [profile.component, profile.ports, *candidate.admits]
            ports: list[Input | Output] = [*profile.inputs, *profile.outputs]
            for port in ports:
                _ = [*port, *port.signals]
