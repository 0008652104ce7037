# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress of a measurement: paths, their speed, and how certain it is so far."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TextIO

from lamplit.report.progress import Progress


class MeasuringProgress(Progress):
    """A callback ``(done, total)`` of paths that tells millions of paths, per second, and error."""

    def __init__(
        self, title: str, stream: TextIO | None = None, *, time_s: float | None = None
    ) -> None:
        super().__init__(title, stream, time_s=time_s)
        self._error = float("inf")

    def note(self, relative_error: float) -> None:
        """Remember how large the relative standard error at the bright test points is now."""
        self._error = relative_error

    def _details(self, done: int, total: int, elapsed_s: float) -> Iterator[str]:
        paths = f"{done / 1e6:.3g}"
        if self._time_s is None:
            paths += f" of {total / 1e6:.3g}"
        yield f"{paths} million paths"
        if elapsed_s > 0.0:
            yield f"{done / elapsed_s / 1e6:.3g} million paths/s"
        if self._error < 10.0:
            yield f"error {100.0 * self._error:.2g} %"
