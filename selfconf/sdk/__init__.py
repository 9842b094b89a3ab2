"""What a component is written with: an advertisement, a class, `emit`, `call`, `fail`, and what arrives.

    from selfconf.sdk import Component, main

    class Thermostat(Component):
        advertisement = "thermostat.ttl"

        def received(self, port, signal):
            self.emit("heating", {"on": signal["temperature"] < 20.0})

    if __name__ == "__main__":
        main(Thermostat)

Threads. All methods of a component that selfconf calls (`started`, `stopped`, `received`, `called`, `parameter_set`,
timers) are called on one thread, one after the other, and have to return: one that outlasts its deadline
(`sc:deadline`; 2 seconds, 8 for `started`) counts as hung, and the component as failed. `emit`, `call` and `fail` may
be called from any thread. Work that takes long belongs on a thread of its own, which emits when it is done.
"""

from selfconf.sdk.component import CallStatus, Component, Refused, Response, Signal
from selfconf.sdk.host import Host
from selfconf.sdk.program import add_connection_arguments, main, open_host
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.termination import Termination, parent_environment

__all__ = [
    "CallStatus",
    "Component",
    "ComponentRuntime",
    "Host",
    "Refused",
    "Response",
    "Signal",
    "Termination",
    "add_connection_arguments",
    "main",
    "open_host",
    "parent_environment",
]
