"""What a node says in terms of other vocabularies, and what of it is left out."""

from __future__ import annotations

from selfconf.errors import AuthorError
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.sources import SourceDocument
from selfconf.importing.wot.contexts import TermMeanings
from selfconf.importing.wot.other_terms import OtherTerms
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import SC, XSD


def test_plain_values_are_stated_and_the_rest_is_named_unless_it_is_read_elsewhere() -> None:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    meanings = TermMeanings({"x": "urn:x:", "sc": "https://w3id.org/selfconf#"})
    node = {"unit": "m", "@type": "x:T", "x:a": [1, {"deep": 2}], "sc:rate": 5, "sc:depth": 2, "y:b": 3}
    terms = OtherTerms(meanings, ledger, SourceDocument("lamp", "lamp", b""))
    assert list(terms.stated(node, {"unit"}, {SC.rate})) == [(IRI("urn:x:a"), Literal("1", XSD.integer))]
    assert {each.what: each.number for each in ledger.omissions()} == {
        "nested values of other vocabularies": 1,
        "terms of selfconf": 1,
        "terms with the prefix y:": 1,
    }
