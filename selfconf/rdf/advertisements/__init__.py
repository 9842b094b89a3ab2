"""Advertisements: from the text of a document to the profile and the triples of each component.

`read` is the one road from text to advertisements; documents may share a `SegmentCache`. An `Advertisement` is what is
said about one component, as a profile and as triples; a `MalformedAdvertisement` is one that does not conform, and why.
`LoadedAdvertisement` also shares its statements with others. `COMPONENT` is the table of what an advertisement may say:
a `Subject` with `Field`s that lead to further subjects. `STRUCTURE` are the predicates that are no properties of a
component.
"""

from selfconf.rdf.advertisements.advertisement import Advertisement, MalformedAdvertisement
from selfconf.rdf.advertisements.fields import COMPONENT, STRUCTURE, Field, Subject
from selfconf.rdf.advertisements.loader import LoadedAdvertisement, read
from selfconf.rdf.advertisements.segments import SegmentCache

__all__ = [
    "COMPONENT",
    "STRUCTURE",
    "Advertisement",
    "Field",
    "LoadedAdvertisement",
    "MalformedAdvertisement",
    "SegmentCache",
    "Subject",
    "read",
]
