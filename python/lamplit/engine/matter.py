# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What surfaces and bodies are made of, as the compiled core takes it."""

from __future__ import annotations

import numpy as np

from lamplit import _core
from lamplit.engine.carrier import Carrier
from lamplit.materials.models import Conductor, Dielectric, Material
from lamplit.materials.optics import LINE_D_NM


def core_matter(material: Material, carrier: Carrier) -> _core.Matter:
    """Return the optics of ``material``, its spectra as ``carrier`` carries them."""
    reflectance = carrier.reflectance
    match material.kind:
        case "dielectric":
            made = _transparent(material, carrier)
        case "conductor":
            made = _metal(material, carrier)
        case "mirror":
            made = _core.Matter.mirror(reflectance(material.reflectance_at))
        case "diffuse":
            made = _core.Matter.diffuse(reflectance(material.reflectance_at))
        case "diffuse-transmitter":
            made = _core.Matter.transmitter(
                reflectance(material.reflectance_at), reflectance(material.transmittance_at)
            )
        case "checker":
            first = reflectance(material.reflectance_a_at)
            second = reflectance(material.reflectance_b_at)
            made = _core.Matter.checker(first, second, material.square_mm)
        case "glossy":
            base = reflectance(material.reflectance_at)
            made = _core.Matter.glossy(carrier.index(material.index), base)
    return made


def _transparent(body: Dielectric, carrier: Carrier) -> _core.Matter:
    turbid = body.scattering
    return _core.Matter.dielectric(
        carrier.index(body.index),
        _index_d(body),
        carrier.absorption_per_mm(body.absorption_per_mm),
        scattering_per_mm=None if turbid is None else carrier.per_mm(turbid.per_mm),
        anisotropy=0.0 if turbid is None else turbid.anisotropy,
    )


def _metal(metal: Conductor, carrier: Carrier) -> _core.Matter:
    coat = metal.lacquer
    lacquer = None
    if coat is not None:
        # The optical depth of one passage is absorbed like that of 1 mm.
        depth = carrier.absorption_per_mm(coat.optical_depth)
        lacquer = (carrier.index(coat.index), depth)
    n, k = carrier.metal(metal.index), carrier.metal(metal.extinction)
    return _core.Matter.conductor(n, k, metal.factor, lacquer=lacquer)


def _index_d(material: Dielectric) -> float:
    """Return the index that steers rays: n_d, or that of the nearest end of the data."""
    spectrum = material.refractive_index.index()
    low, high = spectrum.domain_nm
    return float(spectrum(np.array([np.clip(LINE_D_NM, low, high)]))[0])
