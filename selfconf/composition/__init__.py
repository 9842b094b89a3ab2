"""Act 3 of the paper, composition: from a task and an ecology to a configuration or an explained refusal.

A `Composer` composes one task again and again, by a `Strategy`; `composed` is its best answer within a `TimeLimit`, and
`explained` a refusal with everything that can be found out about it. `ranked_exclusions` tells of a role what keeps
each other component out. `configurable` tells which composites can be configured (`Inside`), and of the others why not,
by a `DocumentOf`, which reads the document of a composite; `insides` what those of a configuration are inside;
`why_none` says why there is no configuration.
"""

from selfconf.composition.composer import Composer
from selfconf.composition.explanation import explained
from selfconf.composition.inside import DocumentOf, Inside, configurable, insides, why_none
from selfconf.composition.near_misses import ranked_exclusions
from selfconf.composition.searches import Strategy
from selfconf.composition.time_limit import TimeLimit, composed

__all__ = [
    "Composer",
    "DocumentOf",
    "Inside",
    "Strategy",
    "TimeLimit",
    "composed",
    "configurable",
    "explained",
    "insides",
    "ranked_exclusions",
    "why_none",
]
