"""The notation of RosTooling models: names with colons and items with dashes, nested by indentation.

It looks like YAML and is none: a list may be words on lines of their own, `-[a, b]` is an item, `type:"x"` has its
colon without a space, and an item may go on in a line that begins left of its text. So it is read by what its grammar
(Xtext, with synthetic tokens for indentation) and the models that are about have in common.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from selfconf.errors import AuthorError
from selfconf.importing.sources import SourceDocument

_LINE = re.compile(
    r"""(?P<dash>-(?!>))?\s*(?P<key>"[^"]*"|'[^']*'|[^\s:\[\]"'#,-][^\s:\[\]"'#,]*)\s*:(?!:)\s*(?P<value>.*)"""
)
_WORD = re.compile(r""""[^"]*"|'[^']*'|[^\s\[\]{},"':]+(?:::?[^\s\[\]{},"':]+)*""")
_QUOTED_OR_COMMENT = re.compile(r""""[^"]*"|'[^']*'|(?P<comment>\#.*)|(?P<open>["'])""")
DEEPEST_MODEL = 50
"""How deep entries may be nested; models need eight levels."""


@dataclass(slots=True)
class ModelEntry:
    """A line of a model: its name, if it has one, what stands behind the colon or the dash, and what is below it."""

    key: str
    text: str
    line: int
    column: int
    below: list[ModelEntry] = field(default_factory=list)

    def child(self, key: str) -> ModelEntry | None:
        """The first entry of a name below this one."""
        return next((each for each in self.below if each.key == key), None)

    def value(self, key: str) -> str:
        """The text of the entry of a name below this one, without quotes; empty if there is none."""
        found = self.child(key)
        return "" if found is None else unquoted(found.text)

    def words(self) -> list[str]:
        """The words of the text, such as the members of a list in brackets, without quotes."""
        return [unquoted(word) for word in _WORD.findall(self.text)]


def unquoted(text: str) -> str:
    """A text without the quotes around it."""
    text = text.strip()
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "\"'" else text


def parse_model(source: SourceDocument) -> list[ModelEntry]:
    """The entries at the left margin. Raises AuthorError with line and column where a line is none of the notation."""
    root = ModelEntry("", "", 0, 0)
    open_entries = [(-1, root)]
    for entry in _entries(source):
        while entry.column <= open_entries[-1][0]:
            open_entries.pop()
        if len(open_entries) > DEEPEST_MODEL:
            raise _mistake(source, entry.line, entry.column, f"it is nested more than {DEEPEST_MODEL} levels deep")
        open_entries[-1][1].below.append(entry)
        open_entries.append((entry.column, entry))
    return root.below


def _entries(source: SourceDocument) -> Iterator[ModelEntry]:
    """Each line that says something; a list in brackets may take several."""
    lines = enumerate(source.text().splitlines(), 1)
    for number, raw in lines:
        line = _without_comment(raw.expandtabs(8), source, number)
        column = len(line) - len(line.lstrip())
        text = line.strip()
        if not text or text == "---":
            continue
        while text.count("[") > text.count("]"):
            following = next(lines, None)
            if following is None:
                raise _mistake(source, number, column, "a list in brackets has no end")
            text = f"{text} {_without_comment(following[1], source, following[0]).strip()}"
        found = _LINE.fullmatch(text)
        if found is not None:
            yield ModelEntry(unquoted(found["key"]), found["value"].strip(), number, column + 1)
        elif _WORD.fullmatch(text.lstrip("- ")) or re.fullmatch(r"-\s*\[.*\]", text):
            yield ModelEntry("", text.removeprefix("-").strip(), number, column + 1)
        else:
            message = "a line is `name:`, `name: value`, `- name: value`, `- [a, b]` or a name"
            raise _mistake(source, number, column, f"{message}, not {text[:40]!r}")


def _without_comment(line: str, source: SourceDocument, number: int) -> str:
    for found in _QUOTED_OR_COMMENT.finditer(line):
        if found["comment"] is not None:
            return line[: found.start()]
        if found["open"] is not None:
            raise _mistake(source, number, found.start(), "a quotation has no end")
    return line


def _mistake(source: SourceDocument, line: int, column: int, message: str) -> AuthorError:
    return AuthorError(message, file=source.shown, line=line, column=column + 1)
