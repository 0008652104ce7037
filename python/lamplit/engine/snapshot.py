# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Snapshot`: a picture in the making."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from lamplit.engine.image import Array, relative_error
from lamplit.scene import Scene


@dataclass(frozen=True, eq=False)
class Snapshot:
    """What a picture of H rows by W columns shows before all its samples are taken."""

    scene: Scene
    #: Tristimulus values X, Y, Z, (H, W, 3), in cd/m².
    xyz: Array
    #: Their standard errors (1σ); infinite below two samples.
    xyz_standard_error: Array
    #: How many samples there are, over all pixels.
    samples: int
    #: The share of the work that is done, and what each pixel's standard error will be multiplied
    #: with, (H, W); None while it is not known how many samples the pixels will have.
    outlook: tuple[float, Array] | None = None

    @cached_property
    def relative_error(self) -> float:
        """The `Image.relative_error` so far; infinite where a pixel has fewer than two samples."""
        return relative_error(self.xyz, self.xyz_standard_error)

    @property
    def done_share(self) -> float | None:
        """How much of the work is done, as far as that is known."""
        return None if self.outlook is None else self.outlook[0]

    @cached_property
    def relative_error_at_end(self) -> float | None:
        """What the relative error will be by the law 1/√n, as far as that is known."""
        if self.outlook is None:
            return None
        return relative_error(self.xyz, self.xyz_standard_error * self.outlook[1][..., None])


#: Called with the picture in the making every two seconds, or less often where that takes long.
PreviewCallback: TypeAlias = Callable[[Snapshot], object]
