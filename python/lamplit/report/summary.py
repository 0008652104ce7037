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

Array = NDArray[np.float64]

_PERCENTILES = (0, 1, 5, 25, 50, 75, 95, 99, 100)


def summary(image: Image, developed: Developed) -> dict[str, Any]:
    """Return what ``image`` shows and how it came about, as plain JSON values.

    Luminances are in cd/m². The standard error of the mean takes pixels as independent; like the
    relative error, it is None where a pixel has a single sample, which has no error that could be
    known.
    """
    shown = picture_numbers(image.xyz, image.xyz_standard_error, developed)
    return {
        "lamplit_summary": 1,
        **provenance(image),
        **shown,
        "relative_error_rms": _known(image.relative_error),
        "samples_per_pixel": {
            "fewest": int(image.samples_per_pixel.min()),
            "mean": float(image.samples_per_pixel.mean()),
            "most": int(image.samples_per_pixel.max()),
        },
        "light_groups": list(image.layers),
        "ledger": None if image.ledger is None else image.ledger.as_json(),
        "losses": Losses.of(image).as_json(),
        "notices": list(image.notices),
        "statistics": dict(image.statistics),
        "speed": speed(image),
        "elapsed_s": float(image.elapsed_s),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "machine": platform.machine(),
    }


def picture_numbers(xyz: Array, standard_error: Array, developed: Developed) -> dict[str, Any]:
    """Return what XYZ (H, W, 3), in cd/m², show on their display, as plain JSON values."""
    settings = developed.view.settings
    good = np.isfinite(xyz).all(axis=-1)
    luminance = xyz[..., 1][good]
    mean_xyz = xyz[good].mean(axis=0) if good.any() else np.zeros(3)
    error = standard_error[..., 1][good]
    return {
        "width": xyz.shape[1],
        "height": xyz.shape[0],
        "luminance_cd_m2": {
            "mean": float(mean_xyz[1]),
            "mean_standard_error": _known(np.sqrt(np.square(error).sum()) / max(error.size, 1)),
            "percentiles": percentiles(luminance, _PERCENTILES),
        },
        "chromaticity_xy_of_mean": chromaticity(mean_xyz),
        "display": {
            "label": developed.display_label,
            "space": described(settings.space),
            "white_luminance_cd_m2": float(developed.white_luminance_cd_m2),
            "brightest_luminance_cd_m2": developed.exposure.brightest_luminance_cd_m2,
            "tone": settings.tone,
            "adaptation": settings.adaptation,
            "gamut": settings.gamut,
            "out_of_gamut_share": float(developed.picture.gamut_share),
            "over_white_share": float(developed.picture.over_white_share),
        },
        "not_finite_pixels": int(good.size - good.sum()),
        "negative_luminance_pixels": int((luminance < 0).sum()),
    }


def speed(image: Image) -> dict[str, float | None]:
    """Return rays (segments of walks and towards lights) and walks from the eye per second."""
    seconds = float(image.statistics.get("trace_s", 0.0))
    walks = int(image.samples_per_pixel.sum())
    counts = {"rays_per_s": Losses.of(image).segments, "paths_per_s": walks}
    return {name: count / seconds if seconds > 0.0 else None for name, count in counts.items()}


def _known(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


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
