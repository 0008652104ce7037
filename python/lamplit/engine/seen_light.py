# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Whether the wavelengths that are followed hold the light of the sources."""

from __future__ import annotations

from lamplit.engine.carrier import SpectralCarrier
from lamplit.errors import LamplitError, SceneError
from lamplit.scene import Scene

#: What the eye sees of any lamp's light, in nm.
_VISIBLE_NM = (380.0, 780.0)
#: A share of a source's visible light that may lie beyond the range, as rounding and tails do.
_MOST_LEFT_OUT = 0.005


def check_range(scene: Scene, carrier: SpectralCarrier) -> None:
    """Check that the range of wavelengths cuts no source: its lumens would get another colour.

    Raises:
        SceneError: More than half a percent of the light of an object lies beyond the range.
    """
    every = SpectralCarrier(_VISIBLE_NM, scene.image.observer)
    for thing in scene.objects_as_read:
        emission = thing.emission
        if emission is None or not emission.shines:
            continue
        try:
            visible = every.tristimulus(emission.spectrum(every.wavelengths_nm))[1]
        except LamplitError:
            continue  # the table ends where the range does: nothing is known of what lies beyond
        followed = carrier.tristimulus(emission.spectrum(carrier.wavelengths_nm))[1]
        if followed < (1.0 - _MOST_LEFT_OUT) * visible:
            low, high = scene.image.wavelength_range_nm
            raise SceneError(
                f"{low:g} to {high:g} nm leave out {100.0 * (1.0 - followed / visible):.3g} % of "
                f"the light of {thing.name!r}, so its candela and colour would be wrong; take "
                "380 to 780 nm",
                file=scene.path,
                where="image.wavelength_range_nm",
            )
