"""Trying components and tasks without a network: an ecology in memory, with a clock turned by hand.

`MemoryEcology` holds components and runs tasks, in one thread and in simulated time, each as a `MemoryRun`.
`ComponentBench` tries one component by itself: it feeds its inputs and hears its outputs. `Faults` are what the
simulated network does to messages. The programs are the real ones: sites, configurators and the runtime of the SDK; the
network alone is played.

    from selfconf.testing import ComponentBench

    def test_it_heats_when_it_is_cold():
        bench = ComponentBench(Thermostat())
        bench.start()
        bench.send("temperature", {"temperature": 15.0})
        assert bench.emitted["heating"] == [{"on": True}]
"""

from selfconf.bus.memory import Faults
from selfconf.testing.bench import ComponentBench
from selfconf.testing.memory_ecology import MemoryEcology, MemoryRun

__all__ = ["ComponentBench", "Faults", "MemoryEcology", "MemoryRun"]
