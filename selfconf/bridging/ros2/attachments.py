"""What travels beside each message of rmw_zenoh: its number, its time, and which publisher it is from.

33 octets, little-endian: number (int64), nanoseconds (int64), 16, and the 16 octets of the publisher's identifier. That
of 2024 carried names of its fields; it is refused, like everything else that is not these 33 octets.
"""

from __future__ import annotations

import struct

from selfconf.errors import PeerError
from selfconf.model.immutable import immutable

_FORM = struct.Struct("<qqB16s")
_SIZE = 16


@immutable
class RosAttachment:
    """The attachment of a message."""

    sequence: int
    nanoseconds: int
    """Its time, of the Unix epoch."""
    publisher: bytes
    """16 octets; each implementation makes them in its own way."""

    @classmethod
    def unpack(cls, octets: bytes) -> RosAttachment:
        """Read an attachment. Raises PeerError."""
        try:
            sequence, nanoseconds, size, publisher = _FORM.unpack(octets)
        except struct.error:
            raise PeerError(f"an attachment of {len(octets)} octets is none of rmw_zenoh as of 2025") from None
        if size != _SIZE:
            raise PeerError(f"an identifier of a publisher has {_SIZE} octets, not {size}")
        return cls(sequence, nanoseconds, publisher)

    def pack(self) -> bytes:
        """The octets of the attachment."""
        return _FORM.pack(self.sequence, self.nanoseconds, _SIZE, self.publisher)
