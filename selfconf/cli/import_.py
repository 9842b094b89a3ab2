"""`import`: writes advertisements from descriptions in other formats."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from selfconf.cli.options import add_format_argument, domain
from selfconf.cli.terminal import complain, display, display_json
from selfconf.errors import AuthorError
from selfconf.model.wording import counted, listed

if TYPE_CHECKING:
    from selfconf.importing import ImportedFile, ImportReport

EXAMPLE = """  selfconf import wot examples/imports/lamp.td.json --out ads
  selfconf import ros2 examples/imports --out ads
  selfconf import wot http://192.0.2.7/.well-known/wot --out ads
  selfconf import ros2 --connect tcp/127.0.0.1:7447 --domain 0 --out ads"""
FORM_NAMES = ("wot", "ros2", "owl-s", "peis", "rdf")
# Those of `selfconf.importing.IMPORT_FORMATS`, which is not loaded to parse arguments; a test compares them.


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("form", metavar="FORMAT", choices=FORM_NAMES, help=f"{', '.join(FORM_NAMES)}")
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="a file, a folder with all files of the format below it, or an http or https URL, which is fetched",
    )
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        required=True,
        help="where the Turtle files go; those of an earlier import are replaced, other files are left alone",
    )
    parser.add_argument(
        "--namespace",
        metavar="IRI",
        help="the beginning of the IRIs of components whose source has none for them (default: urn:selfconf:FORMAT:)",
    )
    parser.add_argument(
        "--connect",
        dest="router",  # of ROS 2, and not where a site listens, as `connect` of the project file says
        metavar="ENDPOINT",
        help="for ros2, instead of sources: where the router of ROS 2 listens; the nodes that live now are imported",
    )
    parser.add_argument(
        "--domain", metavar="N", type=domain, default=0, help="the ROS_DOMAIN_ID of these nodes (default: %(default)s)"
    )
    add_format_argument(parser)


def run(given: argparse.Namespace) -> int:
    """0 if all was imported that can be read, 1 if there was nothing to import, 2 if some source cannot be read."""
    from selfconf.api.unknown_terms import unknown_in_file

    report = _imported(given)
    for unreadable in report.unreadable:
        complain(str(unreadable) if unreadable.file else f"selfconf import: {unreadable}")  # a place comes first
    for each in (*report.renamed, *report.left_out):
        complain(str(each))
    if not (report.files or report.unreadable or report.left_out):
        complain(f"selfconf import: {_looked_for(given)}")
    for file in report.files:
        for unknown in unknown_in_file(file.path):
            complain(unknown)
    if given.format == "json":
        display_json(_body(report))
    else:
        _print_table(report)
    return 2 if report.unreadable else 0 if report.files else 1


def _imported(given: argparse.Namespace) -> ImportReport:
    if given.router is None:
        from selfconf.importing import import_descriptions

        if not given.sources:
            raise AuthorError("name at least one SOURCE to import, or for ros2 a router with --connect")
        return import_descriptions(given.form, given.sources, given.out, given.namespace)
    from selfconf.api.living.living_import import import_living_nodes

    if given.form != "ros2" or given.sources:
        raise AuthorError("--connect imports the nodes that live in a domain of ROS 2; it goes with ros2 and no SOURCE")
    return import_living_nodes(given.router, given.domain, given.out, given.namespace)


def _looked_for(given: argparse.Namespace) -> str:
    """The sentence about sources that hold nothing of a format: which domain, or which files of a folder, was read."""
    from selfconf.importing import IMPORT_FORMATS

    if given.router is not None:
        return f"no node of ROS 2 lives in the domain {given.domain} at {given.router}; --domain names another one"
    *others, last = IMPORT_FORMATS[given.form].endings
    endings = f"{', '.join(others)} or {last}" if others else last
    where = listed(given.sources)
    written = ", but for those that an import has written" if ".ttl" in IMPORT_FORMATS[given.form].endings else ""
    read = f"of a folder the files that end in {endings} are read{written}"
    return f"there is nothing of the format {given.form} in {where}; {read}"


def _print_table(report: ImportReport) -> None:
    from selfconf.render import table

    rows = [[str(file.path), file.state.value, str(len(_components(file)))] for file in report.files]
    if rows:
        display(table(["file", "is", "components"], rows))
    components = sum(len(_components(file)) for file in report.files)
    display(f"{counted(components, 'component')} in {counted(len(rows), 'file')}")


def _components(file: ImportedFile) -> list[dict[str, Any]]:
    """The components of a file, with how much they take and give."""
    from selfconf.rdf.vocabulary import SC

    counted = {
        "inputs": SC.hasInput,
        "outputs": SC.hasOutput,
        "parameters": SC.hasParameter,
        "operations": SC.hasOperation,
        "needed_operations": SC.needsOperation,
    }
    return [
        {"component": str(each.subject), **{name: len(each.values(link)) for name, link in counted.items()}}
        for each in file.document.subjects(SC.Component)
    ]


def _body(report: ImportReport) -> dict[str, Any]:
    from selfconf.rdf.vocabulary import SC

    return {
        "format": report.form,
        "files": [
            {
                "file": str(file.path),
                "state": file.state.value,
                "source": file.document.source,
                "components": _components(file),
                "templates": [str(each.subject) for each in file.document.subjects(SC.Template)],
            }
            for file in report.files
        ],
        "renamed": [{"component": each.component, "was": each.was, "source": each.source} for each in report.renamed],
        "left_out": [
            {"what": each.what, "reason": each.reason, "count": each.number, "sources": list(each.sources)}
            for each in report.left_out
        ],
        "unreadable": [
            {"message": each.message, "source": each.file, "line": each.line, "column": each.column}
            for each in report.unreadable
        ],
    }
