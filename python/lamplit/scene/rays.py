# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From `[[ray_files]]` to rays in the scene, in lm or W, with their spectra."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.tristimulus import K_M
from lamplit.errors import LamplitError, SceneError
from lamplit.files import resolve_inside
from lamplit.scene.emitters import file_fault
from lamplit.scene.fields import FARTHEST_MM, is_group_name
from lamplit.scene.models import Scene
from lamplit.scene.objects import UNITS_MM
from lamplit.scene.ray_files import RayFile, ResolvedRays
from lamplit.scene.references import resolve_source
from lamplit.spectrum import SpectralDistribution

if TYPE_CHECKING:
    from lamplit.photometry.rays import RaySet, SpectralTable

#: A header and the sum of its rays may differ by this share before it is told.
_TOTALS_AGREE = 0.01


def resolve_rays(scene: Scene) -> tuple[ResolvedRays, ...]:
    """See `Scene.resolved_rays`."""
    return tuple(
        rays for at, own in enumerate(scene.ray_files) for rays in _resolved(scene, own, at)
    )


def ray_faults(scene: Scene) -> list[LamplitError]:
    """Return an error for each ray file that cannot be used; each is read for it."""
    found = (_fault_of(scene, own, at) for at, own in enumerate(scene.ray_files))
    return [fault for fault in found if fault is not None]


def ray_notices(scene: Scene) -> tuple[str, ...]:
    """Return what to know of the rays of a scene, one line each.

    Raises:
        SceneError: A ray file cannot be used.
    """
    return tuple(notice for rays in resolve_rays(scene) for notice in rays.notices)


def _fault_of(scene: Scene, own: RayFile, at: int) -> LamplitError | None:
    try:
        _resolved(scene, own, at)
    except LamplitError as fault:
        return fault
    return None


def _resolved(scene: Scene, own: RayFile, at: int) -> list[ResolvedRays]:
    if own.group is None and not is_group_name(own.name):
        raise _fault(scene, at, "name", "this cannot name a light group; give a group")
    rays = _placed(own, _read(scene, own, at))
    if not (np.abs(rays.positions_mm) <= FARTHEST_MM).all():
        raise _fault(scene, at, "file", "rays start more than 1000 km away; is the unit right?")
    if own.source is not None:
        resolved = [_of_one_spectrum(scene, at, rays, resolve_source(scene, own.source))]
    elif rays.wavelengths_nm is not None:
        resolved = [_of_wavelengths(scene, at, rays)]
    elif rays.spectra:
        resolved = _of_tables(scene, at, rays)
    else:
        raise _fault(
            scene, at, "source", f"{own.file} says nothing of its spectrum; give the LED's source"
        )
    if own.flux_lm is not None:
        resolved = _scaled(scene, at, resolved, own.flux_lm)
    return resolved


def _read(scene: Scene, own: RayFile, at: int) -> RaySet:
    from lamplit.photometry.rays import read_rays

    where = f"ray_files[{at}].file"
    path = resolve_inside(scene.root, own.file, where=where)
    try:
        return read_rays(path)
    except LamplitError as fault:
        raise file_fault(scene, own.file, fault, where) from fault


def _placed(own: RayFile, rays: RaySet) -> RaySet:
    unit = 1.0 if own.unit is None else UNITS_MM[own.unit] / rays.unit_mm
    matrix = own.transform.matrix()
    turn = matrix[:3, :3] / own.transform.scale
    return replace(
        rays,
        positions_mm=unit * rays.positions_mm @ matrix[:3, :3].T + matrix[:3, 3],
        directions=rays.directions @ turn.T,
    )


def _of_one_spectrum(
    scene: Scene, at: int, rays: RaySet, spectrum: SpectralDistribution
) -> ResolvedRays:
    own, flux = scene.ray_files[at], rays.flux
    if rays.quantity == "radiant":
        flux = flux * _efficacy(scene, at, spectrum)
    return ResolvedRays(
        own.name,
        own.group or own.name,
        rays.positions_mm,
        rays.directions,
        flux,
        spectrum,
        None,
        _notices(own, rays),
    )


def _of_tables(scene: Scene, at: int, rays: RaySet) -> list[ResolvedRays]:
    own = scene.ray_files[at]
    if rays.spectrum_index is None:
        return [_of_one_spectrum(scene, at, rays, _table(own, rays.spectra[0]))]
    resolved: list[ResolvedRays] = []
    for number, table in enumerate(rays.spectra):
        mine = rays.spectrum_index == number
        if rays.flux[mine].any():
            part = replace(
                rays,
                positions_mm=rays.positions_mm[mine],
                directions=rays.directions[mine],
                flux=rays.flux[mine],
            )
            resolved.append(_of_one_spectrum(scene, at, part, _table(own, table)))
    told = _notices(own, rays)
    return [replace(part, notices=told if part is resolved[0] else ()) for part in resolved]


def _table(own: RayFile, table: SpectralTable) -> SpectralDistribution:
    nm, weights = table
    if len(nm) == 1:  # a line; it is as wide as a wavelength of the picture
        nm, weights = nm[0] + np.array([-1.0, 0.0, 1.0]), weights[0] * np.array([0.0, 1.0, 0.0])
    return SpectralDistribution.tabulated(nm, weights, extension="zero", label=own.file)


def _of_wavelengths(scene: Scene, at: int, rays: RaySet) -> ResolvedRays:
    own, nm = scene.ray_files[at], rays.wavelengths_nm
    if nm is None:
        raise TypeError("these rays have no wavelengths")
    low, high = scene.image.wavelength_range_nm
    seen = (nm >= low) & (nm < high)
    told = _notices(own, rays)
    if not rays.flux[seen].any():
        raise _fault(scene, at, "file", f"no ray has a wavelength from {low:g} to {high:g} nm")
    if rays.quantity == "luminous":
        raise _fault(scene, at, "file", "a flux in lm with wavelengths is not read; give a source")
    if not seen.all():
        lost = float(rays.flux[~seen].sum())
        notice = (
            f"{own.file}: {np.count_nonzero(~seen)} rays, {lost:.3g} W, are left out: their "
            f"wavelengths are not from {low:g} to {high:g} nm"
        )
        told = (*told, notice)
    return ResolvedRays(
        own.name,
        own.group or own.name,
        rays.positions_mm[seen],
        rays.directions[seen],
        rays.flux[seen],
        None,
        nm[seen],
        told,
    )


def _scaled(scene: Scene, at: int, parts: list[ResolvedRays], flux_lm: float) -> list[ResolvedRays]:
    total = sum(luminous_flux_lm(scene, part) for part in parts)
    if not total > 0.0:
        raise _fault(scene, at, "flux_lm", "the eye sees nothing of these rays; leave it out")
    return [replace(part, flux=part.flux * (flux_lm / total)) for part in parts]


def luminous_flux_lm(scene: Scene, rays: ResolvedRays) -> float:
    """Return the luminous flux of ``rays`` in lm, for the scene's observer."""
    if rays.wavelengths_nm is None:
        return float(rays.flux.sum())
    photopic = colour_matching_functions(scene.image.observer, rays.wavelengths_nm)[:, 1]
    return K_M * float(rays.flux @ photopic)


def _efficacy(scene: Scene, at: int, spectrum: SpectralDistribution) -> float:
    """Return lm/W of what ``spectrum`` has within the picture's wavelengths, each nm."""
    low, high = scene.image.wavelength_range_nm
    nm = low + np.arange(int(high - low) + 1)
    power = spectrum(nm)
    total = float(power.sum())
    if not total > 0.0:
        raise _fault(scene, at, "source", f"the spectrum has nothing from {low:g} to {high:g} nm")
    photopic = colour_matching_functions(scene.image.observer, nm)[:, 1]
    return K_M * float(power @ photopic) / total


def _notices(own: RayFile, rays: RaySet) -> tuple[str, ...]:
    stated, total = rays.stated_flux, rays.total_flux
    if stated is None or abs(stated - total) <= _TOTALS_AGREE * total:
        return ()
    unit = "lm" if rays.quantity == "luminous" else "W"
    notice = (
        f"{own.file}: its header says {stated:.4g} {unit}, and its rays have {total:.4g} {unit}; "
        "the rays are taken, unless flux_lm is given"
    )
    return (notice,)


def _fault(scene: Scene, at: int, key: str, message: str) -> SceneError:
    return SceneError(message, file=scene.path, where=f"ray_files[{at}].{key}")
