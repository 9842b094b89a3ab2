"""Names of modules and classes that have another value for a while."""

from __future__ import annotations

import subprocess
import sys
import threading
from types import ModuleType

import pytest

from selfconf.rdf.pyshacl_corrections.library_patches import replaced


class _Owner:
    @staticmethod
    def answer() -> str:
        return "own"


def test_a_name_has_another_value_in_the_block_and_its_own_afterwards() -> None:
    module = ModuleType("module")
    module.answer = "own"  # type: ignore[attr-defined]
    before = vars(_Owner)["answer"]
    with replaced([(module, "answer", "other"), (_Owner, "answer", staticmethod(lambda: "other"))]):
        assert (module.answer, _Owner.answer()) == ("other", "other")
    assert (module.answer, _Owner.answer()) == ("own", "own")
    assert vars(_Owner)["answer"] is before  # and no function in the place of a static method


def test_a_block_that_breaks_leaves_nothing_replaced() -> None:
    with pytest.raises(KeyError), replaced([(_Owner, "answer", None)]):
        raise KeyError
    assert _Owner.answer() == "own"


class _Interrupting(type):
    """Raises as its attributes are replaced, as a time limit does that is over at that step."""

    def __setattr__(cls, name: str, value: object) -> None:
        super().__setattr__(name, value)
        if value is None:
            raise TimeoutError


class _Interrupted(metaclass=_Interrupting):
    answer: object = "own"


def test_a_block_that_is_ended_while_names_are_replaced_leaves_nothing_replaced() -> None:
    others: list[tuple[object, str, object]] = [(_Interrupted, "answer", None), (_Interrupted, "answer", "late")]
    with pytest.raises(TimeoutError), replaced([(_Owner, "answer", None), *others]):
        pass
    assert _Owner.answer() == "own"
    assert _Interrupted.answer == "own"


def test_one_thread_at_a_time_replaces_a_name() -> None:
    entered, seen = threading.Event(), list[str]()

    def other() -> None:
        entered.set()
        with replaced([(_Owner, "answer", staticmethod(lambda: "other's"))]):
            seen.append(_Owner.answer())

    thread = threading.Thread(target=other)
    with replaced([(_Owner, "answer", staticmethod(lambda: "mine"))]):
        thread.start()
        entered.wait(10)
        assert not seen
        assert _Owner.answer() == "mine"
    thread.join(10)
    assert seen == ["other's"]
    assert _Owner.answer() == "own"


IN_THREADS = """
import threading
from selfconf.rdf.validation.shape_violations import Shapes, reported_violations
from rdflib import Graph
from selfconf import library

shapes = Graph()
for path in library.shapes():
    shapes.parse(path)
text = "@prefix sc: <https://w3id.org/selfconf#> . <urn:t> a sc:Template ; sc:roles ( <urn:r> <urn:r> ) ."
failed = []

def judge():
    try:
        read = Shapes.of(shapes).read
        assert list(reported_violations(Graph().parse(data=text), read))
    except Exception as error:
        failed.append(error)

threads = [threading.Thread(target=judge) for _ in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert not failed, failed
"""


@pytest.mark.process
def test_threads_may_ask_the_first_queries_of_a_process_together() -> None:
    """In a process of its own, as what pyparsing finds out at the first query it finds out once."""
    done = subprocess.run([sys.executable, "-c", IN_THREADS], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
