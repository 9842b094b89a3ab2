"""`site`: an init-component, which serves the advertisements of this host and watches the files."""

from __future__ import annotations

import argparse
from pathlib import Path

from selfconf.cli.options import add_ontology_argument, add_reasoning_argument
from selfconf.cli.site_options import add_site_arguments
from selfconf.cli.terminal import complaining_aside, display

EXAMPLE = """  selfconf site examples/peis-home --ecology home
  selfconf site restart person-tracker"""
RESTART = "restart"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "paths",
        metavar="PATH",
        nargs="*",  # texts: a path would make one slash of the two of an IRI
        help="advertisements: files, or folders with *.ttl below them (default: the `ads` of selfconf.toml); or"
        " `restart COMPONENT`, which ends a component that a site has started, and starts it again",
    )
    listen = (
        "where to listen; port 0 is any free one (default: on 127.0.0.1, at a port derived from the name of the"
        " ecology, so that former clients find a site that is started again; if it is taken, at any free port)"
    )
    add_site_arguments(parser, listen, "--connect")
    parser.add_argument(
        "--state",
        metavar="DIR",
        type=Path,
        help="where the tasks that live in the ecology are kept (default: in the runtime folder of this machine)",
    )
    add_ontology_argument(parser)
    add_reasoning_argument(parser, "which triples the shapes of roles inside of composites see")
    parser.add_argument(
        "--log",
        metavar="DIR",
        type=Path,
        help="where to keep what the components print that this site starts: lines with time, stream and component, in"
        " ECOLOGY@SITE.log, which rotates (default: log in the runtime folder)",
    )


def run(given: argparse.Namespace) -> int:
    """Serve until SIGINT, SIGTERM or SIGHUP; then 0. Of `restart`: 0 once the component lives again."""
    if given.paths[:1] == [RESTART]:
        return _restart(given)
    from selfconf.api.arguments import checked_path
    from selfconf.api.sites.site_program import SiteOptions, serve

    paths = [checked_path(path) for path in given.paths] or given.project.values.get("ads")
    if not paths:
        given.misused("there is nothing to serve; name files or folders, or give `ads` in selfconf.toml")
    options = SiteOptions(
        paths=tuple(paths),
        ecology=given.ecology,
        name=given.name,
        listen=given.listen,
        connect=tuple(given.connect),
        state=given.state,
        log=given.log,
        keys=given.keys,
        insecure=given.insecure,
        ontologies=tuple(given.ontology),
        reasoning=given.reasoning,
    )
    with complaining_aside() as complain:
        serve(options, complain)
    return 0


def _restart(given: argparse.Namespace) -> int:
    from selfconf.cli.options import joined

    if len(given.paths) != 2:
        given.misused("restart takes one component, by its IRI or local name; a folder of that name is ./restart")
    with joined(given) as ecology:
        now = ecology.restart(given.paths[1])
    display(f"{now.component} lives again at site {now.site}: {now.place}")
    return 0
