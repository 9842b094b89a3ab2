"""The one door to a clause-learning solver, for the instances on which depth-first search thrashes.

*Which library.* python-sat (MIT; Ignatiev, Morgado and Marques-Silva, SAT 2018), with its MiniCard (Liffiton and
Maglalang, SAT 2012): MiniSat 2.2 with "at most k of these hold" as a constraint of its own, which spares the clauses
that would count. python-sat has only pre-releases on the index, which is why it is an extra (`solvers`) and
why nothing else knows it; clingo has stable releases. But python-sat stops after a given number of *conflicts*, so
that a budget means the same on every machine; it imports in a fortieth of a second and starts in well under a
millisecond, an instance being a list of clauses and not a program to ground; and its lexicographic minimisation is
exact, where clingo's priorities saturate at 32,767 levels. Without it everything works, and hard instances end as
`Undecided` sooner.

*Encoding.* A literal for each option: it plays; of two, the second plays iff the first does not. Each role is played
by exactly as many as it has slots; a component plays one role at most. An option with a need implies one of the options
that support it, by way of a literal for the need where several options have it.
A literal for each value of a variable, at most one of which holds: an option that constrains the variable implies one
of the values that it admits, or none of those that it does not admit.

*The least solution.* Slot by slot: given the choices so far and a model, ask for one in which an earlier option is
in the slot, until there is none. What is settled is added as a unit, so that everything learned stays true.

*Guards.* Each constraint may have a literal that puts it in force, to be assumed: the solver then names assumptions
that cannot hold together, an unsatisfiable core. A role that is not in force may still be played, so that fewer
constraints in force never make less possible.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from importlib.util import find_spec
from typing import Any

from selfconf.model.partition import ANY_VALUE
from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.reduction import Constraint, Distinct, Fed, Option, Played, ReducedProblem, Shared

SOLVER = "Minicard"
"""The solver, by the name of its class in python-sat."""
CONFLICTS_PER_CALL = 5_000
"""Conflicts for one call of the solver, a fraction of a second."""


def solver_available() -> bool:
    """Return whether the extra `solvers` is installed."""
    return find_spec("pysat") is not None


def any_by_clauses(reduced: ReducedProblem, budget: Budget) -> list[Option] | Undecided | None:
    """Return any solution, one option per slot; None if there is none; Undecided when the budget ends."""
    with ClauseSolver(reduced) as clauses:
        found = clauses.solve((), budget)
        return clauses.chosen() if found is True else None if found is False else found


def least_by_clauses(reduced: ReducedProblem, budget: Budget) -> list[Option] | Undecided | None:
    """Return the least solution, one option per slot; None if there is none; Undecided when the budget ends."""
    with ClauseSolver(reduced) as clauses:
        found = clauses.solve((), budget)
        return clauses.least(budget) if found is True else None if found is False else found


class ClauseSolver:
    """A reduced problem as clauses in an incremental solver; use it in a `with` statement."""

    def __init__(self, reduced: ReducedProblem, guarded: bool = False, distinct: bool = True) -> None:
        from pysat import solvers

        self.reduced = reduced
        self._solver = getattr(solvers, SOLVER)()
        self._top = 0
        self._model: list[int] = []
        self.guards: dict[Constraint, int] = {}
        self._guarded = guarded
        self._asked = Counter(reduced.slots)
        self.plays: tuple[tuple[int, ...], ...] = tuple(
            self._literals(role, len(options)) for role, options in enumerate(reduced.options)
        )
        """For each role, the literals of its options."""
        self._roles()
        if distinct:
            self._distinct()
        self._needs()
        self._values()
        self._solver.set_phases([literals[0] for literals in self.plays if literals])

    def __enter__(self) -> ClauseSolver:
        return self

    def __exit__(self, *_: object) -> None:
        self._solver.delete()

    def literal(self) -> int:
        """Return a new literal."""
        self._top += 1
        return self._top

    def _literals(self, role: int, options: int) -> tuple[int, ...]:
        """Return a literal for each option; of two options of which one must play, each is the other's negation."""
        # Not with guards: then the role may be left unplayed, so that neither option holds.
        if options == 2 and self._asked[role] == 1 and not self._guarded:
            first = self.literal()
            return first, -first
        before, self._top = self._top, self._top + options
        return tuple(range(before + 1, self._top + 1))

    def add(self, clause: Iterable[int]) -> None:
        """Add a clause."""
        self._solver.add_clause(list(clause))

    def prefer(self, literals: Iterable[int]) -> None:
        """Try these literals first, which changes the time alone."""
        self._solver.set_phases(list(literals))

    def _in_force(self, constraint: Constraint) -> list[int]:
        """Return what a clause of a constraint starts with: nothing, or that its guard does not hold."""
        if not self._guarded:
            return []
        guard = self.guards.get(constraint)
        if guard is None:
            guard = self.guards[constraint] = self.literal()
        return [-guard]

    def _roles(self) -> None:
        for role, asked in self._asked.items():
            literals = self.plays[role]
            force = self._in_force(Played(role))
            if len(literals) == 2 and literals[0] == -literals[1]:
                continue
            self.at_most(literals, asked)
            if len(literals) < asked:
                impossible = self.literal()
                self.add([*force, impossible])
                self.add([-impossible])
            elif asked == 1:
                self.add([*force, *literals])
            else:
                self.at_most([-literal for literal in literals], len(literals) - asked, force)

    def _distinct(self) -> None:
        names = [option.component for options in self.reduced.options for option in options if option.component]
        if len(set(names)) == len(names):
            return
        playing: dict[str, list[int]] = {}
        for options, literals in zip(self.reduced.options, self.plays, strict=True):
            for option, literal in zip(options, literals, strict=True):
                if option.component:
                    playing.setdefault(option.component, []).append(literal)
        for same in playing.values():
            if len(same) > 1:
                self.at_most(same, 1, self._in_force(Distinct()))

    def _needs(self) -> None:
        supporting: list[list[int]] = [[] for _ in self.reduced.needs]
        needing: list[list[int]] = [[] for _ in self.reduced.needs]
        for options, literals in zip(self.reduced.options, self.plays, strict=True):
            for option, literal in zip(options, literals, strict=True):
                kind = option.kind
                for need in kind.supports:
                    supporting[need].append(literal)
                for need in kind.needs:
                    needing[need].append(literal)
        add = self._solver.add_clause
        for need, having in enumerate(needing):
            if not having:
                continue
            force = self._in_force(Fed(need))
            if len(having) == 1:
                add([*force, -having[0], *supporting[need]])
                continue
            # One literal between both sides: a sum of clauses instead of a product.
            fed = self.literal()
            add([*force, -fed, *supporting[need]])
            for literal in having:
                add([-literal, fed])

    def _values(self) -> None:
        for variable, open_values in enumerate(self.reduced.values):
            constrained = [
                (literal, option.kind.admits[variable] & open_values)
                for options, literals in zip(self.reduced.options, self.plays, strict=True)
                for option, literal in zip(options, literals, strict=True)
                if option.kind.admits[variable] != ANY_VALUE
            ]
            if constrained:
                self._one_value(constrained, self._in_force(Shared(variable)))

    def _one_value(self, constrained: Sequence[tuple[int, int]], force: Sequence[int]) -> None:
        """Let options have a common value of a variable, given their literals and the masks of what they admit."""
        width = max((mask if mask >= 0 else ~mask).bit_length() for _, mask in constrained)
        values = [self.literal() for _ in range(width)]
        self.at_most(values, 1)
        for literal, mask in constrained:
            if mask >= 0:
                self.add([*force, -literal, *(values[k] for k in range(width) if mask >> k & 1)])
                continue
            # A mask below zero admits every value but some: it only forbids these, and a model may set none at all.
            for k in range(width):
                if not mask >> k & 1:
                    self.add([*force, -literal, -values[k]])

    def at_most(self, literals: Sequence[int], most: int, force: Sequence[int] = ()) -> None:
        """Allow no more than a number of the literals to hold, under the guards given."""
        if most >= len(literals):
            return
        if not force and self._solver.supports_atmost():
            self._solver.add_atmost(list(literals), most)
            return
        from pysat.card import CardEnc, EncType

        encoded = CardEnc.atmost(list(literals), most, top_id=self._top, encoding=EncType.seqcounter)
        self._top = max(self._top, encoded.nv)
        for clause in encoded.clauses:
            self.add([*force, *clause])

    def solve(self, assumed: Sequence[int], budget: Budget) -> bool | Undecided:
        """Return whether the clauses can hold under assumptions; each conflict is a step, and each call."""
        if budget.steps == 0:
            return Undecided(0)
        before = self._conflicts()
        found: bool | None = None
        while found is None and budget.steps != 0:
            # The solver handles no signal inside a call, so that calls have to end for a time limit to be kept. Were
            # no interrupt expected, it would catch Ctrl-C itself, and raise an error of its own.
            self._solver.conf_budget(
                CONFLICTS_PER_CALL if budget.steps is None else min(CONFLICTS_PER_CALL, budget.steps)
            )
            found = self._solver.solve_limited(assumptions=list(assumed), expect_interrupt=True)
            budget.spend(1 + self._conflicts() - before)
            before = self._conflicts()
        if found is None:
            return Undecided(self._conflicts())
        if found:
            self._model = self._solver.get_model()
        return found

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

    def _conflicts(self) -> int:
        return int(self._solver.accum_stats()["conflicts"])

    def holds(self, literal: int) -> bool:
        """Return whether a literal holds in the last model."""
        place = abs(literal) - 1
        return (place < len(self._model) and self._model[place] > 0) == (literal > 0)

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

    def least(self, budget: Budget) -> list[Option] | Undecided:
        """Return the least solution, given that there is a model.

        The model is never forgotten: when the budget ends, `chosen` still gives a solution.
        """
        chosen: list[Option] = []
        start, previous = 0, -1
        for role in self.reduced.slots:
            if role != previous:
                start, previous = 0, role
            literals = self.plays[role]
            current = next(i for i in range(start, len(literals)) if self.holds(literals[i]))
            while current > start:
                earlier = literals[start]
                if current > start + 1:
                    earlier = self.literal()
                    self.add([-earlier, *literals[start:current]])
                found = self.solve((earlier,), budget)
                if isinstance(found, Undecided):
                    return found
                if not found:
                    break
                current = next(i for i in range(start, current) if self.holds(literals[i]))
            for literal in literals[start:current]:
                self.add([-literal])
            self.add([literals[current]])
            chosen.append(self.reduced.options[role][current])
            start = current + 1
        return chosen
