# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`PreviewFile`: the picture in the making, in a file that a viewer can watch."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import OutputError
from lamplit.report.develop import develop_xyz
from lamplit.report.png import write_png
from lamplit.report.view import View

if TYPE_CHECKING:
    from typing_extensions import Self

    from lamplit.engine import Snapshot

PREVIEW_FILE = "preview.png"
#: A larger picture is shown in blocks of pixels, so that showing it holds up no render.
_MOST_PIXELS = 2**19


class PreviewFile:
    """Writes snapshots to ``preview.png``, whole each time; by `with`, the file goes at the end.

    A preview that cannot be written is given up: the render goes on, and what it writes itself
    says what is wrong.
    """

    def __init__(self, directory: Path) -> None:
        self._path = directory / PREVIEW_FILE
        self._view: View | None = None
        self._is_given_up = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with suppress(OSError):
            self._path.unlink()

    def show(self, snapshot: Snapshot) -> None:
        """Put the picture of ``snapshot`` in the place of the one before."""
        if self._is_given_up:
            return
        if self._view is None:
            self._view = View.of(snapshot.scene)
        developed = develop_xyz(_in_blocks(snapshot.xyz), self._view)
        height, width, _ = snapshot.xyz.shape
        samples = snapshot.samples / (height * width)
        words = {
            "Title": snapshot.scene.name,
            "Comment": f"in the making: {samples:.3g} samples per pixel",
        }
        try:
            write_png(self._path, developed.picture.encoded, developed.display, provenance=words)
        except OutputError:
            self._is_given_up = True


def _in_blocks(xyz: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the means of square blocks of XYZ (H, W, 3), so large that few enough are left."""
    height, width, _ = xyz.shape
    side = int(np.ceil(np.sqrt(height * width / _MOST_PIXELS)))
    side = max(1, min(side, height, width))
    rows, columns = height // side, width // side
    whole = xyz[: rows * side, : columns * side]
    return whole.reshape(rows, side, columns, side, 3).mean(axis=(1, 3))
