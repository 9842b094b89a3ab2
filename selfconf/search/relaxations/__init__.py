"""Relaxations: changes to an ecology or a template that make a refused task possible.

* `with_relaxations` is a refusal with those that were found, within a number of steps.
* `NEAR` is how many near misses are tried.
"""

from selfconf.search.relaxations.relaxations import NEAR, with_relaxations

__all__ = ["NEAR", "with_relaxations"]
