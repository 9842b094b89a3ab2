"""The origin of a URL: scheme, host and port."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.errors import AuthorError
from selfconf.http_origin import check_without_user, http_origin


@pytest.mark.parametrize("url", ["ftp://a/", "lamp", "http:///x", "coap://a", "http://a:99999/"])
def test_only_http_has_an_origin(url: str) -> None:
    with pytest.raises(ValueError, match=r"http|Port|port"):
        http_origin(url)


def test_the_usual_port_is_left_out() -> None:
    said: Any = {"HTTP://A.Example:80/x": "http://a.example", "https://a:443": "https://a", "http://a:8": "http://a:8"}
    assert {url: http_origin(url) for url in said} == said


@pytest.mark.parametrize("user", ["me:secret", "secret", ":secret", "me:sec@ret"])
def test_a_password_in_a_url_is_refused_in_words_that_do_not_tell_it(user: str) -> None:
    with pytest.raises(AuthorError) as error:
        check_without_user(f"http://{user}@home.example:8080/query")
    assert str(error.value) == (
        "the URL of home.example:8080 has a user name or a password in it, which are not sent; leave them out"
    )


@pytest.mark.parametrize("url", ["http://home.example/a@b?c=d@e", "http://[::1", "no url", "http://"])
def test_any_other_url_passes(url: str) -> None:
    check_without_user(url)
