"""Names of modules and classes that have another value for a while."""

from __future__ import annotations

from types import ModuleType

import pytest

from selfconf.rdf.replacements import replaced


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
