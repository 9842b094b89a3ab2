"""Errors are problem details."""

from __future__ import annotations

import json

from selfconf.serve.problems import problem


def test_a_problem_has_title_status_and_detail() -> None:
    response = problem(406, "no type fits", {"Allow": "GET"})
    assert (response.status_code, response.media_type) == (406, "application/problem+json")
    assert json.loads(bytes(response.body))["title"] == "Not Acceptable"
    assert response.headers["allow"] == "GET"


def test_what_a_client_does_not_accept_varies_with_what_it_accepts() -> None:
    assert problem(406, "no type fits").headers["vary"] == "Accept"
    assert "vary" not in problem(404, "nothing is there").headers
