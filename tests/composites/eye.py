"""A composite that tasks share, its site, and tasks that follow it, for the tests of composites."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from selfconf import files
from selfconf.deployment import TaskRunner
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from tests.lab import PREFIXES as LAB_PREFIXES
from tests.lab import Lab

EYE = {
    "eye": """:eye a sc:Component, :Eye ; sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] ;
        sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :lens ) ;
            sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ; sc:of :lens ] .
        :lens a sc:Role ; sh:class :Lens .""",
    "lens": """:lens-1 a sc:Component, :Lens ; sc:shareable false ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
    "plain": """:plain a sc:Component, :Plain ; sc:preference -1 ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
} | {
    name: f""":{name} a sc:Component, :{name.title()} ;
        sc:hasInput [ sc:name "seen" ; sc:signalType rob:Text ] ."""
    for name in ("low", "middle", "high")
}  # fmt: skip
"""A composite that tasks share, with one component inside that they do not, and for each task what follows them."""
LOOK = f"""{LAB_PREFIXES}
:look a sc:Template ; sc:roles ( :source :sink ) .
:source a sc:Role ; sh:class :Eye ; sc:feeds :sink . :sink a sc:Role ; sh:class :SINK ."""
HINTED = {
    "eye": """:eye a sc:Component, :Eye ; sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] ;
        sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:optional true ] ; sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :lens ) ;
            sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :lens ] ;
            sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ; sc:of :lens ] .
        :lens a sc:Role ; sh:class :Lens .""",
    "lens": """:lens-1 a sc:Component, :Lens ; sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ;
        sc:hasOutput [ sc:name "seen" ; sc:signalType rob:Text ] .""",
    "high": EYE["high"],
} | {
    f"hinter{number}": f""":hinter{number} a sc:Component, :Hinter ; sc:preference -{number} ;
        sc:hasOutput [ sc:name "hint" ; sc:signalType :Hint ] ."""
    for number in range(2)
}  # fmt: skip
"""A composite that can be fed or not, with a component inside that has to be fed."""


def eye(folder: Path, advertised: Mapping[str, str] = EYE) -> Lab:
    """A site with the composite, and with all that lives."""
    lab = Lab(folder, advertised=advertised)
    lab.site("home", *advertised)
    for name in sorted(advertised.keys() - {"eye", "outer"}):
        lab.component(name)
    lab.let_pass(3.0)
    return lab


def looking(lab: Lab, sink: str, priority: int, source: str = "Eye") -> TaskRunner:
    """A task that begins, and gets as far as it does."""
    agent = lab.agent(LOOK.replace("SINK", sink).replace(":Eye", f":{source}"), (), priority=priority)
    lab.running(agent)
    lab.let_pass(3.0)
    return agent


def advertised_in(folder: Path) -> dict[IRI, Advertisement]:
    """What the files of a folder advertise, read anew."""
    return {one.component: one for path in folder.iterdir() for one in files.advertisements(path)[0]}
