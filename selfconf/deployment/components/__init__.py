"""How one task deals with the components of its ecology: what it asks of them, what they say, and whether they live.

* `Calls` makes the calls to components: be reserved, act with these inputs, turn off; how one is made, and what becomes
  of it, is in `calling`, and what follows where one does not obey its release in `releases`. `Waking` has those live
  that are dormant.
* `ComponentMessages` receives what components say of themselves; `Liveness` follows their lives, and decides when one
  is believed to be dead, by the `LivingSites` and as far as `Reachability` lets it: an ecology that cannot be reached
  seems to be dead. `Audits` ask those that live whether they act.
* `HeldLives` knows which life of each component has obeyed the task, and what may be left of earlier ones; `PortEnds`
  where connections end, which lead into composites or out of one.
"""

from selfconf.deployment.components.audits import Audits
from selfconf.deployment.components.calls import Calls
from selfconf.deployment.components.component_messages import ComponentMessages
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.components.liveness import Liveness
from selfconf.deployment.components.living_sites import LivingSites
from selfconf.deployment.components.port_ends import PortEnds
from selfconf.deployment.components.reachability import Reachability
from selfconf.deployment.components.waking import Waking

__all__ = [
    "Audits",
    "Calls",
    "ComponentMessages",
    "HeldLives",
    "Liveness",
    "LivingSites",
    "PortEnds",
    "Reachability",
    "Waking",
]
