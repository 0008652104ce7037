# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress is lively on a terminal and quiet in a log."""

from __future__ import annotations

from io import StringIO

import pytest

from lamplit.report.progress import Progress
from lamplit.report.view_progress import ViewsProgress


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


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Put a clock in place of the machine's, and return what it shows."""
    shown = [0.0]
    monkeypatch.setattr("lamplit.report.progress.time.monotonic", lambda: shown[0])
    return shown


def test_samples_per_pixel_and_paths_per_second_are_told(clock: list[float]) -> None:
    log = StringIO()
    with Progress("Rendering", log, pixels=1000) as progress:
        clock[0] = 20.0
        progress(16_000, 64_000)
    assert "25 % after 20.0 s, 16 of 64 samples per pixel, 0.0008 million paths/s" in log.getvalue()


def test_before_the_first_round_is_over_nobody_foretells_the_end(clock: list[float]) -> None:
    log = StringIO()
    with Progress("Rendering", log, pixels=1000, first_round=16_000) as progress:
        clock[0] = 11.0
        progress(9000, 65_536_000)
        clock[0] = 40.0
        progress(20_000, 80_000)
    first, second = log.getvalue().splitlines()
    assert first.startswith("Rendering: first round after 11.0 s, 9 samples per pixel")
    assert "left" not in first
    assert "25 % after 40.0 s, 20 of 80 samples per pixel" in second
    assert second.endswith("about 2 min 00 s left")


def test_a_time_budget_is_told_as_a_share_of_it(clock: list[float]) -> None:
    log = StringIO()
    with Progress("Rendering", log, pixels=1000, time_s=60.0) as progress:
        clock[0] = 15.0
        progress(3000, 65_536_000)
    assert "25 % after 15.0 s, 3 samples per pixel" in log.getvalue()
    assert "about 45.0 s left" in log.getvalue()


def test_a_terminal_shows_the_details_beside_the_bar() -> None:
    terminal = Terminal()
    with Progress("Rendering", terminal, pixels=10, first_round=20) as progress:
        progress(10, 10_000)
        progress(100, 100)
    assert "10 of 10 samples per pixel" in " ".join(terminal.getvalue().split())


def test_progress_over_frames_tells_which_and_when_all_are_done(clock: list[float]) -> None:
    log = StringIO()
    with ViewsProgress("Rendering", log, count=4, pixels=1000) as progress:
        clock[0] = 10.0
        progress.frame(1, 8_000, 16_000)
        clock[0] = 20.0
        progress.frame(3, 0, 16_000)
    first, second = log.getvalue().splitlines()
    assert first.startswith("Rendering: 37 % after 10.0 s, frame 2 of 4, 8 of 16 samples per pixel")
    assert first.endswith("about 16.7 s left")
    assert second.startswith("Rendering: 75 % after 20.0 s, frame 4 of 4, no sample yet")
    assert second.endswith("about 6.7 s left")


def test_the_error_so_far_and_at_the_end_is_told_and_the_work_counts_not_the_samples(
    clock: list[float],
) -> None:
    """A quarter of the work took 20 s, whatever the samples say, and 5 s more are over: 55 s."""
    log = StringIO()
    with Progress("Rendering", log, pixels=1000, error=0.01) as progress:
        clock[0] = 20.0
        progress.foresee(0.042, done_share=0.25, at_end=0.0123)
        clock[0] = 25.0
        progress(60_000, 80_000)
    line = log.getvalue()
    assert "error 4.2 % (about 1.2 % at the end, 1 % is asked)" in line
    assert line.startswith("Rendering: 31 % after 25.0 s, 60 of 80 samples per pixel")
    assert line.rstrip().endswith("about 55.0 s left")


def test_in_the_first_round_the_way_to_the_target_is_that_of_one_over_root_n(
    clock: list[float],
) -> None:
    """4 % after 10 s is 2 % after 40 s."""
    log = StringIO()
    with Progress("Rendering", log, pixels=1000, first_round=16_000, error=0.02) as progress:
        clock[0] = 10.0
        progress.foresee(0.04)
        progress(8_000, 65_536_000)
    assert "25 % after 10.0 s" in log.getvalue()
    assert "error 4 % (2 % is asked), about 30.0 s left" in log.getvalue()


def test_an_error_that_is_not_known_yet_is_not_told(clock: list[float]) -> None:
    log = StringIO()
    with Progress("Rendering", log, pixels=1000, error=0.02, first_round=16_000) as progress:
        clock[0] = 11.0
        progress.foresee(float("inf"))
        progress(1_000, 65_536_000)
    assert "error" not in log.getvalue()
    assert "left" not in log.getvalue()


def test_the_time_to_set_the_scene_up_is_not_taken_for_work(clock: list[float]) -> None:
    log = StringIO()
    with Progress("Rendering", log) as progress:
        clock[0] = 5.0
        progress(0, 4)
        clock[0] = 50.0
        progress(0, 4)
        clock[0] = 60.0
        progress(1, 4)
    assert "25 % after 1 min 00 s, about 30.0 s left" in log.getvalue()


def test_a_budget_of_time_runs_from_the_first_call_on(clock: list[float]) -> None:
    log = StringIO()
    with Progress("Rendering", log, time_s=40.0) as progress:
        for clock[0] in (5.0, 15.0):
            progress(0, 4)
    assert "25 % after 15.0 s, about 30.0 s left" in log.getvalue()


def test_each_frame_has_an_error_of_its_own(clock: list[float]) -> None:
    log = StringIO()
    with ViewsProgress("Rendering", log, count=2, pixels=1000) as progress:
        clock[0] = 10.0
        progress.foresee(0.05, done_share=0.5, at_end=0.03)
        progress.frame(0, 2_000, 16_000)
        clock[0] = 30.0
        progress.frame(1, 8_000, 16_000)
    first, second = log.getvalue().splitlines()
    assert first.startswith("Rendering: 25 % after 10.0 s, frame 1 of 2")
    assert "error 5 % (about 3 % at the end)" in first
    assert "error" not in second
