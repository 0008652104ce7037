# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress that is lively on a terminal and quiet in a log."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from types import TracebackType
from typing import TYPE_CHECKING, NamedTuple, TextIO

from lamplit.printable import printable
from lamplit.report.terminal_bar import terminal_bar

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID
    from typing_extensions import Self

_FRAME_S = 0.1
_QUIET_S = 10.0
_QUIET_STEPS = 10
#: A larger relative error says nothing but that it is early.
_WORTH_TELLING = 10.0


class Progress:
    """A callback ``(done, total)`` for `lamplit.engine.render` that tells how far it is.

    On a terminal it draws a bar with the time left, at most ten times a second. Elsewhere it
    writes a line per tenth of the work, and one at least every ten seconds. With ``pixels`` it
    also tells samples per pixel and paths per second, and after `foresee` the error so far.
    ``time_s`` is a budget of seconds, of which the work is then told as a share; how many of the
    samples come in it, nobody knows. Neither is the total known before ``first_round`` samples are
    done: until then the way to ``error`` is judged by the error so far.
    """

    def __init__(
        self,
        title: str,
        stream: TextIO | None = None,
        *,
        pixels: int | None = None,
        time_s: float | None = None,
        first_round: int = 0,
        error: float | None = None,
    ) -> None:
        self.title = printable(title)
        self.stream = sys.stderr if stream is None else stream
        self._pixels = pixels
        self._time_s = time_s
        self._first_round = first_round
        self._aim = error
        self._noted: _Noted | None = None
        self._bar: Bar | None = None
        self._task: TaskID | None = None
        self._started = self._began = time.monotonic()
        self._last_time = self._started
        self._last_step = 0
        self._is_begun = False

    def __enter__(self) -> Self:
        if self.stream.isatty():
            self._bar = terminal_bar(self.stream)
            self._task = self._bar.add_task(self.title, total=None, detail="", left="")
            self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None and self._task is not None:
            self._bar.update(self._task, left="")
            self._bar.refresh()
            self._bar.stop()

    def foresee(
        self, error: float, *, done_share: float | None = None, at_end: float | None = None
    ) -> None:
        """Remember the relative error so far, and what is known of the end.

        ``done_share`` is how much of the work is done, ``at_end`` the relative error to come.
        """
        worked_s = time.monotonic() - self._began
        self._noted = _Noted(error, at_end, worked_s, done_share)

    def __call__(self, done: int, total: int) -> None:
        """Tell that ``done`` of ``total`` pieces of work are over.

        What comes before the first piece is no work, by which the rest could be foretold; a budget
        of time runs from the first call on.
        """
        now = time.monotonic()
        if done == 0 and not self._is_begun:
            self._began = now
        self._is_begun = self._is_begun or done > 0 or self._time_s is not None
        worked_s = now - self._began
        share = self._share(done, total, worked_s)
        if self._bar is not None and self._task is not None:
            self._bar.update(
                self._task,
                completed=share or 0.0,
                total=None if share is None else 1.0,
                detail=", ".join(self._details(done, total, worked_s)),
                left=_left(share, worked_s),
            )
            if now - self._last_time >= _FRAME_S or done >= total:
                self._last_time = now
                self._bar.refresh()
            return
        step = int((share or 0.0) * _QUIET_STEPS)
        if step > self._last_step or now - self._last_time >= _QUIET_S:
            self._last_time, self._last_step = now, step
            print(self._line(done, total, worked_s), file=self.stream, flush=True)

    def _share(self, done: int, total: int, elapsed_s: float) -> float | None:
        """Return how much of the work is over, or None while that is not known."""
        by_time = 0.0 if self._time_s is None else min(elapsed_s / self._time_s, 1.0)
        noted = self._noted
        if noted is not None and noted.done_share:
            # Since then the work went on as fast as before.
            return max(min(noted.done_share * elapsed_s / noted.worked_s, 1.0), by_time)
        if done >= self._first_round:
            return max(done / max(total, 1), by_time)
        if noted is not None and self._aim is not None and noted.error > self._aim:
            return max((self._aim / noted.error) ** 2 * elapsed_s / noted.worked_s, by_time)
        return by_time or None

    def _details(self, done: int, total: int, elapsed_s: float) -> Iterator[str]:
        if self._pixels is None:
            return
        if done == 0:
            yield "no sample yet"
            return
        samples = f"{done / self._pixels:.3g}"
        if self._time_s is None and done >= self._first_round:
            samples += f" of {total / self._pixels:.3g}"
        yield f"{samples} samples per pixel"
        if elapsed_s > 0.0:
            yield f"{done / elapsed_s / 1e6:.3g} million paths/s"
        yield from self._certainty()

    def _certainty(self) -> Iterator[str]:
        if self._noted is not None and self._noted.error < _WORTH_TELLING:
            yield self._noted.in_words(self._aim)

    def _line(self, done: int, total: int, worked_s: float) -> str:
        share = self._share(done, total, worked_s)
        percent = "first round" if share is None else f"{int(100 * share)} %"
        words = [f"{self.title}: {percent} after {duration(time.monotonic() - self._started)}"]
        words += self._details(done, total, worked_s)
        if left := _left(share, worked_s):
            words.append(left)
        return ", ".join(words)


class _Noted(NamedTuple):
    """How certain a picture was ``worked_s`` seconds after the work began."""

    error: float
    at_end: float | None
    worked_s: float
    done_share: float | None

    def in_words(self, aim: float | None) -> str:
        """Return the error, what it will be, and what it is to be."""
        more = [] if self.at_end is None else [f"about {percent(self.at_end)} at the end"]
        more += [] if aim is None else [f"{percent(aim)} is asked"]
        return f"error {percent(self.error)}" + (f" ({', '.join(more)})" if more else "")


def _left(share: float | None, worked_s: float) -> str:
    if share is None or not 0.0 < share < 1.0:
        return ""
    return f"about {duration(worked_s * (1.0 - share) / share)} left"


def percent(share: float) -> str:
    """Return a relative error in percent, two digits of it.

    >>> percent(1.04), percent(0.0123)
    ('104 %', '1.2 %')
    """
    return f"{100.0 * share:.0f} %" if share >= 0.0995 else f"{100.0 * share:.2g} %"


def duration(seconds: float) -> str:
    """Return seconds in words a log can carry.

    >>> duration(4.26), duration(75), duration(7260)
    ('4.3 s', '1 min 15 s', '2 h 01 min')
    """
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest:02d} s"
    return f"{minutes // 60} h {minutes % 60:02d} min"
