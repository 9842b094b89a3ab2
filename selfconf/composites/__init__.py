"""The composites of a site: outside a component, inside a task that the site runs.

A composite is advertised like any other component; its grounding names a template of the same document, whose ports are
its own. `Composites` says which of those that a site advertises live; each that lives has an `InsideOfComposite`.
"""

from selfconf.composites.inside_of_composite import InsideOfComposite
from selfconf.composites.living_composites import Composites

__all__ = ["Composites", "InsideOfComposite"]
