"""From ontologies to the hierarchy that a reasoning mode lets the roles see.

`hierarchy` closes what ontologies state or entail; `HIERARCHY` are the predicates that it closes, and `READ` those
that it reads in the mode `subclass`. The OWL 2 RL closure
is computed by `owlrl_owl_rl`, or by `reasonable_owl_rl` for the ontologies that `suits` it.
"""

from selfconf.rdf.reasoning.closure import HIERARCHY, READ, hierarchy, owlrl_owl_rl
from selfconf.rdf.reasoning.fast_owl import reasonable_owl_rl, suits

__all__ = ["HIERARCHY", "READ", "hierarchy", "owlrl_owl_rl", "reasonable_owl_rl", "suits"]
