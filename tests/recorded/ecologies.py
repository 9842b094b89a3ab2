"""Random ecologies as files: advertisements, a template and an ontology in Turtle, and the options to configure them.

Each ecology is made around a cast: for every role as many components as it asks for, which issue what is needed. So it
can be configured. Then come rivals, which nearly fit, and in more than half of the ecologies a flaw or two, each of
which takes away something that the cast needs. Everything depends on the seed alone.
"""

from __future__ import annotations

from dataclasses import dataclass

from tests.recorded.chance import Chance
from tests.recorded.drafts import Draft
from tests.recorded.flaws import FLAWS, MALFORMED
from tests.recorded.shapes import HEAD, ONTOLOGY

TROUBLES = ("syntax", "role", "counts", "unbound", "unknown parameter", "literal signal", "empty")
"""What makes an ecology unreadable, or a task not a task."""


@dataclass(frozen=True)
class Ecology:
    """Files by name, and the options of `configure` that go with them, besides the format."""

    files: dict[str, str]
    options: tuple[str, ...]

    @property
    def ontology(self) -> tuple[str, ...]:
        """The option that names the ontology, if the ecology has one."""
        return ("--ontology", "ontology.ttl") if "ontology.ttl" in self.files else ()


def generated(seed: int) -> Ecology:
    """The ecology of a seed."""
    return _finished(Draft(seed))


def _finished(draft: Draft) -> Ecology:
    """The files and the options, after what is to go wrong has gone wrong."""
    chance = draft.chance
    if chance.often(0.62):
        for _ in range(chance.one((1, 1, 1, 2))):
            chance.one(FLAWS)(draft)
    options, draft.costs = _options(draft)
    advertised = [component.turtle() for component in chance.shuffled(draft.components)]
    if chance.often(0.12):
        for number in range(1 + chance.below(2)):
            advertised.append(f":wrong{number} {chance.one(MALFORMED)} .\n")
    files = {"template.ttl": draft.template(), "ads/all.ttl": HEAD + "".join(advertised)}
    if len(advertised) > 2 and chance.often(0.3):
        half = len(advertised) // 2
        files["ads/all.ttl"] = HEAD + "".join(advertised[:half])
        files["ads/more.ttl"] = HEAD + "".join(advertised[half - chance.below(2) :])  # one may be advertised twice
    if draft.reasoning == "subclass" or chance.often(0.3):
        files["ontology.ttl"] = ONTOLOGY
    if "ontology.ttl" in files:
        options += ["--ontology", "ontology.ttl"]
    if chance.often(0.025):
        _trouble(chance, files, options)
    return Ecology(files, tuple(options))


def _options(draft: Draft) -> tuple[list[str], tuple[str, ...]]:
    chance = draft.chance
    options = [part for bound in draft.bound for part in ("--bind", bound)]
    costs: tuple[str, ...] = ()
    if draft.reasoning != "syntactic" or chance.often(0.1):
        options += ["--reasoning", draft.reasoning]
    strategy = chance.one(("first",) * 14 + ("best",) * 4 + ("paper",) * 2)
    if strategy == "paper" and any(parameter.startswith(":level ") for parameter in draft.parameters):
        strategy = "first"  # the paper has nothing to say of a parameter that is set and has no value
    if strategy != "first":
        options += ["--strategy", strategy]
    if strategy == "best" and chance.often(0.9):
        terms = ["[ sc:property :latency ]", "[ sc:property :power ; sc:otherwise 20 ]"]
        terms += [f"[ sc:property :power ; sc:weight -0.5 ; sc:ofRole {draft.roles[0].name} ]"]
        levels = [f"[ sc:term {term} ]" for term in chance.some(terms, 0.6)] or [f"[ sc:term {', '.join(terms)} ]"]
        costs = (f"sc:cost ( {' '.join(levels)} )",)
    if chance.often(0.2):
        options.append("--what-if")
    if chance.often(0.06):
        options += ["--steps", chance.one(("1", "2", "5", "20", "1000"))]
    return options, costs


def _trouble(chance: Chance, files: dict[str, str], options: list[str]) -> None:
    trouble = chance.one(TROUBLES)
    if trouble == "syntax":
        files["ads/all.ttl"] += ':broken a sc:Component, :K0 ; sc:hasOutput [ sc:name "out" .\n'
    elif trouble == "role":
        files["template.ttl"] = files["template.ttl"].replace(":r1 a sc:Role ;", ":r1 a sh:NodeShape ;")
    elif trouble == "counts":
        files["template.ttl"] = files["template.ttl"].replace(
            ":r0 a sc:Role", ":r0 sc:minCount 3 ; sc:maxCount 2 ; a sc:Role"
        )
    elif trouble == "unbound":
        options += ["--bind", "no equals sign"]
    elif trouble == "unknown parameter":
        options += ["--bind", "altitude=3"]
    elif trouble == "literal signal":
        files["template.ttl"] = files["template.ttl"].replace("sc:feeds :", 'sc:feeds "somebody", :')
    else:
        files["ads/all.ttl"] = HEAD
