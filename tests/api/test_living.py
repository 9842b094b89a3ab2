"""`join`: the living ecology as the library sees it, and tasks of one's own in it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf import LivingEcology, Refusal, join, template
from selfconf.api.answer import Answer
from selfconf.api.ecology import Solutions
from selfconf.errors import AuthorError, NetworkError
from tests.cli.processes import Home
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri

pytestmark = pytest.mark.process
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


def test_what_is_advertised_is_found_and_whether_it_lives(living: LivingEcology) -> None:
    assert len(living.components) == len(ADVERTISEMENTS)
    assert living.sites == ("home",)
    assert living.state(iri("person-tracker")) == "alive"
    assert living.state(iri("pippi-drive")) == "absent"
    assert living.state(iri("nobody")) == "absent"
    assert living.complaints == ()


def test_the_only_ecology_of_this_machine_need_not_be_named(house: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(house.runtime))
    with join() as living:
        assert living.name == house.ecology
        assert house.ecology in repr(living)


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
    with pytest.raises(NetworkError, match="no configurator 'nobody' answers"):
        living.stop("nobody")
    assert living.stop(status.configurator) == (status.configurator,)
    assert program.ended() == 0
    assert living.tasks == ()


def test_an_ecology_that_is_not_there_is_an_error_that_says_what_to_try(house: Home) -> None:
    with pytest.raises(NetworkError, match="is it the right name"):
        join("elsewhere", connect=[house.endpoint()])
    with pytest.raises(NetworkError, match="selfconf site"):
        join()
    with pytest.raises(AuthorError, match="cannot name an ecology"):
        join("a/b", connect=[house.endpoint()])


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
