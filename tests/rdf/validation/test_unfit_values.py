"""Values that parameters do not allow are told at their place, as configuring the task would refuse them."""

from __future__ import annotations

import pytest

from selfconf.errors import AuthorError
from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.tasks import complete, read_task
from selfconf.rdf.turtle import parse
from selfconf.rdf.validation.unfit_values import unfit_values
from tests.lab import PREFIXES, iri

TEMPLATE = """:t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p .
:r a sc:Role ; sh:class :R ; sh:property [ sh:path :at ; sh:in ( :p ) ] .
"""
TASK = "[] sc:grounding :task . :task a sc:Task ; sc:template :t"


def told(text: str) -> list[tuple[str, int]]:
    """Code and line below the prefixes of each problem of a text."""
    found = unfit_values(*parse_with_positions(PREFIXES + text, "x.ttl", "file:///"))
    return sorted((one.code, one.line - PREFIXES.count("\n")) for one in found)


@pytest.mark.parametrize(
    ("constraint", "good", "bad"),
    [
        ("sh:nodeKind sh:IRI", ":kitchen", '"lit"'),
        ("rdfs:comment 'of any kind'", ":kitchen", "[]"),
        ("sh:datatype xsd:integer", "3", '"x"'),
        ("sh:datatype xsd:integer", "3", '"x"^^xsd:integer'),
        ("sh:minInclusive 3", "3.0", "2"),
        ("sh:in ( :kitchen :hall )", ":hall", ":cellar"),
        ('sh:pattern "^a"', '"ab"', '"ba"'),
        ("sh:not [ sh:hasValue 3 ]", "2", "3"),  # by pySHACL
    ],
)
def test_bindings_and_defaults_are_told_that_would_be_refused(constraint: str, good: str, bad: str) -> None:
    for value, fits in ((good, True), (bad, False)):
        bound = f'{TEMPLATE}:p a sc:Parameter ; sc:name "p" ; {constraint} .\n'
        bound += f"{TASK} ; sc:binding [ sc:parameter :p ;\n sc:value {value} ] ."
        default = f'{TEMPLATE}:p a sc:Parameter ; sc:name "p" ; {constraint} ;\n sh:defaultValue {value} .\n'
        assert told(bound) == ([] if fits else [("SC-K02", 5)])
        assert told(default) == ([] if fits else [("SC-T09", 4)])
        for text, wanted in ((bound, "task"), (default, "t")):
            document = parse(PREFIXES + text, "x.ttl")
            if fits:
                complete(read_task(document, iri(wanted)))
            else:
                with pytest.raises(
                    AuthorError, match=r"cannot stand for the parameter 'p'|the default of the parameter"
                ):
                    complete(read_task(document, iri(wanted)))


def test_a_parameter_of_another_file_is_not_judged() -> None:
    assert told(f'{TASK} ; sc:binding [ sc:parameter :p ; sc:value "lit" ] .') == []


def test_a_parameter_that_is_no_shape_is_told_where_it_gets_a_value() -> None:
    text = f'{TEMPLATE}:p a sc:Parameter ; sc:name "p" ; sh:pattern "(" ;\n sh:defaultValue "x" .\n'
    assert told(text) == [("SC-T09", 4)]
