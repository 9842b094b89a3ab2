"""A network in memory, with simulated time and faults.

* A `Network` delivers what its nodes send, with `Faults`; a node that is paused counts as gone after its `LEASE`.
* A `MemoryBus` is the bus of a node, a `MemoryRequest` a question that a node answers.
"""

from selfconf.bus.memory.bus import MemoryBus
from selfconf.bus.memory.network import LEASE, Faults, Network
from selfconf.bus.memory.questions import MemoryRequest

__all__ = ["LEASE", "Faults", "MemoryBus", "MemoryRequest", "Network"]
