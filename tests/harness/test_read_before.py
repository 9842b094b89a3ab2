"""What is read before processes are forked is what validation would otherwise prepare in each of them."""

from __future__ import annotations

from pathlib import Path

from selfconf.rdf.validation import shape_violations, validate_texts
from tests import bad_files
from tests.bad_files import BAD, shipped, source
from tests.harness.read_before import ASKED, read_what_many_tests_need

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_examples_are_validated_without_another_query_being_prepared() -> None:
    assert {path.stem for path in BAD}.issuperset(ASKED)
    shape_violations._prepared.cache_clear()
    bad_files.checked.cache_clear()
    read_what_many_tests_need()
    prepared = shape_violations._prepared.cache_info().misses
    validate_texts([source(EXAMPLES / "watch.ttl")], *shipped())
    assert shape_violations._prepared.cache_info().misses == prepared > 20
