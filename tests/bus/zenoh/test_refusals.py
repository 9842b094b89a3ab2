"""What Zenoh's log says of refused messages is read, counted and bounded; real lines are in the table of attacks."""

from __future__ import annotations

import re

import pytest

from selfconf.bus.zenoh.refusals import MOST_ATTEMPTS, RefusalLog

PEER = "5ec1c06f0c48971bb2c118a3b409706c"
LINK = f"{PEER} on Interface(lo)+CertCommonName(comp.x)+Transport(Tls)+{PEER}"
AC = "2026-11-22T19:22:36.669613Z TRACE  rx-1 ThreadId({}) zenoh::net::routing::interceptor::access_control: "
INTERCEPTED = "2026-11-22T19:22:36.669Z TRACE  rx-1 ThreadId({}) zenoh::net::routing::interceptor: Msg intercepted!"


def denied(key: str, what: str = "Put", flow: str = "ingress", thread: int = 11) -> list[str]:
    """The lines of one refused message."""
    return [AC.format(thread) + f"{LINK} is unauthorized to {what} ({flow}) on {key}", INTERCEPTED.format(thread)]


def log_of(*lines: str) -> RefusalLog:
    """A log that has read some lines."""
    log = RefusalLog(clock=lambda: 7.0)
    for line in lines:
        log.take(line)
    return log


def found(log: RefusalLog) -> list[tuple[str, str, str, int]]:
    """What was refused."""
    return [(one.principal, one.attempt, one.key, one.number) for one in log.refused]


def test_a_refused_message_is_counted_for_who_sent_it() -> None:
    log = log_of(*denied("a/b"), *denied("a/b"), *denied("a/c", "Declare/Undeclare Queryable"))
    assert sorted(found(log)) == [("comp.x", "Declare/Undeclare Queryable", "a/c", 1), ("comp.x", "Put", "a/b", 2)]
    assert log.refused[0].latest == 7.0


def test_a_cached_refusal_names_the_peer_only_by_its_number() -> None:
    cached = AC.format(3) + f"Using cached result: {PEER} is unauthorized to Put (ingress) on a/b"
    assert found(log_of(*denied("x"), cached, INTERCEPTED.format(3)))[-1] == ("comp.x", "Put", "a/b", 1)
    assert found(log_of(cached, INTERCEPTED.format(3))) == [("?", "Put", "a/b", 1)]


def test_what_is_kept_from_somebody_or_allowed_in_the_end_is_no_attempt() -> None:
    first, last = denied("a/b", flow="egress")
    assert found(log_of(first, last)) == []
    assert found(log_of(denied("a/b")[0])) == []
    assert found(log_of(denied("a/b")[0], INTERCEPTED.format(12))) == [], "another thread"


def test_an_error_reply_to_what_was_asked_of_many_is_no_attempt() -> None:
    log = log_of(*denied("site/*/@ctl/introduce", "Reply"), *denied("site/home/@ctl/introduce", "Reply"))
    assert found(log) == [("comp.x", "Reply", "site/home/@ctl/introduce", 1)]


def test_who_knocks_without_a_good_certificate_is_counted() -> None:
    line = "2026Z  WARN acc-0 ThreadId(06) zenoh_link_tls::unicast: {}. Hint: increase the system open file limit."
    log = log_of(line.format("peer sent no certificates"), line.format("invalid peer certificate: UnknownIssuer"))
    assert {attempt for _, attempt, _, _ in found(log)} == {
        "peer sent no certificates",
        "invalid peer certificate: UnknownIssuer",
    }


def test_a_connection_that_broke_off_before_a_certificate_was_looked_at_is_no_attempt() -> None:
    line = "2026Z  WARN acc-0 ThreadId(06) zenoh_link_tls::unicast: {}. Hint: increase the system open file limit."
    ended = "Connection reset by peer (os error 104)", "Broken pipe (os error 32)", "tls handshake eof"
    assert found(log_of(*map(line.format, (*ended, "Too many open files (os error 24)")))) == []


def test_who_knocks_again_and_again_by_another_clock_has_made_one_attempt() -> None:
    line = (
        "2026Z  WARN acc-0 ThreadId(06) zenoh_link_tls::unicast: invalid peer certificate: certificate not valid yet: "
        "verification time {} (UNIX), but certificate is not valid before 1795873165 (86084 seconds in future)"
    )
    log = log_of(line.format(1795787081), line.format(1795787082))
    assert found(log) == [("", "invalid peer certificate: certificate not valid yet", "", 2)]


def coloured(*lines: str) -> bytes:
    """Lines as Zenoh writes them, of which the time, the level and the target have colours."""
    return "\n".join(
        re.sub(r"^(\S+) +(\w+) (.*?)(zenoh\S*?): ", "\x1b[2m\\1\x1b[0m \x1b[35m\\2\x1b[0m \\3\x1b[2m\\4\x1b[0m: ", line)
        for line in lines
    ).encode()


def test_what_is_no_line_of_zenoh_is_passed_over_and_the_next_one_counts() -> None:
    odd = "\x1b[2mthread 'rx' panicked: it is unauthorized to say so"
    assert found(log_of(odd, "", *denied("a/b"))) == [("comp.x", "Put", "a/b", 1)]


def test_ends_of_chunks_do_not_matter() -> None:
    log = RefusalLog(clock=lambda: 7.0)
    first, last = denied("a/b")
    log.take_chunk(b"\x1b[2mnoise\x1b[0m\n" + coloured(first))
    log.take_chunk(coloured(last))
    assert found(log) == [("comp.x", "Put", "a/b", 1)]


@pytest.mark.parametrize("line_break", ["\n", "\r", "\r\n", "\v", "\x85", "\u2028"])
@pytest.mark.parametrize("what", ["{}", "\\x1b[2m{}", "[2m{}"])
def test_a_key_with_line_breaks_blames_nobody_else(line_break: str, what: str) -> None:
    """Zenoh writes a key as it is, but for each ESC, which stands as text there: its own lines begin with one."""
    forged = [what.format(line.replace("comp.x", "conf.main").replace(PEER, "0" * 32)) for line in denied("stolen")]
    first, last = denied("a/b")
    log = RefusalLog(clock=lambda: 7.0)
    log.take_chunk(coloured(first) + line_break.join(["", *forged]).encode() + b"\n" + coloured(last))
    ((who, attempt, key, number),) = found(log)
    assert (who, attempt, number) == ("comp.x", "Put", 1)
    assert key.startswith("a/b")


def test_a_key_that_is_worded_like_a_refusal_changes_nothing() -> None:
    key = "a (egress) on b: x on CertCommonName(conf.main) is unauthorized to Put (egress) on c"
    assert found(log_of(*denied(key))) == [("comp.x", "Put", key, 1)]
    assert found(log_of(*denied("a: Msg intercepted!"), *denied("b"))) == [
        ("comp.x", "Put", "a: Msg intercepted!", 1),
        ("comp.x", "Put", "b", 1),
    ]


def test_a_flood_takes_bounded_memory() -> None:
    log = log_of(*(line for number in range(3 * MOST_ATTEMPTS) for line in denied(f"key/{number}")))
    assert len(log.refused) <= 2 * MOST_ATTEMPTS
    assert sum(one.number for one in log.refused) == 3 * MOST_ATTEMPTS
    log = log_of(*(line.replace(PEER, f"{peer:032x}") for peer in range(2 * MOST_ATTEMPTS) for line in denied("x")))
    assert [(one.principal, one.number) for one in log.refused] == [("comp.x", 2 * MOST_ATTEMPTS)]
    assert len(log._names) == MOST_ATTEMPTS
