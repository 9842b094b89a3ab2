"""The living ecology as the library sees it: its components, sites, tasks and answers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import selfconf as sc
from selfconf import LivingEcology, Refusal, join, template, this_machine
from selfconf.api import synchronous_bus
from selfconf.api.answer import Answer
from selfconf.api.ecology import Solutions
from selfconf.bus.port import Request
from selfconf.bus.zenoh import ZenohBus
from selfconf.discovery import Discovery, ecology_view
from selfconf.errors import AuthorError, NetworkError, ProgrammerError
from selfconf.this_machine import LocalSite
from tests.cli.processes import Home
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri
from tests.suspended_run import suspended_run

pytestmark = pytest.mark.process


def test_an_ecology_is_found_by_name_by_endpoint_or_as_the_only_one(served: Home) -> None:
    for arguments, options in (
        ((served.ecology,), {}),
        ((), {}),
        ((), {"connect": [served.endpoint()]}),
        ((), {"connect": served.endpoint()}),
        ((served.ecology,), {"connect": (served.endpoint(),)}),
    ):
        with sc.join(*arguments, **options) as living:
            assert len(living.components) == 2
            assert repr(living) == f"<living ecology {served.ecology}>"


def test_components_are_looked_up_anew_each_time(served: Home) -> None:
    with sc.join() as living:
        components = living.components
        assert [living.state(component) for component in components] == ["dormant", "dormant"]
        assert living.sites == ("home",)
        other = served.folder / "more"
        other.mkdir()
        (other / "lamp.ttl").write_text("<x:lamp> a <https://w3id.org/selfconf#Component>, <x:Lamp> .")
        served.site("attic", str(other), connect=(served.endpoint(),))
        assert served.until(lambda: len(living.components) == 3)
        assert living.state(sc.IRI("x:lamp")) == "absent"
        assert living.sites == ("attic", "home")
        assert "lamp" in repr(living.components)
        assert "lamp" in living._repr_html_()


def test_an_ecology_that_was_only_joined_is_discovered_for_its_sites_and_for_a_state(served: Home) -> None:
    with sc.join() as living:
        assert living.state(sc.IRI("https://example.org/my-home#clock")) == "dormant"
    with sc.join() as living:
        assert living.sites == ("home",)


def test_looking_and_configuring_start_nothing(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join() as living:
        answer = living.configure(clock, what_if=True)
        assert answer
        assert answer == sc.configure(clock, living)
        assert answer == sc.configure(clock, sc.read("examples/clock"))
        refusal = living.configure(clock.bind(room=":cellar"))
        assert isinstance(refusal, sc.Refusal)
        assert sc.partition(clock, living)["source"].eligible == answer["source"]
        assert [living.state(component) for component in living.components] == ["dormant", "dormant"]
        assert living.tasks == ()


def test_the_ecology_is_asked_in_sparql(served: Home) -> None:
    with sc.join() as living:
        (row,) = living.query("SELECT ?g ?place { GRAPH ?g { ?c rob:place ?place } }")
        assert row["place"] == "https://example.org/my-home#kitchen"
        assert living.query("ASK { ?c a sc:Configuration }") is False


def test_what_cannot_be_run_is_refused_in_a_sentence(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join() as living:
        with pytest.raises(ProgrammerError, match=r"a task is what selfconf\.template\(\) gives"):
            living.run("clock.ttl")  # type: ignore[arg-type]  # that is what is tested
        with pytest.raises(ProgrammerError, match=r"a task is what selfconf\.template\(\) gives"):
            living.detach("clock.ttl")  # type: ignore[arg-type]  # that is what is tested
        with pytest.raises(ProgrammerError, match="an upgrade comes after"):
            living.run(clock, upgrade=-1)
        for run in (living.run, living.detach):
            for name in (3, None):
                with pytest.raises(ProgrammerError, match=r"^the name of a task is text, not "):
                    run(clock, name=name)  # type: ignore[operator]  # that is what is tested
        with pytest.raises(ProgrammerError, match=r"^wait is True or False, not 'no'$"):
            living.run(clock, wait="no")  # type: ignore[arg-type]  # that is what is tested


def test_what_is_no_term_is_refused_in_a_sentence_and_a_local_name_is_one(served: Home) -> None:
    nothing: Any = None
    with sc.join() as living:
        for ask in (living.component, living.state, living.restart, living.why):
            with pytest.raises(ProgrammerError, match=r"is text, not None$"):
                ask(nothing)
        with pytest.raises(ProgrammerError, match=r"^the name of a task is text, not 3$"):
            living.stop(3)  # type: ignore[arg-type]  # that is what is tested
        with pytest.raises(ProgrammerError, match=r"^a moment is a number of seconds"):
            living.why("clock", "x")  # type: ignore[arg-type]  # that is what is tested
        clock = living.component("clock").advertisement.component
        assert [living.state(name) for name in (clock, "clock", ":clock", "x:clock", f"<{clock}>")] == ["dormant"] * 5
        with pytest.raises(AuthorError, match="no component lamp is advertised"):
            living.state("lamp")
    for arguments in ({"ecology": 42}, {"keys": 42}):
        with pytest.raises(ProgrammerError, match="text"):
            sc.join(**arguments)  # type: ignore[arg-type]  # that is what is tested


def test_an_ecology_that_was_left_says_so(served: Home, clock: sc.TaskSpecification) -> None:
    with sc.join() as living:
        pass
    living.close()
    for ask in (
        lambda: living.components,
        lambda: living.tasks,
        lambda: living.query("ASK {}"),
        lambda: living.configure(clock),
        lambda: living.run(clock),
        lambda: living.detach(clock),
        lambda: living.stop(),
    ):
        with pytest.raises(ProgrammerError, match="the ecology was left"):
            ask()
    assert repr(living) == f"<living ecology {served.ecology}>"
    shown = living._repr_html_()
    assert shown.startswith(f"<pre>&lt;living ecology {served.ecology}&gt;: the ecology was left"), shown


def test_stopping_what_is_not_there_says_what_to_try(served: Home) -> None:
    with sc.join() as living:
        assert living.stop() == ()
        with pytest.raises(NetworkError, match="selfconf tasks"):
            living.stop("c123")


def test_sites_are_listed_with_name_endpoint_and_process(served: Home) -> None:
    (site,) = sc.sites()
    assert (site.site, site.ecology, site.endpoint) == ("home", served.ecology, served.endpoint())
    assert Path(f"/proc/{site.process}").exists()
    assert sc.sites("no-such-ecology") == ()


def test_without_a_site_joining_says_what_to_try() -> None:
    assert sc.sites() == ()
    with pytest.raises(NetworkError, match="selfconf site"):
        sc.join()


TASK = template(NAVIGATE).bind(robot=":Astrid", goal="x")


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """The paper's ecology with all of its components in one process, but for Pippi's drive, which nothing runs."""
    house = Home(tmp_path_factory.mktemp("house"))
    house.site("home", "ads")
    house.components("sonar", "encoder", "tracker", "odometry", "control", "drive")
    yield house
    house.close()


@pytest.fixture
def living(house: Home) -> Iterator[LivingEcology]:
    """The ecology, joined."""
    with join(house.ecology, connect=[house.endpoint()]) as living:
        yield living


def test_an_ecology_that_cannot_be_reached_any_more_is_not_taken_for_an_empty_one(
    living: LivingEcology, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as cut_off:
        cut_off.setattr(synchronous_bus, "LINK_BACK", 0.2)
        cut_off.setattr(ZenohBus, "link", "")
        asked_for = (living.discover, living.component_states, living.holders, living.all_tasks, living.deployed)
        for asked in (*asked_for, lambda: living.tasks, living.stop, lambda: living.why("tracker")):
            with pytest.raises(NetworkError, match="cut off from the ecology"):
                asked()
    assert living.discover().found


def test_an_ecology_is_asked_again_where_its_hub_was_opened_anew_meanwhile(
    living: LivingEcology, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, discover = list[str](), living._view.discover

    def discovered(done: Callable[[Discovery], None]) -> None:
        asked.append("once")
        discover(done)

    monkeypatch.setattr(living._view, "discover", discovered)
    monkeypatch.setattr(ZenohBus, "link", property(lambda _: f"hub {min(len(asked), 2)}"))
    assert living.discover().found
    assert len(asked) == 3


@pytest.mark.parametrize("many", [0, ecology_view.MANY_LIVES], ids=["large", "small"])
def test_what_is_advertised_is_found_and_whether_it_lives(
    living: LivingEcology, monkeypatch: pytest.MonkeyPatch, many: int
) -> None:
    monkeypatch.setattr(ecology_view, "MANY_LIVES", many)
    assert len(living.components) == len(ADVERTISEMENTS)
    assert living.sites == ("home",)
    assert living.state(iri("person-tracker")) == "alive"
    assert living.state(iri("pippi-drive")) == "absent"
    assert living.state(iri("nobody")) == "absent"
    assert living.complaints == ()


@pytest.mark.usefixtures("asked_here")
def test_a_query_is_asked_of_all_that_is_advertised_and_deployed(living: LivingEcology, house: Home) -> None:
    found = living.query("SELECT ?c { ?c a rob:MotorDrive } ORDER BY ?c")
    assert isinstance(found, Solutions)
    assert [row["c"] for row in found] == [iri("astrid-drive"), iri("pippi-drive")]
    deployed = "ASK { ?x a sc:Configuration }"
    assert living.query(deployed) is False
    program = house.run()
    program.act("running")
    assert living.query(deployed) is True
    assert program.end() == 0
    assert living.query(deployed) is False


def test_a_task_is_answered_for_the_ecology_as_it_is_now(living: LivingEcology) -> None:
    answer = living.configure(TASK)
    assert isinstance(answer, Answer)
    assert answer["position"] == (iri("person-tracker"),)
    refusal = living.configure(template(NAVIGATE).bind(robot=":Karlsson", goal="x"))
    assert isinstance(refusal, Refusal)
    assert living.tasks == ()


def test_a_run_is_shown_while_it_lasts_and_can_be_stopped_by_another_program(
    living: LivingEcology, house: Home
) -> None:
    assert living.stop() == ()
    program = house.run()
    program.act("running")
    (status,) = living.tasks
    assert (status.process, status.phase, status.template) == (program.number, "running", iri("navigate"))
    with pytest.raises(NetworkError, match="no task or configurator 'nobody' answers"):
        living.stop("nobody")
    assert living.stop(status.configurator) == ("navigate",)
    assert program.ended() == 0
    assert living.tasks == ()


def test_a_run_of_this_machine_that_is_suspended_is_told_by_its_task_apart_from_silent_configurators(
    living: LivingEcology, house: Home, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(house.runtime))
    with suspended_run(house.ecology, "patrol", house.endpoint()):
        assert living.all_tasks() == ()
        assert (living.silent, living.suspended) == ((), ("patrol",))
    assert living.all_tasks() == living.suspended == ()


def test_a_refusal_names_the_sites_that_did_not_answer(
    living: LivingEcology, house: Home, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(house.runtime))
    task = template(NAVIGATE).bind(robot=":Nobody", goal="(AT BEDROOM)")
    with suspended_run(house.ecology, "patrol", house.endpoint()) as program:
        this_machine.announce(LocalSite(house.ecology, "attic", house.endpoint(), program.pid))
        refusal = living.configure(task)
    assert isinstance(refusal, Refusal)
    assert refusal.missing_sites == living.missing_sites == ("attic",)


@pytest.mark.parametrize(
    ("configurator", "payload"),
    [("stranger", b"no Turtle"), ("*", b"<urn:a> a <https://w3id.org/selfconf#Configuration> .")],
    ids=["what is no Turtle", "the key of no configurator"],
)
def test_a_configuration_that_cannot_be_read_is_left_out_and_named(
    living: LivingEcology, house: Home, configurator: str, payload: bytes
) -> None:
    key = living._view.keys.configuration(configurator)

    def answer(request: Request) -> None:
        request.reply(key, payload)
        request.finish()

    undo = living._bus.serve(key, answer)
    program = house.run()
    program.act("running")
    (status,) = living.tasks
    assert list(living.deployed()) == [status.configurator]
    (complaint,) = living.complaints
    assert complaint.startswith("left out a configuration: ")
    assert living.links_of(status.name)
    assert living.complaints == (complaint,)
    living.dataset()
    assert complaint in living.complaints
    assert living.why(status.name)
    assert living.complaints == (complaint,)
    undo()
    assert program.end() == 0


def test_an_ecology_that_is_not_there_is_an_error_that_says_what_to_try(house: Home) -> None:
    with pytest.raises(NetworkError, match="is it the right name"):
        join("elsewhere", connect=[house.endpoint()])
    with pytest.raises(NetworkError, match="selfconf site"):
        join()
    with pytest.raises(AuthorError, match="cannot name an ecology"):
        join("a/b", connect=[house.endpoint()])
    with suspended_run("elsewhere", "patrol") as program:
        this_machine.announce(LocalSite("elsewhere", "attic", house.endpoint(), program.pid))
        with pytest.raises(NetworkError, match="the site 'attic' of ecology 'elsewhere', is suspended; `kill -CONT"):
            join("elsewhere", connect=[house.endpoint()])


def test_an_advertisement_that_does_not_conform_is_not_found(house: Home, tmp_path: Path) -> None:
    odd = Home(tmp_path)
    try:
        (odd.folder / "ads" / "bad.ttl").write_text(PREFIXES + ':bell a sc:Component, :Bell ; sc:preference "loud" .')
        odd.site("odd", "ads")
        with join(odd.ecology, connect=[odd.endpoint()]) as living:
            assert iri("bell") not in living.components
            assert len(living.components) == len(ADVERTISEMENTS)
    finally:
        odd.close()
