"""The advertisements of a SPARQL endpoint as files, for a site that starts what they say."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from ipaddress import ip_address
from pathlib import Path
from urllib.parse import urlsplit

from selfconf.api.ecology import EndpointEcology
from selfconf.api.method import Method
from selfconf.api.sites.temporary_folder import temporary_folder
from selfconf.api.task import TaskSpecification
from selfconf.errors import AuthorError
from selfconf.model.left_out import LeftOut
from selfconf.rdf.turtle import to_turtle


@contextmanager
def endpoint_files(
    ecology: EndpointEcology, task: TaskSpecification, method: Method
) -> Iterator[tuple[Path, tuple[LeftOut, ...]]]:
    """A folder with the advertisements of an endpoint that a task may want, while the block runs, and what is left out.

    The commands in them will be started on this machine, so what they say has to come from where it claims to. Raises
    AuthorError for an endpoint on another machine that is not reached over HTTPS, and NetworkError.
    """
    if not _trustworthy(ecology.url):
        raise AuthorError(
            f"a run starts the commands that advertisements state, and what {ecology.url} answers can be changed on "
            "its way; give an https:// URL, or an endpoint on this machine"
        )
    composer = method.composer(task.complete())
    found, left_out = ecology.for_task(composer.partitioner, method.wider() or composer.hierarchy)
    with temporary_folder("selfconf-") as folder:
        for number, component in enumerate(sorted(found)):
            (folder / f"{number}.ttl").write_text(to_turtle(found[component].triples), "utf-8")
        yield folder, left_out


def _trustworthy(url: str) -> bool:
    """Whether what it answers cannot be changed between the endpoint and this machine."""
    try:
        where = urlsplit(url)
        return where.scheme == "https" or where.hostname == "localhost" or ip_address(where.hostname or "").is_loopback
    except ValueError:
        return False
