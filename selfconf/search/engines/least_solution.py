"""The least solution by clause learning, with engines that take turns, or work beside each other.

*Least.* Slot by slot, option by option: given what is settled and a model, ask for one in which an earlier option is in
the slot, the earliest first, until there is none; where answers come easily, about several slots at once (`turn`). What
is settled is added as a unit, so that everything learned stays true, and a solver goes from one question to the next
with it.

*Engines.* Which solver is quick on which problem is luck: on one family MiniCard, which counts by itself, on another
CaDiCaL with the counting written as clauses, on a third clasp, which decides in order and needs no questions
(`ordered_decisions`), each by an order of magnitude and more. So MiniCard, which loads the clauses in the least time,
begins. It soon gets support clauses, from which more propagates (`support_clauses`), a little later the values that
options exclude, and, where roles ask for many, the counting as clauses too; where they ask for several, after `BRIEF`
steps. Then it gets what takes longer to find out, and mostly rules out nothing: another way to the answer is asked for
(`OtherWay`), as to divide the problem, then options are tried alone (`probing`), and what has not been counted is. From
then on clasp works beside it; where MiniCard has met `ALONE` conflicts, CaDiCaL joins in, in a process of its own
(`rival`). Three on two processors would each take twice as long, so there CaDiCaL waits a little longer
(`ALONE_OF_TWO`), and takes the place of clasp; if no engine has ended after `BESIDE_CADICAL`, MiniCard and clasp take
turns on the other processor. Where there is one processor, all three take turns, each twice as long as before. With a
budget of steps it is always in turns, as a step has to mean the same on every machine. What one engine has settled the
others take over, since the least solution is unique: so the answer is the same whichever engine finds it, and the time
is that of the better one at each question.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import TypeVar

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines.clause_learning import LONGEST_CALL, SECOND_SOLVER, ClauseSolver
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.formula import Counted
from selfconf.search.engines.ordered_decisions import OrderedDecisions
from selfconf.search.engines.rival import Rival, processors
from selfconf.search.engines.turn import Turn
from selfconf.search.reduction import Option, ReducedProblem

UNSUPPORTED = 100
"""Conflicts and questions of the first solver before it gets support clauses.

As many again before it gets the values that options exclude.
"""
BRIEF = 1_000
"""Conflicts and questions of the first solver before another way is asked for and options are tried; then company."""
BRIEF_COUNTING = 250
"""Conflicts and questions before it gets numbers as clauses, where some are worth that."""
BRIEF_COUNTED = 1_500
"""Conflicts and questions after that before it has company: most of them end by then, and company takes preparing."""
PREPARED = 8
"""To prepare company takes as long as a conflict of the first solver, at most, for each of so many clauses: with more
of them, company comes later."""
COUNTED_IN_VAIN = 4
"""Counting groups from so many of them without a result, it is left until the first solver gets company."""
NEARLY = 2
"""Where one in this number of all slots is settled by then, the first solver has as many again."""
ALONE = 10_000
"""Conflicts of the first solver after that before CaDiCaL joins in, some tenths of a second."""
ALONE_OF_TWO = 15_000
"""Conflicts of the first solver before CaDiCaL joins in where there are but two processors, one of them clasp's."""
BESIDE_CADICAL = 30_000
"""Conflicts of the first solver beside CaDiCaL there before it shares its processor with clasp."""
FIRST_TURN = 5_000
"""Conflicts of clasp, and then of the first solver, in their first turns on one processor; later turns are longer."""


OtherWay = Callable[[], list[Option] | Undecided | None]
"""Another way to the answer of an engine; Undecided if it does not lead there."""


def any_by_clauses(
    reduced: ReducedProblem, budget: Budget, otherwise: OtherWay | None = None
) -> list[Option] | Undecided | None:
    """Return any solution, one option per slot; None if there is none; Undecided when the budget ends.

    Where the clauses turn out to be hard, `otherwise` is asked before more engines are.
    """
    return _Descent(reduced, budget, least=False).run(otherwise)


def least_by_clauses(
    reduced: ReducedProblem, budget: Budget, otherwise: OtherWay | None = None
) -> list[Option] | Undecided | None:
    """Return the least solution, one option per slot; None if there is none; Undecided when the budget ends.

    Where the clauses turn out to be hard, `otherwise` is asked before more engines are.
    """
    return _Descent(reduced, budget).run(otherwise)


def least_of_clauses(clauses: ClauseSolver, budget: Budget) -> list[Option] | Undecided:
    """Return the least solution of the clauses that a solver has, given that there is a model.

    The model is never forgotten: when the budget ends, `chosen` still gives a solution.
    """
    descent = _Descent(clauses.reduced, budget, clauses.plays)
    descent.possible = True
    turn = Turn(clauses, modelled=True)
    while not descent.finished:
        descent.advance(turn, None)
        if budget.steps == 0 and not descent.finished:
            return Undecided(0)
    return descent.chosen()


_Company = TypeVar("_Company", OrderedDecisions, Rival)


def _joined(engine: Callable[[], _Company], stack: ExitStack) -> _Company | None:
    """Return an engine that joins in; None where it cannot, as on a full disk: the others find the same."""
    try:
        return stack.enter_context(engine())
    except OSError:
        return None


class _Descent:
    """What is known of the least solution: the options of the first slots, settled by one engine or another."""

    def __init__(
        self,
        reduced: ReducedProblem,
        budget: Budget,
        plays: tuple[tuple[int, ...], ...] | None = None,
        least: bool = True,
    ) -> None:
        self.reduced, self.budget, self.least = reduced, budget, least
        self.slots = reduced.slots
        self.plays: tuple[tuple[int, ...], ...] = plays or ()
        self.settled: list[int] = []
        """For each of the first slots the number of its option."""
        self.least_left = 0
        """Below which number no option of the next slot is possible."""
        self.possible: bool | None = None
        self.beside: list[OrderedDecisions | Rival] = []
        """The engines that work beside this one."""

    @property
    def finished(self) -> bool:
        """Whether the answer is known."""
        return self.possible is False or len(self.settled) == len(self.slots)

    def run(self, otherwise: OtherWay | None = None) -> list[Option] | Undecided | None:
        """Return the solution, None if there is none, or Undecided when the budget ends."""
        encoding = Encoding(self.reduced, ordered=True, patience=COUNTED_IN_VAIN)
        self.plays = encoding.plays
        with ExitStack() as stack:
            first = self._search_alone(encoding, stack)
            if not self.finished and otherwise is not None:
                chosen = otherwise()
                if not isinstance(chosen, Undecided):
                    return chosen
            if not self.finished:
                first = self._prepare(first, encoding, stack)
            if not self.finished:
                self._search_together(first, encoding, stack)
        if self.possible is False:
            return None
        return self.chosen() if self.finished else Undecided(0)

    def _search_alone(self, encoding: Encoding, stack: ExitStack) -> Turn:
        """Let the first solver work by itself, with more and more clauses, and return how far it is."""
        first = Turn(stack.enter_context(ClauseSolver(self.reduced, encoding=encoding)))
        self.advance(first, UNSUPPORTED)
        if not self.finished:
            first.clauses.extend(encoding.support(), encoding.top)
        if encoding.valued:
            self.advance(first, UNSUPPORTED)
            if not self.finished:
                first.clauses.extend(encoding.exclude(), encoding.top)
        if any(bound.counts_many for bound in encoding.bounds):
            self.advance(first, BRIEF_COUNTING)
            first = self._counting(first, Counted.MANY, encoding, stack)
            self.advance(first, BRIEF_COUNTED)
        else:
            self.advance(first, BRIEF)
        if not self.finished and len(self.settled) * NEARLY >= len(self.slots):
            self.advance(first, BRIEF)  # to prepare company takes as long as hundreds of conflicts
        return first

    def _prepare(self, first: Turn, encoding: Encoding, stack: ExitStack) -> Turn:
        """Let the first solver work with all that can be found out, until company is worth its price."""
        found = (*encoding.probe(), *encoding.count())
        encoding.gather()
        company = max(0, encoding.size // PREPARED - BRIEF)
        if any(bound.counts and not bound.counts_many for bound in encoding.bounds):
            first = self._counting(first, Counted.ALL, encoding, stack)
            company = max(company, BRIEF_COUNTED)
        else:
            for clause in found:
                first.clauses.add(clause)
        self.advance(first, company)
        return first

    def _counting(self, turn: Turn, counted: Counted, encoding: Encoding, stack: ExitStack) -> Turn:
        """Have the first solver begin anew, with clauses that count, if the answer is not known."""
        if self.finished:
            return turn
        return Turn(stack.enter_context(ClauseSolver(self.reduced, encoding=encoding, counted=counted)))

    def _search_together(self, first: Turn, encoding: Encoding, stack: ExitStack) -> None:
        """Let all solvers work, beside each other or in turns."""
        in_order: OrderedDecisions | None = None
        if OrderedDecisions.available(encoding):
            # Left before the first solver is, as its thread interrupts that one.
            in_order = _joined(lambda: OrderedDecisions(encoding, self.slots), stack)
        if self.budget.steps is None and Rival.available():
            self._work_beside(first, encoding, in_order, stack)
        else:
            self._take_turns(first, encoding, in_order, stack)

    def _work_beside(
        self, first: Turn, encoding: Encoding, in_order: OrderedDecisions | None, stack: ExitStack
    ) -> None:
        """Let all solvers work, each beside the others, but two at a time for long where there are two processors."""
        if in_order is not None:
            in_order.begin(first.clauses.interrupt)
            self.beside.append(in_order)
        crowded = in_order is not None and processors() == 2
        self.advance(first, ALONE_OF_TWO if crowded else ALONE)
        if self.finished:
            return
        rival = _joined(lambda: Rival(encoding, self.slots, self.least, first.clauses.interrupt), stack)
        if rival is not None:
            self.beside.append(rival)
            if in_order is not None and crowded:
                in_order.pause()
                self._share_processor(first, in_order, rival)
        self.advance(first, None)

    def _share_processor(self, first: Turn, in_order: OrderedDecisions, rival: Rival) -> None:
        """Let the first solver work beside CaDiCaL, and later take turns with clasp, until one has ended."""

        def heard() -> bool:
            self._hear(rival)
            return self.finished

        self.advance(first, BESIDE_CADICAL)
        conflicts = FIRST_TURN
        while not self.finished:
            in_order.search(conflicts, heard)
            self.advance(first, conflicts)
            conflicts = min(2 * conflicts, LONGEST_CALL)

    def _take_turns(self, first: Turn, encoding: Encoding, in_order: OrderedDecisions | None, stack: ExitStack) -> None:
        """Let one solver after the other work, each time for longer, until one has the answer or the budget ends."""
        self.advance(first, ALONE)
        if self.finished or self.budget.steps == 0:
            return
        turns = [Turn(stack.enter_context(ClauseSolver(self.reduced, encoding=encoding, solver=SECOND_SOLVER))), first]
        conflicts = ALONE
        while not self.finished and self.budget.steps != 0:
            if in_order is not None:
                part = conflicts if self.budget.steps is None else min(conflicts, self.budget.steps)
                in_order.search(part)
                self._hear(in_order)
                self.budget.spend(1 if self.finished else part)
            for turn in turns:
                self.advance(turn, conflicts)
            conflicts *= 2

    def chosen(self) -> list[Option]:
        """Return the options that are settled."""
        return [self.reduced.options[role][number] for role, number in zip(self.slots, self.settled, strict=True)]

    def advance(self, turn: Turn, conflicts: int | None) -> None:
        """Let a solver work for a number of conflicts, or to the end."""
        left = conflicts
        while not self.finished and (left is None or left > 0) and self.budget.steps != 0:
            for engine in self.beside:
                self._hear(engine)
            self._inform(turn)
            if self.finished:
                return
            before = turn.clauses.conflicts
            asked = self._ask(turn, left)
            if left is not None:
                left -= asked + turn.clauses.conflicts - before

    def _hear(self, engine: OrderedDecisions | Rival) -> None:
        """Take over what an engine has found; of any solution all or nothing, as engines find different ones."""
        numbers = engine.settled()
        self.possible = engine.possible if self.possible is None else self.possible
        if self.least or len(numbers) == len(self.slots):
            for number in numbers[len(self.settled) :]:
                self._settle(number)

    def _inform(self, turn: Turn) -> None:
        """Add what is settled to the clauses of a solver."""
        clauses = turn.clauses
        known: list[int] = []
        for slot in range(turn.fixed, len(self.settled)):
            literals = self.plays[self.slots[slot]]
            # Its clauses know already of what was rejected for the slot that it was asked about.
            start = max(turn.rejected, self._start(slot)) if slot == turn.fixed else self._start(slot)
            known += [-literal for literal in literals[start : self.settled[slot]]]
            known.append(literals[self.settled[slot]])
            turn.modelled = turn.modelled and clauses.holds(known[-1])
        if turn.fixed < len(self.settled):
            turn.fixed, turn.rejected = len(self.settled), 0
        if not self.finished:
            literals = self.plays[self.slots[turn.fixed]]
            turn.rejected = max(turn.rejected, self._start(turn.fixed))
            rejected = [-literal for literal in literals[turn.rejected : self.least_left]]
            turn.modelled = turn.modelled and all(map(clauses.holds, rejected))
            known += rejected
            turn.rejected = max(turn.rejected, self.least_left)
        if known:
            clauses.settle(known)

    def _start(self, slot: int) -> int:
        """Return the first option that a slot may have: slots of one role take options in ascending order."""
        return self.settled[slot - 1] + 1 if slot and self.slots[slot] == self.slots[slot - 1] else 0

    def _ask(self, turn: Turn, conflicts: int | None) -> int:
        """Ask a solver the next question, and draw the consequences; return how many were asked of it."""
        clauses = turn.clauses
        if not turn.modelled:
            found = clauses.ask((), self.budget, conflicts)
            if found is not None:
                self.possible = turn.modelled = found
                if found and not self.least:
                    self._settle_all(clauses)
            return 1
        literals = self.plays[self.slots[turn.fixed]]
        self._reject(turn, literals)
        if clauses.holds(literals[turn.rejected]):
            self._settle_along(clauses, turn.rejected)
            return 0
        if self.budget.steps == 0:
            return 0
        numbers = turn.ahead(self.slots, self.plays, self.budget)
        before = clauses.conflicts
        roles = self.slots[turn.fixed : turn.fixed + len(numbers)]
        assumed = [self.plays[role][number] for role, number in zip(roles, numbers, strict=True)]
        found = clauses.ask(assumed, self.budget, conflicts)
        turn.answered(len(numbers), found, clauses.conflicts - before)
        if found is True:
            for number in numbers[:-1]:
                self._settle(number)
            self._settle_along(clauses, numbers[-1])
        elif found is False and len(numbers) == 1:
            self.least_left = turn.rejected + 1
        return 1

    def _reject(self, turn: Turn, literals: Sequence[int]) -> None:
        """Pass over options of the next slot that propagation alone refutes, each for a step.

        Where roles are bound to each other, most questions are of this sort, and to ask the solver takes longer than it
        takes to answer.
        """
        clauses = turn.clauses
        while self.budget.steps != 0:
            literal = literals[turn.rejected]
            if clauses.holds(literal) or not clauses.refutes(literal):
                break
            turn.rejected += 1
            self.budget.spend(1)
        self.least_left = max(self.least_left, turn.rejected)

    def _settle(self, number: int) -> None:
        self.settled.append(number)
        self.least_left = 0
        if len(self.settled) < len(self.slots):
            self.least_left = self._start(len(self.settled))

    def _settle_along(self, clauses: ClauseSolver, number: int) -> None:
        """Settle the next slot as the model has it, and those after it while that has their first options."""
        self._settle(number)
        while not self.finished and clauses.holds(self.plays[self.slots[len(self.settled)]][self.least_left]):
            self._settle(self.least_left)

    def _settle_all(self, clauses: ClauseSolver) -> None:
        """Take a model as it is."""
        place: dict[int, list[int]] = {}
        for role, literals in enumerate(self.plays):
            place[role] = [number for number, literal in enumerate(literals) if clauses.holds(literal)]
        for role in self.slots:
            self._settle(place[role].pop(0))
