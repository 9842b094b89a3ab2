"""`new`: writes the first files of a component, a template or an ontology, valid and commented."""

from __future__ import annotations

import argparse
import re
import sys
from keyword import iskeyword
from pathlib import Path

from selfconf.cli.scaffolds import SCAFFOLDS
from selfconf.errors import AuthorError, NamespaceError
from selfconf.model.wording import as_typed

EXAMPLE = """  selfconf new component kitchen-thermometer
  selfconf new template watch-the-temperature
  selfconf configure watch-the-temperature.ttl --ads ."""

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:[-_][A-Za-z0-9]+)*")
_NAMESPACE = re.compile(
    r"[a-z][a-z0-9+.-]*:(?:[^\x00-\x20<>\"{}|^`\\%\ud800-\udfff]|%[0-9a-f]{2})*[#/:]", re.IGNORECASE
)
_MODULES = sys.stdlib_module_names | {"selfconf", "zenoh"}
"""Modules that a component needs, or may: beside a file of that name none would be found."""
_HOME = "https://example.org/my-home#"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("kind", metavar="KIND", choices=tuple(SCAFFOLDS), help="component, template or ontology")
    parser.add_argument("name", metavar="NAME", help="its name, such as kitchen-thermometer: letters, digits, - and _")
    parser.add_argument(
        "--dir", metavar="DIR", type=Path, default=Path(), help="where the files go (default: the current folder)"
    )
    parser.add_argument(
        "--namespace",
        metavar="IRI",
        help=f"what the IRIs of your own terms start with, up to #, / or : (default: {_HOME}; "
        "of an ontology https://example.org/NAME#)",
    )


def run(given: argparse.Namespace) -> int:
    """0 when the files are written; their paths go to stdout, what to do next to stderr."""
    written = scaffold(given.kind, given.name, given.dir, given.namespace)
    for path in written:
        print(path)
    print(f"next: change them, and type `selfconf validate {as_typed(written[0])}`", file=sys.stderr)
    return 0


def scaffold(kind: str, name: str, folder: Path, namespace: str | None) -> list[Path]:
    """Write the files of one thing; raises AuthorError, and writes nothing, if there is a file of that name."""
    if not _NAME.fullmatch(name):
        raise AuthorError(
            f"{name!r} cannot be a name; begin with an ASCII letter, go on with these and digits, a - or _ between them"
        )
    if namespace is None:
        namespace = f"https://example.org/{name}#" if kind == "ontology" else _HOME
    if not _NAMESPACE.fullmatch(namespace):
        raise NamespaceError(namespace)
    words = " ".join(re.split("[-_]", name))
    class_ = "".join(part[:1].upper() + part[1:] for part in re.split("[-_]", name))
    if kind == "component" and (name in _MODULES or iskeyword(class_)):
        raise AuthorError(f"{name!r} is something else in Python already; choose another name, such as my-{name}")
    fillings = {
        "name": name,
        "class_": class_,
        "namespace": namespace,
        "document": namespace.rstrip("#"),
        "label": words[:1].upper() + words[1:],
        "lower": words,
    }
    files = {folder / f"{name}{ending}": text.substitute(fillings) for ending, text in SCAFFOLDS[kind].items()}
    for path in files:
        if path.exists():
            raise AuthorError(f"{path} is there already, and is not overwritten; choose another name or --dir")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path, text in files.items():
            with path.open("x", encoding="utf-8") as file:
                file.write(text)
    except OSError as error:
        raise AuthorError(f"cannot write to {folder}: {error.strerror}") from None
    return list(files)
