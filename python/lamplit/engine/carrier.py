# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a path carries for each light and material: a spectrum, or three numbers.

The core follows lanes and knows nothing of their meaning. `SpectralCarrier` makes them the
wavelengths of the picture; `RgbCarrier` makes the first three of them red, green and blue, so that
the RGB half of a comparison goes through the same code along the same rays.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lamplit._core import LANES
from lamplit.colour.display import Display
from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.tristimulus import K_M
from lamplit.errors import SceneError

Array = NDArray[np.float64]
#: A quantity as a function of wavelengths in nm.
Spectrum = Callable[[Array], Array]


class Carrier(Protocol):
    """Turns functions of wavelength into the core's lane values, in its ascending order."""

    @property
    def count(self) -> int:
        """How many values a quantity has."""
        ...

    def light(self, spectrum: Spectrum, luminance_cd_m2: float, *, where: str) -> Array:
        """Return a radiance of this spectrum and luminance."""
        ...

    def radiant(self, spectrum: Spectrum, watts: float, *, where: str) -> Array:
        """Return a quantity of this spectrum whose sum over the wavelengths is ``watts``."""
        ...

    def absolute(self, spectrum: Spectrum) -> Array:
        """Return a radiance that the spectrum gives in its own unit, per nm."""
        ...

    def environment(self, white: Spectrum, luminance_cd_m2: float) -> tuple[Array, Array, Array]:
        """Return the radiances of R, G and B = 1 of a picture whose white has this luminance."""
        ...

    def reflectance(self, spectrum: Spectrum) -> Array:
        """Return a reflectance or a transmittance."""
        ...

    def index(self, spectrum: Spectrum) -> Array:
        """Return a transparent body's refractive index."""
        ...

    def metal(self, spectrum: Spectrum) -> Array:
        """Return n or k of a conductor."""
        ...

    def absorption_per_mm(self, spectrum: Spectrum) -> Array:
        """Return an absorption coefficient in 1/mm."""
        ...

    def per_mm(self, spectrum: Spectrum) -> Array:
        """Return a scattering coefficient in 1/mm, which may exceed 1."""
        ...

    def colour_matching(self) -> tuple[Array, Array, Array]:
        """Return what a path's radiance is multiplied with and summed to X, Y and Z in cd/m²."""
        ...


class SpectralCarrier:
    """The wavelengths of the picture: the middles of steps of at most 1 nm."""

    #: How many wavelengths each lane takes in turn, from one sample to the next.
    phases: int
    #: How many wavelengths there are.
    count: int
    step_nm: float
    #: All of them, (count,), rising.
    wavelengths_nm: Array

    def __init__(self, range_nm: tuple[float, float], observer: str) -> None:
        low, high = range_nm
        self.phases = max(1, int(np.ceil((high - low) / LANES - 1e-9)))
        self.count = self.phases * LANES
        self.step_nm = (high - low) / self.count
        middles = np.arange(self.count, dtype=np.float64) + 0.5
        self.wavelengths_nm = low + self.step_nm * middles
        self._functions = colour_matching_functions(observer, self.wavelengths_nm)

    def tristimulus(self, radiance: Array) -> Array:
        """Return X, Y, Z (3,) in cd/m² of a spectral radiance on the wavelengths: eq. (1)."""
        return K_M * self.step_nm * (radiance @ self._functions)

    def light(self, spectrum: Spectrum, luminance_cd_m2: float, *, where: str) -> Array:
        """Return the spectral radiance with the spectrum's shape and this luminance.

        Raises:
            SceneError: The spectrum gives no light that the eye sees, or is negative somewhere.
        """
        shape = self._not_negative(spectrum, where)
        if luminance_cd_m2 == 0.0:
            return np.zeros(self.count)
        luminance = float(self.tristimulus(shape)[1])
        if luminance <= 0.0:
            raise SceneError(
                "the source gives no visible light within image.wavelength_range_nm, "
                "so no luminance can be given to it",
                where=where,
            )
        return shape * (luminance_cd_m2 / luminance)

    def radiant(self, spectrum: Spectrum, watts: float, *, where: str) -> Array:
        """Return the spectrum scaled so that its sum over the picture's wavelengths is ``watts``.

        Raises:
            SceneError: The spectrum has no power there, or is negative somewhere.
        """
        shape = self._not_negative(spectrum, where)
        power = float(shape.sum()) * self.step_nm
        if power <= 0.0:
            raise SceneError(
                "the source has no power within image.wavelength_range_nm", where=where
            )
        return shape * (watts / power)

    def absolute(self, spectrum: Spectrum) -> Array:
        """Return the values on the wavelengths."""
        return spectrum(self.wavelengths_nm)

    def environment(self, white: Spectrum, luminance_cd_m2: float) -> tuple[Array, Array, Array]:
        """Return smooth spectra for R, G and B that add up to the white: a guess."""
        from lamplit.colour.uplift import basis

        radiance = self.light(white, luminance_cd_m2, where="background.source")
        r, g, b = (np.ascontiguousarray(column) for column in basis(self.wavelengths_nm).T)
        return r * radiance, g * radiance, b * radiance

    def _not_negative(self, spectrum: Spectrum, where: str) -> Array:
        shape = spectrum(self.wavelengths_nm)
        if (shape < 0).any():
            at = self.wavelengths_nm[np.argmax(shape < 0)]
            raise SceneError(f"the source is negative at {at:g} nm; no light is", where=where)
        return shape

    def reflectance(self, spectrum: Spectrum) -> Array:
        """Return the values on the wavelengths."""
        return spectrum(self.wavelengths_nm)

    index = metal = absorption_per_mm = per_mm = reflectance

    def colour_matching(self) -> tuple[Array, Array, Array]:
        """Return K_M x̄ Δλ, K_M ȳ Δλ, K_M z̄ Δλ; every sample stands for all phases."""
        weights = K_M * self.step_nm * self.phases * self._functions
        x, y, z = (np.ascontiguousarray(column) for column in weights.T)
        return x, y, z


class RgbCarrier:
    """Three numbers per light and material, as an RGB renderer has them.

    They are linear RGB in ``space``, derived from the spectra: a light's from its tristimulus
    values, a reflectance's from those of the scene's white after it, divided by the white's own,
    an absorption's from the transmittance of 1 mm. One reflection of the white is therefore right;
    what RGB gets wrong is everything after. Numbers below 0, which such renderers do not know,
    become 0; transmittances stay above 1e-6.
    """

    count: int = LANES

    def __init__(self, spectral: SpectralCarrier, white: Spectrum, *, space: str = "srgb") -> None:
        self._spectral = spectral
        self._space = Display.named(space)
        self._white = white(spectral.wavelengths_nm)
        self._white_rgb = self._rgb(self._white)
        if (self._white_rgb <= 0.0).any():
            raise SceneError(
                f"this white lies outside the colours of {space}, so RGB cannot stand for it",
                where="display.white",
            )

    def _rgb(self, radiance: Array) -> Array:
        return self._space.xyz_to_rgb @ self._spectral.tristimulus(radiance)

    def _lanes(self, rgb: Array) -> Array:
        """Repeat red, green and blue over all lanes; only the first three are looked at."""
        return np.resize(rgb, LANES).astype(np.float64)

    def light(self, spectrum: Spectrum, luminance_cd_m2: float, *, where: str) -> Array:
        """Return linear RGB in cd/m², of this luminance where no number had to be cut."""
        radiance = self._spectral.light(spectrum, luminance_cd_m2, where=where)
        return self._lanes(np.maximum(self._rgb(radiance), 0.0))

    def radiant(self, spectrum: Spectrum, watts: float, *, where: str) -> Array:
        """Return the linear RGB of that power."""
        power = self._spectral.radiant(spectrum, watts, where=where)
        return self._lanes(np.maximum(self._rgb(power), 0.0))

    def absolute(self, spectrum: Spectrum) -> Array:
        """Return the linear RGB of that radiance."""
        radiance = self._spectral.absolute(spectrum)
        return self._lanes(np.maximum(self._rgb(radiance), 0.0))

    def environment(self, white: Spectrum, luminance_cd_m2: float) -> tuple[Array, Array, Array]:
        """Return linear RGB of the picture's R, G and B."""
        r, g, b = (
            self._lanes(np.maximum(self._rgb(radiance), 0.0))
            for radiance in self._spectral.environment(white, luminance_cd_m2)
        )
        return r, g, b

    def metal(self, spectrum: Spectrum) -> Array:
        """Return the numbers under the scene's white, at least 1e-3."""
        seen = self._white * spectrum(self._spectral.wavelengths_nm)
        return self._lanes(np.maximum(self._rgb(seen) / self._white_rgb, 1e-3))

    def reflectance(self, spectrum: Spectrum) -> Array:
        """Return the numbers under the scene's white, cut to 0..1."""
        seen = self._white * spectrum(self._spectral.wavelengths_nm)
        return self._lanes(np.clip(self._rgb(seen) / self._white_rgb, 0.0, 1.0))

    def index(self, spectrum: Spectrum) -> Array:
        """Return n_d for all three: RGB renderers refract all light alike."""
        from lamplit.materials.optics import LINE_D_NM

        return np.full(LANES, float(spectrum(np.array([LINE_D_NM]))[0]))

    def absorption_per_mm(self, spectrum: Spectrum) -> Array:
        """Return −ln of the RGB transmittance of 1 mm."""
        one_millimetre = self.reflectance(lambda nm: np.exp(-spectrum(nm)))
        return -np.log(np.maximum(one_millimetre, 1e-6))

    def per_mm(self, spectrum: Spectrum) -> Array:
        """Return the mean coefficients under the scene's white, as R, G and B weigh it."""
        seen = self._white * spectrum(self._spectral.wavelengths_nm)
        return self._lanes(np.maximum(self._rgb(seen) / self._white_rgb, 0.0))

    def colour_matching(self) -> tuple[Array, Array, Array]:
        """Return the rows of the matrix from RGB to XYZ, on the first three lanes."""
        rows = np.zeros((3, LANES))
        rows[:, :3] = self._space.rgb_to_xyz
        x, y, z = rows
        return x, y, z
