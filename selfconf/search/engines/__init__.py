"""The engines: depth-first search, matching, clause learning, weighted optimisation.

`CandidateSearch` is depth first over the candidates themselves, `ReducedSearch` over a reduced problem.
`FollowedMatching`, `shortage` and `impossible` are bipartite matching (`Shortage` is Hall's set). `ClauseSolver` is a
clause-learning solver, if there is one (`solver_available`), and `minimise` weighted optimisation by it.
"""

from selfconf.search.engines.candidate_search import SLOT_HEADROOM, CandidateSearch
from selfconf.search.engines.clause_learning import (
    ClauseSolver,
    any_by_clauses,
    least_by_clauses,
    solver_available,
)
from selfconf.search.engines.matching import FollowedMatching, Shortage, impossible, shortage
from selfconf.search.engines.max_sat import minimise
from selfconf.search.engines.reduced_search import ReducedSearch, first_solution

__all__ = [
    "SLOT_HEADROOM",
    "CandidateSearch",
    "ClauseSolver",
    "FollowedMatching",
    "ReducedSearch",
    "Shortage",
    "any_by_clauses",
    "first_solution",
    "impossible",
    "least_by_clauses",
    "minimise",
    "shortage",
    "solver_available",
]
