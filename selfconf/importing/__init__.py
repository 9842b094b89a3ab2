"""Other descriptions of components as advertisements: read, converted, and written as Turtle.

`import_descriptions` is one import from sources to files, `import_documents` one of what else is read; its answer is an
`ImportReport` with an `ImportedFile` for each file and its `FileState`, an `Omission` for what is not in them, and a
`Renaming` where a name was taken. `IMPORT_FORMATS` are the formats by name.

For a bridge, which lives as what it describes: `gather` finds the `SourceDocument`s, `document_at` makes one of what a
URL has answered, asked for what is `ACCEPTED`, within `FETCH_SECONDS` and up to `LARGEST_SOURCE` bytes, and `Pages`
says where a list goes on. `described_things` reads each `DescribedThing` of them and notes in an `ImportLedger` what it
leaves out, as `NO_THINGS` where something stands in place of a thing; `one_or_several` are the values of a member of
its description, and `event_ports` names the outputs of its events. An `ImportedComponent` with its `ImportedPort`s and
`ImportedOperation`s is a component; as an `ImportedDocument`, `described_text` writes it as Turtle, in which a
`NestedNode` has no name and a `TermList` is a list. `NodeReader` makes a component of a ROS 2 node's `NodeInterface`s,
each of an `InterfaceKind`; `ROS2` are the terms for them, and `feedback_port` names the output that the feedback of an
action is. `slug` makes a name of a text.
"""

from selfconf.importing.conversion import (
    IMPORT_FORMATS,
    ImportedFile,
    ImportReport,
    import_descriptions,
    import_documents,
)
from selfconf.importing.folder import FileState
from selfconf.importing.imported import (
    ImportedComponent,
    ImportedDocument,
    ImportedOperation,
    ImportedPort,
    NestedNode,
    Omission,
    Renaming,
    TermList,
)
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.naming import slug
from selfconf.importing.pages import Pages
from selfconf.importing.ros2 import ROS2, InterfaceKind, NodeInterface, NodeReader, feedback_port
from selfconf.importing.sources import ACCEPTED, FETCH_SECONDS, LARGEST_SOURCE, SourceDocument, document_at, gather
from selfconf.importing.turtle_text import described_text
from selfconf.importing.wot import NO_THINGS, DescribedThing, described_things, event_ports, one_or_several

__all__ = [
    "ACCEPTED",
    "FETCH_SECONDS",
    "IMPORT_FORMATS",
    "LARGEST_SOURCE",
    "NO_THINGS",
    "ROS2",
    "DescribedThing",
    "FileState",
    "ImportLedger",
    "ImportReport",
    "ImportedComponent",
    "ImportedDocument",
    "ImportedFile",
    "ImportedOperation",
    "ImportedPort",
    "InterfaceKind",
    "NestedNode",
    "NodeInterface",
    "NodeReader",
    "Omission",
    "Pages",
    "Renaming",
    "SourceDocument",
    "TermList",
    "described_text",
    "described_things",
    "document_at",
    "event_ports",
    "feedback_port",
    "gather",
    "import_descriptions",
    "import_documents",
    "one_or_several",
    "slug",
]
