"""Advertisements: from the text of a document to the profile and the triples of each component.

`read_advertisements` is the one road from text to advertisements; documents may share a `SegmentCache`. An
`Advertisement` is what is said about one component, as a profile and as triples; a `MalformedAdvertisement` is one that
does not conform, and why. `LoadedAdvertisement` also shares its statements with others. What an advertisement may say
stands in `selfconf.rdf.permitted_fields`.
"""

from selfconf.rdf.advertisements.advertisement import Advertisement, MalformedAdvertisement
from selfconf.rdf.advertisements.loader import LoadedAdvertisement, read_advertisements
from selfconf.rdf.advertisements.segments import SegmentCache

__all__ = [
    "Advertisement",
    "LoadedAdvertisement",
    "MalformedAdvertisement",
    "SegmentCache",
    "read_advertisements",
]
