"""Other descriptions of components as advertisements: read, converted, and written as Turtle.

`import_descriptions` is one import from sources to files; its answer is an `ImportReport` with an `ImportedFile` for
each file and its `FileState`, an `Omission` for what is not in them, and a `Renaming` where a name was taken.
`IMPORT_FORMATS` are the formats by name.
"""

from selfconf.importing.conversion import IMPORT_FORMATS, ImportedFile, ImportReport, import_descriptions
from selfconf.importing.folder import FileState
from selfconf.importing.imported import Omission, Renaming

__all__ = [
    "IMPORT_FORMATS",
    "FileState",
    "ImportReport",
    "ImportedFile",
    "Omission",
    "Renaming",
    "import_descriptions",
]
