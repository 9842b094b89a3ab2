"""What strangers may advertise to make others wait or fall: ten kinds of it, and a task that asks for all of them.

Each stranger is of the type that a role of the task asks for, comes first by preference, and is not eligible.
"""

from __future__ import annotations

from collections.abc import Callable

from tests.lab import PREFIXES

WORD = r"^(\\w+\\s?)*$"
"""A pattern that looks harmless, and takes years for forty letters and an exclamation mark."""
BACKSLASH = "\\"
KINDS: dict[str, tuple[str, Callable[[int], str]]] = {
    "letters": ("Camera", lambda k: f':model "{"a" * 40}{k}!"'),
    "blanks": ("Camera", lambda k: f':model "{" " * 20_000}{k}!"'),
    "beyond": ("Camera", lambda k: f':model "m" ; :twice "{"ab" * 40}{k}!"'),
    "digits": ("Camera", lambda k: f':model "m" ; :weight {"9" * 5_000}{k} ; :size "1e{10**9 + k}"^^xsd:decimal'),
    "ports": (
        "Camera",
        lambda k: " ; ".join(f"sc:hasOutput [ sc:name 'p{n}' ; sc:signalType :S{k}x{n} ]" for n in range(20)),
    ),
    "question": ("Ear", lambda k: f':serial "{"a" * 40}{k}!"'),
    "crowd": ("Ear", lambda k: f':serial "s" ; :near {" , ".join(f":n{k}x{n}" for n in range(150))}'),
    "no order": ("Arm", lambda k: f':from {k} ; :until "never{k}" , [ :note {k} ]'),
    "circles": ("Arm", lambda k: f":part _:p{k} . _:p{k} :part _:p{k} , [ :part _:p{k} ]"),
    "markup": ("Arm", lambda k: f':from "{"<b>" * 900}{k}"^^rdf:HTML , "{"<b>" * 900}{k}"^^rdf:XMLLiteral'),
}
"""For each kind the type of the strangers, and what the one of a number says of itself."""
TEMPLATE = f"""{PREFIXES}
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
:task a sc:Template ; sc:roles ( :watch :listen :reach :tell ) .
:watch a sc:Role ; sh:class :Camera ; sc:feeds :tell ;
    sh:property [ sh:path :model ; sh:minCount 1 ; sh:pattern "{WORD}" ] , [ sh:path :model ; sh:pattern "\\\\S$" ] ,
        [ sh:path :twice ; sh:pattern "^(?=(\\\\w+)+$)" ] , [ sh:path :size ; sh:minExclusive 0.0 ] ,
        [ sh:path :weight ; sh:minInclusive 1 ; sh:maxInclusive 20 ] .
:listen a sc:Role ; sh:class :Ear ;
    sh:sparql [ sh:select '''SELECT $this {{
            $this <HOMEserial> ?l FILTER ( ! regex(?l, "{WORD.replace(BACKSLASH, 2 * BACKSLASH)}") ) }}''' ] ,
        [ sh:select '''SELECT $this {{ $this <HOMEnear> ?a , ?b , ?c , ?d FILTER ( ?a = ?b && ?c != ?d ) }}''' ] .
:reach a sc:Role ; sh:class :Arm ;
    sh:property [ sh:path :from ; sh:lessThan :until ] ,
        [ sh:path ( [ sh:zeroOrMorePath :part ] rdfs:label ) ; sh:minCount 1 ] .
:tell a sc:Role ; sh:class :Screen .
""".replace("HOME", "https://example.org/peis-home#")
PICTURES = "sc:hasOutput [ sc:name 'pictures' ; sc:signalType rob:Image ]"
HONEST = f"""{PREFIXES}
:cam-1 a sc:Component, :Camera ; rdfs:label "One" ; :model "Eye 1" ; :weight 2 ; :size 1.5 ; {PICTURES} .
:cam-2 a sc:Component, :Camera ; rdfs:label "Two" ; :model "Eye 2" ; :weight 3 ; {PICTURES} .
:ear-1 a sc:Component, :Ear ; :serial "a 1" ; :near :door .
:ear-2 a sc:Component, :Ear ; :serial "a 2" .
:arm-1 a sc:Component, :Arm ; rdfs:label "One" ; :from 1 ; :until 2 .
:arm-2 a sc:Component, :Arm ; :part [ rdfs:label "Two" ] .
:screen a sc:Component, :Screen ; sc:hasInput [ sc:name "pictures" ; sc:signalType rob:Image ] .
"""


def stranger(kind: str, number: int) -> str:
    """The advertisement of one stranger, in Turtle."""
    name = f"stranger-{kind.replace(' ', '-')}-{number}"
    type_, said = KINDS[kind]
    return (
        f"{PREFIXES}@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .\n"
        f":{name} a sc:Component, :{type_} ; sc:preference 9 ; {said(number)} .\n"
    )
