# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress that is lively on a terminal and quiet in a log."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID
    from typing_extensions import Self

_FRAME_S = 0.1
_QUIET_S = 10.0
_QUIET_STEPS = 10


class Progress:
    """A callback ``(done, total)`` for `lamplit.engine.render` that tells how far it is.

    On a terminal it draws a bar with the time left, at most ten times a second. Elsewhere it
    writes a line per tenth of the work, and one at least every ten seconds.
    """

    def __init__(self, title: str, stream: TextIO | None = None) -> None:
        self.title = title
        self.stream = sys.stderr if stream is None else stream
        self._bar: Bar | None = None
        self._task: TaskID | None = None
        self._started = time.monotonic()
        self._last_time = self._started
        self._last_step = 0

    def __enter__(self) -> Self:
        if self.stream.isatty():
            self._bar = _terminal_bar(self.stream)
            self._task = self._bar.add_task(self.title, total=None)
            self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.refresh()
            self._bar.stop()

    def __call__(self, done: int, total: int) -> None:
        """Tell that ``done`` of ``total`` pieces of work are over."""
        now = time.monotonic()
        if self._bar is not None and self._task is not None:
            self._bar.update(self._task, completed=done, total=total)
            if now - self._last_time >= _FRAME_S or done >= total:
                self._last_time = now
                self._bar.refresh()
            return
        step = done * _QUIET_STEPS // max(total, 1)
        if step > self._last_step or now - self._last_time >= _QUIET_S:
            self._last_time, self._last_step = now, step
            print(self._line(done, total, now - self._started), file=self.stream, flush=True)

    def _line(self, done: int, total: int, elapsed_s: float) -> str:
        percent = 100 * done // max(total, 1)
        line = f"{self.title}: {percent} % after {_duration(elapsed_s)}"
        if 0 < done < total:
            line += f", about {_duration(elapsed_s * (total - done) / done)} left"
        return line


def _terminal_bar(stream: TextIO) -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    return Bar(
        TextColumn("{task.description}"),
        BarColumn(bar_width=None, complete_style="red", finished_style="bright_red"),
        TaskProgressColumn(),
        TimeRemainingColumn(compact=True, elapsed_when_finished=True),
        console=Console(file=stream),
        auto_refresh=False,
    )


def _duration(seconds: float) -> str:
    """Return seconds in words a log can carry.

    >>> _duration(4.26), _duration(75), _duration(7260)
    ('4.3 s', '1 min 15 s', '2 h 01 min')
    """
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest:02d} s"
    return f"{minutes // 60} h {minutes % 60:02d} min"
