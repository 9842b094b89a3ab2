"""What else a refusal can tell: which components nearly fit, which relaxations help, whether other reasoning would."""

from __future__ import annotations

from collections.abc import Mapping

from selfconf.composition.composer import Composer
from selfconf.composition.near_misses import ranked_near_misses
from selfconf.composition.recruit_near_misses import with_recruit_near_misses, with_recruiting_instead
from selfconf.composition.time_limit import TimeLimit
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.refusal import Refusal
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement


def explained(
    composer: Composer,
    ecology: Mapping[IRI, Advertisement],
    refusal: Refusal,
    wider: Hierarchy | None,
    limit: TimeLimit,
) -> Refusal:
    """The refusal of an ecology with all that the time allows to find out.

    `wider` is the hierarchy of the mode `subclass` where the task was composed without one: it is tried whether there
    is a configuration under it. None where the composer has seen a hierarchy already.
    """
    known = composer.hierarchy if wider is None else wider
    found = limit.within(lambda: ranked_near_misses(composer, ecology, refusal, known), refusal.near_misses)
    refusal = replace(refusal, near_misses=found)
    refusal = limit.within(lambda: with_recruit_near_misses(composer, ecology, refusal, known), refusal)
    stopped = replace(refusal, repairs_stopped=True)
    refusal = limit.within(lambda: composer.with_relaxations(ecology, refusal), stopped)
    stopped = replace(refusal, repairs_stopped=True)
    refusal = limit.within(lambda: with_recruiting_instead(composer, ecology, refusal), stopped)
    if wider is not None and limit.within(lambda: composer.possible_under(ecology, wider), False):
        return replace(refusal, hint=f"with {setting('reasoning', 'subclass')} there is a configuration")
    return refusal
