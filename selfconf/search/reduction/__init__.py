"""The reduction: a problem in small integers, with only the candidates that can matter.

`reduced` makes a `ReducedProblem` by dominance, `LazyReduction` does so when it is first asked for. Its parts are
`Option`s of slots, each of an `InterchangeabilityClass`, which has `Need`s. `pruned` and `consistent` are arc
consistency. A `Constraint` (`Played`, `Fed`, `Shared`, `Distinct`) can be in force or not: `all_of`, `relaxed`.
"""

from selfconf.search.reduction.arc_consistency import consistent
from selfconf.search.reduction.constraints import Constraint, Distinct, Fed, Played, Shared, all_of, pruned, relaxed
from selfconf.search.reduction.dominance import LazyReduction, reduced
from selfconf.search.reduction.needs import Need
from selfconf.search.reduction.reduced_problem import (
    InterchangeabilityClass,
    Option,
    ReducedProblem,
    assigned,
    likeness,
)

__all__ = [
    "Constraint",
    "Distinct",
    "Fed",
    "InterchangeabilityClass",
    "LazyReduction",
    "Need",
    "Option",
    "Played",
    "ReducedProblem",
    "Shared",
    "all_of",
    "assigned",
    "consistent",
    "likeness",
    "pruned",
    "reduced",
    "relaxed",
]
