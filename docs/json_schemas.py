"""The page `docs/json.md`, made from the JSON Schemas: what each command prints as JSON, member by member."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping
from functools import cache
from typing import Any

from selfconf import library

COMMANDS = (
    "configure",
    "partition",
    "query",
    "validate",
    "import",
    "run",
    "discover",
    "status",
    "tasks",
    "stop",
    "why",
    "access",
    "keys",
    "echo",
    "log",
    "top",
)
"""The commands with a schema, in the order of the page; each schema is named after its command."""
INTRODUCTION = """\
# What the commands print as JSON

Every command that prints results takes `--format json`. Its output is a contract:

* [JSON Schemas](https://json-schema.org) (draft 2020-12) describe it, in [`docs/schemas`](schemas) and in the package,
  where `selfconf.library.schemas()` lists the files.
* No other members occur than those listed here. A member that may be absent is marked as optional.
* Programs should use `status`, `act` and `code`. Sentences (`message`, `obstacle`, `hint`) are for people and may be
  reworded.
* The text is UTF-8, and letters of all scripts are not escaped.

The commands: COMMANDS

A schema refers to others by relative references, so a validator needs all of them:

```python
import json
from jsonschema import Draft202012Validator
from referencing import Registry, Resource
from selfconf import library

schemas = {path.name: json.loads(path.read_text("utf-8")) for path in library.schemas()}
registry = Registry().with_resources((s["$id"], Resource.from_contents(s)) for s in schemas.values())
validator = Draft202012Validator(schemas["configure.schema.json"], registry=registry)
validator.validate(answer)
```
"""
WIDTH = 118
"""Characters of a line of an example."""


def page() -> str:
    """The page in Markdown, without the note that it is made from something else."""
    links = ", ".join(f"[{name}](#selfconf-{name})" for name in COMMANDS)
    introduction = INTRODUCTION.replace("COMMANDS", f"{links}.")
    return "\n".join([introduction, *(line for name in COMMANDS for line in _section(name))])


@cache
def schema(name: str) -> dict[str, Any]:
    """A schema by its name, such as `configure`."""
    (path,) = (path for path in library.schemas() if path.name == f"{name}.schema.json")
    found: dict[str, Any] = json.loads(path.read_text("utf-8"))
    return found


def referred(name: str, part: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """What a reference in the schema of a name leads to, with the name of the schema that holds it."""
    while "$ref" in part:
        file, _, pointer = part["$ref"].partition("#")
        name = file.removesuffix(".schema.json") or name
        found: Any = schema(name)
        for step in pointer.split("/")[1:]:
            found = found[step]
        part = {**found, **{key: value for key, value in part.items() if key != "$ref"}}
    return name, part


def _section(name: str) -> Iterator[str]:
    whole = schema(name)
    yield f"## selfconf {name}\n"
    yield f"{whole['description']}\n\nSchema: [`{name}.schema.json`](schemas/{name}.schema.json)\n"
    shared = whole.get("properties", {}) if "oneOf" in whole else {}
    if shared:
        yield "Members of each:\n"
        yield from _listed(name, shared, tuple(shared))
    for variant in whole.get("oneOf", [whole.get("items", whole)]):
        yield from _members(*referred(name, variant), shared)
    examples = whole["examples"]
    if name == "run":
        yield "```json\n{}\n```\n".format("\n".join(json.dumps(one, ensure_ascii=False) for one in examples))
    else:
        yield from (f"```json\n{laid_out(one)}\n```\n" for one in examples)


def _members(name: str, part: dict[str, Any], shared: Collection[str]) -> Iterator[str]:
    """The members of an object, without those that are said to be shared by all of its kind."""
    act = part.get("properties", {}).get("act", {}).get("const")
    if "$schema" not in part:  # the description of the whole stands above
        yield f"**{f'`{act}`' if act else part['title']}:** {part['description']}\n"
    members = {key: value for key, value in part.get("properties", {}).items() if key not in shared}
    yield from _listed(name, members, part.get("required", ()))


def _listed(name: str, members: Mapping[str, dict[str, Any]], required: Collection[str]) -> Iterator[str]:
    for key, member in members.items():
        found = referred(name, member)[1]
        constant = found.get("const")
        said = f"`{constant}`" if isinstance(constant, str) else found["description"]
        yield f"* `{key}`{'' if key in required else ' (optional)'}: {said}"
    if members:
        yield ""


def laid_out(value: Any, indent: int = 0, lead: int = 0) -> str:
    """A JSON value over several lines, each object and array on one line where there is room."""
    flat = json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict) and value:
        flat = f"{{ {flat[1:-1]} }}"
    if len(flat) + indent + lead <= WIDTH or not isinstance(value, dict | list):
        return flat
    inner = " " * (indent + 2)
    if isinstance(value, dict):
        named = ((json.dumps(key, ensure_ascii=False), each) for key, each in value.items())
        parts = [f"{inner}{key}: {laid_out(each, indent + 2, len(key) + 2)}" for key, each in named]
        return "{{\n{}\n{}}}".format(",\n".join(parts), " " * indent)
    return "[\n{}\n{}]".format(",\n".join(inner + laid_out(each, indent + 2) for each in value), " " * indent)
