"""Validation of files: every problem with its line, column and code.

`validate_texts` checks `SourceText`s and returns a report. A file that the prefilter does not clear (`UnclearedFile`)
is checked by a `FileChecker`; `CheckEach` is how its calls are spread over processes, or remembered.
"""

from selfconf.rdf.validation.checking import CheckEach, FileChecker, SourceText, UnclearedFile, validate_texts

__all__ = ["CheckEach", "FileChecker", "SourceText", "UnclearedFile", "validate_texts"]
