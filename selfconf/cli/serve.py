"""`serve`: the living ecology in a browser, by SPARQL over HTTP, and as W3C Things."""

from __future__ import annotations

import argparse
import importlib.util
import re
from pathlib import Path

from selfconf.cli.options import add_answer_seconds_argument, add_ecology_arguments, joined, whole_number
from selfconf.errors import InstallationError

EXAMPLE = """  selfconf serve --port 8000
  selfconf serve --allow-origin https://yasgui.example   # a page there may ask, too"""
LOCAL, PORT, QUERY_SECONDS = "127.0.0.1", 8000, 30.0
ORIGIN = re.compile(r"(https?)://(\[[0-9a-f:.]+\]|[a-z0-9](?:[a-z0-9.-]*[a-z0-9])?)(?::([0-9]{1,5}))?")
"""An origin as browsers send it, in small letters; names beyond ASCII stand in it as punycode."""
PORTS_LEFT_OUT = {"http": "80", "https": "443"}
"""The ports that browsers leave out of an origin."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "--host", metavar="ADDRESS", default=LOCAL, help="where to listen (default: %(default)s, this machine alone)"
    )
    parser.add_argument(
        "--port", metavar="N", type=_port, default=PORT, help="0 for any free one (default: %(default)s)"
    )
    add_answer_seconds_argument(parser, "a SPARQL query", QUERY_SECONDS)
    parser.add_argument(
        "--history",
        metavar="DIR",
        type=Path,
        help="keep what is deployed in this folder, as PROV-O, so that SPARQL reaches back (default: nothing is kept)",
    )
    parser.add_argument(
        "--allow-origin",
        dest="origins",
        metavar="ORIGIN",
        type=_origin,
        action="append",
        default=[],
        help="let pages of this origin, such as https://yasgui.example, ask SPARQL and the directory from within a"
        " browser; repeatable (default: no page but that of this server)",
    )
    parser.add_argument(
        "--insecure",
        action="store_true",
        help="with keys, listen beyond this host: by HTTP any program that reaches it sees what they protect",
    )
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 when it is ended by Ctrl-C, SIGTERM or SIGHUP."""
    missing = [name for name in ("starlette", "uvicorn") if importlib.util.find_spec(name) is None]
    if missing:
        raise InstallationError(f"what serves pages is missing: {' and '.join(missing)}; install the extra `serve`")
    from selfconf import rendezvous
    from selfconf.api.membership import Membership
    from selfconf.serve import ServerOptions, refuse_exposure, serve_ecology

    shown = rendezvous.credentials(given.keys, "read", "conf", "site")  # a server that may only look on is the safest
    if not given.insecure:
        refuse_exposure(given.host, shown)
    with joined(given) as ecology:
        membership = Membership(ecology.name, ecology.endpoints, shown)
    options = ServerOptions(given.host, given.port, given.answer_seconds, given.history, given.origins)
    serve_ecology(membership, options, lambda url: _tell(membership.ecology, url))
    return 0


def _tell(ecology: str, url: str) -> None:
    print(f"serving the ecology {ecology} at {url}; Ctrl-C ends it", flush=True)


def _port(text: str) -> int:
    port = whole_number(text)
    if port is None or not 0 <= port <= 65535:
        raise argparse.ArgumentTypeError(f"{text!r} is no port; it takes a number from 0 to 65535")
    return port


def _origin(text: str) -> str:
    found = ORIGIN.fullmatch(text.lower())
    if found is None:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no origin; it takes SCHEME://HOST or SCHEME://HOST:PORT without a path, such as"
            " https://yasgui.example"
        )
    scheme, host, port = found.groups()
    return f"{scheme}://{host}" if port in (None, PORTS_LEFT_OUT[scheme]) else f"{scheme}://{host}:{port}"
