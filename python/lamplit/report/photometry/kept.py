# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``measurement.json``: a measurement in one file, strict in form, that reads back the same.

The grids of intensity are beside it in ``candela.csv``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from lamplit.colour.hue import hue
from lamplit.errors import LamplitError
from lamplit.photometry.observed import Observed
from lamplit.report.photometry import results as shown
from lamplit.report.photometry.csv_files import read_grid
from lamplit.report.photometry.isocandela import brightest
from lamplit.report.photometry.kept_verdict import (
    Kept,
    KeptReflector,
    KeptVerdict,
    kept_reflector,
    kept_verdict,
    reflector_of,
    verdict_of,
)
from lamplit.rules.verdict import Outcome

Array = NDArray[np.float64]

#: The file's name, and that of the grids beside it.
MEASUREMENT_FILE, CANDELA_FILE = "measurement.json", "candela.csv"

Pair = tuple[float, float]
Triple = tuple[float, float, float]
Four = tuple[float, float, float, float]


class KeptSpot(Kept):
    """A measured direction.

    The chromaticity is null where no light came, its standard error where too little did. So are
    the dominant wavelength, which is the complementary one with a minus sign of a purple, and the
    CCT, which few colours have.
    """

    h_deg: float
    v_deg: float
    intensity_cd: float
    standard_error_cd: float
    xyz_cd: Triple
    xyz_covariance_cd2: tuple[Triple, Triple, Triple]
    chromaticity_xy: Pair | None
    chromaticity_standard_error: Pair | None
    dominant_wavelength_nm: float | None = None
    dominant_wavelength_standard_error_nm: float | None = None
    colour_temperature_k: float | None = None
    colour_temperature_standard_error_k: float | None = None


class KeptGrid(Kept):
    """Borders of the cells whose intensities are in ``candela.csv``."""

    h_edges_deg: list[float] = Field(min_length=2)
    v_edges_deg: list[float] = Field(min_length=2)
    brightest_cd: float
    brightest_h_deg: float
    brightest_v_deg: float


class KeptRegion(Kept):
    """A legal region of colour."""

    name: str
    outline_xy: list[Pair] = Field(min_length=3)


class KeptSpectrum(Kept):
    """A spectrum as numbers."""

    name: str
    unit: str
    band_nm: float | None
    wavelengths_nm: list[float]
    values: list[float]
    standard_errors: list[float] | None = None


class KeptFunction(Kept):
    """One function of the lamp."""

    name: str
    paths: int
    verdict: KeptVerdict | None
    spots: list[KeptSpot]
    grid: KeptGrid
    region: KeptRegion | None
    fields_deg: list[Four]
    spectrum: KeptSpectrum | None


class KeptEnergy(Kept):
    """Where the flux of the sources went, in lm; ``gap_lm`` is what rounding leaves."""

    emitted_lm: dict[str, float]
    out_lm: float
    absorbed_lm: dict[str, float]
    cut_lm: float
    lost_lm: float
    chance_lm: float
    gap_lm: float


class KeptResults(Kept):
    """The file as a whole."""

    lamplit_measurement: Literal[1]
    scene: str
    scene_hash: str
    version: str
    command: str
    seed: int
    paths: int
    complete: bool
    elapsed_s: float
    outcome: Outcome | None
    geometry: dict[str, str]
    notices: list[str]
    functions: list[KeptFunction]
    energy: KeptEnergy | None
    spectra: list[KeptSpectrum]
    reflectors: list[KeptReflector] = Field(default_factory=list[KeptReflector])


def measurement_json(results: shown.Results) -> bytes:
    """Return ``results`` as the text of ``measurement.json``, apart from the grids."""
    energy = results.energy
    kept = KeptResults(
        lamplit_measurement=1,
        scene=results.scene,
        scene_hash=results.scene_hash,
        version=results.version,
        command=results.command,
        seed=results.seed,
        paths=results.paths,
        complete=results.complete,
        elapsed_s=results.elapsed_s,
        outcome=results.outcome,
        geometry=dict(results.geometry),
        notices=list(results.notices),
        functions=[_kept_function(one) for one in results.functions],
        energy=None if energy is None else KeptEnergy(
            emitted_lm=dict(energy.emitted_lm), out_lm=energy.out_lm,
            absorbed_lm=dict(energy.absorbed_lm), cut_lm=energy.cut_lm, lost_lm=energy.lost_lm,
            chance_lm=energy.chance_lm, gap_lm=energy.gap_lm,
        ),
        spectra=[_kept_spectrum(one) for one in results.spectra],
        reflectors=[kept_reflector(one) for one in results.reflectors],
    )  # fmt: skip
    return (kept.model_dump_json(indent=2) + "\n").encode()


def read_results(directory: Path) -> shown.Results:
    """Return the measurement that `lamplit measure` wrote into ``directory``.

    Raises:
        LamplitError: A file is missing, damaged, or of another version of the format.
    """
    path = directory / MEASUREMENT_FILE
    try:
        kept = KeptResults.model_validate_json(path.read_bytes())
    except OSError as fault:
        raise LamplitError(
            f"cannot be read ({fault.strerror}); name a scene, or a folder that "
            "`lamplit measure` wrote",
            file=path,
        ) from fault
    except ValidationError as fault:
        first = fault.errors()[0]
        where = ".".join(map(str, first["loc"])) or None
        raise LamplitError(
            f"is no measurement of this version of Lamplit: {first['msg']}; measure again",
            file=path, where=where,
        ) from fault  # fmt: skip
    shapes = {
        one.name: (len(one.grid.v_edges_deg) - 1, len(one.grid.h_edges_deg) - 1)
        for one in kept.functions
    }
    grids = read_grid(directory / CANDELA_FILE, shapes) if shapes else {}
    energy = kept.energy
    return shown.Results(
        scene=kept.scene,
        scene_hash=kept.scene_hash,
        version=kept.version,
        seed=kept.seed,
        paths=kept.paths,
        functions=tuple(_function(one, *grids[one.name]) for one in kept.functions),
        energy=None if energy is None else shown.EnergyFlow(
            **energy.model_dump(exclude={"gap_lm"})
        ),
        spectra=tuple(_spectrum(one) for one in kept.spectra),
        geometry=kept.geometry,
        notices=tuple(kept.notices),
        elapsed_s=kept.elapsed_s,
        complete=kept.complete,
        command=kept.command,
        reflectors=tuple(reflector_of(one) for one in kept.reflectors),
    )  # fmt: skip


def _kept_function(one: shown.FunctionResults) -> KeptFunction:
    seen = one.observed
    h_deg, v_deg, peak = brightest(seen)
    return KeptFunction(
        name=one.name,
        paths=seen.paths,
        verdict=None if one.verdict is None else kept_verdict(one.verdict),
        spots=_kept_spots(seen),
        grid=KeptGrid(
            h_edges_deg=seen.grid_h_edges_deg.tolist(),
            v_edges_deg=seen.grid_v_edges_deg.tolist(),
            brightest_cd=peak, brightest_h_deg=h_deg, brightest_v_deg=v_deg,
        ),
        region=None if one.region is None else KeptRegion(
            name=one.region.name, outline_xy=one.region.outline_xy.tolist()
        ),
        fields_deg=list(one.fields_deg),
        spectrum=None if one.spectrum is None else _kept_spectrum(one.spectrum),
    )  # fmt: skip


def _kept_spots(seen: Observed) -> list[KeptSpot]:
    colours = seen.spot_colours
    xy, errors = colours.xy, colours.standard_error
    lit = seen.spot_xyz.sum(axis=-1) > 0.0
    return [
        KeptSpot(
            h_deg=float(seen.spot_h_deg[at]), v_deg=float(seen.spot_v_deg[at]),
            intensity_cd=float(seen.spot_cd[at]),
            standard_error_cd=float(seen.spot_standard_error_cd[at]),
            xyz_cd=seen.spot_xyz[at].tolist(),
            xyz_covariance_cd2=seen.spot_xyz_covariance[at].tolist(),
            chromaticity_xy=xy[at].tolist() if lit[at] else None,
            chromaticity_standard_error=errors[at].tolist() if colours.is_known[at] else None,
            **_known_hue(xy[at], colours.covariance[at]),
        )
        for at in range(len(seen.spot_h_deg))
    ]  # fmt: skip


def _known_hue(xy: Array, covariance: Array) -> dict[str, float]:
    found = hue(xy, covariance)._asdict()
    return {name: value for name, value in found.items() if np.isfinite(value)}


def _kept_spectrum(one: shown.Spectrum) -> KeptSpectrum:
    return KeptSpectrum(
        name=one.name, unit=one.unit, band_nm=one.band_nm,
        wavelengths_nm=one.wavelengths_nm.tolist(), values=one.values.tolist(),
        standard_errors=None if one.standard_error is None else one.standard_error.tolist(),
    )  # fmt: skip


def _spectrum(one: KeptSpectrum) -> shown.Spectrum:
    wavelengths, values = np.array(one.wavelengths_nm), np.array(one.values)
    error = None if one.standard_errors is None else np.array(one.standard_errors)
    return shown.Spectrum(one.name, wavelengths, values, one.unit, one.band_nm, error)


def _function(one: KeptFunction, grid_xyz: Array, grid_error: Array) -> shown.FunctionResults:
    spots = one.spots
    count = len(spots)
    observed = Observed(
        name=one.name,
        spot_h_deg=np.array([spot.h_deg for spot in spots]),
        spot_v_deg=np.array([spot.v_deg for spot in spots]),
        spot_xyz=np.array([spot.xyz_cd for spot in spots]).reshape(count, 3),
        spot_xyz_covariance=np.array([spot.xyz_covariance_cd2 for spot in spots]).reshape(
            count, 3, 3
        ),
        grid_h_edges_deg=np.array(one.grid.h_edges_deg),
        grid_v_edges_deg=np.array(one.grid.v_edges_deg),
        grid_xyz=grid_xyz,
        grid_standard_error_cd=grid_error,
        paths=one.paths,
    )
    region = one.region
    verdict = one.verdict
    return shown.FunctionResults(
        observed,
        None if verdict is None else verdict_of(verdict, one.name),
        None if region is None else shown.ColourRegion(region.name, np.array(region.outline_xy)),
        tuple(one.fields_deg),
        None if one.spectrum is None else _spectrum(one.spectrum),
    )  # fmt: skip
