# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress is lively on a terminal and quiet in a log."""

from __future__ import annotations

from io import StringIO

import pytest

from lamplit.report.progress import Progress


class Terminal(StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        """Return True."""
        return True


def test_a_log_gets_a_line_per_tenth_of_the_work() -> None:
    log = StringIO()
    with Progress("Rendering", log) as progress:
        for done in range(1, 1001):
            progress(done, 1000)
    lines = log.getvalue().splitlines()
    assert len(lines) == 10
    assert lines[4].startswith("Rendering: 50 % after")
    assert "\x1b" not in log.getvalue()


def test_slow_work_is_heard_of_every_ten_seconds(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    monkeypatch.setattr("lamplit.report.progress.time.monotonic", lambda: clock[0])
    log = StringIO()
    with Progress("Rendering", log) as progress:
        for second in range(1, 36):
            clock[0] = float(second)
            progress(second, 100_000)
    assert len(log.getvalue().splitlines()) == 3


def test_the_time_left_is_told_in_proportion(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    monkeypatch.setattr("lamplit.report.progress.time.monotonic", lambda: clock[0])
    log = StringIO()
    with Progress("Rendering", log) as progress:
        clock[0] = 30.0
        progress(1, 4)
    assert "about 1 min 30 s left" in log.getvalue()


def test_a_terminal_gets_a_bar() -> None:
    terminal = Terminal()
    with Progress("Rendering", terminal) as progress:
        for done in range(11):
            progress(done, 10)
    assert "100%" in terminal.getvalue()
