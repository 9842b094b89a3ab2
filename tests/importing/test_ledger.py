"""What an importer notes."""

from __future__ import annotations

from selfconf.errors import AuthorError
from selfconf.importing.imported import Omission
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.sources import SourceDocument

A, B = SourceDocument("a", "a", b""), SourceDocument("b", "b", b"")


def test_what_is_left_out_for_one_reason_is_counted_over_all_sources() -> None:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    for source, number in ((A, 2), (B, 1), (A, 3)):
        ledger.leave_out("forms", "why", source, number)
    ledger.leave_out("forms", "another why", B)
    ledger.leave_out("links", "there are none", B, 0)
    assert ledger.omissions() == (Omission("forms", "another why", ("b",), 1), Omission("forms", "why", ("a", "b"), 6))


def test_a_minted_name_lies_in_the_namespace() -> None:
    assert ImportLedger("urn:x:", list[AuthorError]().append).minted("a b", "c/d") == "urn:x:a-b/c-d"
