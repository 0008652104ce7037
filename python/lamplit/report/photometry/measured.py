# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From what the engine measured to what is shown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.chance import variance_of_mean
from lamplit.report.photometry.judged import judged
from lamplit.report.photometry.progress import in_words
from lamplit.report.photometry.results import EnergyFlow, FunctionResults, Results, Spectrum
from lamplit.scene.rays import ray_notices

Array = NDArray[np.float64]

#: So many bands of a measurement are drawn as one: all, a whole lane, several lanes. One lane is
#: filled evenly by every path; its parts take turns.
_BANDS_TOGETHER = (1, 5, 10, 20)
_HITS_IN_BAND = 30.0
#: A standard error below this share of the peak can be looked at.
_CERTAIN = 0.2

if TYPE_CHECKING:
    from lamplit.engine.cross_check import CrossCheck
    from lamplit.engine.measurement import Measurement
    from lamplit.photometry.observed import Observed
    from lamplit.rules import Rule


class Asked(Protocol):
    """A function of a lamp: its light, and what it has to meet."""

    @property
    def name(self) -> str:
        """Its name."""
        ...

    @property
    def light(self) -> Mapping[str, float]:
        """The weight of each light group; empty for all."""
        ...

    @property
    def rule(self) -> Rule | None:
        """What it has to meet."""
        ...

    @property
    def with_position(self) -> str | None:
        """The function that ratios are taken to."""
        ...


def results_of(
    measurement: Measurement, functions: Sequence[Asked], *, production: bool = False
) -> Results:
    """Return a measurement with the verdicts on its functions.

    Raises:
        RuleError: A rule cannot be judged by it.
    """
    scene = measurement.scene
    both = _both_ways(measurement)
    return Results(
        scene=scene.name,
        scene_hash=scene.scene_hash,
        version=measurement.version,
        seed=measurement.seed,
        paths=measurement.paths,
        functions=judged_functions(measurement, functions, production=production),
        energy=energy_of(measurement),
        spectra=_spectra(measurement),
        geometry=_geometry(measurement, both),
        notices=(*ray_file_notices(measurement), *_apart(both)),
        elapsed_s=measurement.elapsed_s,
        complete=measurement.complete,
    )


def judged_functions(
    measurement: Measurement, functions: Sequence[Asked], *, production: bool = False
) -> tuple[FunctionResults, ...]:
    """Return what was seen of each function, and what its rule says of it."""
    by_name = {one.name: one for one in functions}
    seen = {one.name: _observed(measurement, one.name, one.light) for one in functions}
    return tuple(
        judged(
            seen[one.name],
            one.rule,
            others=_others(measurement, one, by_name, seen),
            production=production,
            spectrum=_on_axis(measurement, one),
        )
        for one in functions
    )


def energy_of(measurement: Measurement) -> EnergyFlow | None:
    """Return where the lumens of all light groups, lit once each, went; None if nothing shone."""
    ledger = measurement.ledger
    if not ledger.emitted > 0.0:
        return None
    return EnergyFlow(
        emitted_lm={name: own.emitted for name, own in measurement.ledgers.items() if own.emitted},
        out_lm=ledger.out,
        absorbed_lm={name: lm for name, lm in ledger.absorbed.items() if lm != 0.0},
        cut_lm=ledger.cut_by_depth,
        lost_lm=ledger.lost,
        chance_lm=ledger.chance,
    )


def _observed(measurement: Measurement, name: str, light: Mapping[str, float]) -> Observed:
    return measurement.observed(light or None, name=name)


def _others(
    measurement: Measurement,
    one: Asked,
    by_name: Mapping[str, Asked],
    seen: Mapping[str, Observed],
) -> dict[str, Observed]:
    """Return the position lamp by the name that the rule's ratios give it, and both lit together.

    Both lit: a light group that both use shines as brightly as the brighter of the two asks.
    """
    if one.rule is None or one.with_position is None or one.with_position not in by_name:
        return {}
    names = {ratio.to for ratio in one.rule.entry.ratio if one.rule.holds(ratio.when)}
    found = dict.fromkeys(names, seen[one.with_position])
    other = by_name[one.with_position]
    shared = set(one.light) & set(other.light) if one.light and other.light else {""}
    if found and shared:
        groups = measurement.groups
        light = {group: max(_weight(one, group), _weight(other, group)) for group in groups}
        found["both"] = _observed(measurement, "both", light)
    return found


def _weight(one: Asked, group: str) -> float:
    return one.light.get(group, 0.0) if one.light else 1.0


def _on_axis(measurement: Measurement, one: Asked) -> Spectrum | None:
    gonio = measurement.goniometer
    at = np.flatnonzero((gonio.spot_h_deg == 0.0) & (gonio.spot_v_deg == 0.0))
    if at.size == 0 or measurement.band_centres_nm.size == 0:
        return None
    weights = measurement.weights(one.light or None)
    batches = np.einsum("g,bgn->bn", weights, measurement.spot_spectra_by_batch[:, :, int(at[0])])
    # As certain as the walks from the light, which made the bands.
    seen = measurement.observed(one.light or None, by="light")
    cd, error = float(seen.spot_cd[at[0]]), float(seen.spot_standard_error_cd[at[0]])
    about = Spectrum(f"{one.name} at HV", measurement.band_centres_nm, np.empty(0), "W/(sr nm)")
    return in_bands(about, batches, _hits(cd, error))


def _hits(flux: float, standard_error: float) -> float:
    """Return how many hits of one weight would scatter so much."""
    return (flux / standard_error) ** 2 if standard_error > 0.0 else float("inf")


def _spectra(measurement: Measurement) -> tuple[Spectrum, ...]:
    """Return the spectra of the sources by light group: what is emitted, and what leaves."""
    nm = np.arange(380.0, 780.5)
    emitted = {
        own.emission.group or own.name: own.emission.source
        for own in measurement.scene.objects
        if own.emission is not None and own.emission.source is not None
    }
    shapes = [
        Spectrum(f"{group}, the source", nm, measurement.scene.resolve_source(source)(nm), "")
        for group, source in emitted.items()
        if measurement.light is None
    ]
    lumens = measurement.out_xyz.mean(axis=0)[:, 1]
    errors = np.sqrt(variance_of_mean(measurement.out_xyz[..., 1]))
    nm = measurement.band_centres_nm
    leaving = [
        in_bands(
            Spectrum(f"{name}, leaving the lamp", nm, np.empty(0), "W/nm"),
            measurement.out_spectra_by_batch[:, at],
            _hits(float(lumens[at]), float(errors[at])),
        )
        for at, name in enumerate(measurement.groups)
    ]
    return (*shapes, *(one for one in leaving if one is not None))


def in_bands(about: Spectrum, batches: Array, hits: float) -> Spectrum | None:
    """Return a measured spectrum, with standard errors, in bands wide enough to mean something.

    ``batches`` (b, n) are values in n bands evenly apart, of independent walks, and ``hits`` paths
    made them; ``about`` says the rest. Where dispersion parts the wavelengths, a hit tells of one
    alone: a band has at least thirty of them, were all bands alike. They are also wide enough for σ
    to be below a fifth of the peak, if that can be had. None of darkness, and where not even the
    widest bands have hits enough: too few paths.
    """
    middles_nm, wide = about.wavelengths_nm, None
    if len(middles_nm) < 2 or not batches.any():
        return None
    step = float(middles_nm[1] - middles_nm[0])
    for several in _BANDS_TOGETHER:
        count, rest = divmod(len(middles_nm), several)
        if rest == 0 and hits >= _HITS_IN_BAND * count:
            means = batches.reshape(len(batches), count, several).mean(axis=2)
            wide = replace(
                about,
                wavelengths_nm=middles_nm.reshape(count, several).mean(axis=1),
                values=means.mean(axis=0),
                band_nm=step * several,
                standard_error=np.sqrt(variance_of_mean(means)),
            )
            error = wide.standard_error
            if error is None or error.max() <= _CERTAIN * wide.values.max():
                break
    return wide


def ray_file_notices(measurement: Measurement) -> tuple[str, ...]:
    """Return what to know of the scene's ray files: what they lack, and where they are coarse."""
    if measurement.light is not None or not measurement.scene.ray_files:
        return ()
    counts: dict[str, int] = {}
    for rays in measurement.scene.resolved_rays():
        counts[rays.name] = counts.get(rays.name, 0) + len(rays.flux)
    coarse = [
        f"{name}: its file has {count} rays, fewer than the paths that were walked: σ is that of "
        "walks from these rays, and says nothing of how coarsely they stand for the source"
        for name, count in counts.items()
        if count < measurement.paths
    ]
    return (*ray_notices(measurement.scene), *coarse)


def _both_ways(measurement: Measurement) -> CrossCheck | None:
    """Return the readings of the eye beside those of the light; None where no eye looked."""
    eye = measurement.eye
    return measurement.cross_check() if eye is not None and eye.looks.any() else None


def _apart(both: CrossCheck | None) -> tuple[str, ...]:
    """Return a notice where the eye and the light differ by more than chance lets them."""
    if both is None or not both.is_apart.any():
        return ()
    apart = np.abs(both.sigmas)
    at = int((apart / both.allowed).argmax())
    notice = (
        f"walks from the light and from the receiver differ by {apart[at]:.1f} σ at "
        f"H {both.spot_h_deg[at]:g}°, V {both.spot_v_deg[at]:g}°: {both.light_cd[at]:.3g} and "
        f"{both.eye_cd[at]:.3g} cd; smooth normals on a coarse mesh do that, or light that one of "
        "them seldom finds"
    )
    return (notice,)


def _geometry(measurement: Measurement, both: CrossCheck | None) -> dict[str, str]:
    gonio = measurement.goniometer
    distance = gonio.distance_m
    centre = ", ".join(f"{at:.1f}".replace("-", "−") for at in gonio.centre_mm)
    found = {
        "distance": "far field" if distance is None else f"{distance:g} m",
        "receiver": f"{gonio.receiver_deg:.3g}° full angle",
        "reference centre": f"({centre}) mm",
    }
    if both is not None and measurement.eye is not None:
        found["test points"] = (
            f"{in_words(float(measurement.eye.looks.sum()))} looks from the receivers; the light "
            f"reads the same but for {np.abs(both.sigmas).max():.1f} σ at most, of "
            f"{both.light_cd.size} points"
        )
    return found
