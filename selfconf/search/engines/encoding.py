"""A reduced problem as clauses, and as bounds on how many of some literals hold.

A literal for each option: it plays; of two, the second plays iff the first does not. Each role is played by exactly as
many as it has slots; a component plays one role at most. An option with a need implies one of the options that support
it, by way of a literal where several options have the need: one for all needs that the same options support.
A literal for each value of a variable, at most one of which holds: an option that constrains the variable implies one
of the values that it admits, or none of those that it does not admit. Values that no option tells apart have one
literal, and there is none where one value suits all options.

Where several roles may feed a need, the options of each that support it have a literal which holds iff one of them
plays, one for all needs that the same options support: what clause learning then learns is about the signals that roles
issue, and not about candidates one by one.

Where a role of one slot always issues one of two signals, and never both, as a wire does with its two bits, the one
literal is the negation of the other.

*Both ways.* That an option plays only if those that it feeds can do with it is said by clauses of their own
(`support_clauses`), which are added (`Encoding.support`) when the clauses turn out to be hard without. That an option
excludes the values which it does not admit is added (`Encoding.exclude`) when they are hard even then.

*Probing.* Options that turn out to be in no solution when they are tried alone (`probing`) are ruled out
(`Encoding.probe`) when the clauses turn out to be hard: to try them takes longer than most problems take.

*Groups.* Where options exclude each other (`exclusion`), one bound for each group says so, in place of the needs from
which that follows; and what counting the groups has proved is added. With patience, counting may be left, to be gone on
with (`Encoding.count`) when the clauses turn out to be hard without. Where a role has several options of a group, as an
item that may lie in several ways over one place, a literal which holds iff one of them plays takes their place in the
bound (`Encoding.gather`) when the clauses turn out to be hard: what is learned then is about roles and places.

*Limits.* Of the options that supply none of some needs, though they fill a slot for these, no more play than there are
slots to spare (`need_counting`): a bound, left out with guards as well. Needs that only roles of one slot each may
supply are counted when the clauses turn out to be hard, and so is how much each role can serve (`capacity_counting`).

*Order.* Where only the least solution is asked for, or any, interchangeable roles are played in order (`symmetry`).

*Guards.* Each constraint may have a literal that puts it in force, to be assumed: the solver then names assumptions
that cannot hold together, an unsatisfiable core. A role that is not in force may still be played, so that fewer
constraints in force never make less possible. There are no groups then, as each follows from many constraints.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from selfconf.search.engines.capacity_counting import within_capacity
from selfconf.search.engines.counting_order import counting_order
from selfconf.search.engines.exclusion import exclusive_groups
from selfconf.search.engines.formula import FEW_TO_COUNT, AtMost, Formula, Implied
from selfconf.search.engines.group_counting import ExclusiveGroups
from selfconf.search.engines.need_counting import Undersupply, counted_needs, limits, supplied
from selfconf.search.engines.probing import probed
from selfconf.search.engines.support_clauses import clauses_of_needs, clauses_of_values, exclusions_of_values
from selfconf.search.engines.symmetry import interchangeable
from selfconf.search.reduction import Constraint, Distinct, Fed, Limit, Played, ReducedProblem, Shared


class Encoding(Formula):
    """The clauses and bounds of a reduced problem."""

    def __init__(
        self,
        reduced: ReducedProblem,
        guarded: bool = False,
        distinct: bool = True,
        ordered: bool = False,
        patience: int | None = None,
    ) -> None:
        super().__init__()
        self.reduced = reduced
        self.guards: dict[Constraint, int] = {}
        self._guarded = guarded
        self._needing: Mapping[int, list[int]] = {}
        """The literals of the options that have each need, of those needs that are written."""
        self._supporting: Mapping[int, Mapping[int, list[int]]] = {}
        """The literals of the options that support each of these, by role."""
        self._valued: list[tuple[list[tuple[int, int, int]], list[tuple[int, int]]]] = []
        """The options that constrain each variable which has literals for its values, and these, each with a mask."""
        self._crowds: dict[int, list[list[int]]] = {}
        """For the bounds of groups of which a role has several options, by their numbers, the options of each role."""
        self._asked = Counter(reduced.slots)
        self.plays: tuple[tuple[int, ...], ...] = tuple(
            self._literals(role, len(options)) for role, options in enumerate(reduced.options)
        )
        """For each role, the literals of its options."""
        groups = self._exclusive = ExclusiveGroups() if guarded else exclusive_groups(reduced, distinct, patience)
        self._roles()
        if guarded and distinct:
            self._distinct()
        self._needs(groups.stated)
        self._values(groups.settled)
        self._groups(groups)
        if not guarded:
            self._limits(reduced.limits)
        if ordered:
            for first, second in interchangeable(reduced):
                self.ascending(self.plays[first], self.plays[second])

    def _literals(self, role: int, options: int) -> tuple[int, ...]:
        """Return a literal for each option; of two options of which one must play, each is the other's negation."""
        # Not with guards: then the role may be left unplayed, so that neither option holds.
        if options == 2 and self._asked[role] == 1 and not self._guarded:
            first = self.literal()
            return first, -first
        before, self.top = self.top, self.top + options
        return tuple(range(before + 1, self.top + 1))

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
            force = self._in_force(Played(role)) if self._guarded else ()
            if len(literals) == 2 and literals[0] == -literals[1]:
                continue
            if FEW_TO_COUNT < asked < len(literals):
                literals = tuple([literals[place] for place in counting_order(self.reduced.options[role])])
            self.at_most(literals, asked, exactly=True)
            if len(literals) < asked:
                impossible = self.literal()
                self.statements.append([*force, impossible])
                self.statements.append([-impossible])
            elif asked == 1:
                self.statements.append([*force, *literals])
            else:
                self.at_most([-literal for literal in literals], len(literals) - asked, force)

    def _distinct(self) -> None:
        playing: dict[str, list[int]] = {}
        for options, literals in zip(self.reduced.options, self.plays, strict=True):
            for option, literal in zip(options, literals, strict=True):
                if option.component:
                    playing.setdefault(option.component, []).append(literal)
        for same in playing.values():
            if len(same) > 1:
                self.at_most(same, 1, self._in_force(Distinct()))

    def _needs(self, stated: frozenset[int]) -> None:
        """Write the needs that are not stated otherwise."""
        needing = self._having(stated)
        supporting = self._supports_of(needing) if needing else {}
        if not self._guarded:
            self._needing, self._supporting = needing, supporting
            self._complements()
        add = self.statements.append
        feeding: dict[tuple[int, ...], int] = {}
        for need, having in sorted(needing.items()):
            force = self._in_force(Fed(need)) if self._guarded else ()
            supports = self._supports(supporting[need])
            if len(having) == 1:
                add([*force, -having[0], *supports])
                continue
            if len(supports) == 1 and not force:
                add(Implied(supports[0], having, alone=False))
                continue
            # One literal between both sides, a sum of clauses instead of a product; and one for all needs that the same
            # options support, unless each is put in force by itself.
            known = (*force, *supports)
            fed = feeding.get(known)
            if fed is None:
                fed = feeding[known] = self.literal()
                add([*force, -fed, *supports])
            add(Implied(fed, having))

    def _having(self, stated: frozenset[int]) -> dict[int, list[int]]:
        """Return for the needs that are not stated otherwise the literals of the options that have them."""
        needing: defaultdict[int, list[int]] = defaultdict(list)
        for options, literals in zip(self.reduced.options, self.plays, strict=True):
            for option, literal in zip(options, literals, strict=True):
                for need in option.kind.needs:
                    if need not in stated:
                        needing[need].append(literal)
        return needing

    def _supports(self, by_role: Mapping[int, list[int]]) -> Sequence[int]:
        """Return literals of which one holds iff one of some options plays, given by role."""
        if len(by_role) > 1:
            return [self.any_of(some) for some in by_role.values()]
        alone = next(iter(by_role.values()), [])
        known = self._sums.get(tuple(alone)) if self._sums else None
        return alone if known is None else [known]

    def _alone(self) -> Iterator[tuple[int, int, list[int]]]:
        """Yield the needs that one role alone supports, of one slot, with that role and what supports them there."""
        for need, by_role in self._supporting.items():
            if len(by_role) == 1:
                ((role, literals),) = by_role.items()
                if self._asked[role] == 1:
                    yield need, role, literals

    def _complements(self) -> None:
        """Let two sets of options of a role, of which one always plays, have one literal and its negation."""
        of_role: defaultdict[int, list[list[int]]] = defaultdict(list)
        for _, role, supporting in self._alone():
            of_role[role].append(supporting)
        for role, sets in of_role.items():
            literals = self.plays[role]
            # Of two such sets one has half of the options at least; mostly there is none.
            large = [some for some in sets if 2 * len(some) >= len(literals) and len(some) > 1]
            if not large:
                continue
            known = set(map(tuple, sets))
            for some in map(tuple, large):
                if some in self._sums:
                    continue
                within = set(some)
                rest = tuple([literal for literal in literals if literal not in within])
                if len(rest) == 1:
                    self._sums[some] = -rest[0]
                elif rest in known:
                    one = self._sums[some] = self.literal()
                    self._sums[rest] = -one
                    self.statements += [[-one, *some], [one, *rest]]

    def _supports_of(self, needs: Collection[int]) -> dict[int, dict[int, list[int]]]:
        """Return for some needs the literals of the options that support them, by role."""
        found: dict[int, dict[int, list[int]]] = {need: {} for need in needs}
        few = len(found) < len(self.reduced.needs)
        for role, (options, literals) in enumerate(zip(self.reduced.options, self.plays, strict=True)):
            of_role: defaultdict[int, list[int]] = defaultdict(list)
            for option, literal in zip(options, literals, strict=True):
                for need in found.keys() & option.kind.supports if few else option.kind.supports:
                    of_role[need].append(literal)
            for need, some in of_role.items():
                found[need][role] = some
        return found

    def _values(self, settled: frozenset[int]) -> None:
        """Write what variables say that is not stated otherwise."""
        if len(settled) == len(self.reduced.values):
            return
        options = [literal for literals in self.plays for literal in literals]
        for variable, some in enumerate(self.reduced.constraining()):
            if some and variable not in settled:
                constrained = [(options[number], mask) for _, number, mask in some]
                values = self.one_value(constrained, self._in_force(Shared(variable)))
                if values:
                    self._valued.append((some, values))

    def support(self) -> list[list[int] | Implied]:
        """Add support clauses, and return all that is added."""
        before = len(self.statements)
        links: dict[tuple[int, int], dict[int, tuple[list[int], list[int]]]] = {}
        for need, source, literals in self._alone():
            sink = self.reduced.needs.scopes[need].role
            links.setdefault((source, sink), {})[need] = self._needing[need], literals
        for (source, sink), needs in links.items():
            self.statements += [*clauses_of_needs(self.plays[source], self.plays[sink], needs, self.any_of)]
        options = [literal for literals in self.plays for literal in literals]
        for some, values in self._valued:
            admitted: defaultdict[int, dict[int, int]] = defaultdict(dict)
            for role, number, mask in some:
                admitted[role][options[number]] = mask
            for role, masks in admitted.items():
                self.statements += clauses_of_values(self.plays[role], masks, values)
        return self.statements[before:]

    @property
    def valued(self) -> bool:
        """Whether values of variables have literals."""
        return bool(self._valued)

    def exclude(self) -> list[list[int] | Implied]:
        """Let options exclude the values that they do not admit, and return all that is added."""
        before = len(self.statements)
        options = [literal for literals in self.plays for literal in literals]
        for some, values in self._valued:
            admitting: defaultdict[int, list[int]] = defaultdict(list)
            for _, number, mask in some:
                admitting[mask].append(options[number])
            self.statements += exclusions_of_values(admitting, values, self.any_of)
        return self.statements[before:]

    def gather(self) -> None:
        """Bound the roles that play an option of a group, not the options, for solvers that get the bounds later."""
        for place, by_role in self._crowds.items():
            self.bounds[place] = AtMost([self.any_of(literals) for literals in by_role], 1)
        self._crowds = {}

    def probe(self) -> list[list[int]]:
        """Rule out options that were tried alone, where roles share components, and return the clauses."""
        before = len(self.statements)
        if self.reduced.shares_components():
            self._rule_out(probed(self.reduced))
        return self._clauses_since(before)

    def count(self) -> list[list[int]]:
        """Add what follows from counting groups and needs that have not been counted yet, and return the clauses."""
        before, after = len(self.statements), self._exclusive.all_counted()
        if after is not self._exclusive:
            self._exclusive = after
            self._counted(after)
        self._count_needs()
        return self._clauses_since(before)

    def _clauses_since(self, number: int) -> list[list[int]]:
        """Return the clauses that were written after a number of statements."""
        return [statement for statement in self.statements[number:] if isinstance(statement, list)]

    def _count_needs(self) -> None:
        """Add what follows from counting needs that roles of one slot may supply, and what each role can serve."""
        counted = counted_needs(self.reduced, single=True)
        left, able = supplied(self.reduced, counted), within_capacity(self.reduced)
        if isinstance(left, Undersupply) or able is None:
            self.contradict()
            return
        self._rule_out(left)
        self._rule_out(able)
        self._limits(limits(self.reduced, counted))

    def _rule_out(self, left: ReducedProblem) -> None:
        """Rule out the options that are not left of the problem."""
        for literals, options, kept in zip(self.plays, self.reduced.options, left.options, strict=True):
            if len(kept) < len(options):
                numbers = {option.number for option in kept}
                self.statements += [
                    [-literal]
                    for literal, option in zip(literals, options, strict=True)
                    if option.number not in numbers
                ]

    def _limits(self, known: Iterable[Limit]) -> None:
        """Write how many of some options may play."""
        for limit in known:
            some = [
                literal
                for role in sorted({role for role, _ in limit.options})
                for literal, option in zip(self.plays[role], self.reduced.options[role], strict=True)
                if (role, option.number) in limit.options
            ]
            if limit.most > 0:
                self.at_most(some, limit.most)
            else:
                self.statements += [[-literal] for literal in some]

    def _groups(self, known: ExclusiveGroups) -> None:
        options = [literal for literals in self.plays for literal in literals]
        # What to gather the options by: the role, where it plays one of them; else each by itself.
        parts = [
            role if self._asked[role] == 1 else -literal
            for role, literals in enumerate(self.plays)
            for literal in literals
        ]
        for group in known.groups:
            if len(group) == 2:
                self.statements.append([-options[number] for number in group])
                continue
            gathered: defaultdict[int, list[int]] = defaultdict(list)
            for number in group:
                gathered[parts[number]].append(options[number])
            if 1 < len(gathered) < len(group):
                self._crowds[len(self.bounds)] = list(gathered.values())
            self.at_most([options[number] for number in group], 1)
        self._counted(known)

    def _counted(self, known: ExclusiveGroups) -> None:
        """Write what follows from counting groups."""
        if known.impossible:
            self.contradict()
        options = [literal for literals in self.plays for literal in literals]
        self.statements += [[options[number] for number in some] for some in known.played]
        self.statements += [[-options[number]] for number in known.excluded]
