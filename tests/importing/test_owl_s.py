"""Services of OWL-S as components."""

from __future__ import annotations

import pytest

import selfconf as sc
from tests.importing.imports import Workshop, left_out

XML = """<?xml version="1.0"?>
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"
    xmlns:service="http://www.daml.org/services/owl-s/{version}/Service.owl#"
    xmlns:profile="http://www.daml.org/services/owl-s/{version}/Profile.owl#"
    xmlns:process="http://www.daml.org/services/owl-s/{version}/Process.owl#"
    xml:base="http://example.org/book_price.owls">
  <service:Service rdf:ID="SERVICE">
    <service:presents rdf:resource="#PROFILE"/>
    <service:supports rdf:resource="#GROUNDING"/>
  </service:Service>
  <profile:Profile rdf:ID="PROFILE">
    <profile:serviceName xml:lang="en">BookPrice</profile:serviceName>
    <profile:textDescription>
      The price
      of a book.
    </profile:textDescription>
    <profile:hasInput rdf:resource="#_BOOK"/>
    <profile:hasOutput rdf:resource="#_PRICE"/>
    <profile:hasParameter rdf:resource="#_CURRENCY"/>
    <profile:hasPrecondition rdf:resource="#P"/>
  </profile:Profile>
  <process:Input rdf:ID="_BOOK">
    <process:parameterType rdf:datatype="http://www.w3.org/2001/XMLSchema#anyURI">http://example.org/books#Book</process:parameterType>
  </process:Input>
  <process:Output rdf:ID="_PRICE">
    <process:parameterType rdf:datatype="http://www.w3.org/2001/XMLSchema#anyURI">http://example.org/c#Price</process:parameterType>
  </process:Output>
  <process:Parameter rdf:ID="_CURRENCY">
    <process:parameterType rdf:datatype="http://www.w3.org/2001/XMLSchema#anyURI">http://example.org/c#Currency</process:parameterType>
  </process:Parameter>
</rdf:RDF>
"""
TURTLE = """
@prefix service: <http://www.daml.org/services/owl-s/1.2/Service.owl#> .
@prefix profile: <http://www.daml.org/services/owl-s/1.2/Profile.owl#> .
@prefix process: <http://www.daml.org/services/owl-s/1.2/Process.owl#> .
<#s> a service:Service ; service:presents <#p> ; service:describedBy <#process> .
<#p> a profile:Profile, <http://example.org/Selling>, <https://w3id.org/selfconf#Template> .
<#process> process:hasInput <#a>, <#b/a> ; process:hasOutput [ process:parameterType "no IRI" ] .
<#a> process:parameterType <http://example.org/A> .
[] a profile:Profile .
"""


@pytest.mark.parametrize("version", ["1.1", "1.2"])
def test_the_profile_of_a_service_becomes_an_advertisement(workshop: Workshop, version: str) -> None:
    report = workshop.imported("owl-s", {"book.owls": XML.format(version=version)})
    prefix = f"service{version.replace('.', '')}"
    assert (
        workshop.texts()["book.ttl"].partition("\n\n")[2].partition("\n\n")[2]
        == f"""\
<http://example.org/book_price.owls#SERVICE> a sc:Component, {prefix}:Service ;
    rdfs:label "BookPrice"@en ;
    rdfs:comment "The price of a book." ;
    sc:hasInput [ sc:name "_BOOK" ; sc:signalType <http://example.org/books#Book> ] ;
    sc:hasOutput [ sc:name "_PRICE" ; sc:signalType <http://example.org/c#Price> ] ;
    sc:hasParameter [ sc:name "_CURRENCY" ; sc:parameterType <http://example.org/c#Currency> ] .
"""
    )
    assert left_out(report) == {"groundings": 1, "preconditions": 1}
    assert sc.validate([workshop.out]).conforms


def test_a_profile_without_parameters_has_those_of_the_process(workshop: Workshop) -> None:
    report = workshop.imported("owl-s", {"s/x.ttl": TURTLE})
    text = workshop.texts()["s/x.ttl"]
    assert "<urn:selfconf:owl-s:s/x#s> a sc:Component, service:Service, <http://example.org/Selling> ;" in text
    assert '[ sc:name "a" ; sc:signalType <http://example.org/A> ] ,\n        [ sc:name "a-2" ]' in text
    assert 'sc:hasOutput [ sc:name "parameter" ] .' in text
    assert left_out(report) == {"types that are no IRIs": 1, "services without an IRI": 1, "types of selfconf": 1}


def test_a_parameter_whose_name_no_port_may_have_gets_another(workshop: Workshop) -> None:
    base = "http://www.daml.org/services/owl-s/1.1/Profile.owl#"
    names = (f"http://e.org/s#{'x' * 1_001}", "http://e.org/s#\u202eb")
    inputs = " , ".join(f"<{name}>" for name in names)
    workshop.imported("owl-s", {"x.ttl": f"<http://e.org/s> a <{base}Profile> ; <{base}hasInput> {inputs} ."})
    assert sc.validate([workshop.out]).errors == 0
    assert '[ sc:name "parameter-2" ]' in workshop.texts()["x.ttl"]


def test_a_profile_is_found_by_its_service_and_a_process_by_either_of_them(workshop: Workshop) -> None:
    head = TURTLE.partition("<#s>")[0]
    text = """<#a> process:parameterType <urn:A>, <urn:B> . <#m> process:hasInput <#a> .
        <#s1> service:presents <#p1> ; service:describedBy <#m> . <#p1> a <urn:Brewing> .
        <#s2> service:presents <#p2> . <#p2> profile:serviceName "two" ; profile:has_process <#m> .
        <#s3> service:presents <#p3> . <#m> service:describes <#s3> . <#p3> a profile:Profile .
        <#s4> a service:Service ; service:describedBy <#m> ."""
    report = workshop.imported("owl-s", {"x.ttl": head + text})
    found = workshop.texts()["x.ttl"]
    assert "<urn:selfconf:owl-s:x#s1> a sc:Component, service:Service, <urn:Brewing> ;" in found
    assert found.count('sc:hasInput [ sc:name "a" ; sc:signalType <urn:A> ] .') == 3
    assert left_out(report) == {"further types of parameters": 3, "services without a profile": 1}


def test_what_is_said_in_other_vocabularies_is_kept_and_the_rest_is_named(workshop: Workshop) -> None:
    more = """@prefix x: <urn:x:> . @prefix sc: <https://w3id.org/selfconf#> .
        <#s> x:owner x:me . <#p> x:stars 5 , [ x:of 6 ] ; profile:serviceProduct x:b ; profile:hasParameter <#o> ;
            sc:preference 3 . <#a> x:unit "m" . <#o> process:parameterType x:O ; x:unit "s" ."""
    report = workshop.imported("owl-s", {"x.ttl": TURTLE + more})
    text = workshop.texts()["x.ttl"]
    assert "    x:owner x:me ;\n    x:stars 5 ;\n" in text
    assert '[ sc:name "a" ; sc:signalType <http://example.org/A> ; x:unit "m" ]' in text
    assert {what: number for what, number in left_out(report).items() if "type" not in what and "IRI" not in what} == {
        "further terms of OWL-S": 1,
        "nested values of other vocabularies": 1,
        "terms of selfconf": 1,
        "what else is said of operational parameters": 1,
    }
    assert sc.validate([workshop.out]).conforms


def test_what_is_no_service_is_named_and_what_is_no_rdf_is_unreadable(workshop: Workshop) -> None:
    report = workshop.imported("owl-s", {"a.owl": "<?xml", "b.ttl": "<urn:x> a <urn:y> .", "c.ttl": "<"})
    assert report.files == ()
    assert left_out(report) == {"documents without a profile": 1}
    assert ["not RDF/XML" in str(error) or "c.ttl:1:1: not Turtle" in str(error) for error in report.unreadable] == [
        True
    ] * 2
