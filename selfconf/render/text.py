"""Answers as text for people: a configuration, its cost, what would replace what, a refusal on one screen.

The names of ports and parameters are any text that strangers wrote: what would break or forge a line is spelt out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from selfconf.model.alternative import Alternative
from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.holder import Holder
from selfconf.model.optimum import Optimum
from selfconf.model.partition import NearMiss
from selfconf.model.refusal import Reason, Refusal, Undecided
from selfconf.model.relaxation import Relaxation
from selfconf.model.template import Interaction
from selfconf.model.term import IRI, Term
from selfconf.model.wording import counted, one_line
from selfconf.render.bodies import double
from selfconf.render.tables import clock_time

Name = Callable[[Term], str]
"""How a term is written: `Names` of a document, or `short`."""
MOST_LINES = 8
"""How many reasons, and how many near misses, a screen has room for."""


def disobedience(component: str, why: str) -> str:
    """The sentence that a component was turned off and does not come to rest, with how it is where that is known."""
    return f"{component} was turned off and has not obeyed{f': {why}' if why else ''}"


def disobedience_text(disobedient: Mapping[IRI, str], name: Name) -> list[str]:
    """A line for each component that was turned off and does not come to rest, with how it is where that is known."""
    return [f"out of control: {disobedience(name(one), why)}" for one, why in disobedient.items()]


def unconnected_text(configuration: Configuration, interactions: Iterable[Interaction], name: Name) -> Iterator[str]:
    """Yield a line for each interaction that connects nothing: an author may have expected otherwise."""
    for one in configuration.unconnected(interactions):
        ports = [f" {one_line(port)!r}" if port else "" for port in (one.output, one.input)]
        source, sink = (name(role) + port for role, port in zip((one.source, one.sink), ports, strict=True))
        yield f"{source} feeds {sink}, which connects nothing: no output of the one matches an input of the other"


def configuration_text(configuration: Configuration, name: Name) -> str:
    """A configuration: which components play which role, which output feeds which input, what is bound and set."""
    roles = [name(a.role) for a in configuration.assignments]
    width = max(map(len, roles), default=0)
    lines = [f"configured {name(configuration.template)}"]
    for role, assignment in zip(roles, configuration.assignments, strict=True):
        lines.append(f"  {role:<{width}}  {', '.join(map(name, assignment.components)) or '(no component)'}")
    if configuration.recruits:
        lines += ["recruits", *(f"  {name(component)}" for component in configuration.recruits)]
    return "\n".join([*lines, *_connections(configuration, name), *_values(configuration, name)])


def _connections(configuration: Configuration, name: Name) -> list[str]:
    ends = [
        (f"{name(c.source)} {one_line(c.output)}", f"{name(c.sink)} {one_line(c.input)}")
        for c in configuration.connections
    ]
    width = max((len(left) for left, _ in ends), default=0)
    return ["connections", *(f"  {left:<{width}}  ->  {right}" for left, right in ends)] if ends else []


def _values(configuration: Configuration, name: Name) -> list[str]:
    bindings = [f"  {one_line(parameter)} = {name(value)}" for parameter, value in configuration.bindings.items()]
    settings = [f"  {name(s.component)} {one_line(s.name)} = {name(s.value)}" for s in configuration.settings]
    return [*(["bindings", *bindings] if bindings else []), *(["parameters", *settings] if settings else [])]


def consequences_text(consequences: Sequence[Consequence], name: Name) -> str:
    """What would replace each component if it failed; single points of failure stand out."""
    width = max((len(name(one.component)) for one in consequences), default=0)
    lines = [f"  {name(one.component):<{width}}  ->  {one.told(name)}" for one in consequences]
    return "\n".join(["if it failed", *lines])


def cost_text(optimum: Optimum, unknown: Iterable[IRI], name: Name) -> str:
    """What a configuration costs; `unknown` are properties of the cost that no component of the ecology has."""
    lines = ["cost, compared level by level" if len(optimum.cost) > 1 else "cost"]
    for number, (spent, least) in enumerate(zip(optimum.cost, optimum.bound, strict=True), 1):
        bound = "" if optimum.proved else f"  (bound {_decimal(least)})"
        lines.append(f"  level {number}  {_decimal(spent)}{bound}")
    unproved = "not proved: there may be something better"
    if optimum.unaided:
        unproved += ", which the extra `solvers` would tell"
    lines.append(f"  {'proved: nothing costs less' if optimum.proved else unproved}")
    if optimum.missing:
        terms, are = counted(optimum.unknown_terms, "term"), "is" if optimum.unknown_terms == 1 else "are"
        lines.append(f"  {terms} {are} unknown, and left out of the sums (sc:otherwise would say what to count)")
    unstated = set(unknown)
    lines += [f"    no component of the ecology has a number for {name(one)}" for one in sorted(unstated)]
    told = dict.fromkeys(pair for pair in optimum.missing if pair[1] not in unstated)
    lines += [f"    {name(component)} has no number for {name(wanted)}" for component, wanted in told]
    return "\n".join(lines)


def alternative_text(one: Alternative, chosen: Alternative | None, some_held: bool) -> str:
    """What speaks for a candidate of a role and against it, beside the one that is chosen.

    Where tasks hold some of the components, only the others are free for a configuration.
    """
    said = [f"preference {one.preference:g}" if one.preference else "no preference"]
    if one.cost:
        said.append(f"cost {_amounts(one.cost)}")
    if one.unknown_terms:
        said.append(f"{counted(one.unknown_terms, 'term')} of the cost unknown")
    return f"{', '.join(said)}; {_outcome(one, chosen, some_held)}"


def _outcome(one: Alternative, chosen: Alternative | None, some_held: bool) -> str:
    """What comes of a candidate."""
    proved = "" if one.proved else " at most"
    if one.chosen:
        return f"chosen, all in all{proved} {_amounts(one.total)}" if one.total else "chosen"
    if one.outcome != "possible":
        impossible = "no configuration of what is free has it" if some_held else "no configuration has it"
        return {"impossible": impossible, "undecided": "not decided in time"}.get(one.outcome, "not tried")
    if not one.total:
        return "possible, and comes later in the order"
    return f"with it all in all{proved} {_amounts(one.total)}{_beside(one, chosen)}"


def _beside(one: Alternative, chosen: Alternative | None) -> str:
    """How much more or less the cheapest configuration with a candidate costs than the answer."""
    level, more = next(((n, x) for n, x in enumerate(one.extra(chosen), 1) if x), (0, Fraction(0)))
    where = f" on level {level}" if len(one.total) > 1 else ""
    if chosen is None or not level:
        return ", which is no more: it comes later in the order"
    if more > 0:
        return f", {_decimal(more)} more{where}"
    # With as few components of optional roles, and as few unknown terms, as the answer has, nothing costs less.
    known = one.proved and chosen.proved and one.total_unknown_terms == chosen.total_unknown_terms
    return f", {_decimal(-more)} less{where}{', but with more of the optional roles' if known else ''}"


def _amounts(levels: Iterable[Fraction]) -> str:
    """Amounts, level by level."""
    return " / ".join(map(_decimal, levels))


def _decimal(amount: Fraction) -> str:
    return f"{double(amount):.10g}"


def undecided_text(undecided: Undecided, template: IRI, name: Name) -> str:
    """The sentence that there is no answer yet."""
    return f"{name(template)} is {undecided}"


NOT_PROVED = {
    "irreducible": "irreducible: all of that is needed, but another reason might be shorter",
    "unproved": "explaining stopped there: not all of that may be needed",
}
"""What is said of a reason that is not proved to be a smallest one."""


def refusal_text(refusal: Refusal, name: Name) -> str:
    """A refusal on one screen, the most likely cause first, each line with the place that it speaks of."""
    lines = [f"no configuration for {name(refusal.template)}"]
    if not refusal.reasons:
        lines.append("  no time was left to find out why; allow more")
    lines += [_placed(f"  because {reason}", reason) for reason in refusal.reasons[:MOST_LINES]]
    if len(refusal.reasons) > MOST_LINES:
        lines.append(f"  and {counted(len(refusal.reasons) - MOST_LINES, 'more reason')}")
    if refusal.reasons and refusal.minimality in NOT_PROVED:
        lines.append(f"  {NOT_PROVED[refusal.minimality]}")
    if refusal.near_misses:
        lines.append("near misses")
        lines += [_placed(f"  {_near_miss(miss, name)}", miss) for miss in refusal.near_misses[:MOST_LINES]]
        if len(refusal.near_misses) > MOST_LINES:
            lines.append(f"  and {len(refusal.near_misses) - MOST_LINES} more")
    lines += [f"held by another task: {name(one)}: {holder_text(holder)}" for one, holder in refusal.held[:MOST_LINES]]
    if len(refusal.held) > MOST_LINES:
        lines.append(f"  and {len(refusal.held) - MOST_LINES} more that are held")
    lines += _repairs(refusal)
    return "\n".join((*lines, *_missing(refusal.missing_sites)))


def _repairs(refusal: Refusal) -> Iterator[str]:
    """What would make a configuration possible, and whether more was to be tried."""
    if refusal.repairs or refusal.hint:
        yield "what would mend it"
        yield from (_placed(f"  {relaxation}", relaxation) for relaxation in refusal.repairs)
    if refusal.hint:
        yield f"  {refusal.hint}"
    if refusal.repairs_stopped:
        yield f"the search for {'other ' * bool(refusal.repairs)}repairs stopped before all was tried"


def _missing(sites: Sequence[str]) -> list[str]:
    """The sites that may have what is lacking."""
    more = [f"and {counted(len(sites) - MOST_LINES, 'other site')} did not either"] if len(sites) > MOST_LINES else []
    return [*(f"the site {site} did not answer in full" for site in sites[:MOST_LINES]), *more]


def holder_text(holder: Holder) -> str:
    """The holder of a component, and since when."""
    return f"{holder} since {clock_time(holder.beginning)}"


def _placed(sentence: str, fact: Reason | Relaxation | NearMiss) -> str:
    return sentence if fact.place is None else f"{sentence}  [{fact.place}]"


def _near_miss(miss: NearMiss, name: Name) -> str:
    would = "could be recruited" if miss.recruit else "would fit"
    return f"{miss.role.short}: {name(miss.component)} {would}, but {miss}"
