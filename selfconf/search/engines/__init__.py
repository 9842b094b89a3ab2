"""The engines: depth-first search, matching, clause learning, weighted optimisation.

* `CandidateSearch` is depth-first search over the candidates of a problem; `SLOT_HEADROOM` is the number of slots for
  which it may take steps at once.
* `ReducedSearch` is depth-first search over a reduced problem, and `first_solution` the least solution found by it.
* `hall_set` finds roles that lack components (a `HallSet`) by bipartite matching, `unmatchable` the options that are in
  no matching; a `MaintainedMatching` follows a depth-first search.
* `value_cases` are the cases of a problem by the values of free parameters.
* `probed` removes options that would leave other roles too few components.
* `counted_needs` are needs that every solution has to supply by a slot each (`CountedNeeds`); `supplied` removes
  options that leave some of them unsupplied, or says which of them have too few slots (an `Undersupply`), and `limits`
  says how many slots may be spent on options that supply none.
* `within_capacity` removes options that leave demands unmet, as each role can serve so many of them.
* `exclusive_groups` are groups of options of which at most one can play, and what counting them proves.
* `ClauseSolver` is a clause-learning solver, if one is installed (`solver_available`). `any_by_clauses` and
  `least_by_clauses` find any or the least solution by several of them, or by an `OtherWay` where that is hard;
  `least_of_clauses` finds the least one of the clauses that a solver holds, and `minimise` a solution of least weight.
  `end_calls` ends the calls that go on, for a limit of time.
* `FoundedSolver` is such a solver for players and recruits, which never feed each other in a circle.
* `smallest_core` is a smallest set of constraints that cannot hold together, by hitting sets.
"""

from selfconf.search.engines.candidate_search import SLOT_HEADROOM, CandidateSearch
from selfconf.search.engines.capacity_counting import within_capacity
from selfconf.search.engines.case_splitting import value_cases
from selfconf.search.engines.clause_learning import ClauseSolver, end_calls, solver_available
from selfconf.search.engines.exclusion import exclusive_groups
from selfconf.search.engines.founded import FoundedSolver
from selfconf.search.engines.hitting_sets import smallest_core
from selfconf.search.engines.least_solution import OtherWay, any_by_clauses, least_by_clauses, least_of_clauses
from selfconf.search.engines.matching import HallSet, MaintainedMatching, hall_set, unmatchable
from selfconf.search.engines.max_sat import minimise
from selfconf.search.engines.need_counting import CountedNeeds, Undersupply, counted_needs, limits, supplied
from selfconf.search.engines.probing import probed
from selfconf.search.engines.reduced_search import ReducedSearch, first_solution

__all__ = [
    "SLOT_HEADROOM",
    "CandidateSearch",
    "ClauseSolver",
    "CountedNeeds",
    "FoundedSolver",
    "HallSet",
    "MaintainedMatching",
    "OtherWay",
    "ReducedSearch",
    "Undersupply",
    "any_by_clauses",
    "counted_needs",
    "end_calls",
    "exclusive_groups",
    "first_solution",
    "hall_set",
    "least_by_clauses",
    "least_of_clauses",
    "limits",
    "minimise",
    "probed",
    "smallest_core",
    "solver_available",
    "supplied",
    "unmatchable",
    "value_cases",
    "within_capacity",
]
