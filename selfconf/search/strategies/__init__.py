"""The strategies: which configuration is the answer.

* `first` answers with the lexicographically first configuration: `answers` yields it, or why there is none; `solution`
  is the least solution before it is extended, and `possible` says whether any solution is found.
* `best` answers with a configuration of least cost: `best_configuration`, within `BEST_STEPS` steps if not told else.
* `paper` answers as `first` does, by the algorithm of the paper as printed: `algorithm_1`.
"""

from selfconf.search.strategies.best import BEST_STEPS, best_configuration
from selfconf.search.strategies.first import answers, possible, solution
from selfconf.search.strategies.paper import algorithm_1

__all__ = ["BEST_STEPS", "algorithm_1", "answers", "best_configuration", "possible", "solution"]
