"""The reduction: a problem in small integers, with only the candidates that can matter.

* `reduced` makes a `ReducedProblem` by dominance; `LazyReduction` does so when the result is first asked for.
* An `Option` is a candidate that a slot may take. It belongs to an `InterchangeabilityClass`, which its `signature`
  decides. A `Need` is a signal that an input must get; those of a problem are its `Needs`,
  and those of a `NeedScope` may be fed by the same links.
* A `Limit` says of some options how many play at most.
* `in_order` has the options of each role in the order of its candidates.
* `assigned` gives the candidates for each role that chosen options stand for.
* `with_recruits` is a problem whose recruits are options as well, those of one role more that has no slots, without a
  component (`NO_COMPONENT`). `recruits_that_matter` are those that can be fed and feed a component. `needed_signals`
  are those that some components and their suppliers need, `signals_served` those that a component serves.
* `pruned` removes options by arc consistency; `consistent` does so for classes, and says why each was removed;
  `ArcConsistency` does so again and again, with some classes or others taken out on trial.
* A `Constraint` is one of `Played` (a role), `Fed` (a need), `Shared` (the value of a variable) and `Distinct` (the
  components). `all_of` lists those of a problem, and `subproblem` is the problem with only some of them in force.
"""

from selfconf.search.reduction.arc_consistency import ArcConsistency, consistent
from selfconf.search.reduction.constraints import (
    NO_COMPONENT,
    Constraint,
    Distinct,
    Fed,
    Played,
    Shared,
    all_of,
    pruned,
    subproblem,
)
from selfconf.search.reduction.dominance import LazyReduction, reduced
from selfconf.search.reduction.needs import Need, Needs, NeedScope
from selfconf.search.reduction.recruit_options import (
    needed_signals,
    recruits_that_matter,
    signals_served,
    with_recruits,
)
from selfconf.search.reduction.reduced_problem import (
    InterchangeabilityClass,
    Limit,
    Option,
    ReducedProblem,
    assigned,
    in_order,
    signature,
)

__all__ = [
    "NO_COMPONENT",
    "ArcConsistency",
    "Constraint",
    "Distinct",
    "Fed",
    "InterchangeabilityClass",
    "LazyReduction",
    "Limit",
    "Need",
    "NeedScope",
    "Needs",
    "Option",
    "Played",
    "ReducedProblem",
    "Shared",
    "all_of",
    "assigned",
    "consistent",
    "in_order",
    "needed_signals",
    "pruned",
    "recruits_that_matter",
    "reduced",
    "signals_served",
    "signature",
    "subproblem",
    "with_recruits",
]
