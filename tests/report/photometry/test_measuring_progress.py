# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a measurement says of its own progress is a share of what will end it."""

from __future__ import annotations

import time
from io import StringIO
from typing import Any

import pytest

from lamplit.report.photometry.progress import MeasuringProgress


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    return now


def told(clock: list[float], at_s: float, done: int, total: int, **settings: Any) -> str:
    log = StringIO()
    with MeasuringProgress("Measuring", log, **settings) as progress:
        if (noted := settings.get("error")) is not None:
            progress._done = done // 4
            progress.note(4.0 * noted)
        clock[0] = at_s
        progress(done, total)
    return log.getvalue()


def test_a_full_round_is_not_the_end_of_a_time_budget(clock: list[float]) -> None:
    line = told(clock, 15.0, 65_000, 65_536, time_s=60.0)
    assert "25 % after 15.0 s, 65000 paths, 4330 paths/s" in line
    assert "about 45.0 s left" in line


def test_paths_are_told_as_a_share_of_all_that_are_wanted(clock: list[float]) -> None:
    line = told(clock, 20.0, 500_000, 65_536, paths=2_000_000)
    assert "25 % after 20.0 s, 0.5 million of 2 million paths" in line


def test_an_aim_is_judged_by_the_error_so_far(clock: list[float]) -> None:
    # A quarter of the paths had four times the error: 16 times that quarter, 4 of now, are needed.
    line = told(clock, 30.0, 40_000, 40_000, error=0.01)
    assert "25 % after 30.0 s" in line
    assert "error 4 %" in line


def test_an_error_above_all_is_told_in_plain_percent(clock: list[float]) -> None:
    log = StringIO()
    with MeasuringProgress("Measuring", log, time_s=20.0) as progress:
        progress.note(1.04)
        clock[0] = 10.0
        progress(10, 10)
    assert "error 104 %" in log.getvalue()
