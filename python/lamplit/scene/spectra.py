# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Do the spectra of a scene reach over the wavelengths of its picture?"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import LamplitError, SceneError, SpectrumError
from lamplit.materials import Material
from lamplit.scene.models import Scene
from lamplit.scene.references import resolve_material, resolve_source, values_of
from lamplit.spectra_spec import AnySource
from lamplit.table_faults import key_path

_Spectrum = Callable[[NDArray[np.float64]], object]

#: What materials, and their Hall terms, answer for wavelengths.
_ANSWERS = (
    *("index", "extinction", "absorption_per_mm"),
    *("reflectance_at", "transmittance_at", "reflectance_a_at", "reflectance_b_at"),
)
_PARTS = {"scattering": ("per_mm",), "lacquer": ("index", "optical_depth")}
_TERMS = ("specular_reflectance", "specular_transmittance", "ambient_reflectance")


def spectral_faults(scene: Scene) -> list[LamplitError]:
    """Return an error for each source or material without values somewhere in the range."""
    low, high = scene.image.wavelength_range_nm
    wavelengths = np.append(np.arange(low, high, 1.0), high)
    faults: dict[str, LamplitError] = {}
    for where, spectrum in _spectra(scene):
        if any(known.startswith(f"{where}.") for known in faults):
            continue  # this part of a material has been named already
        try:
            spectrum(wavelengths)
        except SpectrumError as fault:
            message = f"the picture goes from {low:g} to {high:g} nm, and {fault.message}"
            faults.setdefault(where, SceneError(message, file=scene.path, where=where))
    return list(faults.values())


def _spectra(scene: Scene) -> Iterator[tuple[str, _Spectrum]]:
    """Yield every spectrum that the picture needs, with its key path."""
    used = {thing.material for thing in scene.objects}
    for keys, spec in values_of(scene, AnySource):
        if keys[0] != "sources" and (keys[0] != "materials" or keys[1] in used):
            yield key_path(keys), resolve_source(scene, spec)
    for at, name in enumerate(thing.material for thing in scene.objects):
        own = name in scene.materials
        where = key_path(("materials", name)) if own else f"objects[{at}].material"
        for spectrum in _answers(resolve_material(scene, name)):
            yield where, spectrum


def _answers(material: Material) -> Iterator[_Spectrum]:
    for name in _ANSWERS:
        if answer := getattr(material, name, None):
            yield answer
    for part, names in _PARTS.items():
        for name in names:
            if (holder := getattr(material, part, None)) is not None:
                yield getattr(holder, name)
    for name in _TERMS:
        if term := getattr(material.hall, name, None):
            yield term.distribution()
