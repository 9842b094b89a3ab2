"""Errors: one sentence that begins with the place, and the facts as attributes."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from selfconf import errors
from selfconf.errors import AuthorError, NamespaceError, SelfconfError, TemplateError, TurtleError, reason


def test_an_error_of_an_author_begins_with_its_place() -> None:
    error = TurtleError("a dot is missing", file="a.ttl", line=3, column=7)
    assert str(error) == "a.ttl:3:7: a dot is missing"
    assert (error.message, error.file, error.line, error.column) == ("a dot is missing", "a.ttl", 3, 7)


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (AuthorError("it is empty"), "it is empty"),
        (AuthorError("it is empty", file="a.ttl"), "a.ttl: it is empty"),
        (AuthorError("it is empty", file="a.ttl", line=3), "a.ttl:3: it is empty"),
    ],
)
def test_what_is_not_known_of_a_place_is_not_written(error: AuthorError, text: str) -> None:
    assert str(error) == text


def test_an_error_in_a_template_keeps_the_way_to_the_value_at_fault() -> None:
    error = TemplateError("two defaults", subject="urn:p", steps=(("urn:default", 1),))
    assert (error.subject, error.steps) == ("urn:p", (("urn:default", 1),))
    assert str(error) == "two defaults"


def test_what_cannot_be_a_namespace_is_said_with_what_can() -> None:
    error = NamespaceError("home")
    assert (error.namespace, str(error)) == (
        "home",
        "'home' cannot be a namespace; it is an absolute IRI that ends with #, / or :",
    )


def test_every_error_of_the_module_is_caught_as_one_of_selfconf() -> None:
    kinds = [kind for kind in vars(errors).values() if isinstance(kind, type)]
    assert len(kinds) > 1
    assert all(issubclass(kind, SelfconfError) for kind in kinds)


def test_the_reason_of_the_system_names_the_file_and_no_number(tmp_path: Path) -> None:
    missing = tmp_path / "missing.ttl"
    with pytest.raises(OSError, match=str(errno.ENOENT)) as error:
        missing.read_text()
    assert reason(error.value) == f"{missing}: No such file or directory"


def test_a_reason_without_a_file_is_what_the_system_says() -> None:
    assert reason(OSError(errno.ENOSPC, "No space left on device")) == "No space left on device"
    assert reason(OSError("disk gone")) == "disk gone"
