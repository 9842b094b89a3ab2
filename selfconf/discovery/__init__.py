"""The living ecology as seen from a bus: which components live, and what the sites advertise.

Discovery is acts 1 and 2 of the paper (section 2.4). An `EcologyView` is asked for it, and follows the lives of
components; what it finds is a `Discovery`, in which each `FoundAdvertisement` has its site. `Beliefs` say whose a
component is that several sites advertise; `namesakes` names the sites that have one name.
"""

from selfconf.discovery.ecology_view import Beliefs, EcologyView
from selfconf.discovery.found import Discovery, FoundAdvertisement, namesakes

__all__ = ["Beliefs", "Discovery", "EcologyView", "FoundAdvertisement", "namesakes"]
