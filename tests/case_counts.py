"""How many cases of each kind of property test ran, added up over all test processes.

A test calls :func:`count_case` once at the end of each case, with one of :data:`KINDS`; in a
``RuleBasedStateMachine`` that is in ``teardown``. The run ends with a line such as::

    cases: state machine 2000, random scenes 2000, one number by every route 2000

The cases that Hypothesis draws while it shrinks a failure count as well. This module is a plugin
of pytest, which ``conftest.py`` loads.
"""

from __future__ import annotations

from collections import Counter

import pytest
from _pytest.terminal import TerminalReporter

#: The kinds of cases, in the order in which they are printed.
KINDS = ("state machine", "random scenes", "one number by every route")
PROPERTY = "cases"  #: Name of the counts among the user properties of a report.

_counts: Counter[str] = Counter()


def count_case(kind: str) -> None:
    """Count one case of a kind that has passed."""
    assert kind in KINDS, f"kind is {kind!r}; expected one of {KINDS}"
    _counts[kind] += 1


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item) -> None:
    """Give the counts to the report of the test, which workers send to the main process."""
    if _counts:
        item.user_properties.append((PROPERTY, dict(_counts)))
        _counts.clear()


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Print how many cases of each kind ran."""
    total: Counter[str] = Counter()
    for reports in terminalreporter.stats.values():
        for report in reports:
            for name, counts in getattr(report, "user_properties", ()):
                if name == PROPERTY:
                    total.update(counts)
    if total:
        parts = [f"{kind} {total[kind]}" for kind in KINDS]
        terminalreporter.write_line(f"cases: {', '.join(parts)}")
