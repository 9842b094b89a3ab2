"""What a component is written with: an advertisement, a class, `emit`, `fail`, and what arrives on an input.

    from selfconf.sdk import Component, main

    class Thermostat(Component):
        advertisement = "thermostat.ttl"

        def received(self, port, signal):
            self.emit("heating", {"on": signal["celsius"] < 20.0})

    if __name__ == "__main__":
        main(Thermostat)

Threads. Everything that selfconf tells a component (`started`, `stopped`, `received`, `parameter_set`, timers) is
told on one thread, one call after the other; return soon, for control calls wait in the same queue. `emit` and `fail`
may be called from any thread. Work that takes long belongs in a thread of your own, which emits when it is done.
"""

from selfconf.sdk.component import Component, Refused, Signal
from selfconf.sdk.host import Host
from selfconf.sdk.program import main
from selfconf.termination import Termination
from selfconf.termination import parent_environment as lineage

__all__ = ["Component", "Host", "Refused", "Signal", "Termination", "lineage", "main"]
