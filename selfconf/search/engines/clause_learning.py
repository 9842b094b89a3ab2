"""The one door to a clause-learning solver, for the instances on which depth-first search thrashes.

*Which library.* python-sat (MIT; Ignatiev, Morgado and Marques-Silva, SAT 2018), with its MiniCard (Liffiton and
Maglalang, SAT 2012): MiniSat 2.2 with "at most k of these hold" as a constraint of its own, which spares the clauses
that would count. python-sat has only pre-releases on the index, which is why it is an extra (`solvers`) and
why nothing else knows it; clingo has stable releases. But python-sat stops after a given number of *conflicts*, so
that a budget means the same on every machine; it imports in a fortieth of a second and starts in well under a
millisecond, an instance being a list of clauses and not a program to ground; and its lexicographic minimisation is
exact, where clingo's priorities saturate at 32,767 levels. Without it everything works, and hard instances end as
`Undecided` sooner.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from importlib.util import find_spec
from typing import Any

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.formula import FEW_TO_COUNT, AtMost, Counted, Implied
from selfconf.search.reduction import Constraint, Option, ReducedProblem

SOLVER = "Minicard"
"""The solver, by the name of its class in python-sat."""
SECOND_SOLVER = "Cadical195"
"""The solver that joins in, which gets cardinalities as clauses."""
PAIRED = 6
"""At most one of so many literals is written pair by pair, for a solver that cannot count."""
CONFLICTS_PER_CALL = 1_000
"""Conflicts for the first call of the solver about a question, hundredths of a second; the next has twice as many."""
LONGEST_CALL = 32_000
"""Conflicts for a call at most. What a solver can do within few is not what it can do within many, as it starts to
restart ever more rarely, and to keep ever more of what it has learned, with each call anew."""


@cache  # to look takes a tenth as long as a small search, and each search and each repair asks
def solver_available() -> bool:
    """Return whether the extra `solvers` is installed, as of the first call."""
    return find_spec("pysat") is not None


def as_clauses(literals: Sequence[int], most: int, top: int) -> list[list[int]]:
    """Return clauses by which at most a number of literals hold; new literals are numbered from `top` on."""
    from pysat.card import CardEnc, EncType, ITotalizer

    if most > FEW_TO_COUNT:
        # `CardEnc` would count to the number of literals, not to the bound: several times as many clauses.
        with ITotalizer(list(literals), ubound=most, top_id=top) as counter:
            return [[-counter.rhs[most]], *counter.cnf.clauses]
    kind = EncType.pairwise if most == 1 and len(literals) <= PAIRED else EncType.seqcounter
    return list(CardEnc.atmost(list(literals), most, top_id=top, encoding=kind).clauses)


_CALLING: dict[int, ClauseSolver] = {}
"""The solver that is in a call, by the thread that waits for it."""
_CALLS = threading.Lock()
"""Held by who begins or ends a call: none is interrupted after its end, when its solver may be freed."""


@contextmanager
def _in_call(solver: ClauseSolver) -> Iterator[None]:
    """In the block a solver is in a call of this thread."""
    with _CALLS:
        _CALLING[threading.get_ident()] = solver
    try:
        yield
    finally:
        with _CALLS:
            _CALLING.pop(threading.get_ident(), None)


def end_calls() -> None:
    """End the calls that go on in other threads, as if their conflicts were used up; each may be made once more."""
    with _CALLS:
        for solver in _CALLING.values():
            solver.interrupt()


class ClauseSolver:
    """A reduced problem as clauses in an incremental solver; use it in a `with` statement."""

    def __init__(
        self,
        reduced: ReducedProblem,
        guarded: bool = False,
        distinct: bool = True,
        encoding: Encoding | None = None,
        solver: str | None = None,
        counted: Counted = Counted.NONE,
    ) -> None:
        from pysat import solvers

        self.reduced = reduced
        self._solver = getattr(solvers, solver or SOLVER)()
        self._model: list[int] = []
        self._propagates = solver in (None, SOLVER)
        self._interruptible = solver != SECOND_SOLVER
        self.conflicts = 0
        """How many conflicts the solver has met."""
        self._patience = CONFLICTS_PER_CALL
        """How many conflicts the next call has."""
        self._interrupted = False
        """Whether an interrupt has to be cleared after the call that it ends."""
        self._refuted: set[int] = set()
        """The literals of which propagation has shown that they cannot hold, whatever else does."""
        self.counted = counted
        """Which bounds are clauses that count."""
        encoding = encoding or Encoding(reduced, guarded, distinct)
        self.guards: dict[Constraint, int] = encoding.guards
        self.plays: tuple[tuple[int, ...], ...] = encoding.plays
        """For each role, the literals of its options."""
        self._top = 0
        self.extend(encoding.statements, encoding.top)
        for bound in encoding.bounds:
            self.at_most(*bound)
        self._solver.set_phases([literals[0] for literals in self.plays if literals])

    def __enter__(self) -> ClauseSolver:
        return self

    def __exit__(self, *_: object) -> None:
        self._solver.delete()

    def literal(self) -> int:
        """Return a new literal."""
        self._top += 1
        return self._top

    def add(self, clause: Iterable[int]) -> None:
        """Add a clause."""
        self._solver.add_clause(list(clause))

    def extend(self, statements: Iterable[list[int] | Implied], top: int) -> None:
        """Add statements of an encoding, whose highest literal is given, before any literal of this object's own."""
        self._top = top
        add = self._solver.add_clause
        for statement in statements:
            if isinstance(statement, Implied):
                literal = statement.literal
                for one in statement.literals:
                    add([-one, literal])
            else:
                add(statement)

    def prefer(self, literals: Iterable[int]) -> None:
        """Try these literals first, which changes the time alone."""
        self._solver.set_phases(list(literals))

    def at_most(self, literals: Sequence[int], most: int, force: Sequence[int] = (), exactly: bool = False) -> None:
        """Allow at most a number of the literals to hold, under the guards given; `exactly` if no fewer ever do."""
        if most >= len(literals):
            return
        counted = AtMost(literals, most, force, exactly).is_counted(self.counted)
        if not force and not counted and self._solver.supports_atmost():
            self._solver.add_atmost(list(literals), most)
            return
        clauses = as_clauses(literals, most, self._top)
        add = self._solver.add_clause
        for clause in clauses:
            add([*force, *clause])
        self._top = max(self._top, *map(max, clauses))

    def solve(self, assumed: Sequence[int], budget: Budget) -> bool | Undecided:
        """Return whether the clauses can hold under assumptions; each conflict is a step, and each call."""
        found: bool | None = None
        while found is None and budget.steps != 0:
            found = self.ask(assumed, budget)
        return Undecided(self.conflicts) if found is None else found

    def ask(self, assumed: Sequence[int], budget: Budget, most: int | None = None) -> bool | None:
        """Return whether the clauses can hold under assumptions; None if that takes more conflicts than a call may."""
        # The solver handles no signal inside a call, so that calls have to end for Ctrl-C to be heard, and, where no
        # other thread ends them (`end_calls`), for a time limit to be kept. Were no interrupt expected, it would catch
        # Ctrl-C itself, and raise an error of its own. As calls about a question double, either is late by no more than
        # the time that the question has taken already.
        before = self.conflicts
        self._solver.conf_budget(min(some for some in (self._patience, most, budget.steps) if some is not None))
        with _in_call(self):
            found: bool | None = self._solver.solve_limited(assumptions=list(assumed), expect_interrupt=True)
        if self._interrupted:
            self._solver.clear_interrupt()
            self._interrupted = False
        self._patience = min(2 * self._patience, LONGEST_CALL) if found is None else CONFLICTS_PER_CALL
        self.conflicts = int(self._solver.accum_stats()["conflicts"])
        budget.spend(1 + self.conflicts - before)
        if found:
            self._model = self._solver.get_model()
        return found

    def settle(self, literals: Sequence[int]) -> None:
        """Let literals hold from now on, which can hold together."""
        # What follows from them is noted before, as the solver does not say of what follows from nothing that it does.
        self._refuted.update([-literal for literal in self.implied(literals) or ()])
        for literal in literals:
            self.add([literal])

    def refutes(self, literal: int) -> bool:
        """Return whether propagation shows that a literal cannot hold; False if the solver would have to search."""
        if literal in self._refuted:
            return True
        if not self._propagates:
            return False
        possible, implied = self._solver.propagate((literal,))
        if not possible:
            self._refuted.add(literal)
            if implied:
                self.add([-literal])  # else the solver knows already
        return not possible

    def implied(self, literals: Sequence[int]) -> set[int] | None:
        """Return what follows from literals by propagation, but not without them; None if they cannot hold together."""
        if not self._propagates:
            return set()
        possible, implied = self._solver.propagate(literals)
        return set(implied) if possible else None

    def interrupt(self) -> None:
        """End the call that goes on in another thread, or else the next one, as if its conflicts were used up.

        python-sat cannot interrupt the second solver, the calls of which go on until they are.
        """
        if self._interruptible:
            self._solver.interrupt()
            self._interrupted = True  # afterwards: else the call that ends just now would clear it before it is there

    def maximise(self, literals: Sequence[int], budget: Budget) -> bool:
        """Make as many of the literals hold as can hold, from the last model upwards; False if the budget ends before.

        The bound stays in force, at what was reached.
        """
        from pysat.card import ITotalizer

        missing = sum(not self.holds(literal) for literal in literals)
        if not missing:
            for literal in literals:
                self.add([literal])
            return True
        with ITotalizer([-literal for literal in literals], ubound=missing, top_id=self._top) as counter:
            self._top = max(self._top, counter.top_id)
            for clause in counter.cnf.clauses:
                self.add(clause)
            found: bool | Undecided = True
            while missing and found is True:
                found = self.solve((-counter.rhs[missing - 1],), budget)
                if found is True:
                    missing = sum(not self.holds(literal) for literal in literals)
            if missing < len(literals):
                self.add([-counter.rhs[missing]])
        return not isinstance(found, Undecided)

    def counter(self, literals: Sequence[int], stack: ExitStack) -> Any:
        """Return a totalizer over literals, for `at_least` to count with; it lives as long as the stack."""
        from pysat.card import ITotalizer

        counter = stack.enter_context(ITotalizer(list(literals), ubound=1, top_id=self._top))
        self._top = max(self._top, counter.top_id)
        for clause in counter.cnf.clauses:
            self.add(clause)
        return counter

    def at_least(self, counter: Any, number: int) -> int:
        """Return the literal that holds whenever this number (two or more) of a totalizer's literals hold."""
        if number - 1 > counter.ubound:
            counter.increase(ubound=number - 1, top_id=self._top)
            self._top = max(self._top, counter.top_id)
            for clause in counter.cnf.clauses[-counter.nof_new :] if counter.nof_new else ():
                self.add(clause)
        return int(counter.rhs[number - 1])

    def holds(self, literal: int) -> bool:
        """Return whether a literal holds in the last model."""
        place = abs(literal) - 1
        return (place < len(self._model) and self._model[place] > 0) == (literal > 0)

    def holding(self, literals: Sequence[int]) -> list[int]:
        """Return those of some variables that hold in the last model: to ask one by one takes several times as long."""
        model = self._model
        known = len(model)
        return [literal for literal in literals if literal <= known and model[literal - 1] > 0]

    def core(self) -> set[int]:
        """Return assumptions of the last call that cannot hold together: an unsatisfiable core, not a minimal one."""
        return set(self._solver.get_core() or ())

    def chosen(self) -> list[Option]:
        """Return the solution that the last model is."""
        return [
            option
            for options, literals in zip(self.reduced.options, self.plays, strict=True)
            for option, literal in zip(options, literals, strict=True)
            if self.holds(literal)
        ]
