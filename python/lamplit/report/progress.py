# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress that is lively on a terminal and quiet in a log."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from types import TracebackType
from typing import TYPE_CHECKING, TextIO

from lamplit.printable import printable

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
    writes a line per tenth of the work, and one at least every ten seconds. With ``pixels`` it
    also tells samples per pixel and paths per second. ``time_s`` is a budget of seconds, of which
    the work is then told as a share; how many of the samples come in it, nobody knows. Neither is
    the total known before ``first_round`` samples are done.
    """

    def __init__(
        self,
        title: str,
        stream: TextIO | None = None,
        *,
        pixels: int | None = None,
        time_s: float | None = None,
        first_round: int = 0,
    ) -> None:
        self.title = printable(title)
        self.stream = sys.stderr if stream is None else stream
        self._pixels = pixels
        self._time_s = time_s
        self._first_round = first_round
        self._bar: Bar | None = None
        self._task: TaskID | None = None
        self._started = time.monotonic()
        self._last_time = self._started
        self._last_step = 0

    def __enter__(self) -> Self:
        if self.stream.isatty():
            self._bar = _terminal_bar(self.stream)
            self._task = self._bar.add_task(self.title, total=None, detail="")
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
        elapsed_s = now - self._started
        share = self._share(done, total, elapsed_s)
        if self._bar is not None and self._task is not None:
            detail = ", ".join(self._details(done, total, elapsed_s))
            known = None if share is None else 1.0
            self._bar.update(self._task, completed=share or 0.0, total=known, detail=detail)
            if now - self._last_time >= _FRAME_S or done >= total:
                self._last_time = now
                self._bar.refresh()
            return
        step = int((share or 0.0) * _QUIET_STEPS)
        if step > self._last_step or now - self._last_time >= _QUIET_S:
            self._last_time, self._last_step = now, step
            print(self._line(done, total, elapsed_s), file=self.stream, flush=True)

    def _share(self, done: int, total: int, elapsed_s: float) -> float | None:
        """Return how much of the work is over, or None while that is not known."""
        by_time = 0.0 if self._time_s is None else min(elapsed_s / self._time_s, 1.0)
        if done < self._first_round:
            return by_time or None
        return max(done / max(total, 1), by_time)

    def _details(self, done: int, total: int, elapsed_s: float) -> Iterator[str]:
        if self._pixels is None:
            return
        samples = f"{done / self._pixels:.3g}"
        if self._time_s is None and done >= self._first_round:
            samples += f" of {total / self._pixels:.3g}"
        yield f"{samples} samples per pixel"
        if elapsed_s > 0.0:
            yield f"{done / elapsed_s / 1e6:.3g} million paths/s"

    def _line(self, done: int, total: int, elapsed_s: float) -> str:
        share = self._share(done, total, elapsed_s)
        percent = "first round" if share is None else f"{int(100 * share)} %"
        words = [f"{self.title}: {percent} after {_duration(elapsed_s)}"]
        words += self._details(done, total, elapsed_s)
        if share is not None and 0.0 < share < 1.0:
            words.append(f"about {_duration(elapsed_s * (1.0 - share) / share)} left")
        return ", ".join(words)


def _terminal_bar(stream: TextIO) -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    return Bar(
        TextColumn("{task.description}"),
        BarColumn(bar_width=None, complete_style="red", finished_style="bright_red"),
        TaskProgressColumn(),
        TimeRemainingColumn(compact=True, elapsed_when_finished=True),
        TextColumn("{task.fields[detail]}"),
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
