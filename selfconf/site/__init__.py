"""A site: the init-component of a host (section 2.1 of the paper)."""

from selfconf.site.site import Shelf, Site

__all__ = ["Shelf", "Site"]
