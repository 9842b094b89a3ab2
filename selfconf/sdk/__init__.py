"""What a component is written with: an advertisement, a class, `emit`, `call`, `fail`, and what arrives.

    from selfconf.sdk import Component, main

    class Thermostat(Component):
        advertisement = "thermostat.ttl"

        def received(self, port, signal):
            self.emit("heating", {"on": signal["temperature"] < 20.0})

    if __name__ == "__main__":
        main(Thermostat)

Threads. All methods of a `Component` that selfconf calls (`started`, `stopped`, `received`, `called`, `parameter_set`,
timers) are called on one thread, one after the other, and have to return: one that outlasts its deadline
(`sc:deadline`; 2 seconds, 8 for `started`) counts as hung, and the component as failed. `emit`, `call` and `fail` may
be called from any thread. Work that takes long belongs on a thread of its own, which emits when it is done.

What arrives is a `Signal`; a call comes to a `Response` with its `CallStatus`. `Refused` is raised by a component that
cannot act now. A program that does more than `main`: a `Host` has several components with one session, `open_host`
makes one in the ecology that is found, `add_connection_arguments` adds the options for that; `Termination` tells when
the program is to end, `parent_environment` ends with it a program that it starts. A `ComponentRuntime` joins one
component to a bus of any kind.
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
