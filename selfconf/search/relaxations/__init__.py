"""Relaxations: changes to an ecology or a template that make a refused task possible.

* `with_relaxations` is a refusal with those that were found, within a number of steps.
"""

from selfconf.search.relaxations.relaxations import with_relaxations

__all__ = ["with_relaxations"]
