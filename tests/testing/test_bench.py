"""A component is tried by itself: fed, heard, timed, failed and stopped, without a network."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import pytest

from selfconf.errors import ProgrammerError
from selfconf.sdk import Component, Refused, Response, Signal
from selfconf.testing import ComponentBench

ADVERTISEMENT = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix : <urn:test:> .
:thermostat a sc:Component, :Thermostat ;
    sc:hasInput [ sc:name "temperature" ; sc:signalType :Temperature ] ;
    sc:hasOutput [ sc:name "heating" ; sc:signalType :Switch ] , [ sc:name "ticks" ; sc:signalType :Number ] ;
    sc:hasParameter [ sc:name "wanted" ; sc:parameterType :Degrees ] , [ sc:name "mode" ; sc:parameterType :Mode ] .
"""


class Thermostat(Component):
    """Heats while it is colder than wanted, and counts the seconds."""

    wanted: Any = 20.0
    mode: Any = None
    ticks = 0
    rests = 0

    def started(self) -> None:
        if self.wanted == "never":
            raise Refused("there is no heating here")
        self.every(1.0, self.tick)

    def stopped(self) -> None:
        self.rests += 1

    def tick(self) -> None:
        self.ticks += 1
        self.emit("ticks", self.ticks)

    def received(self, port: str, signal: Signal) -> None:
        if signal["celsius"] > 1000:
            self.fail("it burns")
        else:
            self.emit("heating", {"on": signal["celsius"] < self.wanted})

    def parameter_set(self, name: str, value: Any) -> None:
        setattr(self, name, value)


def test_what_is_sent_is_answered() -> None:
    bench = ComponentBench(Thermostat(), ADVERTISEMENT)
    bench.start()
    bench.send("temperature", {"celsius": 15.0})
    bench.send("temperature", {"celsius": 25.0})
    assert bench.emitted["heating"] == [{"on": True}, {"on": False}]


def test_parameters_are_set_as_what_they_are() -> None:
    thermostat = Thermostat()
    bench = ComponentBench(thermostat, ADVERTISEMENT)
    bench.start(wanted=10.5, mode='a "quiet" one')
    assert (thermostat.wanted, thermostat.mode) == (10.5, 'a "quiet" one')
    bench.send("temperature", {"celsius": 15.0})
    assert bench.emitted["heating"] == [{"on": False}]


def test_a_parameter_may_have_any_name() -> None:
    thermostat = Thermostat()
    ComponentBench(thermostat, ADVERTISEMENT.replace('sc:name "mode"', 'sc:name "self"')).start(self="quiet")
    assert vars(thermostat)["self"] == "quiet"


@pytest.mark.parametrize("value", [1e-7, 1e22, -0.5, 3, -4, True, "1e-7"])
def test_a_parameter_is_set_to_any_number_or_text(value: Any) -> None:
    thermostat = Thermostat()
    ComponentBench(thermostat, ADVERTISEMENT).start(wanted=value)
    assert (type(thermostat.wanted), thermostat.wanted) == (type(value), value)


@pytest.mark.parametrize("value", [None, float("inf"), [1]])
def test_what_no_parameter_is_set_to_is_named(value: Any) -> None:
    with pytest.raises(ProgrammerError, match="a finite number or a truth value; wanted is not, by"):
        ComponentBench(Thermostat(), ADVERTISEMENT).start(wanted=value)


def test_parameters_of_one_type_are_set_together() -> None:
    thermostat, alike = Thermostat(), ADVERTISEMENT.replace(":Mode", ":Degrees")
    with pytest.raises(ProgrammerError, match="'wanted' and 'mode' are of one, Degrees: they have one value"):
        ComponentBench(thermostat, alike).start(wanted=1, mode=2)
    ComponentBench(thermostat, alike).start(wanted=3, mode=3)
    assert (thermostat.wanted, thermostat.mode) == (3, 3)


def test_time_is_turned_by_hand() -> None:
    bench = ComponentBench(Thermostat(), ADVERTISEMENT)
    bench.start()
    before = len(bench.emitted["ticks"])
    bench.advance(10.0)
    assert len(bench.emitted["ticks"]) - before == 10


def test_a_failure_is_told_and_a_stop_brings_it_to_rest() -> None:
    thermostat = Thermostat()
    bench = ComponentBench(thermostat, ADVERTISEMENT)
    assert not bench.active
    assert repr(bench) == "<bench of thermostat, which does not act>"
    bench.start()
    assert bench.active
    assert repr(bench) == "<bench of thermostat, which acts>"
    assert bench.failure is None
    bench.send("temperature", {"celsius": 2000.0})
    assert bench.failure == "it burns"
    assert not bench.active
    bench.stop()
    assert thermostat.rests >= 1


@pytest.mark.parametrize("seconds", [float("nan"), float("inf"), -5.0])
def test_time_goes_by_numbers_and_forward_on_the_bench(seconds: float) -> None:
    bench = ComponentBench(Guide(), GUIDE)
    bench.start()
    for let_pass in (bench.advance, partial(bench.call, "map", None)):
        with pytest.raises(ProgrammerError, match="simulated seconds are a number"):
            let_pass(seconds)


def test_a_component_that_acts_is_not_started_again_and_one_stop_is_enough() -> None:
    bench = ComponentBench(Thermostat(), ADVERTISEMENT)
    bench.start()
    with pytest.raises(ProgrammerError, match="thermostat acts already; stop it first"):
        bench.start()
    bench.stop()
    assert not bench.active
    bench.advance(10.0)
    assert not bench.active
    bench.start(wanted=30.0)
    bench.send("temperature", {"celsius": 25.0})
    assert bench.emitted["heating"] == [{"on": True}]


def test_what_is_no_component_and_no_advertisement_is_refused_in_a_sentence() -> None:
    for component in (None, Thermostat):
        with pytest.raises(ProgrammerError, match="a component is an object of a class"):
            ComponentBench(component, ADVERTISEMENT)  # type: ignore[arg-type]  # that is what is tested
    with pytest.raises(ProgrammerError, match="a source is a path"):
        ComponentBench(Thermostat(), 42)  # type: ignore[arg-type]  # that is what is tested
    bench, no_name = ComponentBench(Guide(), GUIDE), 3
    for use in (bench.call, partial(bench.answer, answer=str)):
        with pytest.raises(ProgrammerError, match=r"operation 3$"):
            use(no_name)  # type: ignore[operator]  # that is what is tested


def test_an_actuator_that_breaks_as_it_is_stopped_has_failed() -> None:
    class Motor(Component):
        def stopped(self) -> None:
            raise ValueError("it is stuck")

    motor = "@prefix sc: <https://w3id.org/selfconf#> .\n<urn:test:motor> a sc:Component, <urn:test:Motor> ."
    bench = ComponentBench(Motor(), motor)
    bench.start()
    assert bench.failure is None
    bench.stop()
    assert bench.failure == "its code has not come to rest"


def test_what_breaks_in_a_component_is_its_failure() -> None:
    bench = ComponentBench(Thermostat(), ADVERTISEMENT)
    bench.start()
    bench.send("temperature", {"fahrenheit": 15.0})
    assert bench.failure is not None
    assert "KeyError" in bench.failure


def test_a_component_that_declines_says_why() -> None:
    thermostat = Thermostat()
    thermostat.wanted = "never"
    with pytest.raises(ProgrammerError, match=r"thermostat does not start: there is no heating here$"):
        ComponentBench(thermostat, ADVERTISEMENT).start()


GUIDE = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix : <urn:test:> .
:guide a sc:Component, :Guide ;
    sc:hasInput [ sc:name "place" ; sc:signalType :Place ] ;
    sc:hasOutput [ sc:name "map" ; sc:signalType :Map ] ;
    sc:hasOperation [ sc:name "map" ; sc:request :Place ; sc:response :Map ] , [ sc:name "reset" ] ;
    sc:needsOperation [ sc:name "draw" ; sc:request :Place ; sc:response :Map ] .
"""


class Guide(Component):
    """Has a map drawn of each place that it hears of, and answers with the last one."""

    last: Any = None

    def received(self, port: str, signal: Signal) -> None:
        self.call("draw", signal.value, answered=self.drawn)

    def drawn(self, answer: Response) -> None:
        self.last = answer.value if answer else answer.detail
        self.emit("map", self.last)

    def called(self, operation: str, request: Signal) -> Any:
        if operation == "reset":
            self.last = None
            return True
        if self.last is None:
            raise Refused(f"there is no map of {request.value} yet")
        return self.last


def test_operations_are_called_and_answered() -> None:
    bench = ComponentBench(Guide(), GUIDE)
    bench.start()
    assert bench.call("map", "kitchen").detail == "there is no map of kitchen yet"
    bench.send("place", "kitchen")
    assert bench.emitted["map"] == ["the bench does not answer"]
    bench.answer("draw", lambda place: f"a plan of the {place}")
    bench.send("place", "kitchen")
    assert bench.call("map", "kitchen").value == bench.emitted["map"][-1] == "a plan of the kitchen"
    assert bench.call("reset").value is True
    assert not bench.call("map", "kitchen")


def test_ports_and_parameters_that_are_not_there_are_named() -> None:
    guide = ComponentBench(Guide(), GUIDE)
    with pytest.raises(ProgrammerError, match="guide cannot be called now; start it first"):
        guide.call("map")
    with pytest.raises(ProgrammerError, match="no operation 'draw'"):
        guide.call("draw")
    with pytest.raises(ProgrammerError, match="no need of an operation 'map'"):
        guide.answer("map", str)
    bench = ComponentBench(Thermostat(), ADVERTISEMENT)
    with pytest.raises(ProgrammerError, match="no parameter 'colour'"):
        bench.start(colour="red")
    bench.start()
    with pytest.raises(ProgrammerError, match="no input 'pressure'"):
        bench.send("pressure", 1)


def test_what_is_emitted_is_checked_against_its_signal_type_by_ontologies_and_the_advertisement_s_own_document(
    tmp_path: Path,
) -> None:
    words = """@prefix rob: <https://w3id.org/selfconf/robotics#> . @prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
<urn:test:Switch> rob:field ( [ rob:fieldName "on" ; rob:datatype xsd:decimal ] ) .
"""
    (tmp_path / "words.ttl").write_text(words)
    for bench in (
        ComponentBench(Thermostat(), ADVERTISEMENT, ontologies=tmp_path),
        ComponentBench(Thermostat(), f"{ADVERTISEMENT}\n{words}"),
    ):
        bench.start()
        bench.send("temperature", {"celsius": 15.0})
        assert bench.failure is not None
        assert "what it emits on 'heating'" in bench.failure
        assert bench.emitted["heating"] == []


KETTLE = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix : <urn:test:> .
:kettle a sc:Component, :Kettle ; sc:hasInput [ sc:name "state" ; SAID ] .
"""


class Kettle(Component):
    """Notes what it hears."""

    def __init__(self) -> None:
        self.heard: list[Any] = []

    def received(self, port: str, signal: Signal) -> None:
        self.heard.append(signal.value)


@pytest.mark.parametrize("optional", ["", " ; sc:optional true"])
@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path sc:unit ; sh:hasValue unit:K ]",
        "sh:property [ sh:path ( sc:rate sc:value ) ; sh:minCount 1 ; sh:minInclusive 5 ]",
        "sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] rob:support ) ; sh:hasValue :Astrid ]",
    ],
)
def test_an_input_is_fed_whatever_shape_it_accepts(shape: str, optional: str) -> None:
    kettle = Kettle()
    said = f"sc:signalType rob:Temperature{optional} ; sc:accepts [ {shape} ]"
    bench = ComponentBench(kettle, KETTLE.replace("SAID", said))
    bench.start()
    bench.send("state", {"temperature": 2.0})
    assert kettle.heard == [{"temperature": 2.0}]


def test_an_input_of_several_types_is_sent_what_is_of_any() -> None:
    kettle = Kettle()
    bench = ComponentBench(kettle, KETTLE.replace("SAID", "sc:signalType rob:Temperature, rob:Text"))
    bench.start()
    bench.send("state", {"temperature": 2.0})
    bench.send("state", {"text": "boiling"})
    bench.send("state", {"temperature": 100.0})
    assert kettle.heard == [{"temperature": 2.0}, {"text": "boiling"}, {"temperature": 100.0}]
    with pytest.raises(ProgrammerError, match=r"'state' of kettle lacks 'temperature' .* and lacks 'text'"):
        bench.send("state", {"colour": "red"})


@pytest.mark.parametrize(
    ("value", "why"),
    [
        ({"celsius": 2.0}, "what is sent to the input 'state' of kettle lacks 'temperature'"),
        (b"2.0", "'state' of kettle is bytes"),
        (object(), "'state' of kettle is"),
    ],
)
def test_a_malformed_signal_is_refused_and_the_component_acts_on(value: Any, why: str) -> None:
    kettle = Kettle()
    bench = ComponentBench(kettle, KETTLE.replace("SAID", "sc:signalType rob:Temperature"))
    bench.start()
    with pytest.raises(ProgrammerError, match=why):
        bench.send("state", value)
    assert bench.active
    bench.send("state", {"temperature": 2.0})
    assert kettle.heard == [{"temperature": 2.0}]


def test_nothing_is_sent_to_a_component_that_does_not_act() -> None:
    bench = ComponentBench(Thermostat(), ADVERTISEMENT)
    with pytest.raises(ProgrammerError, match="thermostat does not act; start it first"):
        bench.send("temperature", {"celsius": 15.0})
    bench.start()
    bench.send("temperature", {"celsius": 2000.0})
    with pytest.raises(ProgrammerError, match="thermostat does not act: it burns"):
        bench.send("temperature", {"celsius": 15.0})
