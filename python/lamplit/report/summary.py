# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The numbers of a picture, ready for JSON and for the table at the end of a render."""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit.report.losses import Losses
from lamplit.report.provenance import described, provenance

if TYPE_CHECKING:
    from lamplit.engine.image import Image
    from lamplit.report.develop import Developed

_PERCENTILES = (0, 1, 5, 25, 50, 75, 95, 99, 100)


def summary(image: Image, developed: Developed) -> dict[str, Any]:
    """Return what ``image`` shows and how it came about, as plain JSON values.

    Luminances are in cd/m². The standard error of the mean takes pixels as independent; it is None
    where a pixel has a single sample, which has no error that could be known.
    """
    height, width = image.height, image.width
    good = np.isfinite(image.xyz).all(axis=-1)
    mean_xyz = image.xyz[good].mean(axis=0) if good.any() else np.zeros(3)
    error = image.xyz_standard_error[..., 1][good]
    mean_error = float(np.sqrt(np.square(error).sum()) / max(error.size, 1))
    return {
        "lamplit_summary": 1,
        **provenance(image),
        "width": width,
        "height": height,
        "luminance_cd_m2": {
            "mean": float(mean_xyz[1]),
            "mean_standard_error": mean_error if np.isfinite(mean_error) else None,
            "percentiles": percentiles(image.luminance_cd_m2[good], _PERCENTILES),
        },
        "chromaticity_xy_of_mean": chromaticity(mean_xyz),
        "display": {
            "space": described(image.scene.display.space),
            "label": developed.display_label,
            "white_luminance_cd_m2": float(developed.white_luminance_cd_m2),
            "adaptation": image.scene.display.adaptation,
            "gamut": image.scene.display.gamut,
            "out_of_gamut_share": float(developed.picture.gamut_share),
            "over_white_share": float(developed.picture.over_white_share),
        },
        "not_finite_pixels": int(good.size - good.sum()),
        "negative_luminance_pixels": int((image.luminance_cd_m2[good] < 0).sum()),
        "losses": Losses.of(image).as_json(),
        "statistics": dict(image.statistics),
        "elapsed_s": float(image.elapsed_s),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "machine": platform.machine(),
    }


def percentiles(values: NDArray[np.float64], shares: tuple[float, ...]) -> dict[str, float]:
    """Return the percentiles of ``values`` keyed by share in %, linearly interpolated."""
    if values.size == 0:
        return {}
    found = np.percentile(values, shares)
    return {f"{share:g}": float(value) for share, value in zip(shares, found, strict=True)}


def chromaticity(xyz: NDArray[np.float64]) -> tuple[float, float] | None:
    """Return (x, y) of one XYZ, or None for black, which has none."""
    total = float(xyz.sum())
    return (float(xyz[0]) / total, float(xyz[1]) / total) if total > 0 else None
