"""Programs that use the library as its pages show it pass a strict type checker."""

from __future__ import annotations

import doctest
import subprocess
import sys
from pathlib import Path

import pytest

from selfconf.api.tasks.run import Run

pytest.importorskip("mypy", reason="mypy, which checks types, is not installed")

ROOT = Path(__file__).resolve().parents[2]
ANSWERS = """
answer = sc.configure(sc.template("t.ttl"), sc.read("ads"), seconds=5)
if answer:
    print(answer["position"], answer.connections, answer.to_turtle(), answer.to_mermaid())
else:
    print([str(reason.place) for reason in answer.reasons], answer.near_misses, answer.repairs)
"""

EVENTS = """
from selfconf import values

def told(event: values.AnyRunEvent) -> str:
    match event:
        case values.TaskRunning(configuration=configuration):
            return f"{configuration['screen']} in epoch {event.epoch}"
        case values.TaskWaiting() | values.TaskRefused():
            return f"{event.refusal and event.refusal.reasons}"
        case values.ComponentLost():
            return event.detail
    if event.act == "left out":
        return event.reason
    if event.act == "composed" and event.outcome:
        return event.outcome.to_turtle()
    return event.act

def shown(event: values.TaskRunning) -> tuple[sc.IRI, ...]:
    return event.configuration["screen"]

with sc.join() as living, living.run(sc.template("t.ttl"), seconds=5) as run:
    lines = [told(event) for event in run.events()]
    screens = [event.configuration["screen"] for event in run.events() if event.act == "running"]
    shown_first = next(shown(event) for event in run.events() if isinstance(event, values.TaskRunning))
"""


def from_readme() -> str:
    """The lines by which the README introduces the library."""
    text = (ROOT / "README.md").read_text("utf-8")
    return text.partition("```python\nimport selfconf as sc\n")[2].partition("```")[0]


def from_docstring(documented: type) -> str:
    """The example of a docstring, as a program."""
    lines = (example.source for example in doctest.DocTestParser().get_examples(documented.__doc__ or ""))
    return "from selfconf import join, template\n" + "".join(lines)


READING = """
from selfconf import values

def solutions_of(found: values.Solutions) -> str:
    first = found[0]["c"]
    assert_type(first, values.Term)
    assert_type(found[:2], Sequence[Mapping[str, values.Term]])
    return first.short if isinstance(first, sc.IRI) else str(first)

def problem_of(report: values.ValidationReport) -> str:
    assert_type(report[0], values.Diagnostic)
    return "" if report[0].severity is values.Severity.WARNING else report[0].message

def what_is_wrong(miss: values.NearMiss) -> str:
    match miss.obstacle:
        case values.WrongType(wanted=wanted):
            return wanted.short
        case values.PropertyUnmet(faults=faults):
            return ", ".join(type(fault).__name__ for fault in faults)
    return str(miss)
"""
READING = "from collections.abc import Mapping, Sequence\nfrom typing_extensions import assert_type\n" + READING

PROGRAMS = {
    "answers": ANSWERS,
    "reading": READING,
    "events": EVENTS,
    "readme": from_readme(),
    "run": from_docstring(Run),
}


@pytest.fixture(scope="module")
def errors(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """What mypy finds in all programs: in one run, and with the cache of the tree, as without one it takes long."""
    folder = tmp_path_factory.mktemp("programs")
    for name, text in PROGRAMS.items():
        (folder / f"{name}.py").write_text(f"import selfconf as sc\n{text}", "utf-8")
    files = [str(folder / f"{name}.py") for name in PROGRAMS]
    command = [sys.executable, "-m", "mypy", "--config-file", "pyproject.toml", *files]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert said.returncode in (0, 1), said.stderr
    return [line for line in said.stdout.splitlines() if ": error: " in line]


@pytest.mark.slow
@pytest.mark.process
@pytest.mark.parametrize("program", PROGRAMS)
def test_a_program_is_typed(program: str, errors: list[str]) -> None:
    assert [line for line in errors if f"/{program}.py:" in line] == []
