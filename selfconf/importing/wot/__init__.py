"""Thing Descriptions and Thing Models of the W3C Web of Things, versions 1.0 and 1.1, as components.

`import_things` reads them as documents to be written, `described_things` one by one, each a `DescribedThing`.
`NO_THINGS` names what is left out where something else stands in their place. `one_or_several` are the values of a
member of one, `event_ports` the names of the outputs that its events are.
`td-context-1.1.json` is the JSON-LD context of the W3C, minified and otherwise unchanged, from
https://www.w3.org/2022/wot/td/v1.1 under the W3C Software and Document License (`LICENSE.md`).
"""

from selfconf.importing.wot.affordances import event_ports
from selfconf.importing.wot.json_text import one_or_several
from selfconf.importing.wot.things import NO_THINGS, DescribedThing, described_things, import_things

__all__ = ["NO_THINGS", "DescribedThing", "described_things", "event_ports", "import_things", "one_or_several"]
