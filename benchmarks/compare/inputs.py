"""What both trees are measured on: files that are made once, and the commands over them.

Nothing is asked of a tree but its command line, so that it does not matter what its modules are called.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from benchmarks import validate
from benchmarks.scale import worlds
from benchmarks.search.families import scaling as f
from selfconf.search.problem import Problem

SEED = 52_417
PROCESS = "process"
"""The processor time of the whole process; other quantities are members of `seconds` in what it prints as JSON."""
HEAD = """\
@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:bench:> .
"""


@dataclass(frozen=True)
class Measure:
    """A command that both trees run, and what is measured of it."""

    part: str
    name: str
    arguments: tuple[str, ...]
    quantities: tuple[str, ...] = (PROCESS,)
    trials: int = 5
    codes: tuple[int, ...] = (0,)
    """The exit codes that it may have."""


def measures(folder: Path, examples: Path, smoke: bool) -> Iterator[Measure]:
    """Everything but failover, which is a program of its own.

    The examples are those of the earlier tree: a tree knows what an earlier one wrote, and not what a later one did.
    """
    yield from _start(examples, 15 if not smoke else 2)
    yield from _search(folder, smoke)
    yield from _scale(folder, 200 if smoke else 10_000, 1 if smoke else 5)
    yield from _validate(folder, examples, 20 if smoke else 2_000, 1 if smoke else 4)


def _start(examples: Path, trials: int) -> Iterator[Measure]:
    navigate = ("configure", str(examples / "navigate.ttl"), "--ads", str(examples / "peis-home"))
    bound = ("--bind", "robot=:Astrid", "--bind", "goal=(AT BEDROOM)")
    query = ("query", "SELECT ?c WHERE { ?c a rob:PositionSensor }", "--ads", str(examples / "peis-home"))
    yield Measure("start", "`selfconf --help`", ("--help",), trials=trials)
    yield Measure("start", "`configure`, the paper's template", (*navigate, *bound), trials=trials)
    yield Measure(
        "start", "`configure --reasoning subclass`", (*navigate, *bound, "--reasoning", "subclass"), trials=trials
    )
    refused = (*navigate, "--bind", "robot=:Pippi", "--bind", "goal=x")
    yield Measure("start", "`configure`, refused", refused, trials=trials, codes=(1,))
    yield Measure("start", "`query`", query, trials=trials)


FIRST: dict[str, Callable[[], Problem]] = {
    "navigation, 10 per role": partial(f.navigation, 10, SEED),
    "navigation, 1,000 per role": partial(f.navigation, 1_000, SEED),
    "navigation, impossible, 100 per role": partial(f.navigation, 100, SEED, False),
    "chain, 20 roles": partial(f.graph, "chain", 20, 10, 3, SEED),
    "tree, 50 roles": partial(f.graph, "tree", 50, 10, 3, SEED),
    "graph, 20 roles": partial(f.graph, "graph", 20, 10, 3, SEED),
    "distinct, 60 roles": partial(f.distinct, 60, 60),
    "distinct, impossible, 12 roles": partial(f.distinct, 12, 11),
    "distinct, scarce, 60 roles": partial(f.scarce, 60, 0.1, SEED),
    "3-SAT, 50 variables": partial(f.satisfiability, 50, 4.26, SEED),
    "3-SAT, 100 variables": partial(f.satisfiability, 100, 4.26, SEED),
    "missing signal, 20 roles": partial(f.missing, 20, 20, SEED),
    "fleet of 20, 100 per role": partial(f.fleet, 20, 100, SEED),
}
BEST: dict[str, Callable[[], Problem]] = {
    "navigation, 100 per role": partial(f.navigation, 100, SEED),
    "chain, 20 roles": partial(f.graph, "chain", 20, 10, 3, SEED),
    "tree, 20 roles": partial(f.graph, "tree", 20, 6, 3, SEED),
    "graph, 10 roles": partial(f.graph, "graph", 10, 5, 3, SEED),
    "distinct, 9 roles": partial(f.distinct, 9, 9),
    "fleet of 5, 20 per role": partial(f.fleet, 5, 20, SEED),
}
SMOKE = ("navigation, 10 per role", "graph, 10 roles")


def _search(folder: Path, smoke: bool) -> Iterator[Measure]:
    for strategy, problems in (("first", FIRST), ("best", BEST)):
        for number, (name, make) in enumerate(problems.items()):
            if smoke and name not in SMOKE:
                continue
            template, ads = folder / f"{strategy}-{number}.ttl", folder / f"{strategy}-{number}-ads.ttl"
            texts = turtle(make())
            for path, text in zip((template, ads), texts, strict=True):
                path.write_text(text)
            options = ("--ads", str(ads), "--strategy", strategy, "--format", "json")
            arguments = ("configure", str(template), *options)
            trials = 1 if smoke else 7
            yield Measure(f"search, {strategy}", name, arguments, ("search", PROCESS), trials, (0, 1))


def turtle(problem: Problem) -> tuple[str, str]:
    """A problem of a family as a template and advertisements: the class of a role is that of its candidates."""
    task, names = problem.task.template, [variable.parameter for variable in problem.partition.variables]
    shapes = [f"sh:property [ sh:path <{name}-of> ; sh:in ( <{name}> ) ]" for name in names]
    listed = f"sc:parameter {', '.join(f'<{name}>' for name in names)} ; " if names else ""
    order = " ".join(f"<{role.iri}>" for role in task.roles)
    text = [HEAD, f":t a sc:Template ; {listed}sc:roles ( {order} ) ;"]
    text.append(" sc:cost ( [ sc:term [ sc:property :price ] ] ) .\n")
    text += [f'<{name}> a sc:Parameter ; sc:name "{name.short}" .\n' for name in names]
    for role in task.roles:
        feeds = [f"sc:feeds <{each.sink}>" for each in task.interactions if each.source == role.iri]
        text.append(_statement(f"<{role.iri}> a sc:Role", [f"sh:class <{role.iri}-kind>", *shapes, *feeds]))
    return "".join(text), "".join(_advertisements(problem))


def _advertisements(problem: Problem) -> Iterator[str]:
    variables = problem.partition.variables
    said: dict[str, list[str]] = {}
    for role, candidates in zip(problem.task.template.roles, problem.candidates, strict=True):
        for candidate in candidates:
            parts = said.setdefault(candidate.profile.component, [f":price {1 + len(said) * 37 % 101}"])
            parts.append(f"a <{role.iri}-kind>")
            if len(parts) > 2:
                continue  # it is a candidate of another role too, and described already
            for link, ports in (("hasInput", candidate.profile.inputs), ("hasOutput", candidate.profile.outputs)):
                parts += [f'sc:{link} [ sc:name "{port.name}" ; sc:signalType <{port.signals[0]}> ]' for port in ports]
            for variable, mask in zip(variables, candidate.admits, strict=False):
                values = [value for place, value in enumerate(variable.domain) if mask == 1 << place]
                parts += [f"<{variable.parameter}-of> <{value}>" for value in values]
    yield HEAD
    for component, parts in said.items():
        yield _statement(f"<{component}> a sc:Component", parts)


def _statement(subject: str, said: list[str]) -> str:
    return " ;\n    ".join([subject, *said]) + " .\n"


def _scale(folder: Path, size: int, trials: int) -> Iterator[Measure]:
    template = folder / "scale.ttl"
    template.write_text(worlds.template())
    styles = {"alike": None, "each with types, signals and values of its own": worlds.unlike}
    for number, (style, form) in enumerate(styles.items()):
        path = folder / f"scale-{number}.ttl"
        texts = [form(text, each) if form and each else text for each, text in enumerate(worlds.ecology(size))]
        path.write_text("".join(texts))
        arguments = ("configure", str(template), "--ads", str(path), "--bind", "robot=:robot0", "--format", "json")
        quantities = ("load", "partition", PROCESS)
        yield Measure("scale", f"{size:,} advertisements, {style}", arguments, quantities, trials, (0, 1))


def _validate(folder: Path, examples: Path, size: int, trials: int) -> Iterator[Measure]:
    files = folder / "validate"
    files.mkdir()
    for each in range(size):
        (files / f"{each:05}.ttl").write_text(validate.HEAD + validate.advertisement(each))
    form = ("--format", "json")
    yield Measure("validate", "the examples", ("validate", str(examples), *form), trials=max(trials, 5))
    name = f"{size:,} files, one in ten with a mistake"
    yield Measure("validate", name, ("validate", str(files), *form), trials=trials, codes=(0, 1))
