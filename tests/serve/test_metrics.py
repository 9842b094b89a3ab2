"""The metrics are in the text format of Prometheus."""

from __future__ import annotations

import re

from selfconf.protocol.messages import Cause
from selfconf.serve.metrics import Metrics

LINE = re.compile(r'# (HELP|TYPE) \w+ .+|\w+(\{(\w+="(\\.|[^"\\])*",?)*\})? -?[\d.e+]+')


def test_what_was_counted_is_told_in_lines_that_prometheus_reads() -> None:
    metrics = Metrics()
    metrics.queried("200", 0.5)
    metrics.queried("200", 0.25)
    metrics.happened("lost", "crash", 1.0)
    metrics.happened("lost", "what a stranger has made up", 1.0)
    metrics.happened("running", "", 1.0)
    text = metrics.text({"selfconf_up": [({"of": 'a "quoted"\nlabel'}, 1.0)]})
    assert all(LINE.fullmatch(line) for line in text.splitlines())
    assert 'selfconf_queries_total{status="200"} 2' in text
    assert "selfconf_query_seconds_total 0.75" in text
    assert 'selfconf_component_losses_total{cause="crash"} 1' in text
    assert 'selfconf_component_losses_total{cause="other"} 1' in text
    assert r'selfconf_up{of="a \"quoted\"\nlabel"} 1' in text
    assert "selfconf_configurations_total 1" in text


def test_each_cause_of_a_loss_is_told_before_the_first_as_growth_is_counted_from_there() -> None:
    text, told = Metrics().text({}), (*(cause.value for cause in Cause), "other")
    assert all(f'selfconf_component_losses_total{{cause="{cause}"}} 0\n' in text for cause in told)


def test_a_counter_is_told_to_the_last_one_however_far_it_has_come() -> None:
    metrics = Metrics()
    metrics.changes = 12_345_678
    assert "selfconf_changes_total 12345678\n" in metrics.text({})


def test_what_happened_before_the_server_began_is_not_counted() -> None:
    metrics = Metrics(100.0)
    for moment in (99.0, 100.0):
        metrics.happened("lost", "crash", moment)
        metrics.happened("running", "", moment)
    assert 'selfconf_component_losses_total{cause="crash"} 1\n' in metrics.text({})
    assert "selfconf_configurations_total 1\n" in metrics.text({})
