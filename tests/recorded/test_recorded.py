"""What selfconf answers is what it has answered before: every code, exit code and member, and every sentence.

The record is in `answers.json.xz` (structure) and `sentences.json.xz`. A sentence that was reworded on purpose is
recorded anew by `python -m tests.recorded.record sentences`, a structure by `... answers`; `... show NAME` shows a
case, and `... count` how often everything occurs in the random ecologies.
"""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.harness.asked_here import ask_here
from tests.harness.effort import examples, thorough
from tests.recorded import cases
from tests.recorded.answers import Answer, differences, taken_apart
from tests.recorded.record import GROUPS, answers, compared, load

pytestmark = pytest.mark.slow
pytest.importorskip("pysat", reason="with fewer solvers, fewer searches are decided: install the extra solvers")


@pytest.fixture(
    scope="module",
    params=[pytest.param(name, marks=thorough if name == "ecologies" else ()) for name in sorted(GROUPS)],
)
def found(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict[str, Answer]]:
    """A group, and what is answered to its cases now."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cases, "ECOLOGIES", min(cases.ECOLOGIES, examples(500)))
        ask_here(patch)
        patch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path_factory.mktemp("runtime")))
        for name in ("SELFCONF_ECOLOGY", "SELFCONF_CONNECT", "SELFCONF_PARENT"):
            patch.delenv(name, raising=False)
        return request.param, answers(request.param, tmp_path_factory.mktemp(request.param))


def test_codes_exit_codes_and_members_are_as_recorded(found: tuple[str, dict[str, Answer]]) -> None:
    check(found, "answers")


def test_sentences_are_as_recorded(found: tuple[str, dict[str, Answer]]) -> None:
    check(found, "sentences")


def check(found: tuple[str, dict[str, Answer]], part: str) -> None:
    """Fail with what differs from the record, and with the command that records it anew."""
    told = compared(*found, part)
    if told:
        pytest.fail(f"{told}\nif that is intended: python -m tests.recorded.record {part}", pytrace=False)


@pytest.mark.parametrize(
    "name",
    [
        "watch, configure json",
        "radio in the bedroom, configure turtle",
        "selfconf configure --steps 0 examples/watch.ttl --ads examples/watch",
    ],
)
def test_a_process_answers_as_the_function_does(name: str) -> None:
    (case,) = (case for case in (*cases.examples(), *cases.misuse()) if case.name == name)
    command = [sys.executable, "-m", "selfconf", *case.arguments]
    done = subprocess.run(command, cwd=cases.ROOT, capture_output=True, text=True, timeout=120, check=False)
    answer = taken_apart(case, done.returncode, done.stdout, done.stderr)
    assert answer.structure == next(group[name] for group in load("answers").values() if name in group)


def test_a_difference_is_told_with_its_place() -> None:
    recorded = {"exit": 0, "stdout": {"roles": [{"role": "a", "components": ["b"]}], "cost": 1}}
    now = {"exit": 1, "stdout": {"roles": [{"role": "a", "components": ["c"]}], "bound": True}}
    assert list(differences(recorded, now)) == [
        "exit: was 0, is 1",
        "stdout.bound: is new, true",
        "stdout.cost: is gone, was 1",
        'stdout.roles[0].components[0]: was "b", is "c"',
    ]
    assert list(differences(["a", "b", "d"], ["b", "c", "e", "d"])) == [
        '[0]: is gone, was "a"',
        '[1]: is new, "c"',
        '[2]: is new, "e"',
    ]
    assert list(differences({"a": 1, "b": 2}, {"b": 2, "a": 1})) == [
        ": members in another order, ['b', 'a'] for ['a', 'b']"
    ]
