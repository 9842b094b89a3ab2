"""Which tests run in one process where several run them, and which processes compute while others wait."""

from __future__ import annotations

from collections.abc import Collection

INHABITED = "inhabited"
"""The fixture that starts a site and seven components: once is enough."""
WHOLE = {
    "tests/access/test_intruder.py",
    "tests/cli/test_access.py",
    "tests/api/test_ecology.py",
    "tests/api/living/test_living_ecology.py",
    "tests/api/tasks/test_run.py",
    "tests/api/test_typed_programs.py",
    "tests/cli/test_untrusted.py",
    "tests/query/test_endpoint.py",
    "tests/serve/test_page.py",
    "tests/serve/test_w3c_protocol.py",
    "tests/sim/test_pictures.py",
    "tests/sim/test_rehearsal.py",
    "tests/docs/test_ci_for_users.py",
    "tests/docs/test_reasoning.py",
    "tests/test_house.py",
    "tests/examples/test_notebook.py",
}
"""Modules whose tests share something that takes seconds to make: an ecology, an endpoint, an album, a type check."""
BAD_FILES = ("test_a_bad_file_", "test_the_log_of_every_bad_file_", "test_every_constraint_is_broken_by_a_bad_file")
"""How the names of tests begin that share the reports about all files of `tests/bad`."""
RECORDED = "tests/recorded/test_recorded.py"
"""A module whose tests share the answers to a group of cases, which is their parameter."""


def group_of(test: str, fixtures: Collection[str] = ()) -> str:
    """Return the name of a test's group, by its name and its fixtures; a test for any process is a group by itself."""
    module, _, name = test.partition("::")
    if INHABITED in fixtures:
        return INHABITED
    if module in WHOLE:
        return module
    if name.startswith(BAD_FILES):
        return "bad files"
    if module == RECORDED and "_as_recorded[" in name:
        return module + name.partition("[")[2]
    return test


YIELDS = 3
"""By how much a process that computes is nicer than the others: it takes what time these leave, and none starves."""


def computes(process: int) -> bool:
    """Whether the process of this number takes tests from the end of the order, and others from its beginning.

    The tests come as `tests/conftest.py` has put them: those that wait for programs first, those that compute for long
    last. One process in three takes them from the end, so that some compute while others wait; they meet among the
    short ones, and all end together.
    """
    return process % 3 == 2
