# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From an object's `Emission` to what the engine needs of it, and whether the object can shine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lamplit.colour.tristimulus import luminous_efficacy
from lamplit.errors import LamplitError, SceneError
from lamplit.files import resolve_inside
from lamplit.led_spec import LedSource
from lamplit.scene.emission import (
    CosineDistribution,
    Emission,
    FileDistribution,
    Quantity,
    ResolvedEmission,
)
from lamplit.scene.fields import is_group_name
from lamplit.scene.models import Scene
from lamplit.scene.objects import Object
from lamplit.scene.references import resolve_source
from lamplit.sources import bulb
from lamplit.spectra_spec import NamedSource
from lamplit.spectrum import Array, SpectralDistribution

if TYPE_CHECKING:
    from lamplit.photometry import Photometry

_STRENGTHS: tuple[Quantity, ...] = ("flux_lm", "radiant_flux_w", "luminance_cd_m2")


def resolve_emission(scene: Scene, shape: Object, at: int) -> ResolvedEmission | None:
    """Return the emission of ``shape``, which is object number ``at``; None if it has none.

    Raises:
        SceneError: Its photometric file cannot be used.
    """
    own = shape.emission
    if own is None:
        return None
    frame, photometry, exponent = np.eye(3), None, 1.0
    if isinstance(own.distribution, CosineDistribution):
        exponent = own.distribution.cosine_exponent
    elif isinstance(own.distribution, FileDistribution):
        photometry = _photometry(scene, own.distribution, at)
        turn = shape.transform.matrix()[:3, :3] / shape.transform.scale
        frame = own.distribution.frame() @ turn.T
    quantity, amount = _strength(scene, own, at)
    spectrum = _spectrum(scene, own)
    group = own.group or shape.name
    return ResolvedEmission(group, spectrum, quantity, amount, exponent, photometry, frame)


def _strength(scene: Scene, own: Emission, at: int) -> tuple[Quantity, float]:
    if own.bulb is not None:
        return "flux_lm", bulb(own.bulb).flux_lm
    if own.flux_lm_at_25_celsius is not None:
        return "flux_lm", own.flux_lm_at_25_celsius * _heated_share(scene, own, at)
    for name in _STRENGTHS:
        amount: float | None = getattr(own, name)
        if amount is not None:
            return name, amount
    return "spectral_radiance", 1.0


def _heated_share(scene: Scene, own: Emission, at: int) -> float:
    """Return the luminous flux of an LED as a share of that at 25 °C.

    The peak moves along V(λ), and the radiant flux falls.
    """
    led = own.source
    if isinstance(led, NamedSource):
        led = scene.sources.get(led.root)
    if not isinstance(led, LedSource):
        raise SceneError(
            "flux_lm_at_25_celsius needs a source { led_peak_nm, led_fwhm_nm, "
            "junction_temperature_celsius }, here or in [sources]; for others give flux_lm",
            file=scene.path,
            where=f"objects[{at}].emission.flux_lm_at_25_celsius",
        )
    hot = luminous_efficacy(led.distribution())
    return led.radiant_share * hot / luminous_efficacy(led.at_reference().distribution())


def _spectrum(scene: Scene, own: Emission) -> SpectralDistribution:
    if own.source is not None:
        return resolve_source(scene, own.source)
    if own.temperature_kelvin is None:
        raise TypeError("this emission was made without a source")
    planck = SpectralDistribution.blackbody(own.temperature_kelvin)
    if own.emissivity is None:
        return planck
    share = own.emissivity.distribution()

    def radiance(nm: Array) -> Array:
        return share(nm) * planck(nm)

    return SpectralDistribution(radiance, label=planck.label)


def _photometry(scene: Scene, spread: FileDistribution, at: int) -> Photometry:
    from lamplit.photometry import read_photometry

    where = f"objects[{at}].emission.distribution.file"
    path = resolve_inside(scene.root, spread.file, where=where)
    try:
        return read_photometry(path)
    except LamplitError as fault:
        raise file_fault(scene, spread.file, fault, where) from fault


def file_fault(scene: Scene, name: str, fault: LamplitError, where: str) -> SceneError:
    """Return ``fault``, found in the file ``name`` of a scene, as a fault of the scene's key."""
    place = f"{name}: {fault.where}" if fault.where else name
    return SceneError(f"{place}: {fault.message}", file=scene.path, where=where)


def emission_faults(scene: Scene) -> list[LamplitError]:
    """Return an error for each object that is to shine and cannot."""
    faults: list[LamplitError] = []
    for at, thing in enumerate(scene.objects_as_read):
        if thing.emission is None:
            continue
        says = None
        if thing.kind == "plane":
            says = "a plane without end cannot shine; use a disc or a box"
        elif thing.transparent:
            says = (
                f"{thing.material_name!r} is transparent, and light comes from opaque surfaces "
                "only; put an opaque object that shines into it, or use an opaque material"
            )
        elif not is_group_name(thing.emission.group):
            says = "the object's name cannot name a light group; give a group, such as 'lamp'"
        if says is not None:
            fault = SceneError(
                f"{thing.name!r}: {says}", file=scene.path, where=f"objects[{at}].emission"
            )
            faults.append(fault)
    return faults
