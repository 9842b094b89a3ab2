"""Advertisements: from the text of a document to the profile and the triples of each component.

`read` is the one road from text to advertisements; documents may share a `SegmentCache`. An `Advertisement` is what is
said about one component, as a profile and as triples; a `MalformedAdvertisement` is one that does not conform, and why.
`LoadedAdvertisement` also shares its statements with others. `STRUCTURE` are the predicates that a profile has fields
for.
"""

from selfconf.rdf.advertisements.loader import LoadedAdvertisement, read
from selfconf.rdf.advertisements.reader import STRUCTURE, Advertisement, MalformedAdvertisement
from selfconf.rdf.advertisements.segments import SegmentCache

__all__ = ["STRUCTURE", "Advertisement", "LoadedAdvertisement", "MalformedAdvertisement", "SegmentCache", "read"]
