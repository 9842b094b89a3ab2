"""Recruits: components that no role names, taken because the players need what they issue.

* `recruited` is a configuration with as few recruits as it takes, `first_recruited` that of the first players that
  recruits can feed, and `possible_with_recruits` says whether there is one; `RECRUIT_STEPS` is how long they look if
  not told otherwise, `REPAIR_STEPS` how long a repair does.
* `refusal_of_recruits` is the refusal of a problem whose players have no recruits.
* `founded` is the solver for players and recruits together, `fewest_of` the fewest recruits that its clauses allow.
* A `RecruitChoice` holds the recruits that matter to the players of one configuration.
"""

from selfconf.search.recruiting.fewest_recruits import fewest_of
from selfconf.search.recruiting.recruit_choice import RecruitChoice
from selfconf.search.recruiting.recruit_refusal import refusal_of_recruits
from selfconf.search.recruiting.recruiting import (
    RECRUIT_STEPS,
    REPAIR_STEPS,
    first_recruited,
    founded,
    possible_with_recruits,
    recruited,
)

__all__ = [
    "RECRUIT_STEPS",
    "REPAIR_STEPS",
    "RecruitChoice",
    "fewest_of",
    "first_recruited",
    "founded",
    "possible_with_recruits",
    "recruited",
    "refusal_of_recruits",
]
