# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A dark sheet on which things stand by pixels from the top left corner."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.text import Text

Array = NDArray[np.float64]

PAGE, TEXT, QUIET, FAINT = "#151515", "#ececec", "#9b9b9b", "#3a3a3a"
#: The one family that comes with matplotlib, so that a page looks the same everywhere.
FONT = "DejaVu Sans"
_DPI = 100


class Sheet:
    """A page of ``width`` by ``height`` pixels; ``unit`` multiplies text and line widths."""

    def __init__(self, width: float, height: float, *, unit: float) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.width, self.height, self.unit = round(width), round(height), unit
        size = (self.width / _DPI, self.height / _DPI)
        self.figure = Figure(figsize=size, dpi=_DPI, facecolor=PAGE)
        FigureCanvasAgg(self.figure)

    def axes(self, left: float, top: float, width: float, height: float) -> Axes:
        """Return new axes at a place in pixels."""
        bottom = self.height - top - height
        return self.figure.add_axes(
            (left / self.width, bottom / self.height, width / self.width, height / self.height)
        )

    def write(
        self,
        left: float,
        baseline: float,
        text: str,
        points: float,
        *,
        ink: str = TEXT,
        bold: bool = False,
        align: str = "left",
    ) -> Text:
        """Write one line; ``align`` says which end of it stands at ``left``."""
        return self.figure.text(
            left / self.width,
            1.0 - baseline / self.height,
            " ".join(text.split()),
            color=ink,
            ha=align,
            va="baseline",
            fontsize=points * self.unit,
            fontweight="bold" if bold else "normal",
            family=FONT,
            parse_math=False,
        )

    def title(self, left: float, top: float, name: str, explanation: str) -> None:
        """Write the heading of the part of the page that begins at ``top``."""
        baseline = top - 14 * self.unit
        written = self.write(left, baseline, name, 15, bold=True)
        end = written.get_window_extent().x1 + 12 * self.unit
        self.write(end, baseline, explanation, 10.5, ink=QUIET)

    def pixels(self) -> Array:
        """Return the sheet as display values (rows, columns, 3) in [0, 1]."""
        canvas: Any = self.figure.canvas
        canvas.draw()
        return np.asarray(canvas.buffer_rgba(), dtype=np.float64)[..., :3] / 255.0


def show_pixels(axes: Axes, encoded: Array, size: tuple[int, int]) -> None:
    """Show display values on axes of ``size`` pixels: as they are, magnified, or averaged.

    The axes count picture pixels, from the top left.
    """
    from PIL import Image as Raster

    codes = np.rint(encoded * 255.0).astype(np.uint8)
    if codes.shape[1::-1] != size:
        shrinks = size[0] < codes.shape[1]
        method = Raster.Resampling.LANCZOS if shrinks else Raster.Resampling.NEAREST
        codes = np.asarray(Raster.fromarray(codes).resize(size, method))
    height, width = encoded.shape[:2]
    axes.imshow(codes, interpolation="nearest", extent=(0, width, height, 0), aspect="auto")
    axes.set_axis_off()
