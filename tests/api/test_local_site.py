"""A site of one's own serves while a block lasts, and says why where it cannot."""

from __future__ import annotations

import pytest

import selfconf as sc
from selfconf.api.local_site import SiteProcess
from selfconf.errors import AuthorError, SiteMisusedError


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


def test_a_site_watches_files_and_nothing_else() -> None:
    with pytest.raises(AuthorError, match="not -"):
        SiteProcess(["-"])
    with pytest.raises(AuthorError, match="no file or folder"):
        SiteProcess(["no-such-folder"])
