"""Record what selfconf answers now, say what has changed since the record, or show one answer.

    python -m tests.recorded.record answers            record the structure of all answers: codes, members, exit codes
    python -m tests.recorded.record sentences          record the sentences alone, after rewording them
    python -m tests.recorded.record answers examples   only those of one group
    python -m tests.recorded.record show NAME          show what is recorded of a case, and its files
    python -m tests.recorded.record count              count how often which codes occur in the random ecologies

Type it in the root of the tree. The first two name every answer that differs from the record before: look through
them before you commit. A record is compressed JSON; `git diff` cannot show it, the test and these commands can.
"""

from __future__ import annotations

import argparse
import json
import lzma
import os
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from tests.recorded import cases
from tests.recorded.answers import Answer, differences
from tests.recorded.clock import acts
from tests.recorded.ecologies import generated

HERE = Path(__file__).resolve().parent
GROUPS: Mapping[str, Callable[[Path], Iterator[tuple[str, Answer]]]] = {
    "ecologies": cases.ecologies,
    "examples": lambda _: cases.on_tree(cases.examples),
    "bad": lambda _: cases.on_tree(cases.bad),
    "misuse": lambda _: cases.on_tree(cases.misuse),
    "scaffolds": cases.scaffolds,
    "clock": acts,
}
"""What is recorded together; each may use an empty folder."""
Record = dict[str, dict[str, Any]]
"""By group and by the name of a case."""


def answers(group: str, here: Path) -> dict[str, Answer]:
    """What selfconf answers now to the cases of a group."""
    found: dict[str, Answer] = {}
    for name, answer in GROUPS[group](here):
        assert name not in found, f"two cases are called {name!r}"
        found[name] = answer
    return found


@cache
def load(part: str) -> Record:
    """What is recorded: of the structure (`answers`) or of the `sentences`, which are read once."""
    path = HERE / f"{part}.json.xz"
    record: Record = json.loads(lzma.decompress(path.read_bytes())) if path.exists() else {}
    return record


def parts(group: str, found: Mapping[str, Answer], part: str) -> dict[str, Any]:
    """One part of the answers of a group, as JSON values; cases without a sentence have none."""
    if part == "sentences":
        return {name: answer.sentences for name, answer in found.items() if answer.sentences}
    structure: dict[str, Any] = {name: answer.structure for name, answer in found.items()}
    return {"files": cases.digest(), **structure} if group == "ecologies" else structure


def compared(group: str, found: Mapping[str, Answer], part: str, most: int = 40) -> str:
    """What differs from the record, or nothing: each case with each place, up to so many lines.

    Of random ecologies only as many are compared as were found.
    """
    recorded, now = load(part).get(group, {}), parts(group, found, part)
    if group == "ecologies" and (last := max(found, default="")):
        recorded = {name: one for name, one in recorded.items() if name[:12] <= last[:12] or name == "files"}
    if recorded.get("files") != now.get("files"):
        return "the generator makes other ecologies than those that are recorded"
    lines: list[str] = []
    differing = 0
    for name in sorted({*recorded, *now}):
        if recorded.get(name) == now.get(name) and json.dumps(recorded.get(name)) == json.dumps(now.get(name)):
            continue
        differing += 1
        lines.append(name)
        lines += [f"    {line}" for line in differences(recorded.get(name), now.get(name))]
    if not lines:
        return ""
    rest = [f"and {len(lines) - most} lines more"] if len(lines) > most else []
    head = f"{differing} of {len(now)} answers differ from the record ({part} of {group}):"
    return "\n".join([head, *lines[:most], *rest])


def record(part: str, groups: Iterable[str]) -> None:
    """Record one part of every answer of some groups, and say what has changed."""
    kept = load(part)
    for group in groups:
        with tempfile.TemporaryDirectory() as here:
            found = answers(group, Path(here))
        print(compared(group, found, part, most=1_000) or f"{part} of {group}: as recorded")
        kept[group] = parts(group, found, part)
    text = json.dumps(kept, ensure_ascii=False, separators=(",", ":")).encode()
    path = HERE / f"{part}.json.xz"
    path.write_bytes(lzma.compress(text, preset=9 | lzma.PRESET_EXTREME))
    print(f"{sum(map(len, kept.values()))} {part}, {len(text)} bytes, {path.stat().st_size} compressed")


def show(name: str) -> None:
    """Print what is recorded of a case, and the files of its ecology, if it is a random one."""
    if name.startswith("ecology-"):
        ecology = generated(int(name.removeprefix("ecology-")[:4]))
        for path, text in ecology.files.items():
            print(f"# {path}\n{text}")
        print("# options:", *map(repr, ecology.options))
    known = False
    for part in ("answers", "sentences"):
        for group, recorded in load(part).items():
            for case, value in recorded.items():
                if case.startswith(name):
                    known = True
                    print(f"# {part} of {group}: {case}\n{json.dumps(value, indent=1, ensure_ascii=False)}")
    if not known:
        raise SystemExit(f"the name of no case begins with {name!r}; a failing test names cases")


def count() -> None:
    """Print how often which status, reasons, repairs and other members occur in the random ecologies."""
    found: Counter[str] = Counter()
    for name, answer in load("answers")["ecologies"].items():
        if name == "files":
            continue
        if not name.endswith("configure json"):
            found[name.partition(" ")[2] or name] += 1
            continue
        body = answer.get("stdout", {})
        found[f"exit {answer['exit']}"] += 1
        found[f"status {body.get('status')}"] += 1
        for kind in ("reasons", "repairs"):
            found.update({f"{kind}: {each['code']}" for each in body.get(kind, ())})
        for member in ("near_misses", "what_if", "cost", "parameters", "bindings", "connections"):
            found[f"with {member}"] += bool(body.get(member))
        found["with several components in a role"] += any(len(r["components"]) > 1 for r in body.get("roles", ()))
        found["with words on stderr"] += answer["stderr"] > 0
    for what, number in sorted(found.items()):
        print(f"{number:5} {what}")


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description="record what selfconf answers")
    parser.add_argument("what", choices=("answers", "sentences", "show", "count"))
    parser.add_argument(
        "name", nargs="?", default="", help="which group to record; for show, how the name of a case begins"
    )
    given = parser.parse_args()
    if given.what in ("answers", "sentences") and given.name not in ("", *GROUPS):
        parser.error(f"there is no group {given.name}, but {', '.join(GROUPS)}")
    if given.what == "show":
        show(given.name)
    elif given.what == "count":
        count()
    else:
        with tempfile.TemporaryDirectory() as runtime:
            os.environ["SELFCONF_RUNTIME_DIR"] = runtime
            record(given.what, [given.name] if given.name else GROUPS)
    return 0


if __name__ == "__main__":
    sys.exit(main())
