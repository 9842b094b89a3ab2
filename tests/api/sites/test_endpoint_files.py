"""The advertisements of an endpoint become files for a site: what a task may want, and of endpoints to be trusted."""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

import pytest

import selfconf as sc
from selfconf import template
from selfconf.api.ecology import EndpointEcology
from selfconf.api.method import Method
from selfconf.api.sites.endpoint_files import endpoint_files
from selfconf.errors import AuthorError, BindingError, NetworkError
from tests.cli.endpoints import oxigraph
from tests.lab import NAVIGATE


@pytest.mark.process
def test_what_a_task_may_want_is_in_files_while_the_block_runs(clock: sc.TaskSpecification) -> None:
    texts = {name: Path(f"examples/clock/{name}.ttl").read_text() for name in ("clock", "display")}
    unwanted = Path("examples/peis-home/motor-drive.ttl").read_text()
    with oxigraph(unwanted, {f"x:{name}": text for name, text in texts.items()}) as url:
        with endpoint_files(EndpointEcology(url), clock, Method()) as (folder, left_out):
            assert left_out == ()
            descriptor = os.open(folder, os.O_RDONLY)
            with pytest.raises(BlockingIOError):  # so that it is not removed for its age
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.close(descriptor)
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


TASK = template(NAVIGATE).bind(robot=":Astrid", goal="x")


@pytest.mark.parametrize(
    "url",
    [
        "http://example.org/query",
        "http://192.0.2.1/query",
        "http://[2001:db8::1]/query",
        "http://0.0.0.0/query",
        "http://localhost.example.org/query",
        "http://127.0.0.1.example.org/query",
        "http://example.org/127.0.0.1",
        "http://example.org?localhost",
        "http:///query",
        "ftp://example.org/query",
        "file:///etc/passwd",
        "httpsx://example.org/",
        "example.org",
        "",
    ],
)
def test_what_could_be_changed_on_its_way_is_not_asked(url: str) -> None:
    with (
        pytest.raises(AuthorError, match="a run starts the commands that advertisements state"),
        endpoint_files(EndpointEcology(url), TASK, Method()),
    ):
        pytest.fail("there are no files")


def test_a_user_name_that_looks_like_this_machine_is_refused() -> None:
    with pytest.raises(AuthorError, match=r"^the URL of example\.org has a user name or a password in it"):
        EndpointEcology("http://127.0.0.1@example.org/query")


@pytest.mark.parametrize(
    "url",
    [
        "https://127.0.0.1:9/query",
        "HTTPS://127.0.0.1:9/query",
        "http://127.0.0.1:9/query",
        "http://127.8.9.10:9/query",
        "http://[::1]:9/query",
        "http://localhost:9/query",
        "http://LOCALHOST:9/query",
    ],
)
def test_https_and_this_machine_are_asked(url: str) -> None:
    with pytest.raises(NetworkError, match="cannot ask"), endpoint_files(EndpointEcology(url), TASK, Method()):
        pytest.fail("nothing listens there")


def test_a_task_that_is_not_complete_is_said_before_anything_is_asked() -> None:
    ecology = EndpointEcology("http://127.0.0.1:9/query")
    with pytest.raises(BindingError, match="needs a value"), endpoint_files(ecology, template(NAVIGATE), Method()):
        pytest.fail("there are no files")


def test_what_is_no_url_is_refused_in_a_sentence() -> None:
    task = template("examples/clock/tell-the-time.ttl")
    with pytest.raises(AuthorError, match="https://"), endpoint_files(EndpointEcology("http://[/"), task, Method()):
        pass
