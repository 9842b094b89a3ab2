"""Writes the pages that are made from the code: `python -m docs.generate`; with `--check` it only looks."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path

from docs import json_schemas, ontology
from selfconf.cli.main import COMMANDS, parser
from selfconf.model.codes import CODES
from selfconf.project import OTHER_WORDS, PROJECT_FILE, PROJECT_KEYS

HERE = Path(__file__).parent
NOTE = "<!-- Made by `python -m docs.generate`; edit the code instead. -->"


def commands() -> str:
    """The reference of the command line, from the commands' own help."""
    os.environ["COLUMNS"] = "100"
    top = parser()
    pages = [f"# The command line\n\n{NOTE}\n", index(), project_file()]
    subparsers = next(action for action in top._actions if isinstance(action, argparse._SubParsersAction))
    for name in COMMANDS:
        help_ = subparsers.choices[name].format_help().rstrip()
        pages.append(f"## selfconf {name}\n\n{COMMANDS[name][0].upper()}{COMMANDS[name][1:]}.\n")
        pages.append(f"```text\n{help_}\n```\n")
        pages += [f"```text\n{one.format_help().rstrip()}\n```\n" for one in _subcommands(subparsers.choices[name])]
    return "\n".join(pages)


def index() -> str:
    """Each command with what it does, and a link to its options."""
    rows = "\n".join(f"| [`{name}`](#selfconf-{name}) | {does} |" for name, does in COMMANDS.items())
    return f"""| command | does |
|---|---|
{rows}

[`{PROJECT_FILE}`](#selfconftoml) spares typing the same options each time.
"""


def _subcommands(command: argparse.ArgumentParser) -> list[argparse.ArgumentParser]:
    """The parsers of the commands below a command, in their order."""
    nested = (action for action in command._actions if isinstance(action, argparse._SubParsersAction))
    return [parser for action in nested for parser in action.choices.values()]


def project_file() -> str:
    """What a project file may say, from the table by which it is read."""
    rows = "\n".join(f"| `{key}` | {setting.means} |" for key, setting in PROJECT_KEYS.items())
    words = " and ".join(f"`{word}` for `{key}`" for word, key in OTHER_WORDS.items())
    return f"""## selfconf.toml

In a file `{PROJECT_FILE}` a project says once which options its commands take. Commands look for it in the current
folder and upward from it. Each key is the option of that name. An option that is typed goes before the environment
(`$SELFCONF_ECOLOGY`, `$SELFCONF_CONNECT`, `$SELFCONF_KEYS`), and the environment before the file. `--help` shows where
each value comes from now, and `selfconf validate` checks the file.

```toml
ecology = "home"
ads = ["ads"]                # relative to this file, as all paths are
ontology = "ontology"
reasoning = "subclass"
seconds = 5

[bind.navigate]              # for the template or task of this name
robot = ":Astrid"
```

| key | says |
|---|---|
{rows}
| `bind.TEMPLATE.PARAMETER` | a value for a parameter, as `--bind PARAMETER=` takes it; numbers may go without quotes |

You may also write {words}, as the library does.

With `ads` or `endpoint` in the file,

* `configure`, `partition` and `query` look there; they ask the living ecology if `--ecology` or `--connect` is typed or
  set in the environment;
* `run` joins the ecology if sites of it are known, and else starts one for the `ads`;
* `site` serves the `ads`, and `validate` checks them, if no path is given.

A file that belongs neither to you nor to the owner of its folder is ignored.
"""


def codes() -> str:
    """The reference of the codes that `validate` reports."""
    sections = [f"{NOTE}\n\n# Codes of `selfconf validate`\n\nGenerated from `selfconf/model/codes.py`.\n"]
    for entry in CODES:
        lines = [f"## {entry.code}: {entry.title}\n", f"*{entry.severity.value}* · {entry.why}\n"]
        if entry.bad:
            lines += [
                "Not so:\n",
                f"```{entry.language}\n{entry.bad}\n```\n",
                "But so:\n",
                f"```{entry.language}\n{entry.good}\n```\n",
            ]
        sections.append("\n".join(lines))
    return "\n".join(sections)


def bodies() -> str:
    """The reference of what the commands print as JSON."""
    return f"{NOTE}\n\n{json_schemas.page()}"


PAGES: dict[str, Callable[[], str]] = {
    "commands.md": commands,
    "codes.md": codes,
    "json.md": bodies,
    "ontology.html": ontology.page,
}


def main() -> int:
    """0 if the pages are, or now are, up to date."""
    options = argparse.ArgumentParser(description="write the pages that are made from the code")
    options.add_argument("--check", action="store_true", help="write nothing; 1 if a page is out of date")
    check = options.parse_args().check
    stale = []
    for name, page in PAGES.items():
        if check and page is commands and sys.version_info[:2] != (3, 11):
            continue  # argparse words its help differently in other versions
        text, path = page().rstrip() + "\n", HERE / name
        if not path.is_file() or path.read_text() != text:
            stale.append(name)
            if not check:
                path.write_text(text)
    if check and stale:
        print(f"out of date: {', '.join(stale)}; type `python -m docs.generate`", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
