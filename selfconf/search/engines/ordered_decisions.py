"""Clause learning that decides on options in order, so that the first model it meets is the least solution.

*Which library.* clingo (MIT; Gebser, Kaminski, Kaufmann and Schaub, TPLP 2019): its solver clasp follows a domain
heuristic that says which atoms to decide on before others, and to make them true (Gebser, Kaufmann, Romero, Otero,
Schaub and Wanko, AAAI 2013). The clauses are handed over as they are; nothing is grounded. They go as one text in
clingo's intermediate format, aspif (Kaminski, Schaub and Wanko, Reasoning Web 2017), which takes half the time of a
call for each. What comes in the extra `solvers` beside it is known by `clause_learning`; without clingo the other
engines find the same.

*Least.* Each option has a level of its own, which falls from slot to slot and from option to option. Let m be the model
that is met, m' another one, and o the first option in order on which they differ. Were o played in m' alone, m would
not have decided against it, as options are decided to play; so that it is not played followed from decisions that were
made while o was open, which are of earlier options, on which m' agrees: then it is not played in m' either. Restarts
and what is forgotten change nothing, as this is about the decisions with which m was met. A role of several slots is
played by a set of options; of two sets of one size, the lesser one has the first option that is in one alone.

*When.* On grids of roles, where each is bound to its neighbours, in rows as they stand in the template, a decision in
order soon meets what it contradicts, and a few hundred conflicts suffice where other orders need a hundred thousand; on
frequencies it is the other way round. So it works beside the other engines.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.formula import Implied

if TYPE_CHECKING:
    import clingo

LEVELS = 32_767
"""How many levels clasp tells apart; beyond, its order would be wrong without a warning."""
COUNTING = "--trans-ext=card"
"""Bounds as rules that count, with an atom for each number reached, about which clasp can learn. On covers it meets a
hundred times fewer conflicts than with bounds as constraints; of one alone, a constraint is the quicker."""
SIGNALS_SECONDS = 0.02
"""How long Python waits for a search before it handles signals, and looks whether the search is still needed."""


class OrderedDecisions:
    """A problem as clauses in clasp, and what that has found; use it in a `with` statement."""

    def __init__(self, encoding: Encoding, slots: Sequence[int]) -> None:
        import clingo

        self._plays, self._slots = encoding.plays, slots
        options = ["--heuristic=Domain"]
        if any(bound.most > 1 for bound in encoding.bounds):
            options.append(COUNTING)
        self._control = clingo.Control(options, logger=lambda *_: None)
        self._handle: clingo.SolveHandle | None = None
        self._found: list[int] = []
        self.possible: bool | None = None
        """Whether there is a solution, once that is known."""
        with tempfile.NamedTemporaryFile("w", encoding="utf-8") as program:
            program.write("\n".join(_aspif(encoding)))
            program.flush()
            self._control.load(program.name)

    @staticmethod
    def available(encoding: Encoding) -> bool:
        """Return whether clingo is installed, can be given a problem, and tells so many options apart."""
        return sum(map(len, encoding.plays)) <= LEVELS and find_spec("clingo") is not None and _folder_for_files()

    def __enter__(self) -> OrderedDecisions:
        return self

    def __exit__(self, *_: object) -> None:
        self.pause()

    def search(self, conflicts: int, needless: Callable[[], bool] = lambda: False) -> None:
        """Look for the least solution until it is found, so many conflicts are met, or it is said to be needless."""
        handle = self._handle = self._started(f"{conflicts}", lambda: None)
        while not handle.wait(SIGNALS_SECONDS):
            if needless():
                self.pause()
                return
        self.settled()

    def begin(self, ended: Callable[[], None]) -> None:
        """Look for the least solution in a thread of clasp's own, until it is found, or this object is left.

        `ended` is called in that thread.
        """
        self._handle = self._started("umax", ended)

    def pause(self) -> None:
        """End the thread; what was learned in it stays for the next one."""
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None

    def settled(self) -> Sequence[int]:
        """Return the options of all slots if they are found by now, without waiting; else nothing."""
        if self._handle is not None and self._handle.wait(0):
            self._take(self._handle)
            self.pause()
        return self._found

    def _started(self, conflicts: str, ended: Callable[[], None]) -> clingo.SolveHandle:
        """A search that goes on in a thread of clasp's own, for so many conflicts."""
        solving: Any = self._control.configuration.solve
        solving.solve_limit = f"{conflicts},umax"

        def found(_: object) -> None:
            ended()

        # A model is reported when it is met, that there is none at the end.
        return self._control.solve(yield_=True, async_=True, on_model=found, on_finish=found)

    def _take(self, handle: clingo.SolveHandle) -> None:
        """Draw from a search that has ended what it found."""
        model = handle.model()
        if model is None:
            self.possible = False if handle.get().unsatisfiable else None
            return
        self.possible = True
        playing = [
            (number for number, literal in enumerate(literals) if model.is_true(literal)) for literals in self._plays
        ]
        self._found = [next(playing[role]) for role in self._slots]


def _aspif(encoding: Encoding) -> Iterator[str]:
    """Yield the lines of a program whose atoms are the literals of an encoding, with a level for each option."""
    plain = [str(atom) for atom in range(encoding.top + 1)]
    denied = [f"-{atom}" for atom in plain]
    # The text of a negative literal is found from the end.
    literal = [*plain, *denied[:0:-1]].__getitem__
    negation = [*denied, *plain[:0:-1]].__getitem__
    implied = {one.literal for one in encoding.statements if isinstance(one, Implied) and one.alone}
    free = [atom for number, atom in enumerate(plain) if number and number not in implied]
    yield "asp 1 0 0 incremental"
    yield " ".join(["1 1", str(len(free)), *free, "0 0"])
    for statement in encoding.statements:
        yield from _rules(statement, literal, negation)
    for literals, most, force, _ in encoding.bounds:
        assert not force  # for there are no guards
        yield f"1 0 0 1 {most + 1} {len(literals)} {' 1 '.join(map(literal, literals))} 1"
    level = sum(map(len, encoding.plays))
    for literals in encoding.plays:
        for option in literals:
            # Of two options the second one plays iff the first, which is decided before it, does not.
            if option > 0:
                yield f"7 4 {option} {level} 0 0"
            level -= 1
    yield "0\n"


def _rules(said: list[int] | Implied, literal: Callable[[int], str], negation: Callable[[int], str]) -> Iterable[str]:
    """Return the lines of a statement, given what returns the text of a literal, and that of its negation."""
    if not isinstance(said, Implied):
        return [" ".join(["1 0 0 0", str(len(said)), *map(negation, said)])]
    if not said.alone:
        missing = negation(said.literal)
        return [f"1 0 0 0 2 {literal(one)} {missing}" for one in said.literals]
    # As nothing else brings the literal about, it holds iff one of these does.
    return [f"1 0 1 {said.literal} 1 1 {len(said.literals)} {' 1 '.join(map(literal, said.literals))} 1"]


def _folder_for_files() -> bool:
    """Return whether there is a folder for temporary files: clingo reads the format from a file alone."""
    try:
        return bool(tempfile.gettempdir())
    except FileNotFoundError:
        return False
