"""`access`: who may do what in a living ecology with keys, and who has tried what it may not."""

from __future__ import annotations

import argparse
from datetime import datetime, timezone
from typing import TYPE_CHECKING, Any

from selfconf.cli.options import add_ecology_arguments, add_format_argument, joined
from selfconf.cli.tasks import code_of_tasks
from selfconf.cli.terminal import complain, display, display_json
from selfconf.errors import AuthorError
from selfconf.model.wording import client_text, counted, utc_text

if TYPE_CHECKING:
    from selfconf.api.living.living_ecology import LivingEcology
    from selfconf.api.living.site_access import SiteAccess

EXAMPLE = """  selfconf access --keys keys
  selfconf access --keys keys --task tidy           # what each component of a deployed task may hear
  selfconf access --keys keys --believe attic https://example.org/my-home#lamp"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_ecology_arguments(parser)
    parser.add_argument("--task", metavar="NAME", help="only which sources each component of a deployed task hears")
    parser.add_argument(
        "--believe",
        metavar=("SITE", "COMPONENT"),
        nargs=2,
        help="decide to which site a component belongs that several sites advertise; holds for programs with the folder"
        " --keys",
    )
    add_format_argument(parser)


def run(given: argparse.Namespace) -> int:
    """0; 1 if a task is asked for that no configurator runs, and 2 where one that does not answer may run it."""
    if given.believe is not None:
        return _believe(given, *given.believe)
    with joined(given) as ecology:
        if given.task is not None:
            return _task(given, ecology)
        sites = ecology.access()
        if not sites:
            raise AuthorError("no site of the ecology has keys: everybody who reaches it may do everything")
        if given.format == "json":
            display_json({"sites": [_body(site) for site in sites]})
        else:
            for site in sites:
                _tell(site)
        for one in ecology.complaints:
            complain(one)
    return 0


def _believe(given: argparse.Namespace, site: str, component: str) -> int:
    from selfconf import rendezvous
    from selfconf.access import believe, written_component

    folder = rendezvous.keys_folder(given.keys)
    if folder is None:
        raise AuthorError("which programs shall believe it? give their folder of keys: --keys DIR")
    iri = written_component(component)  # no ecology is asked, which would know of which component it is the local name
    believe(folder, iri, site)
    display(f"programs with the folder {folder} believe that {iri} is that of site {site}")
    return 0


def _task(given: argparse.Namespace, ecology: LivingEcology) -> int:
    links = ecology.links_of(given.task)
    for one in ecology.complaints:
        complain(one)
    if links is None:
        code = code_of_tasks(ecology)
        complain(f"no configurator{' that answers' * bool(code)} runs a task {given.task!r}")
        return code or 1
    if given.format == "json":
        display_json({"task": given.task, "hears": [{"component": c, "of": list(o)} for c, o in links.items()]})
        return 0
    for component, heard in links.items():
        display(f"{component!r} hears {', '.join(map(repr, heard)) or 'no component'}")
    return 0


def _body(site: SiteAccess) -> dict[str, Any]:
    return {
        "site": site.site,
        "access": [
            {
                "principal": one.principal,
                "may": one.sentence,
                "says": list(one.says),
                "asked": list(one.asked),
                "hears": list(one.hears),
                "components": [site.components.get(chunk, chunk) for chunk in one.about],
            }
            for one in site.accesses
        ],
        "refused": [
            {
                "principal": one.principal,
                "attempt": one.attempt,
                "key": one.key,
                "number": one.number,
                "latest": one.latest,
            }
            for one in site.refused
        ],
        "access_control": site.access_control(),
    }


def _tell(site: SiteAccess) -> None:
    display(f"site {site.site}")
    for one in site.accesses:
        about = [site.components.get(chunk, chunk) for chunk in one.about]
        whose = f" ({', '.join(about[:3])}{', ...' * (len(about) > 3)})" if about else ""
        display(f"  {one.principal or 'everybody'}{whose}: {one.sentence}")
    display(f"  refused: {'nothing' if not site.refused else ''}")
    for refused in site.refused:
        at = datetime.fromtimestamp(refused.latest, timezone.utc)
        where = f" on {refused.key}" if refused.key else ""
        what = f"{client_text(refused.principal)}: {refused.attempt}{where}"
        display(f"    {what}, {counted(refused.number, 'time')}, latest {utc_text(at)}")
