"""The reduction: a problem in small integers, with only the candidates that can matter.

* `reduced` makes a `ReducedProblem` by dominance; `LazyReduction` does so when the result is first asked for.
* An `Option` is a candidate that a slot may take. It belongs to an `InterchangeabilityClass`, which its `signature`
  decides. A `Need` is a signal that an input must get.
* `assigned` gives the candidates for each role that chosen options stand for.
* `pruned` removes options by arc consistency; `consistent` does so for classes, and says why each was removed.
* A `Constraint` is one of `Played` (a role), `Fed` (a need), `Shared` (the value of a variable) and `Distinct` (the
  components). `all_of` lists those of a problem, and `subproblem` is the problem with only some of them in force.
"""

from selfconf.search.reduction.arc_consistency import consistent
from selfconf.search.reduction.constraints import Constraint, Distinct, Fed, Played, Shared, all_of, pruned, subproblem
from selfconf.search.reduction.dominance import LazyReduction, reduced
from selfconf.search.reduction.needs import Need
from selfconf.search.reduction.reduced_problem import (
    InterchangeabilityClass,
    Option,
    ReducedProblem,
    assigned,
    signature,
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
    "pruned",
    "reduced",
    "signature",
    "subproblem",
]
