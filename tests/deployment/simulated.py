"""What tests of a running task simulate: a site that starts programs, and code that is slow."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Request
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Page
from selfconf.sdk.runtime import ComponentRuntime
from tests.deployment.tasks import TASK
from tests.faults.simulated_code import SimulatedCodeThread, SimulatedComponentCode
from tests.lab import ADVERTISEMENTS, PREFIXES, Lab, Recorder, iri


def living_room(
    lab: Lab,
    life: str,
    wake: Callable[[MemoryBus], object],
    name: str = "living-room",
    refusal: str = "",
    unheard: int = 0,
) -> MemoryBus:
    """A site that can start the tracker, as `wake` does, unless it refuses to for a reason; its node.

    So many calls to start it are `unheard`.
    """
    tracker, node = iri("person-tracker"), lab.network.node()
    calls = iter(range(1, 100))
    page = encode(Page(0, 1, 1, tracker, "tracker.ttl", startable=True))

    def advertise(request: Request) -> None:
        payload = (PREFIXES + ADVERTISEMENTS["tracker"]).encode()
        request.reply(lab.keys.advertisement(name, tracker), payload, page)
        request.finish()

    def asked(request: Request) -> None:
        if next(calls) <= unheard:
            return
        if refusal:
            request.refuse(refusal)
        else:
            request.reply(lab.keys.wake(name), b"started")
        request.finish()
        wake(node)

    node.announce(lab.keys.site_life(name, life))
    node.serve(lab.keys.advertisements(name), advertise)
    node.serve(lab.keys.wake(name), asked)
    return node


def home(folder: Path, *more: str) -> Lab:
    """A lab in which one site has the components of the task, but for the tracker, and some more; all of them live."""
    lab = Lab(folder)
    lab.site("astrid", *TASK, *more)
    for name in (*TASK, *more):
        lab.component(name)
    return lab


def slow_code(lab: Lab, name: str) -> SimulatedCodeThread:
    """Have a component begin again, with code on a thread of its own; what hangs there is told, and goes on."""
    lab.crash(name)
    node, recorder = lab.network.node(), Recorder()
    thread = SimulatedCodeThread(node, lambda why: runtime.hung(why))
    runtime = ComponentRuntime(node, lab.keys, lab.profile(name), recorder, f"{name}-slow", thread)
    SimulatedComponentCode.simulate(runtime.code, node, thread)
    recorder.spend = thread.spend
    lab.runtimes[name], lab.components[name] = runtime, recorder
    lab.let_pass(1.0)
    return thread
