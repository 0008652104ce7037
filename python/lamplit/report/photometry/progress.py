# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress of a measurement: paths, their speed, and how certain it is so far."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TextIO

from lamplit.report.progress import Progress, percent

#: From so many on, paths are told in millions.
_LARGE = 1e5


class MeasuringProgress(Progress):
    """A callback ``(done, total)`` of paths that tells paths, how many a second, and the error.

    What is over is a share of whatever ends the work first: ``time_s`` seconds, ``paths`` in all,
    or what the relative error ``error`` will take, judged by the error so far. The ``total`` of a
    round says nothing of it.
    """

    def __init__(
        self,
        title: str,
        stream: TextIO | None = None,
        *,
        time_s: float | None = None,
        paths: int | None = None,
        error: float | None = None,
    ) -> None:
        super().__init__(title, stream, time_s=time_s)
        self._paths, self._aim = paths, error
        self._error = math.inf
        self._done = 0
        self._needed = math.inf

    def __call__(self, done: int, total: int) -> None:
        """Tell that ``done`` paths are over, of ``total`` of this round."""
        self._done = done
        super().__call__(done, total)

    def note(self, relative_error: float) -> None:
        """Remember how large the relative standard error at the bright test points is now."""
        self._error = relative_error
        if self._aim is not None:
            self._needed = self._done * (relative_error / self._aim) ** 2

    def _share(self, done: int, total: int, elapsed_s: float) -> float | None:  # noqa: ARG002
        shares = [0.0 if self._time_s is None else elapsed_s / self._time_s]
        shares += [done / most for most in (self._paths, self._needed) if most]
        share = min(max(shares), 1.0)
        return share if share > 0.0 else None

    def _details(self, done: int, total: int, elapsed_s: float) -> Iterator[str]:  # noqa: ARG002
        most = "" if self._paths is None else f"of {in_words(self._paths)} "
        yield f"{in_words(done)} {most}paths"
        if elapsed_s > 0.0:
            yield f"{in_words(done / elapsed_s)} paths/s"
        if self._error < 10.0:
            yield f"error {percent(self._error)}"


def in_words(count: float) -> str:
    """Return a number of paths to three digits.

    >>> in_words(1792), in_words(154_000), in_words(2_000_000)
    ('1790', '0.154 million', '2 million')
    """
    if count >= _LARGE:
        return f"{float(f'{count / 1e6:.3g}'):g} million"
    return f"{float(f'{count:.3g}'):.0f}"
