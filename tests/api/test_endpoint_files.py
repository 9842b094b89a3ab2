"""The advertisements of an endpoint as files: only from where nobody on the way could have changed them."""

from __future__ import annotations

import pytest

from selfconf import read, template
from selfconf.api.answer import Method
from selfconf.api.ecology import EndpointEcology
from selfconf.api.endpoint_files import endpoint_files
from selfconf.errors import AuthorError, BindingError, NetworkError
from tests.cli.endpoints import oxigraph
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri

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
        "http://127.0.0.1@example.org/query",
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


@pytest.mark.process
def test_what_the_task_may_want_lies_in_a_folder_for_as_long_as_it_is_needed() -> None:
    lamp = ":lamp a sc:Component, :Lamp ."
    with oxigraph(PREFIXES + "\n".join((*ADVERTISEMENTS.values(), lamp)), {}) as url:
        ecology = EndpointEcology(f"{url}?union-default-graph")
        with endpoint_files(ecology, TASK, Method()) as folder:
            found = read(folder).components
            expected = read(PREFIXES + "\n".join(ADVERTISEMENTS.values())).components
            assert dict(found) == {component: expected[component] for component in found}
            assert iri("thinking-cap") in found
            assert iri("lamp") not in found
    assert not folder.exists()
