"""The files that `selfconf new` writes: each is valid as it stands, and says in comments what to change.

`$name`, `$class_`, `$namespace` and `$label` stand where the author's own words will stand.
"""

from __future__ import annotations

from collections.abc import Mapping
from string import Template

_PREFIXES = """\
@prefix :     <$namespace> .
@prefix sc:   <https://w3id.org/selfconf#> .
@prefix rob:  <https://w3id.org/selfconf/robotics#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
"""

_ADVERTISEMENT = f"""\
# The advertisement of $name: what it is, what it takes, what it gives. Check it with `selfconf validate $name.ttl`.

{_PREFIXES}
# sc:Component makes it one; a second type says what kind. Roles ask for kinds: take one of
# rob: (rob:Thermometer, rob:Speaker, ...) or one of your own, such as :$class_.
:$name a sc:Component, rob:Thermometer ;
    rdfs:label "$label"@en ;

    # Properties that roles may ask for. Any property will do; rob:place and rob:support are there already.
    rob:place :kitchen ;

    # What it gives: a name, by which $name.py emits, and a type, by which it is connected.
    sc:hasOutput [ sc:name "temperature" ; sc:signalType rob:Temperature ] ;

    # What it takes, and what can be set; a component may have any number of each, or none.
    # sc:hasInput [ sc:name "switch" ; sc:signalType rob:Switch ] ;
    # sc:hasParameter [ sc:name "volume" ; sc:parameterType rob:Volume ] ;

    # Of several components that could play a role, the one with the highest preference is tried first.
    # sc:preference 10 ;

    # How its site starts it, from the folder of this file.
    sc:grounding [ sc:command "python $name.py" ] .
"""

_PROGRAM = '''\
"""What $name does. Try it with a template that asks for it: `selfconf run TEMPLATE.ttl --ads .`"""

from selfconf.sdk import Component, main


class $class_(Component):
    """One method for each thing that can happen; leave out what you do not need."""

    advertisement = "$name.ttl"

    def started(self):
        """A configuration needs this component. It is stopped again by itself; timers end with it."""
        self.every(1.0, self.measure)

    def measure(self):
        """The name of the output is the one in the advertisement, the fields are those of the signal type."""
        self.emit("temperature", {"temperature": 21.0})

    def received(self, port, signal):
        """A signal has come in on an input: `signal["on"]` is a field of it."""

    def parameter_set(self, name, value):
        """A parameter has been set."""

    def stopped(self):
        """No task needs this component any more; what moves must be at rest when this returns."""


if __name__ == "__main__":
    main($class_)
'''

_TASK_TEMPLATE = f"""\
# $label, as a template: which roles there are, and which feeds which.
# Look at the answer with `selfconf configure $name.ttl --ads .`, run it with `selfconf run $name.ttl --ads .`

{_PREFIXES}@prefix sh:   <http://www.w3.org/ns/shacl#> .

# The order of the roles is the order in which they are cast.
:$name a sc:Template ;
    rdfs:label "$label"@en ;
    sc:parameter :$name-place ;
    sc:roles ( :$name-source ) .

# A parameter stands where its value will stand: `--bind place=:kitchen`. Without a value, any place will do.
:$name-place a sc:Parameter ; sc:name "place" ; sh:nodeKind sh:IRI .

# A role is a SHACL shape: whatever conforms to it may play it. This one wants a thermometer, and if that says where
# it is, it has to be the place. `sh:minCount 1` beside sh:in would want it to say so.
:$name-source a sc:Role ;
    sh:class rob:Thermometer ;
    sh:property [ sh:path rob:place ; sh:in ( :$name-place ) ] .

# A second role, fed by the first: add it to the list above, and `sc:feeds :$name-sink` to the first.
# :$name-sink a sc:Role ; sh:class rob:Thermostat .
"""

_ONTOLOGY = """\
# $label, an ontology: kinds of components and of signals that selfconf does not bring along.
# Hand it to a command with `--ontology $name.ttl`; hierarchies count with `--reasoning subclass`.

@prefix :        <$namespace> .
@prefix rob:     <https://w3id.org/selfconf/robotics#> .
@prefix dcterms: <http://purl.org/dc/terms/> .
@prefix owl:     <http://www.w3.org/2002/07/owl#> .
@prefix rdfs:    <http://www.w3.org/2000/01/rdf-schema#> .
@prefix skos:    <http://www.w3.org/2004/02/skos/core#> .
@prefix xsd:     <http://www.w3.org/2001/XMLSchema#> .

<$document> a owl:Ontology ;
    dcterms:title "$label"@en ;
    owl:versionInfo "0.1.0" .

# A kind of component: a role that asks for a sensor is content with it, where the hierarchy counts.
:$class_ a owl:Class ;
    rdfs:subClassOf rob:Sensor ;
    rdfs:label "$lower"@en ;
    skos:definition "A sensor of something that no other sensor senses."@en ;
    rdfs:isDefinedBy <$document> .

# A kind of signal, with the fields of each of its messages.
:${class_}Reading a owl:Class ;
    rdfs:subClassOf rob:Signal ;
    rdfs:label "$lower reading"@en ;
    skos:definition "$label: what it tells."@en ;
    rob:field ( [ rob:fieldName "value" ; rob:datatype xsd:double ] ) ;
    rdfs:isDefinedBy <$document> .

# A property by which roles can tell components apart.
:range a owl:DatatypeProperty ;
    rdfs:range xsd:double ;
    rdfs:label "range"@en ;
    skos:definition "$label: how far it reaches, in metres."@en ;
    rdfs:isDefinedBy <$document> .
"""

SCAFFOLDS: Mapping[str, Mapping[str, Template]] = {
    "component": {".ttl": Template(_ADVERTISEMENT), ".py": Template(_PROGRAM)},
    "template": {".ttl": Template(_TASK_TEMPLATE)},
    "ontology": {".ttl": Template(_ONTOLOGY)},
}
"""For each kind of thing that can be scaffolded, the endings of its files and what they hold."""
