"""The living ecology as the library sees it: its components, sites, tasks and answers."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf.errors import NetworkError
from tests.cli.processes import Home

pytestmark = pytest.mark.process


def test_an_ecology_is_found_by_name_by_endpoint_or_as_the_only_one(served: Home) -> None:
    for arguments, options in (
        ((served.ecology,), {}),
        ((), {}),
        ((), {"connect": [served.endpoint()]}),
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


def test_stopping_what_is_not_there_says_what_to_try(served: Home) -> None:
    with sc.join() as living:
        assert living.stop() == ()
        with pytest.raises(NetworkError, match="selfconf status"):
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
