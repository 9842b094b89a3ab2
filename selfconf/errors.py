"""What can go wrong, sorted by whose fault it is.

An error carries its facts as attributes; its text is one sentence that says what is wrong, then what to try.
A refusal, a lost component, a SHACL violation or a late message is not here: those are values and events.
"""

from __future__ import annotations


class SelfconfError(Exception):
    """Anything that selfconf raises on purpose.

    >>> try:
    ...     read("no-such-folder")
    ... except SelfconfError as error:
    ...     print(error)
    there is no file or folder no-such-folder
    """


class AuthorError(SelfconfError):
    """The author of an advertisement, a template, a task or a command line wrote something that cannot be read."""

    def __init__(
        self, message: str, *, file: str | None = None, line: int | None = None, column: int | None = None
    ) -> None:
        super().__init__(message)
        self.message, self.file, self.line, self.column = message, file, line, column

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part is not None)
        return f"{place}: {self.message}" if place else self.message


class UnreadableError(AuthorError):
    """The system does not let a file or folder be read that is there, perhaps only for now.

    `path` is the file or folder.
    """

    def __init__(self, what: str, path: str, why: str) -> None:
        super().__init__(f"cannot read {what}: {why}")
        self.path = path


class TurtleError(AuthorError):
    """A file is not Turtle; `line` and `column` count from one."""


class TemplateError(AuthorError):
    """A template or task is Turtle, but not a template or task.

    `subject` is the IRI of what the error speaks of. `steps` lead from it to the value at fault, where there is one:
    each a predicate, and which of its values in the order of the text, counted from zero. Without a subject the first
    step has no predicate, and counts the nodes without an IRI to which nothing leads. So the place can be looked up
    when it is wanted, in another reading of the file, in which blank nodes have other names.
    """

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        subject: str | None = None,
        steps: tuple[tuple[str, int], ...] = (),
    ) -> None:
        super().__init__(message, file=file, line=line, column=column)
        self.subject, self.steps = subject, steps


class BindingError(AuthorError):
    """A value cannot stand for a parameter: unknown name, wrong kind of term, bound twice, or not bound at all.

    `parameter` is the name that it was to be bound by, where the error speaks of one.
    """

    def __init__(self, message: str, *, parameter: str | None = None) -> None:
        super().__init__(message)
        self.parameter = parameter


class NamespaceError(AuthorError):
    """A text cannot be what IRIs begin with."""

    def __init__(self, namespace: str) -> None:
        super().__init__(f"{namespace!r} cannot be a namespace; it is an absolute IRI that ends with #, / or :")
        self.namespace = namespace


class QueryError(AuthorError):
    """A SPARQL query cannot be read or is not allowed here."""


class QueryTimeoutError(QueryError):
    """A query takes longer, or more memory, than it may."""


class NotAcceptableError(QueryError):
    """An answer can be had in none of the media types that are wanted."""


class ProgrammerError(SelfconfError):
    """A program uses the SDK in a way it does not allow, such as emitting on an output that was never advertised."""


class PeerError(SelfconfError):
    """Another process of the ecology said something that the protocol does not allow."""


class SiteEndingError(PeerError):
    """A site starts nothing any more: it is ending, and so are its processes."""

    def __init__(self) -> None:
        super().__init__("this site is ending")


class NetworkError(SelfconfError):
    """The ecology cannot be reached: no site answers, an endpoint is taken, the session was lost."""


class SessionClosedError(NetworkError):
    """Code of this process has closed the session by which it takes part in the ecology; only a new process can."""


class SiteMisusedError(AuthorError):
    """A site that another program has started has ended at once, and has said why on stderr already."""


class InstallationError(SelfconfError):
    """This installation lacks something that the command needs; the text says what to install."""


def reason(error: OSError) -> str:
    """What the system says of an error, and of which file, without the number of the error."""
    said = error.strerror or str(error)
    return f"{error.filename}: {said}" if error.filename else said
