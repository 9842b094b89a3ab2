"""Validation of files: every problem with its line, column and code.

A place is an offset at first: `rdf.positions` knows that of each term of Turtle, `shape_violations` chooses the one at
which a violation is shown, and `diagnostics` makes line and column of it. What the prefilter or a search in the text
finds gets its place by `text_places`, without a parser.

`validate_texts` checks `SourceText`s and returns a report. A file that the prefilter does not clear (`UnclearedFile`)
is checked by a `FileChecker`; `CheckEach` is how its calls are spread over processes, or remembered.
"""

from selfconf.rdf.validation.checking import CheckEach, FileChecker, SourceText, UnclearedFile, validate_texts

__all__ = ["CheckEach", "FileChecker", "SourceText", "UnclearedFile", "validate_texts"]
