"""Advertisements: from the text of a document to the profile and the triples of each component.

`read_advertisements` is the one road from text to advertisements; documents may share a `SegmentCache`. An
`Advertisement` is what is said about one component, as a profile and as triples; a `MalformedAdvertisement` is one that
does not conform, and why. `LoadedAdvertisement` also shares its statements with others. What an advertisement may say
stands in `selfconf.rdf.permitted_fields`; the shape that an input accepts is read by `accepted_shape` and
`statements_of_shape`, which raise `ShapeNotAccepted`; `shape_text` is what says the same of a part of it.
"""

from selfconf.rdf.advertisements.accepted_shapes import (
    ShapeNotAccepted,
    accepted_shape,
    shape_text,
    statements_of_shape,
)
from selfconf.rdf.advertisements.advertisement import Advertisement, MalformedAdvertisement
from selfconf.rdf.advertisements.loader import LoadedAdvertisement, read_advertisements
from selfconf.rdf.advertisements.segments import SegmentCache

__all__ = [
    "Advertisement",
    "LoadedAdvertisement",
    "MalformedAdvertisement",
    "SegmentCache",
    "ShapeNotAccepted",
    "accepted_shape",
    "read_advertisements",
    "shape_text",
    "statements_of_shape",
]
