# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Progress over many pictures: which frame, how far, and when all of them are done."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TextIO

from lamplit.report.progress import Progress


class ViewsProgress(Progress):
    """Tells how far ``count`` pictures are; `frame` is the callback of `lamplit.render_views`."""

    def __init__(
        self,
        title: str,
        stream: TextIO | None = None,
        *,
        count: int,
        pixels: int,
        time_s: float | None = None,
        first_round: int = 0,
        error: float | None = None,
    ) -> None:
        super().__init__(
            title, stream, pixels=pixels, time_s=time_s, first_round=first_round, error=error
        )
        self._count = count
        self._at = 0
        #: Samples of this frame, and of those before it.
        self._done, self._before = 0, 0

    def frame(self, at: int, done: int, total: int) -> None:
        """Tell that ``done`` of ``total`` samples of frame ``at``, counted from 0, are over."""
        if at != self._at:
            self._before, self._at = self._before + self._done, at
            self._noted = None
        self._done = done
        self(done, total)

    def _share(self, done: int, total: int, elapsed_s: float) -> float | None:
        noted = self._noted
        of_frame = done / max(total, 1) if done >= self._first_round else 0.0
        if noted is not None and noted.done_share is not None:
            of_frame = noted.done_share
        by_time = 0.0 if self._time_s is None else min(elapsed_s / self._time_s, 1.0)
        return max((self._at + of_frame) / self._count, by_time) or None

    def _details(self, done: int, total: int, elapsed_s: float) -> Iterator[str]:
        yield f"frame {min(self._at + 1, self._count)} of {self._count}"
        samples, *_ = super()._details(done, total, elapsed_s)
        yield samples
        if elapsed_s > 0.0:
            yield f"{(self._before + done) / elapsed_s / 1e6:.3g} million paths/s"
        yield from self._certainty()
