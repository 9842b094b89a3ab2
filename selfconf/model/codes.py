"""The catalogue of codes: every kind of problem that `selfconf validate` can report, with an example of
each.

A code never changes its meaning and is never given away again. The letter tells what the problem is
about: S the file itself, A advertisements, T templates, K tasks, C configurations, O ontologies, L what
reads well but is probably not what was meant, P the project file `selfconf.toml`. Each shape in `shapes/`
states the code that its violations earn. A test checks that, and every example: the bad one earns its code, the
good one earns nothing.
"""

from __future__ import annotations

from selfconf.model.diagnostic import Severity
from selfconf.model.immutable import immutable

PREAMBLE = """\
@prefix : <https://example.org/home#> .
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
"""
"""What stands at the head of each example."""


@immutable
class Code:
    """One kind of problem."""

    code: str
    title: str
    """What has to hold, in a sentence."""
    why: str
    """Why that is so, or what to do about it."""
    bad: str = ""
    good: str = ""
    severity: Severity = Severity.ERROR
    language: str = "turtle"
    """What the examples are written in: `turtle` or `toml`."""


_BANDS = ':bands a owl:DatatypeProperty ; rdfs:label "bands"@en ; rdfs:range xsd:integer .'
_TUNER = ":tuner a sc:Component, rob:Tuner"
_DISPLAY = ":display a sc:Component, rob:Display"
_TEMPLATE = ":radio a sc:Template ; sc:roles ( :source :sink ) ."
_SOURCE = ":source a sc:Role ; sh:class rob:Tuner ; sc:feeds :sink ."
_SINK = ":sink a sc:Role ; sh:class rob:Speaker ."
_INSIDE = (
    ":play a sc:Template ; sc:roles ( :tuner-role ) ;\n"
    '    sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:of :tuner-role ] .\n'
    ":tuner-role a sc:Role ; sh:class rob:Tuner ."
)
_PAIR = f"{_TEMPLATE}\n{_SOURCE}\n{_SINK}"
_BOUND = (
    f"{_PAIR}\n:radio sc:parameter :room .\n:sink sh:property [ sh:path rob:place ; sh:in ( :room ) ] .\n"
    ':room a sc:Parameter ; sc:name "room" .\n'
)
_CAST = (
    "sc:assignment [ a sc:Assignment ; sc:role :source ; sc:component :tuner ] ,\n"
    "                  [ a sc:Assignment ; sc:role :sink ; sc:component :speaker ]"
)
_LINK = '[ a sc:Connection ; sc:from :tuner ; sc:output "sound" ; sc:to :speaker ; sc:input "audio" ]'
_PORTS = (
    ':tuner a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .\n'
    ':speaker a sc:Component, rob:Speaker ; sc:hasInput [ sc:name "audio" ; sc:signalType rob:Audio ] .'
)
_ANSWER = f":now a sc:Configuration ; sc:template :radio ;\n    {_CAST} ;\n    sc:connection {_LINK} ."

CODES: tuple[Code, ...] = (
    Code(
        "SC-S01", "A file is Turtle.",
        "Nothing else can be said of a file that is not Turtle (W3C RDF 1.1 Turtle, section 6).",
        ":tuner a sc:Component, rob:Tuner ;\n    rdfs:label \"tuner .",
        ":tuner a sc:Component, rob:Tuner ;\n    rdfs:label \"tuner\" .",
    ),
    Code(
        "SC-S02", "A file is encoded in UTF-8.",
        "Turtle is always UTF-8; save the file in that encoding.",
    ),
    Code(
        "SC-S03", "A file can be opened.",
        "The path does not exist, or may not be read.",
    ),
    Code(
        "SC-S04", "There is something to validate.",
        "A folder holds no Turtle files, or a file speaks of no component, template, task, configuration or ontology.",
        ":kitchen rdfs:label \"Kitchen\" .", f"{_TUNER} .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-S05", "A file can be judged.",
        "It has at most 64 MiB, 250,000 statements, 16 MiB in a string and a thousand brackets in brackets, and takes"
        " two minutes at most.",
    ),
    Code(
        "SC-S06", "A list has an end.",
        "A list that comes back to one of its own cells has no order and no number of members.",
        ":radio a sc:Template ; sc:roles _:cell .\n_:cell rdf:first :sink ; rdf:rest _:cell .\n" + _SINK,
        ":radio a sc:Template ; sc:roles ( :sink ) .\n" + _SINK,
    ),
    Code(
        "SC-A01", "A component has an IRI.",
        "Other files and other sites speak of it by its IRI; a blank node has no name outside its file.",
        "[] a sc:Component, rob:Tuner .", f"{_TUNER} .",
    ),
    Code(
        "SC-A02", "What has ports or parameters is a sc:Component.",
        "Discovery looks for sc:Component; without the type the advertisement is left out.",
        ':tuner a rob:Tuner ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
    ),
    Code(
        "SC-A03", "A component says what kind of component it is.",
        "Roles ask for types. Any IRI will do as a type, also one of your own.",
        ":tuner a sc:Component .", f"{_TUNER} .",
    ),
    Code(
        "SC-A04", "A component has at most one preference, a finite number.",
        "The eligible component with the highest preference is tried first; a component without one has 0.",
        f'{_TUNER} ; sc:preference "high" .', f"{_TUNER} ; sc:preference 10 .",
    ),
    Code(
        "SC-A05", "A component has at most one grounding, with one command, or with one template.",
        "The command is the command line with which the component's own site starts its process; the template is the "
        "one of the task that a composite is inside.",
        f'{_TUNER} ; sc:grounding "radio-tuner --band fm" .',
        f'{_TUNER} ; sc:grounding [ a sc:Grounding ; sc:command "radio-tuner --band fm" ] .',
    ),
    Code(
        "SC-A06", "A port or parameter is a node with properties.",
        "Its name and its type are said of it, so it cannot be a mere name; write [ ... ].",
        f'{_TUNER} ; sc:hasOutput "sound" .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
    ),
    Code(
        "SC-A07", "A port has exactly one name, a plain string.",
        "Programs use the name, so it has no language and no other datatype.",
        f"{_TUNER} ; sc:hasOutput [ sc:signalType rob:Audio ] .",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
    ),
    Code(
        "SC-A08", "The signal types of a port are IRIs.",
        "Ports are connected by type. An output is of all its types; an input takes any of its own.",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType "audio" ] .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
    ),
    Code(
        "SC-A09", "The inputs of a component have different names, and so have its outputs.",
        "A connection names its two ports. An input and an output may share a name.",
        ":mixer a sc:Component, :Mixer ;\n"
        '    sc:hasInput [ sc:name "in" ; sc:signalType rob:Audio ] , [ sc:name "in" ; sc:signalType rob:Text ] .',
        ":mixer a sc:Component, :Mixer ;\n"
        '    sc:hasInput [ sc:name "one" ; sc:signalType rob:Audio ] , [ sc:name "two" ; sc:signalType rob:Text ] .',
    ),
    Code(
        "SC-A10", "A rate is promised by an output, as a number above zero in hertz.",
        "When such an output falls silent, the component counts as failed.",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:rate 50 ] .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ;\n'
        "    sc:rate [ sc:value 50 ; sc:unit unit:HZ ] ] .",
    ),
    Code(
        "SC-A11", "An operational parameter has exactly one name, a plain string.",
        "The name is how the component knows which of its parameters is set.",
        f"{_TUNER} ; sc:hasParameter [ sc:parameterType rob:Station ] .",
        f'{_TUNER} ; sc:hasParameter [ sc:name "station" ; sc:parameterType rob:Station ] .',
    ),
    Code(
        "SC-A12", "An operational parameter has exactly one type, an IRI.",
        "A role sets a parameter by its type.",
        f'{_TUNER} ; sc:hasParameter [ sc:name "station" ] .',
        f'{_TUNER} ; sc:hasParameter [ sc:name "station" ; sc:parameterType rob:Station ] .',
    ),
    Code(
        "SC-A13", "The operational parameters of a component have different names.",
        "A setting names the parameter that it sets.",
        f'{_TUNER} ; sc:hasParameter [ sc:name "a" ; sc:parameterType rob:Station ] ,\n'
        '    [ sc:name "a" ; sc:parameterType rob:Volume ] .',
        f'{_TUNER} ; sc:hasParameter [ sc:name "station" ; sc:parameterType rob:Station ] ,\n'
        '    [ sc:name "volume" ; sc:parameterType rob:Volume ] .',
    ),
    Code(
        "SC-A14", "A component says at most once, by true or false, whether it may be shared.",
        "Tasks share it or do not; by default they share what has neither inputs nor operational parameters, nor an "
        "operation that takes a request.",
        f'{_TUNER} ; sc:shareable "yes" .', f"{_TUNER} ; sc:shareable true .",
    ),
    Code(
        "SC-A15", "A duration is one number of seconds above zero, and a component has one of each kind at most.",
        "How long it acts on while an input is unfed (sc:tolerates); how long a callback may take (sc:deadline).",
        f"{_TUNER} ; sc:deadline [ sc:value -2 ; sc:unit unit:SEC ] .",
        f"{_TUNER} ; sc:deadline [ sc:value 2 ; sc:unit unit:SEC ] .",
    ),
    Code(
        "SC-A16", "A component has at most one number of restarts, a whole number from 0 to 1000000.",
        "So often within a minute its site starts it again after a crash; with 0, never.",
        f"{_TUNER} ; sc:restarts 2.5 .", f"{_TUNER} ; sc:restarts 2 .",
    ),
    Code(
        "SC-A17", "A depth belongs to an input, as a whole number from 1 to 1000000.",
        "So many signals wait there while the component is busy; at an output none waits.",
        ":display a sc:Component, rob:Display ;\n"
        '    sc:hasInput [ sc:name "text" ; sc:signalType rob:Text ; sc:depth 0 ] .',
        ":display a sc:Component, rob:Display ;\n"
        '    sc:hasInput [ sc:name "text" ; sc:signalType rob:Text ; sc:depth 10 ] .',
    ),
    Code(
        "SC-A18", "A port has at most one unit, an IRI, and at most one frame, an IRI or a string.",
        "Where an output and an input both state one, they have to agree.",
        f'{_TUNER} ; sc:hasOutput [ sc:name "level" ; sc:signalType rob:Volume ; sc:unit "dB" ] .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "level" ; sc:signalType rob:Volume ; sc:unit unit:DeciB ] .',
    ),
    Code(
        "SC-A19", "An input says at most once, by true or false, whether it is optional.",
        "An optional input may stay unfed. To an output it does not matter whether it feeds something.",
        f'{_DISPLAY} ; sc:hasInput [ sc:name "text" ; sc:signalType rob:Text ; sc:optional "yes" ] .',
        f'{_DISPLAY} ; sc:hasInput [ sc:name "text" ; sc:signalType rob:Text ; sc:optional true ] .',
    ),
    Code(
        "SC-A20", "What an input accepts is one shape in brackets, of SHACL Core and without targets.",
        "It judges the outputs that may feed this input, and nothing else; so it names no other shape, no target and "
        "no query, and is of bounded size.",
        f'{_DISPLAY} ; sc:hasInput [ sc:name "text" ; sc:signalType rob:Text ; sc:accepts :any ] .',
        f'{_DISPLAY} ; sc:hasInput [ sc:name "text" ; sc:signalType rob:Text ;\n'
        "    sc:accepts [ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive 5 ] ] ] .",
    ),
    Code(
        "SC-A21", "An operation has one name of its own, and at most one type of request and one of response.",
        "Types of requests and responses are IRIs; only one that is needed may be optional, and none sc:accepts.",
        ':camera a sc:Component, :Camera ; sc:hasOperation [ sc:name "takePhoto" ; sc:response "photo" ] .',
        ':camera a sc:Component, :Camera ; sc:hasOperation [ sc:name "takePhoto" ; sc:response rob:Image ] .',
    ),
    Code(
        "SC-A22", "A composite has the ports of its template, and their types, and only parameters of its template.",
        "What is outside of it is connected to what its template connects inside, and is set to what that is bound to.",
        f"{_INSIDE}\n:radio-set a sc:Component, :RadioSet ; sc:grounding [ sc:template :play ] .",
        f'{_INSIDE}\n:radio-set a sc:Component, :RadioSet ; sc:grounding [ sc:template :play ] ;\n'
        '    sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
    ),
    Code(
        "SC-A23", "A composite stands in one file with its template.",
        "What is inside of it is configured from the file that it is advertised in.",
        ":radio-set a sc:Component, :RadioSet ; sc:grounding [ sc:template :play ] .",
        f'{_INSIDE}\n:radio-set a sc:Component, :RadioSet ; sc:grounding [ sc:template :play ] ;\n'
        '    sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
        Severity.WARNING,
    ),
    Code(
        "SC-T01", "A template has an IRI and is a sc:Template.",
        "Tasks and command lines speak of it by its IRI.",
        f":radio sc:roles ( :source :sink ) .\n{_SOURCE}\n{_SINK}", _PAIR,
    ),
    Code(
        "SC-T02", "A template has exactly one list of roles, and at least one role in it.",
        "The order of the list is the order in which roles are cast; without parentheses there is no order.",
        f":radio a sc:Template ; sc:roles :source, :sink .\n{_SOURCE}\n{_SINK}", _PAIR,
    ),
    Code(
        "SC-T03", "A role has an IRI and is a sc:Role.",
        "A role is a shape; what is not declared a role asks for nothing, and any component would fit.",
        f"{_TEMPLATE}\n{_SOURCE}\n:sink sh:class rob:Speaker .", _PAIR,
    ),
    Code(
        "SC-T04", "A role stands in the list of roles only once.",
        "To have a role played by several components, give it sc:minCount and sc:maxCount.",
        f":radio a sc:Template ; sc:roles ( :source :sink :sink ) .\n{_SOURCE}\n{_SINK}",
        f":radio a sc:Template ; sc:roles ( :source :sink ) .\n{_SOURCE}\n"
        ":sink a sc:Role ; sh:class rob:Speaker ; sc:minCount 2 ; sc:maxCount 2 .",
    ),
    Code(
        "SC-T05", "A role feeds only roles of its own template.",
        "Mostly a misspelt role, or one that was left out of sc:roles.",
        f"{_TEMPLATE}\n:source a sc:Role ; sh:class rob:Tuner ; sc:feeds :snik .\n{_SINK}", _PAIR,
    ),
    Code(
        "SC-T06", "An interaction has one role that feeds and one that is fed, and names at most one port of each.",
        "For more than one pair of ports write more than one interaction. Operations go with operations; their names "
        'are written with (), as in "takePhoto()".',
        f"{_PAIR}\n[] a sc:Interaction ; sc:from :source .",
        f'{_PAIR}\n[] a sc:Interaction ; sc:from :source ; sc:output "sound" ; sc:to :sink ; sc:input "audio" .',
    ),
    Code(
        "SC-T07", "Both roles of an interaction belong to one template.",
        "Components of different configurations are not connected.",
        f"{_PAIR}\n:third a sc:Role ; sh:class rob:Display .\n[] a sc:Interaction ; sc:from :source ; sc:to :third .",
        f"{_PAIR}\n[] a sc:Interaction ; sc:from :source ; sc:to :sink .",
    ),
    Code(
        "SC-T08", "A parameter of a template has an IRI and is a sc:Parameter.",
        "Its IRI stands in the roles where the value will stand.",
        f"{_PAIR}\n:radio sc:parameter :room .",
        f'{_PAIR}\n:radio sc:parameter :room .\n:sink sh:property [ sh:path rob:place ; sh:in ( :room ) ] .\n'
        ':room a sc:Parameter ; sc:name "room" .',
    ),
    Code(
        "SC-T09", "A parameter of a template has exactly one name, and at most one default, which it allows.",
        "The name is what is written in --bind NAME=VALUE, so it holds no blank and no =.",
        f"{_PAIR}\n:radio sc:parameter :room .\n:sink sh:property [ sh:path rob:place ; sh:in ( :room ) ] .\n"
        ":room a sc:Parameter .",
        f'{_PAIR}\n:radio sc:parameter :room .\n:sink sh:property [ sh:path rob:place ; sh:in ( :room ) ] .\n'
        ':room a sc:Parameter ; sc:name "room" .',
    ),
    Code(
        "SC-T10", "The parameters of a template have different names.",
        "Otherwise --bind could not tell them apart.",
        f"{_PAIR}\n:radio sc:parameter :near, :far .\n"
        ":sink sh:property [ sh:path rob:place ; sh:in ( :near :far ) ] .\n"
        ':near a sc:Parameter ; sc:name "room" .\n:far a sc:Parameter ; sc:name "room" .',
        f"{_PAIR}\n:radio sc:parameter :near, :far .\n"
        ":sink sh:property [ sh:path rob:place ; sh:in ( :near :far ) ] .\n"
        ':near a sc:Parameter ; sc:name "near" .\n:far a sc:Parameter ; sc:name "far" .',
    ),
    Code(
        "SC-T11", "What a role sets has exactly one type and exactly one value.",
        "The component that plays the role has to declare a parameter of that type.",
        f"{_PAIR}\n:source sc:sets [ sc:parameterType rob:Station ] .",
        f'{_PAIR}\n:source sc:sets [ sc:parameterType rob:Station ; sc:value "89.3" ] .',
    ),
    Code(
        "SC-T12", "The counts of a role are whole numbers, the least not above the most.",
        "Without sc:minCount the least is 1. The number of values of a property is another thing: sh:minCount.",
        f"{_PAIR}\n:sink sc:minCount 3 ; sc:maxCount 2 .", f"{_PAIR}\n:sink sc:minCount 1 ; sc:maxCount 2 .",
    ),
    Code(
        "SC-T13", "The shape of a role is well-formed SHACL.",
        "A shape that cannot be evaluated would let no component play the role, or all.",
        f"{_PAIR}\n:sink sh:property [ sh:path rob:place ; sh:minCount \"one\" ] .",
        f"{_PAIR}\n:sink sh:property [ sh:path rob:place ; sh:minCount 1 ] .",
    ),
    Code(
        "SC-T14", "The cost of a template is a list of levels, each with terms that count a property.",
        "The first level matters most, so there has to be an order; a term counts numbers, times its weight.",
        f"{_PAIR}\n:radio sc:cost ( [ sc:term [ sc:weight 2 ] ] ) .",
        f"{_PAIR}\n:radio sc:cost ( [ sc:term [ sc:property rob:latency ; sc:weight 2 ; sc:ofRole :sink ] ] ) .",
    ),
    Code(
        "SC-T15", "A role sets the parameters of one type to one value.",
        "A parameter of a component has one value at a time. For two values, two components play two roles.",
        f'{_PAIR}\n:source sc:sets [ sc:parameterType rob:Station ; sc:value "89.3" ] ,\n'
        '    [ sc:parameterType rob:Station ; sc:value "99.9" ] .',
        f'{_PAIR}\n:source sc:sets [ sc:parameterType rob:Station ; sc:value "89.3" ] .',
    ),
    Code(
        "SC-T16", "A priority belongs to a template or a task, as one whole number from -1000000 to 1000000.",
        "Of several tasks that want one component, the one with the highest priority gets it.",
        f"{_PAIR}\n:radio sc:priority 0.5 .", f"{_PAIR}\n:radio sc:priority 5 .",
    ),
    Code(
        "SC-T17", "A role recruits or does not, or states one shape of its suppliers.",
        "Recruits are components outside of the roles; they feed what no role feeds.",
        f'{_TEMPLATE}\n{_SOURCE}\n:sink a sc:Role ; sh:class rob:Speaker ; sc:recruits "yes" .',
        f"{_TEMPLATE}\n{_SOURCE}\n:sink a sc:Role ; sh:class rob:Speaker ; sc:recruits true .",
    ),
    Code(
        "SC-T18", "A port or operation of a template is that of one of its roles, with a name of its own; a port has a "
        "signal type.",
        "A composite whose inside is a task of the template has these ports and operations; each is joined to those of "
        "the players of its role by type.",
        f'{_PAIR}\n:radio sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
        f'{_PAIR}\n:radio sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:of :source ] .',
    ),
    Code(
        "SC-T19", "A parameter stands in shapes, for what sc:sets sets, and for the sc:property of a cost.",
        "How many components play a role, what a port is called and what a cost weighs is the same for all tasks of a "
        "template.",
        f"{_BOUND}:sink sc:recruits :room .", f"{_BOUND}:sink sc:recruits true .",
    ),
    Code(
        "SC-K01", "A task has exactly one template, given by its IRI.",
        "A task is a template with bindings.",
        ":music a sc:Task .", f"{_PAIR}\n:music a sc:Task ; sc:template :radio .",
    ),
    Code(
        "SC-K02", "A binding has exactly one parameter and exactly one value, which the parameter allows.",
        "To leave a parameter free, leave out its binding. Values are judged where the parameter stands in the file.",
        f"{_BOUND}:music a sc:Task ; sc:template :radio ; sc:binding [ sc:parameter :room ] .",
        f"{_BOUND}:music a sc:Task ; sc:template :radio ; sc:binding [ sc:parameter :room ; sc:value :kitchen ] .",
    ),
    Code(
        "SC-K03", "A task binds each parameter at most once.",
        "A parameter has one value for all roles that mention it.",
        f"{_BOUND}:music a sc:Task ; sc:template :radio ; sc:binding [ sc:parameter :room ; sc:value :kitchen ] ,\n"
        "    [ sc:parameter :room ; sc:value :bedroom ] .",
        f"{_BOUND}:music a sc:Task ; sc:template :radio ; sc:binding [ sc:parameter :room ; sc:value :kitchen ] .",
    ),
    Code(
        "SC-K04", "A task binds only parameters that its template has.",
        "This is checked where task and template stand in one file.",
        f"{_PAIR}\n:music a sc:Task ; sc:template :radio ; sc:binding [ sc:parameter :room ; sc:value :kitchen ] .",
        f"{_PAIR}\n:music a sc:Task ; sc:template :radio .",
    ),
    Code(
        "SC-K05", "A task stands in one file with its template, a configuration beside its template.",
        "A task is configured from one file; a task whose template is elsewhere is not found there. A configuration is "
        "judged by its template, and by the advertisements of its components: name their files in the same command.",
        ":music a sc:Task ; sc:template :radio .", f"{_PAIR}\n:music a sc:Task ; sc:template :radio .",
        Severity.WARNING,
    ),
    Code(
        "SC-C01", "A configuration has exactly one template, and at most one task, epoch and time.",
        "These say which question it answers, and when it was the answer.",
        ":now a sc:Configuration ; sc:epoch 3 .", ":now a sc:Configuration ; sc:template :radio ; sc:epoch 3 .",
    ),
    Code(
        "SC-C02", "An assignment has exactly one role and exactly one component.",
        "For a role that several components play, write several assignments.",
        ":now a sc:Configuration ; sc:template :radio ; sc:assignment [ a sc:Assignment ; sc:role :sink ] .",
        ":now a sc:Configuration ; sc:template :radio ;\n"
        "    sc:assignment [ a sc:Assignment ; sc:role :sink ; sc:component :speaker ] .",
    ),
    Code(
        "SC-C03", "A connection names its two components and its two ports.",
        "It leads from exactly one output to exactly one input.",
        f":now a sc:Configuration ; sc:template :radio ;\n    {_CAST} ;\n"
        "    sc:connection [ a sc:Connection ; sc:from :tuner ; sc:to :speaker ; sc:input \"audio\" ] .",
        _ANSWER,
    ),
    Code(
        "SC-C04", "A setting of a configuration has one component, one name and one value.",
        "It is what was injected into the component when it was activated.",
        f":now a sc:Configuration ; sc:template :radio ;\n    {_CAST} ;\n"
        '    sc:setting [ a sc:Setting ; sc:component :tuner ; sc:name "station" ] .',
        f":now a sc:Configuration ; sc:template :radio ;\n    {_CAST} ;\n"
        '    sc:setting [ a sc:Setting ; sc:component :tuner ; sc:name "station" ; sc:value "89.3" ] .',
    ),
    Code(
        "SC-C05", "A component plays only one role of a configuration.",
        "A configuration casts distinct components.",
        ":now a sc:Configuration ; sc:template :radio ;\n"
        "    sc:assignment [ a sc:Assignment ; sc:role :source ; sc:component :speaker ] ,\n"
        "                  [ a sc:Assignment ; sc:role :sink ; sc:component :speaker ] .",
        _ANSWER,
    ),
    Code(
        "SC-C06", "Connections and settings concern components that have a role.",
        "A component that neither plays a role nor is recruited is no part of the configuration.",
        _ANSWER.replace(":speaker ;", ":amplifier ;", 1).replace("sc:to :speaker", "sc:to :amplifier"), _ANSWER,
    ),
    Code(
        "SC-C07", "The roles of the template, and no others, are played by as many components as they ask for.",
        "This is checked where the template is given in the same command.",
        f"{_PAIR}\n:now a sc:Configuration ; sc:template :radio ;\n"
        "    sc:assignment [ a sc:Assignment ; sc:role :source ; sc:component :tuner ] .",
        f"{_PAIR}\n{_ANSWER}",
    ),
    Code(
        "SC-C08", "Every connection follows an interaction of the template.",
        "This is checked where the template is given in the same command.",
        _PAIR.replace(" ; sc:feeds :sink", "") + "\n" + _ANSWER, f"{_PAIR}\n{_ANSWER}",
    ),
    Code(
        "SC-C09", "The two ports of a connection exist and their types match.",
        "This is checked where the advertisements of both components are given in the same command. The types of ports "
        "match along the hierarchy of the loaded ontologies.",
        f"{_PORTS}\n{_ANSWER}".replace("rob:Audio", "rob:Text", 1), f"{_PORTS}\n{_ANSWER}",
    ),
    Code(
        "SC-C10", "Every matching pair of ports along an interaction is connected, and every input is fed.",
        "This is checked where template and advertisements are given in the same command. Here ports match that have "
        "one type.",
        f"{_PORTS}\n{_PAIR}\n:now a sc:Configuration ; sc:template :radio ;\n    {_CAST} .",
        f"{_PORTS}\n{_PAIR}\n{_ANSWER}",
    ),
    Code(
        "SC-C11", "A failure has one component, one cause, and at most one detail and time.",
        'The causes are "fail", "crash", "silence", "refused", "hung", "malformed", "yield" and "let go".',
        '[] a sc:Failure ; sc:component :tuner ; sc:cause "tired" .',
        '[] a sc:Failure ; sc:component :tuner ; sc:cause "crash" .',
    ),
    Code(
        "SC-O01", "A hierarchy is made of classes, or of properties.",
        "Matching follows rdfs:subClassOf, rdfs:subPropertyOf and the equivalences; a literal leads nowhere.",
        ':Jukebox a owl:Class ; rdfs:label "jukebox"@en ; rdfs:subClassOf "rob:Tuner" .',
        ':Jukebox a owl:Class ; rdfs:label "jukebox"@en ; rdfs:subClassOf rob:Tuner .',
    ),
    Code(
        "SC-O02", "A term of an ontology has a label.",
        "People read labels, also in the report of a refusal.",
        ":Jukebox a owl:Class ; rdfs:subClassOf rob:Tuner .",
        ':Jukebox a owl:Class ; rdfs:label "jukebox"@en ; rdfs:subClassOf rob:Tuner .',
        Severity.WARNING,
    ),
    Code(
        "SC-O03", "A kind of signal has one list of fields, each of which has one name and one datatype.",
        "What an output emits is checked against these fields, so that a wrong signal is blamed on who sent it.",
        ':Bell a owl:Class ; rdfs:label "bell"@en ; rob:field ( [ rob:fieldName "rings" ] ) .',
        ':Bell a owl:Class ; rdfs:label "bell"@en ;\n'
        '    rob:field ( [ rob:fieldName "rings" ; rob:datatype xsd:unsignedInt ] ) .',
    ),
    Code(
        "SC-L01", "Terms of sc: and sh: are spelt as they are declared.",
        "SHACL and RDF pass over a term that does not exist, so that a misspelt constraint asks for nothing.",
        f"{_PAIR}\n:sink sh:property [ sh:path rob:place ; sh:minCnt 1 ] .",
        f"{_PAIR}\n:sink sh:property [ sh:path rob:place ; sh:minCount 1 ] .",
    ),
    Code(
        "SC-L02", "Terms of a loaded ontology are spelt as they are declared.",
        "A type that no ontology declares matches nothing but itself.",
        ":tuner a sc:Component, rob:Tuneer .", f"{_TUNER} .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L03", "The signal types of ports are declared by a loaded ontology.",
        "Without a declaration the type matches only itself, and its fields and units are unknown.",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType :Sound ] .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L04", "A component is described in one file.",
        "Two descriptions of one component contradict each other sooner or later; one IRI means one component.",
    ),
    Code(
        "SC-L05", "A prefix keeps its meaning throughout a file.",
        "Turtle allows to bind it anew, but readers do not expect it.",
        f"{_TUNER} .\n@prefix : <https://example.org/garden#> .", f"{_TUNER} .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L06", "A namespace is written exactly as it is declared.",
        "With http for https, or / for #, all its terms are other terms, and the file says nothing to any reader. "
        "An error for sh: and for what begins with https://w3id.org/selfconf, a warning for others.",
        "@prefix old: <http://w3id.org/selfconf#> .\n:tuner a old:Component, rob:Tuner .",
        f"{_TUNER} .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L07", "Where an ontology wants a thing, there is an IRI.",
        "The literal and the IRI are different values, and a role that asks for one does not accept the other.",
        f'{_TUNER} ; rob:place "kitchen" .', f"{_TUNER} ; rob:place :kitchen .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L08", "The IRI of a component does not depend on where its file lies.",
        "A relative IRI is another one on another site.",
        "<tuner> a sc:Component, rob:Tuner .", f"{_TUNER} .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L09", "A role stands in the list of roles of a template.",
        "A role that no template lists is played by no component.",
        f"{_PAIR}\n:spare a sc:Role ; sh:class rob:Speaker .", _PAIR,
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L10", "A parameter is mentioned by a role.",
        "Binding a parameter that stands nowhere changes nothing.",
        f'{_PAIR}\n:radio sc:parameter :room .\n:room a sc:Parameter ; sc:name "room" .',
        f'{_PAIR}\n:radio sc:parameter :room .\n:room a sc:Parameter ; sc:name "room" .\n'
        ":sink sh:property [ sh:path rob:place ; sh:in ( :room ) ] .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L11", "A role asks for nothing impossible.",
        "If what its shapes ask for cannot hold at once, or holds of no advertisement, no component can play the role. "
        "What is reported is certain; not all that is impossible can be found.",
        f"{_PAIR}\n:sink sh:property [ sh:path rob:place ; sh:hasValue :kitchen ] ,\n"
        "    [ sh:path rob:place ; sh:in ( :bedroom :hall ) ] .",
        f"{_PAIR}\n:sink sh:property [ sh:path rob:place ; sh:minCount 1 ] ,\n"
        "    [ sh:path rob:place ; sh:in ( :bedroom :hall ) ] .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L12", "A loop of roles acts on the world, or feeds a role outside.",
        "Closed loops are what control is about, but a loop without an actuator that hands nothing on keeps only "
        "itself busy. A role of a kind that no loaded ontology tells about may be an actuator.",
        ":loop a sc:Template ; sc:roles ( :eye :mind ) .\n"
        ":eye a sc:Role ; sh:class rob:Camera ; sc:feeds :mind .\n"
        ":mind a sc:Role ; sh:class rob:Controller ; sc:feeds :eye .",
        ":loop a sc:Template ; sc:roles ( :eye :mind :wheels ) .\n"
        ":eye a sc:Role ; sh:class rob:Camera ; sc:feeds :mind .\n"
        ":mind a sc:Role ; sh:class rob:Controller ; sc:feeds :eye, :wheels .\n"
        ":wheels a sc:Role ; sh:class rob:MotorDrive .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L13", "An input that a role asks for is one that another role could feed.",
        "A component plays a role only if each of its inputs is fed. Where the shapes of the roles that feed it name "
        "outputs, one of them has to be of that type or below; a role whose shape names none is left alone.",
        f"{_PAIR}\n:sink sh:property [ sh:path ( sc:hasInput sc:signalType ) ; sh:hasValue rob:Audio ] .\n"
        ":source sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Text ] .",
        f"{_PAIR}\n:sink sh:property [ sh:path ( sc:hasInput sc:signalType ) ; sh:hasValue rob:Audio ] .\n"
        ":source sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Audio ] .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L14", "What a role asks its component to be stands in sh:class.",
        "The type of a role says what the role is, a sc:Role; it asks nothing of a component, so any would fit.",
        f"{_TEMPLATE}\n{_SOURCE}\n:sink a sc:Role, rob:Speaker .", _PAIR,
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L15", "A parameter is one of a template.",
        "What a template does not list among its sc:parameter is not replaced by a value where it stands in a role.",
        f"{_PAIR}\n:sink sh:property [ sh:path rob:place ; sh:in ( :room ) ] .\n"
        ':room a sc:Parameter ; sc:name "room" .',
        f'{_PAIR}\n:radio sc:parameter :room .\n:sink sh:property [ sh:path rob:place ; sh:in ( :room ) ] .\n'
        ':room a sc:Parameter ; sc:name "room" .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L16", "A parameter does not stand in the text of a query.",
        "A value takes the place of a parameter where it is a node of the shape; the text of a query is taken as it "
        "stands, so that there the parameter is only a thing of that name.",
        f'{_BOUND}:sink sh:sparql [ sh:select """SELECT $this WHERE {{\n'
        '    FILTER NOT EXISTS { $this ?property <https://example.org/home#room> } }""" ] .',
        _BOUND.rstrip(),
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L17", "A port belongs to a component.",
        "A port that nothing has is one that was meant to be a component's, and is left out of its advertisement.",
        f'{_TUNER} .\n_:sound sc:name "sound" ; sc:signalType rob:Audio .',
        f'{_TUNER} ; sc:hasOutput _:sound .\n_:sound sc:name "sound" ; sc:signalType rob:Audio .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L18", "A port has a signal type.",
        "Ports are paired by type; without one only an interaction pairs a port that names both ends.",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ] .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L19", "What a role recruits is possible.",
        "If the shape of its suppliers contradicts itself, or holds of no advertisement, none can be recruited.",
        f"{_PAIR}\n:source sc:recruits [ sh:property [ sh:path rob:place ; sh:hasValue :kitchen ] ,\n"
        "    [ sh:path rob:place ; sh:in ( :bedroom :hall ) ] ] .",
        f"{_PAIR}\n:source sc:recruits [ sh:property [ sh:path rob:place ; sh:minCount 1 ] ,\n"
        "    [ sh:path rob:place ; sh:in ( :bedroom :hall ) ] ] .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L20", "A role that may stay unplayed feeds another, or is fed.",
        "Components of a role with sc:minCount 0 join where they feed or are fed. A role that is joined to no other is"
        " played by all that are eligible, up to its sc:maxCount: a sc:feeds was probably forgotten.",
        ":radio a sc:Template ; sc:roles ( :source :sink ) .\n"
        ":source a sc:Role ; sh:class rob:Tuner .\n:sink a sc:Role ; sh:class rob:Speaker ; sc:minCount 0 .",
        f"{_PAIR}\n:sink sc:minCount 0 .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L21", "Ports of one signal type have units of one dimension.",
        "An output in kilograms never feeds an input in metres. One of the two units is likely not what was meant.",
        ':gauge a sc:Component, rob:Sensor ;\n'
        '    sc:hasOutput [ sc:name "d" ; sc:signalType rob:Odometry2D ; sc:unit unit:KiloGM ] .\n'
        ":panel a sc:Component, rob:Display ;\n"
        '    sc:hasInput [ sc:name "d" ; sc:signalType rob:Odometry2D ; sc:unit unit:M ] .',
        ':gauge a sc:Component, rob:Sensor ;\n'
        '    sc:hasOutput [ sc:name "d" ; sc:signalType rob:Odometry2D ; sc:unit unit:MilliM ] .\n'
        ":panel a sc:Component, rob:Display ;\n"
        '    sc:hasInput [ sc:name "d" ; sc:signalType rob:Odometry2D ; sc:unit unit:M ] .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L22", "What an input accepts is met by an output of its type.",
        "Where a file has outputs of the type that an input wants, one of them should conform to its sc:accepts.",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .\n'
        ':speaker a sc:Component, rob:Speaker ; sc:hasInput [ sc:name "in" ; sc:signalType rob:Audio ;\n'
        "    sc:accepts [ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minCount 1 ] ] ] .",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ;\n'
        "    sc:rate [ sc:value 5 ; sc:unit unit:HZ ] ] .\n"
        ':speaker a sc:Component, rob:Speaker ; sc:hasInput [ sc:name "in" ; sc:signalType rob:Audio ;\n'
        "    sc:accepts [ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minCount 1 ] ] ] .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L23", "A unit is called as QUDT calls it.",
        "Two ports agree in their units if these have one name, and only QUDT's names tell what a unit measures. It is "
        "the value of sc:unit: what a port says by qudt:hasUnit and the like keeps no two ports apart.",
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:unit unit:metre ] .',
        f'{_TUNER} ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:unit unit:M ] .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L24", "An operation has types of its request and its response, and no signal type.",
        "Operations are paired by what they take and what they answer; a signal type says neither.",
        ':camera a sc:Component, :Camera ; sc:hasOperation [ sc:name "takePhoto" ; sc:signalType rob:Image ] .',
        ':camera a sc:Component, :Camera ; sc:hasOperation [ sc:name "takePhoto" ; sc:response rob:Image ] .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L25", "What is said of a part of a component or of a template stands at that part.",
        "A term has one place where it is read; at another it says nothing, though it is spelt right.",
        f'{_TUNER} ; sc:command "python tuner.py" ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
        f'{_TUNER} ; sc:grounding [ sc:command "python tuner.py" ] ;\n'
        '    sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L26", "A literal is of the datatype that an ontology states for its property, and written as that is.",
        "A limit compares numbers with numbers, and dates with dates; a text that only looks like one meets none.",
        f'{_BANDS}\n{_TUNER} ; :bands "2" .', f"{_BANDS}\n{_TUNER} ; :bands 2 .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L27", "A role asks something of its component.",
        "A role that every component meets is played by the first that is there, whatever that does.",
        f"{_TEMPLATE}\n{_SOURCE}\n:sink a sc:Role .", _PAIR,
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L28", "A component has classes of components, and a signal type is a class of signals.",
        "A component has ports, a port has a signal type, and that is a class of signals. What names one for another "
        "matches nothing: no component can play such a role.",
        f"{_TEMPLATE}\n{_SOURCE}\n:sink a sc:Role ; sh:class rob:Audio .", _PAIR,
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L29", "No class lies below itself by way of others, and no property.",
        "A circle of rdfs:subClassOf makes its classes one: each matches where another is wanted. Mostly one of the "
        "statements is the wrong way round.",
        ':Jukebox a owl:Class ; rdfs:label "jukebox"@en ; rdfs:subClassOf rob:Tuner .\n'
        "rob:Tuner rdfs:subClassOf :Jukebox .",
        ':Jukebox a owl:Class ; rdfs:label "jukebox"@en ; rdfs:subClassOf rob:Tuner .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L30", "Classes lie below classes, and properties below properties.",
        "Matching follows rdfs:subClassOf between classes and rdfs:subPropertyOf between properties; "
        "by a property among classes nothing is matched.",
        ':room a owl:ObjectProperty ; rdfs:label "room"@en ; rdfs:subClassOf rob:place .',
        ':room a owl:ObjectProperty ; rdfs:label "room"@en ; rdfs:subPropertyOf rob:place .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L31", "A template is the same in each file that describes it.",
        "Files of tasks and composites each hold their template. Where two files differ in what they say of it, one is "
        "out of date or should have a name of its own; a configuration is judged by the first of them.",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L32", "What OWL combines stands in a list.",
        "The value of owl:unionOf, owl:intersectionOf, owl:oneOf and the like is a list, in parentheses; of anything "
        "else a reasoner infers nothing.",
        ':Player a owl:Class ; rdfs:label "player"@en ; owl:unionOf rob:Tuner , rob:Speaker .',
        ':Player a owl:Class ; rdfs:label "player"@en ; owl:unionOf ( rob:Tuner rob:Speaker ) .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L33", "What an ontology imports is loaded as well.",
        "Nothing is fetched because a file names it. The terms and hierarchies of an imported ontology count where its "
        "file is given as an ontology, or is validated beside this one.",
        "<https://example.org/home> a owl:Ontology ; owl:imports <https://example.org/base> .",
        "<https://example.org/home> a owl:Ontology ; owl:imports <https://w3id.org/selfconf/robotics> .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L34", "The query of a shape asks about $this.",
        "SHACL asks a query of sh:sparql with the component for $this, and a row of its answer is a violation. One "
        "whose pattern does not mention $this has the same answer for every component.",
        f'{_PAIR}\n:sink sh:sparql [ sh:select """SELECT $this {{\n'
        '    $This <https://w3id.org/selfconf/robotics#place> ?room }""" ] .',
        f'{_PAIR}\n:sink sh:sparql [ sh:select """SELECT $this {{\n'
        '    $this <https://w3id.org/selfconf/robotics#place> ?room }""" ] .',
        severity=Severity.WARNING,
    ),
    Code(
        "SC-L35", "Alternatives stand in one list.",
        "A shape may have several sh:or and sh:xone, and all of them have to hold. So each of them with one shape in "
        "it is no alternative to the others.",
        f"{_PAIR}\n:sink sh:or ( [ sh:class rob:Speaker ] ) , ( [ sh:class rob:Display ] ) .",
        f"{_PAIR}\n:sink sh:or ( [ sh:class rob:Speaker ] [ sh:class rob:Display ] ) .",
        severity=Severity.WARNING,
    ),
    Code(
        "SC-P01", "A project file is TOML.",
        "Nothing else can be said of a file that is not TOML 1.0, encoded in UTF-8.",
        'ecology = home', 'ecology = "home"',
        language="toml",
    ),
    Code(
        "SC-P02", "A project file has keys that selfconf knows.",
        "A key with a typing error would be overlooked in silence.",
        'ecologie = "home"', 'ecology = "home"',
        language="toml",
    ),
    Code(
        "SC-P03", "A key of a project file has a value of its kind.",
        "Each key is the option of that name and takes what the option takes; numbers go without quotes.",
        'steps = "many"', "steps = 100000",
        language="toml",
    ),
    Code(
        "SC-P04", "A project file names one ecology.",
        "Advertisements are in files (`ads`) or at a SPARQL endpoint (`endpoint`); a command asks one of them.",
        'ads = "."\nendpoint = "https://example.org/sparql"', 'ads = "."',
        language="toml",
    ),
    Code(
        "SC-P05", "What a project file names is there.",
        "Paths are relative to the folder of the project file.",
        'ads = "advertisments"', 'ads = "."',
        language="toml",
    ),
)  # fmt: skip

BY_CODE = {entry.code: entry for entry in CODES}
