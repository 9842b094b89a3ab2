"""Whether an inside that was refused can be configured again: what is free, what lives anew, what is advertised."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from selfconf import files
from selfconf.composites.inside_prospect import InsideProspect
from selfconf.composition import Composer
from selfconf.configurator import Loss, State
from selfconf.deployment import RunRequest
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause
from selfconf.rdf.advertisements import Advertisement
from tests.lab import PREFIXES, Lab, iri, task_of

LENS = iri("lens")
ADVERTISED = {
    "lens": """:lens a sc:Component, :Lens ; SHAREABLE sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] ;
        sc:hasParameter [ sc:name "zoom" ; sc:parameterType :Zoom ] .""",
    "sink": ':sink a sc:Component, :Sink ; sc:hasInput [ sc:name "seen" ; sc:signalType rob:Text ] .',
}
INSIDE = f"""{PREFIXES}
:inside a sc:Template ; sc:roles ( :eye ) . :eye a sc:Role ; sh:class :Lens ; SETS ."""
OTHER = f"""{PREFIXES}
:other a sc:Template ; sc:roles ( :eye :sink ) .
:eye a sc:Role ; sh:class :Lens ; sc:feeds :sink ; sc:sets [ sc:parameterType :Zoom ; sc:value 2 ] .
:sink a sc:Role ; sh:class :Sink ."""


class Prospect:
    """The prospect of an inside that needs the lens, in a lab with that and a task that may hold it."""

    def __init__(
        self, folder: Path, *, shareable: bool = False, zoom: int = 2, loss: Loss | None = None, living: bool = True
    ) -> None:
        text = ADVERTISED["lens"].replace("SHAREABLE", f"sc:shareable {str(shareable).lower()} ;")
        self.lab = Lab(folder, advertised={**ADVERTISED, "lens": text})
        self.lab.site("home", *ADVERTISED)
        for name in ADVERTISED if living else ():
            self.lab.component(name)
        self.lab.let_pass(3.0)
        task = task_of(INSIDE.replace("SETS", f"sc:sets [ sc:parameterType :Zoom ; sc:value {zoom} ]"), ())
        self.searches = 0

        composer = Composer(task)

        def compose(known: Mapping[IRI, Advertisement], lost: frozenset[IRI], running: Configuration | None) -> Outcome:
            self.searches += 1
            return composer.compose(known, lost, running)

        request = RunRequest.of(composer, compose)
        state = State(priority=0, lost={} if loss is None else {LENS: loss, iri("sink"): loss})
        self.prospect = InsideProspect(self.lab.network.node(), "lab", request, state)
        self.known = {one.component: one for one in files.advertisements(folder / "home" / "lens.ttl")[0]}

    def able(self, *, recovered: bool = False) -> bool:
        """Whether a look finds that the inside can be configured."""
        found: list[bool] = []
        self.prospect.look(self.known, lambda: found.append(True), recovered=recovered)
        self.lab.let_pass(5.0)
        return bool(found)


@pytest.mark.parametrize(("priority", "able"), [(-1, True), (0, False), (1, False)])
def test_what_a_task_of_the_same_or_a_higher_priority_holds_is_not_to_be_had(
    tmp_path: Path, priority: int, able: bool
) -> None:
    prospect = Prospect(tmp_path)
    assert prospect.able()
    agent = prospect.lab.agent(OTHER, (), priority=priority)
    assert prospect.lab.running(agent)
    assert prospect.able() is able
    agent.stop()
    prospect.lab.let_pass(3.0)
    assert prospect.able()


@pytest.mark.parametrize(("zoom", "able"), [(2, True), (3, False)])
def test_what_a_task_would_share_is_to_be_had_by_an_inside_that_wants_the_same(
    tmp_path: Path, zoom: int, able: bool
) -> None:
    prospect = Prospect(tmp_path, shareable=True, zoom=zoom)
    assert prospect.lab.running(prospect.lab.agent(OTHER, ()))
    assert prospect.able() is able


@pytest.mark.parametrize("life", ["lens1", ""])
def test_a_component_that_was_lost_counts_again_in_a_new_life(tmp_path: Path, life: str) -> None:
    prospect = Prospect(tmp_path, loss=Loss(Cause.FAIL, "it is dirty", life))
    assert prospect.lab.runtimes["lens"].life == "lens1"
    assert not prospect.able()
    prospect.lab.crash("lens")
    prospect.lab.let_pass(3.0)
    assert not prospect.able()
    prospect.lab.component("lens")
    prospect.lab.let_pass(3.0)
    assert prospect.able()


@pytest.mark.parametrize(("cause", "able"), [(Cause.FAIL, True), (Cause.HUNG, False)])
def test_only_a_component_that_has_raised_fail_may_have_recovered_in_the_same_life(
    tmp_path: Path, cause: Cause, able: bool
) -> None:
    prospect = Prospect(tmp_path, loss=Loss(cause, "it is dirty", "lens1"))
    assert not prospect.able()
    assert prospect.able(recovered=True) is able
    prospect.lab.crash("lens")
    prospect.lab.let_pass(3.0)
    assert not prospect.able(recovered=True)


def test_a_component_that_did_not_live_counts_once_it_does_however_late_it_is_looked_at(tmp_path: Path) -> None:
    prospect = Prospect(tmp_path, loss=Loss(Cause.REFUSED, "it does not run"), living=False)
    prospect.lab.let_pass(1.0)
    prospect.lab.component("lens")
    prospect.lab.let_pass(3.0)
    assert prospect.able()


@pytest.mark.parametrize("life", ["lens1", ""], ids=["and which was only cut off", "and which was not named"])
def test_a_component_of_which_a_life_has_ended_counts_as_soon_as_it_lives(tmp_path: Path, life: str) -> None:
    prospect = Prospect(tmp_path, loss=Loss(Cause.CRASH, "it does not live any more", life))
    prospect.lab.let_pass(1.0)
    assert prospect.able()
    prospect.lab.crash("lens")
    prospect.lab.let_pass(3.0)
    assert not prospect.able()


def test_a_component_that_another_task_held_is_not_lost(tmp_path: Path) -> None:
    assert Prospect(tmp_path, loss=Loss(Cause.YIELD, "another asks for it", "lens1", busy=True)).able()


def test_it_is_searched_again_only_where_something_is_other_than_before(tmp_path: Path) -> None:
    prospect = Prospect(tmp_path)
    agent = prospect.lab.agent(OTHER, ())
    assert prospect.lab.running(agent)
    assert not prospect.able()
    assert not prospect.able()
    assert prospect.searches == 1
    agent.stop()
    prospect.lab.let_pass(3.0)
    assert prospect.able()
