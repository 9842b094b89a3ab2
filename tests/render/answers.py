"""A configuration, refusals and their facts, one of each kind, for the tests that render them."""

from __future__ import annotations

from fractions import Fraction

from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.consequence import Consequence
from selfconf.model.obstacle import WrongType
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import Output, Place, Profile, WantedSignal
from selfconf.model.refusal import (
    Conflict,
    Contradiction,
    InputUnfed,
    Reason,
    Refusal,
    TooFewDistinct,
    TooFewEligible,
    ValueUnknown,
)
from selfconf.model.relaxation import (
    AcceptNearMiss,
    AddComponents,
    AddInteraction,
    Addition,
    AddRecruits,
    AskForFewer,
    LetRecruit,
    Relaxation,
)
from selfconf.model.term import IRI, Literal
from selfconf.render import Names

HOME = "https://example.org/home#"
NAMES = Names({"": HOME})


def term(name: str) -> IRI:
    """A term of the example."""
    return IRI(HOME + name)


TEMPLATE, CLOCK, SCREEN, LAMP = map(term, ("tell", "clock", "screen", "lamp"))
SOURCE, SINK, SPARE = map(term, ("source", "sink", "spare"))
CONFIGURATION = Configuration(
    TEMPLATE,
    (Assignment(SOURCE, (CLOCK,)), Assignment(SINK, (SCREEN,)), Assignment(SPARE, ())),
    (Connection(CLOCK, "time", SCREEN, "text"),),
    (ParameterSetting(SCREEN, "size", Literal("12", IRI("http://www.w3.org/2001/XMLSchema#integer"))),),
    {"room": term("kitchen"), "greeting": Literal('say "hello"')},
)
MISS = NearMiss(SOURCE, LAMP, WrongType(term("Clock")), place=Place("lamp.ttl", 4))
REASONS: tuple[Reason, ...] = (
    Contradiction(SOURCE, 3, 2),
    ValueUnknown(SINK, "room"),
    TooFewEligible(SOURCE, 1, 0, place=Place("tell.ttl", 7)),
    InputUnfed(SINK, SCREEN, "text", WantedSignal((term("Text"),)), (SOURCE,), place=Place("screen.ttl")),
    TooFewDistinct((SOURCE, SINK), 2, 1),
    Conflict((SINK,), ("room",)),
)
"""A reason of each kind."""
REPAIRS: tuple[Relaxation, ...] = (
    AddComponents((Addition(SOURCE, 2, (Output("time", (term("Text"),)),)),)),
    AddRecruits((Addition(SINK, 1, (Output("time", (term("Text"),)),)),)),
    AskForFewer(SOURCE, 0),
    AddInteraction(SOURCE, SINK, place=Place("tell.ttl", 7)),
    AcceptNearMiss(MISS, Candidate(Profile(LAMP))),
    LetRecruit(SOURCE, (LAMP,)),
)
"""A relaxation of each kind."""
REFUSAL = Refusal(
    TEMPLATE, REASONS, (MISS,), "with --reasoning subclass there is a configuration", ("cellar",), REPAIRS
)
CONSEQUENCES = (
    Consequence(CLOCK, SOURCE, Refusal(TEMPLATE, REASONS[:1])),
    Consequence(SCREEN, SINK, CONFIGURATION, (LAMP,), (CLOCK,), ((CLOCK, SPARE),)),
)
OPTIMUM = Optimum(
    CONFIGURATION,
    (Fraction(1, 2), Fraction(24)),
    (Fraction(1, 4), Fraction(24)),
    ((CLOCK, term("power")), (SCREEN, term("error"))),
    proved=False,
)
