# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`cross_check`: the same candela both ways, from the light and from the eye of the receiver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.looking import Looking, check_visible, eye_method
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
    #: How many independent batches and repetitions the standard errors come from.
    light_batches: int
    eye_repetitions: int

    @property
    def sigmas(self) -> Array:
        """How many standard errors both are apart, (p,); 0 where they are equal."""
        off = self.light_cd - self.eye_cd
        sigma = np.hypot(self.light_standard_error_cd, self.eye_standard_error_cd)
        return np.divide(off, sigma, out=np.zeros_like(off), where=off != 0.0)

    @property
    def allowed(self) -> Array:
        """How many standard errors chance lets both be apart, (p,): any of them in 1 of 100 checks.

        By Student's t, since σ comes from few batches, with the degrees of freedom of Welch and
        Satterthwaite; and over all points (Šidák).
        """
        from scipy.stats import t as student_t

        quantile: Any = student_t.ppf
        each = 1.0 - (1.0 - _ALPHA) ** (1.0 / max(1, self.light_cd.size))
        return np.asarray(quantile(1.0 - each / 2.0, self._freedom), dtype=np.float64)

    @property
    def is_apart(self) -> NDArray[np.bool_]:
        """Where both differ by more than chance explains, (p,)."""
        return np.greater(np.abs(self.sigmas), self.allowed)

    @property
    def _freedom(self) -> Array:
        light, eye = self.light_standard_error_cd**2, self.eye_standard_error_cd**2
        of_light, of_eye = self.light_batches - 1, self.eye_repetitions - 1
        both = light**2 / of_light + eye**2 / of_eye
        least = np.full_like(both, min(of_light, of_eye))
        return np.divide((light + eye) ** 2, both, out=least, where=both > 0.0)


def cross_check(
    measurement: Measurement,
    lit: Lit = None,
    *,
    spots: NDArray[np.intp] | list[int] | None = None,
    looks: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> CrossCheck:
    """Return both intensities of ``spots``, by their numbers.

    What the measurement read by the eye is compared as it is. With ``looks``, or where it read
    nothing, the eye of each spot takes so many anew (None: a million, of the brightest three);
    ``progress`` is told the looks done and to do, of all spots together.

    Raises:
        LamplitError: There is no spot, the light was not the scene's own, or an eye cannot see it.
        KeyboardInterrupt: Ctrl-C; half of a comparison says nothing.
    """
    if measurement.light is not None:
        raise LamplitError("only what shines in the scene can be seen by an eye; leave light out")
    seen = measurement.observed(lit, by="light")
    reading = measurement.eye if looks is None else None
    looked = np.flatnonzero([] if reading is None else reading.looks)
    brightest = np.sort(np.argsort(seen.spot_cd)[::-1][:_SPOTS])
    usual = looked if looked.size else brightest
    chosen = usual if spots is None else np.asarray(spots, dtype=np.intp)
    if chosen.size == 0:
        raise LamplitError("there are no spots to check; measure some")
    if reading is not None and np.isin(chosen, looked).all():
        xyz, covariance = (part[chosen] for part in reading.observed(measurement.weights(lit)))
    else:
        reading = _look_again(measurement, chosen, looks or _LOOKS, progress)
        xyz, covariance = reading.observed(measurement.weights(lit))
    return CrossCheck(
        seen.spot_h_deg[chosen],
        seen.spot_v_deg[chosen],
        seen.spot_cd[chosen],
        seen.spot_standard_error_cd[chosen],
        xyz[:, 1],
        np.sqrt(covariance[:, 1, 1]),
        len(measurement.spot_xyz),
        len(reading.xyz),
    )


def _look_again(
    measurement: Measurement,
    spots: NDArray[np.intp],
    looks: int,
    progress: Callable[[int, int], object] | None,
) -> EyeReading:
    from lamplit.engine.measure import in_laboratory

    scene, total = measurement.scene, looks * len(spots)
    check_visible(scene)
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

    def tell(done: int) -> None:
        if progress is not None:
            progress(done, total)

    if looking.until(total, progress=tell):
        raise KeyboardInterrupt
    tell(total)
    return looking.reading()
