"""Several components in one process, and how each finds its advertisement."""

from __future__ import annotations

import os
import socket
import threading
from pathlib import Path

import pytest

from selfconf.bus.memory import Network
from selfconf.bus.zenoh import ZenohBus
from selfconf.errors import AuthorError, NetworkError, ProgrammerError, SessionClosedError, TurtleError
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Reserve
from selfconf.sdk import Component, Host
from selfconf.sdk.host import profile_of
from tests.lab import ADVERTISEMENTS, PREFIXES, iri, write_advertisements
from tests.sdk.living import PATIENCE, LivingStage, until


def kind(advertisement: Path, component: str = "") -> type[Component]:
    """A component class with an advertisement."""
    return type("Lamp", (Component,), {"advertisement": advertisement, "component": component})


def test_a_component_is_what_its_advertisement_says(tmp_path: Path) -> None:
    folder = write_advertisements(tmp_path, "tracker")
    profile = profile_of(kind(folder / "tracker.ttl"))
    assert profile.component == iri("person-tracker")
    assert [port.name for port in profile.outputs] == ["pose"]


def test_of_several_components_in_one_file_the_class_says_which_it_is(tmp_path: Path) -> None:
    path = tmp_path / "all.ttl"
    path.write_text(PREFIXES + " ".join(ADVERTISEMENTS.values()))
    assert profile_of(kind(path, iri("pippi-drive"))).component == iri("pippi-drive")
    with pytest.raises(ProgrammerError, match="must say by `component`"):
        profile_of(kind(path))
    with pytest.raises(ProgrammerError, match="which one"):
        profile_of(kind(path, iri("nobody")))


def test_a_component_is_not_kept_from_living_by_another_one_in_its_file(tmp_path: Path) -> None:
    path = tmp_path / "both.ttl"
    path.write_text(PREFIXES + f"{ADVERTISEMENTS['tracker']} :lamp a sc:Component .")
    assert profile_of(kind(path, iri("person-tracker"))).component == iri("person-tracker")
    for malformed in ("", iri("lamp")):
        with pytest.raises(AuthorError, match="a type of its own"):
            profile_of(kind(path, malformed))


def test_an_advertisement_may_begin_with_a_mark_and_have_relative_iris(tmp_path: Path) -> None:
    (tmp_path / "lamp.ttl").write_bytes(b"\xef\xbb\xbf" + f"{PREFIXES} <#lamp> a sc:Component, :Lamp .".encode())
    assert profile_of(kind(tmp_path / "lamp.ttl")).component == f"{(tmp_path / 'lamp.ttl').as_uri()}#lamp"


def test_an_advertisement_that_is_missing_or_wrong_is_said_to_be(tmp_path: Path) -> None:
    with pytest.raises(ProgrammerError, match="needs an `advertisement`"):
        profile_of(Component)
    with pytest.raises(ProgrammerError, match="is not there"):
        profile_of(kind(tmp_path / "none.ttl"))
    (tmp_path / "broken.ttl").write_text("no turtle")
    with pytest.raises(TurtleError, match=r"broken\.ttl:1"):
        profile_of(kind(tmp_path / "broken.ttl"))
    (tmp_path / "bad.ttl").write_text(PREFIXES + ":lamp a sc:Component .")
    with pytest.raises(AuthorError, match="a type of its own"):
        profile_of(kind(tmp_path / "bad.ttl"))


def test_a_relative_path_counts_from_the_file_of_the_class() -> None:
    class Lamp(Component):
        advertisement = "lamp.ttl"

    assert Lamp.advertisement_path() == Path(__file__).parent / "lamp.ttl"


def test_components_of_one_host_live_and_end_together(tmp_path: Path) -> None:
    network, folder = Network(), write_advertisements(tmp_path)
    host = Host(network.node(), "lab")
    for name in ("tracker", "drive"):
        host.add(kind(folder / f"{name}.ttl")())
    observer = network.node()
    called: list[tuple[str, ...]] = []
    observer.roll_call(Keys("lab").any_life(), 1.0, called.append)
    host.poll(0.1)
    assert len(called[0]) == 2
    host.close()
    observer.roll_call(Keys("lab").any_life(), 1.0, called.append)
    network.run(lambda: len(called) == 2)
    assert called[1] == ()
    assert host.runtimes == []


def test_a_host_runs_until_the_condition_holds(tmp_path: Path) -> None:
    network = Network()
    host = Host(network.node(), "lab")
    told: list[bool] = []
    host.bus.later(5.0, lambda: told.append(True))
    host.run(lambda: bool(told))
    assert network.time == 5.0


def test_a_component_that_is_alive_already_is_not_begun_again(tmp_path: Path) -> None:
    network, folder = Network(), write_advertisements(tmp_path)
    first, second = Host(network.node(), "lab"), Host(network.node(), "lab")
    first.add(kind(folder / "tracker.ttl")())
    with pytest.raises(NetworkError) as refused:
        second.add(kind(folder / "tracker.ttl")())
    holder = f"process {os.getpid()} on {socket.gethostname()}"
    assert str(refused.value) == f"{iri('person-tracker')} is alive already: {holder}; end that one first"
    assert second.runtimes == []
    first.close()
    second.add(kind(folder / "tracker.ttl")())


def test_a_component_that_is_alive_and_does_not_answer_is_not_begun_again_either(tmp_path: Path) -> None:
    network, folder = Network(), write_advertisements(tmp_path)
    network.node().announce(Keys("lab").life(iri("person-tracker"), "1"))
    with pytest.raises(NetworkError, match="a process that does not answer; end that one first"):
        Host(network.node(), "lab").add(kind(folder / "tracker.ttl")())


LAMP = ':lamp a sc:Component, :Lamp ; sc:hasOutput [ sc:name "light" ; sc:signalType :Light ] .'


def test_components_have_the_thread_that_runs_the_host_and_the_bus_has_another(living: LivingStage) -> None:
    threads: list[threading.Thread] = []

    class Lamp(Component):
        component = "urn:c:lamp"

        def started(self) -> None:
            threads.append(threading.current_thread())

    host = living.host()
    host.add(living.advertised(Lamp, LAMP)())
    answers = living.apply("urn:c:lamp")
    host.run(lambda: bool(threads))
    assert threads == [threading.current_thread()]
    assert until(lambda: host.poll(0.01) or answers)
    host.close()


def test_a_living_component_is_refused_in_real_time_too(living: LivingStage) -> None:
    class Lamp(Component):
        component = "urn:c:lamp"

    living.component(living.advertised(Lamp, LAMP)())
    host = living.host()
    with pytest.raises(NetworkError, match=rf"urn:c:lamp is alive already: process {os.getpid()} on "):
        host.add(Lamp())
    host.close()


def test_a_host_of_which_a_component_is_superseded_ends_with_an_error(living: LivingStage) -> None:
    """Its process began at the same moment as another one, whose life is the smaller."""

    class Lamp(Component):
        component = "urn:c:lamp"

    living.advertised(Lamp, LAMP)
    hosts = [living.host(), living.host()]
    together = threading.Barrier(2)

    def join(host: Host, life: str) -> None:
        check = host._check_alone

        def both(profile: object) -> None:
            check(profile)  # type: ignore[arg-type]  # it is handed on
            together.wait(PATIENCE)

        host._check_alone = both  # type: ignore[method-assign]  # both look before either is alive
        host.add(Lamp(), life)

    threads = [threading.Thread(target=join, args=pair) for pair in zip(hosts, ("a", "b"), strict=True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    with pytest.raises(NetworkError, match="urn:c:lamp is alive already, in the life a; this process leaves"):
        hosts[1].run(lambda: False)
    assert hosts[0].trouble is None
    for host in hosts:
        host.close()


@pytest.mark.parametrize("removed", [False, True])
def test_closing_a_host_waits_until_its_components_are_at_rest(living: LivingStage, removed: bool) -> None:
    class Lamp(Component):
        component = "urn:c:lamp"
        lit = False

        def started(self) -> None:
            self.lit = True

        def stopped(self) -> None:
            self.lit = False

    host = living.host()
    lamp = host.add(living.advertised(Lamp, LAMP)())
    living.apply("urn:c:lamp")
    host.run(lambda: lamp.lit)
    if removed:
        host.remove(lamp)
    host.close()
    assert not lamp.lit
    assert not lamp.active


def test_a_component_that_is_removed_and_hangs_as_it_is_to_rest_is_noticed(living: LivingStage) -> None:
    class Lamp(Component):
        component = "urn:c:lamp"

        def stopped(self) -> None:
            living.release_code.wait()

    host = living.host()
    lamp = host.add(
        living.advertised(Lamp, LAMP.removesuffix(".") + " ; sc:deadline [ sc:value 0.1 ; sc:unit unit:SEC ] .")()
    )
    living.apply("urn:c:lamp")
    host.run(lambda: lamp.active)
    host.remove(lamp)
    living.run(host)
    assert until(lambda: living.hangs)
    assert living.hangs == ["urn:c:lamp: `stopped` has not returned within 0.1 s"]


def test_actuators_of_a_host_come_to_rest_before_what_feeds_them(living: LivingStage) -> None:
    at_rest: list[str] = []

    class Resting(Component):
        def stopped(self) -> None:
            at_rest.append(self.component)

    host = living.host()
    camera, motor = (type(name, (Resting,), {"component": f"urn:c:{name}"}) for name in ("camera", "motor"))
    host.add(living.advertised(camera, ':camera a sc:Component, :Camera ; sc:hasOutput [ sc:name "x" ] .')())
    host.add(living.advertised(motor, ":motor a sc:Component, :Motor .")())
    for component in host.runtimes:
        iri = component.profile.component
        reserved = living.call(iri, "reserve", Reserve(1, living.supervisor, "task~1"))
        assert until(lambda answers=reserved: answers)
        living.apply(iri)
    host.run(lambda: all(component.active for component in host.runtimes))
    host.close()
    assert at_rest == ["urn:c:motor", "urn:c:camera"]


def test_one_class_may_stand_for_several_things(tmp_path: Path) -> None:
    network, folder = Network(), write_advertisements(tmp_path)
    host = Host(network.node(), "lab")
    tracker, drive = Component(), Component()
    for component, name in ((tracker, "tracker"), (drive, "drive")):
        host.add(component, advertisement=folder / f"{name}.ttl")
    assert [runtime.profile.component for runtime in host.runtimes] == [iri("person-tracker"), iri("astrid-drive")]
    host.close()


def test_a_component_that_is_removed_leaves_and_may_come_again(tmp_path: Path) -> None:
    network, folder = Network(), write_advertisements(tmp_path, "tracker")
    host, observer = Host(network.node(), "lab"), network.node()
    component = host.add(kind(folder / "tracker.ttl")())
    (runtime,) = host.runtimes
    for _ in range(2):
        host.remove(component)
    host.poll(0.1)
    assert runtime.closed
    called: list[tuple[str, ...]] = []
    observer.roll_call(Keys("lab").any_life(), 1.0, called.append)
    network.run(lambda: bool(called))
    assert called == [()]
    host.add(component)
    assert not host.runtimes[0].closed
    host.close()


def test_an_actuator_whose_session_its_code_has_closed_comes_to_rest_and_its_host_has_to_end(
    living: LivingStage,
) -> None:
    class Lamp(Component):
        def __init__(self) -> None:
            self.said: list[str] = []

        def started(self) -> None:
            self.said.append("started")
            assert self._runtime is not None
            assert isinstance(self._runtime.bus, ZenohBus)
            self._runtime.bus._session.close()

        def stopped(self) -> None:
            self.said.append("stopped")

    host = living.host()
    lamp = host.add(living.advertised(Lamp, ":lamp a sc:Component, :Lamp .")())
    held = living.call("urn:c:lamp", "reserve", Reserve(1, living.supervisor, "task~1"))
    assert until(lambda: held)
    living.apply("urn:c:lamp")
    with pytest.raises(SessionClosedError, match="code of urn:c:lamp has closed the session"):
        host.run(lambda: False)
    host.close()
    assert lamp.said == ["started", "stopped"]
