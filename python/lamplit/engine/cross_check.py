# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`cross_check`: the same candela both ways, from the light and from the eye of the receiver."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.looking import Looking, eye_method
from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from lamplit.engine.eye_reading import EyeReading
    from lamplit.engine.measurement import Lit, Measurement

Array = NDArray[np.float64]

#: Where nothing is said: so many spots, and so many looks from each.
_SPOTS, _LOOKS = 3, 1 << 20
#: How often the largest of all differences may be called one by chance.
_ALPHA = 0.01


@dataclass(frozen=True, eq=False)
class CrossCheck:
    """Luminous intensities at spots by both ways, p of them, with one standard error each."""

    spot_h_deg: Array
    spot_v_deg: Array
    #: (p,), in cd, walked from the light.
    light_cd: Array
    light_standard_error_cd: Array
    #: (p,), in cd, walked from the eye.
    eye_cd: Array
    eye_standard_error_cd: Array

    @property
    def sigmas(self) -> Array:
        """How many standard errors both are apart, (p,); 0 where they are equal."""
        off = self.light_cd - self.eye_cd
        sigma = np.hypot(self.light_standard_error_cd, self.eye_standard_error_cd)
        return np.divide(off, sigma, out=np.zeros_like(off), where=off != 0.0)

    @property
    def allowed(self) -> float:
        """How many standard errors the largest of p differences exceeds by chance in 1 of 100."""
        each = 1.0 - (1.0 - _ALPHA) ** (1.0 / max(1, self.light_cd.size))
        return NormalDist().inv_cdf(1.0 - each / 2.0)


def cross_check(
    measurement: Measurement,
    lit: Lit = None,
    *,
    spots: NDArray[np.intp] | list[int] | None = None,
    looks: int | None = None,
) -> CrossCheck:
    """Return both intensities of ``spots``, by their numbers.

    What the measurement read by the eye is compared as it is. With ``looks``, or where it read
    nothing, the eye of each spot takes so many anew (None: a million, of the brightest three).

    Raises:
        LamplitError: There is no spot, the light was not the scene's own, or an eye cannot see it.
    """
    if measurement.light is not None:
        raise LamplitError("only what shines in the scene can be seen by an eye; leave light out")
    seen = measurement.observed(lit, by="light")
    if seen.spot_cd.size == 0:
        raise LamplitError("there are no spots to check; measure some")
    if measurement.eye is not None and looks is None:
        looked = np.flatnonzero(measurement.eye.looks > 0)
        chosen = looked if spots is None else np.asarray(spots, dtype=np.intp)
        xyz, covariance = (
            part[chosen] for part in measurement.eye.observed(measurement.weights(lit))
        )
    else:
        brightest = np.argsort(seen.spot_cd)[::-1][:_SPOTS]
        chosen = np.sort(brightest) if spots is None else np.asarray(spots, dtype=np.intp)
        reading = _look_again(measurement, chosen, looks or _LOOKS)
        xyz, covariance = reading.observed(measurement.weights(lit))
    return CrossCheck(
        seen.spot_h_deg[chosen],
        seen.spot_v_deg[chosen],
        seen.spot_cd[chosen],
        seen.spot_standard_error_cd[chosen],
        xyz[:, 1],
        np.sqrt(covariance[:, 1, 1]),
    )


def _look_again(measurement: Measurement, spots: NDArray[np.intp], looks: int) -> EyeReading:
    from lamplit.engine.measure import in_laboratory

    scene = measurement.scene
    carrier = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
    looking = Looking(
        assemble(in_laboratory(scene), carrier),
        measurement.goniometer,
        eye_method(scene),
        groups=len(measurement.groups),
        # Other looks than those of the measurement.
        seed=measurement.seed + 1,
        threads=measurement.threads,
        spots=spots,
    )
    if looking.until(looks * len(spots)):
        raise KeyboardInterrupt
    return looking.reading()
