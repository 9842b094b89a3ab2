"""The order in which the candidates of a role are tried; it decides which configuration is the first.

No search may depend on which site answered first. So candidates are ordered by what they say of themselves.
"""

from __future__ import annotations

from decimal import Decimal

from selfconf.model.profile import Profile


def candidate_order(profile: Profile) -> tuple[Decimal, str]:
    """The order in which candidates are tried: higher preference first, then by IRI, never by time of arrival."""
    return profile.preference.copy_negate(), profile.component  # a minus sign would round
