"""The strategies: which configuration is the answer.

The strategy `first` answers with the lexicographically first one: `answers`, and `solution` and `possible` for parts of
the question. `best_configuration` is one of least cost, within `BEST_STEPS`. `algorithm_1` is the paper's.
"""

from selfconf.search.strategies.best import BEST_STEPS, best_configuration
from selfconf.search.strategies.first import answers, possible, solution
from selfconf.search.strategies.paper import algorithm_1

__all__ = ["BEST_STEPS", "algorithm_1", "answers", "best_configuration", "possible", "solution"]
