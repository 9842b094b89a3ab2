"""How one task deals with the components of its ecology: what it asks of them, what they say, and whether they live.

`TaskComponents` does what the machine of the task wants done about a component, by the parts of this room:

* `Calls` makes the calls to components: be reserved, act with these inputs, turn off; how one is made, and what becomes
  of it, is in `calling`, and what follows where one does not obey its release in `releases`. `waking` has those live
  that are dormant.
* `component_messages` receives what components say of themselves; `Liveness` follows their lives, and decides when one
  is believed to be dead, by the `living_sites` and as far as `reachability` lets it: an ecology that cannot be reached
  seems to be dead. `audits` ask those that live whether they act.
* `HeldLives` knows which life of each component has obeyed the task, and what may be left of earlier ones; `PortEnds`
  where connections end, which lead into composites or out of one.
"""

from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.components.liveness import Liveness
from selfconf.deployment.components.port_ends import PortEnds
from selfconf.deployment.components.task_components import TaskComponents

__all__ = ["HeldLives", "Liveness", "PortEnds", "TaskComponents"]
