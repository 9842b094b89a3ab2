"""The advertisements of an endpoint become files for a site: what a task may want, and of endpoints to be trusted."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf as sc
from selfconf.api.answer import Method
from selfconf.api.ecology import EndpointEcology
from selfconf.api.endpoint_files import endpoint_files
from selfconf.errors import AuthorError, NetworkError
from tests.cli.endpoints import oxigraph


@pytest.mark.process
def test_what_a_task_may_want_is_in_files_while_the_block_runs(clock: sc.TaskSpecification) -> None:
    texts = {name: Path(f"examples/clock/{name}.ttl").read_text() for name in ("clock", "display")}
    unwanted = Path("examples/peis-home/motor-drive.ttl").read_text()
    with oxigraph(unwanted, {f"x:{name}": text for name, text in texts.items()}) as url:
        with endpoint_files(EndpointEcology(url), clock, Method()) as folder:
            assert sc.validate(folder).conforms
            local = sc.read(folder)
            assert sorted(component.short for component in local.components) == ["clock", "display"]
            assert sc.configure(clock, local) == sc.configure(clock, sc.read(url))
        assert not folder.exists()


@pytest.mark.parametrize("url", ["http://example.org/query", "http://192.0.2.1/query", "http://127.0.0.1.nip.io/query"])
def test_an_endpoint_elsewhere_without_https_is_refused_before_it_is_asked(
    url: str, clock: sc.TaskSpecification
) -> None:
    with pytest.raises(AuthorError, match="https://"), endpoint_files(EndpointEcology(url), clock, Method()):
        pass


def test_an_endpoint_that_is_not_there_is_said_to_be_unreachable(clock: sc.TaskSpecification) -> None:
    ecology = EndpointEcology("http://127.0.0.1:1/query")
    with pytest.raises(NetworkError, match="is the server running"), endpoint_files(ecology, clock, Method()):
        pass
