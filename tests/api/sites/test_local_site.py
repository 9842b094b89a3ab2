"""A site of one's own serves while a block lasts, and says why where it cannot."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

import selfconf as sc
from selfconf import sites
from selfconf.api.sites.local_site import SiteProcess
from selfconf.errors import AuthorError, NetworkError, ProgrammerError, SiteMisusedError
from selfconf.termination import alive
from tests.lab import write_advertisements


@pytest.mark.process
def test_a_site_of_ones_own_serves_while_the_block_lasts(ecology: str) -> None:
    with SiteProcess(["examples/clock"], ecology) as site:
        assert [(one.ecology, one.endpoint) for one in sc.sites()] == [(ecology, site.endpoint)]
        assert site.running()
        with sc.join(ecology, connect=site.endpoints) as living:
            assert len(living.components) == 2
    assert sc.sites() == ()
    assert not site.running()


@pytest.mark.process
def test_a_site_that_cannot_run_has_said_why(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SiteMisusedError, match="has said why"), SiteProcess(["examples/clock"], "no/name"):
        pass
    assert "no/name" in capfd.readouterr().err


def test_sites_are_those_of_an_ecology_with_a_name() -> None:
    with pytest.raises(AuthorError, match="cannot name an ecology"):
        sites("a/b")
    with pytest.raises(ProgrammerError, match=r"^the name of an ecology is text, not 42$"):
        sites(42)  # type: ignore[arg-type]  # that is what is tested


def test_a_site_watches_files_and_nothing_else(tmp_path: Path) -> None:
    with pytest.raises(AuthorError, match="not -"):
        SiteProcess(["-"])
    with pytest.raises(AuthorError, match="give files to ontologies, not -"):
        SiteProcess([tmp_path], ontologies=[Path("-")])
    with pytest.raises(AuthorError, match="no file or folder"):
        SiteProcess(["no-such-folder"])


@pytest.mark.process
def test_a_site_listens_while_its_block_runs_and_is_gone_after_it(tmp_path: Path) -> None:
    site = SiteProcess([write_advertisements(tmp_path / "ads")])
    assert sites() == ()
    with site:
        (found,) = sites()
        assert (found.ecology, found.site, found.endpoint) == (site.ecology, site.name, site.endpoint)
        assert sites(site.ecology) == (found,)
        assert sites("another") == ()
        assert site.running()
        assert site.endpoints == [site.endpoint]
        assert alive(found.process)
    assert not alive(found.process)
    assert sites() == ()


@pytest.mark.process
def test_a_site_ends_with_its_block_also_when_that_fails(tmp_path: Path) -> None:
    found: list[int] = []

    def fail() -> None:
        with SiteProcess([tmp_path]) as site:
            found.extend(local.process for local in sites(site.ecology))
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert [alive(process) for process in found] == [False]


@pytest.mark.process
def test_a_site_that_is_killed_is_known_to_have_ended_with_its_code(tmp_path: Path) -> None:
    with SiteProcess([tmp_path]) as site:
        (found,) = sites(site.ecology)
        os.kill(found.process, signal.SIGKILL)
        os.waitid(os.P_PID, found.process, os.WEXITED | os.WNOWAIT)
        assert not site.running()
    assert site.exit_code_before_end == -signal.SIGKILL


@pytest.mark.process
def test_a_site_that_hangs_holds_up_no_program_at_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("selfconf.api.sites.local_site.OWN_SITE_ENDS", 0.2)
    with SiteProcess([tmp_path]) as site:
        (found,) = sites(site.ecology)
        os.kill(found.process, signal.SIGSTOP)
    assert not alive(found.process)


@pytest.mark.process
def test_a_site_of_a_named_ecology_connects_to_the_others(tmp_path: Path) -> None:
    with SiteProcess([tmp_path], "home") as first, SiteProcess([tmp_path], "home", [first.endpoint]) as second:
        assert {site.site for site in sites("home")} == {first.name, second.name}
        assert second.endpoints == [second.endpoint, first.endpoint]


@pytest.mark.process
def test_a_site_that_does_not_listen_in_time_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("selfconf.api.sites.local_site.SITE_STARTS", 0.0)
    with pytest.raises(NetworkError, match="does not listen after 0 s"), SiteProcess([tmp_path]):
        pytest.fail("it does not listen")
    assert sites() == ()
