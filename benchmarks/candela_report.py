# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What the candela bench shows: time to 1 % at each test point, agreement, σ against time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from machine import machine_line
from numpy.typing import NDArray

Array = NDArray[np.float64]

WANTED = 0.01
#: Serves all points with the same walks; the others need a walk for each point.
_AT_ONCE = "light walk"
_COLOURS = {"light walk": "#c1121f", "eye walk": "#e07a5f", "Mitsuba": "#33658a"}
_ALPHA = 0.01


@dataclass(frozen=True, eq=False, kw_only=True)
class Round:
    """One round of a program over p points: intensities, their standard errors, and times."""

    cd: Array
    sigma: Array
    core_s: Array
    wall_s: Array
    paths: float = 0.0

    def kept(self) -> dict[str, Any]:
        """Return it as plain values, four digits each."""
        arrays = ("cd", "sigma", "core_s", "wall_s")
        own = {name: [float(f"{x:.4g}") for x in getattr(self, name)] for name in arrays}
        return {**own, "paths": self.paths}


def summary(spots: Array, rounds: dict[str, list[Round]]) -> dict[str, Any]:
    """Return intensities, relative standard errors and times to 1 % of all programs.

    The lamp is the same to both sides of both planes through its axis, so that the variances of
    points that mirror each other are pooled: four times as many repetitions tell them.
    """
    mirrored = np.abs(spots)
    names, group = np.unique(mirrored, axis=0, return_inverse=True)
    group = group.reshape(-1)
    told = {name: _together(done) for name, done in rounds.items()}
    # By pooled variances: a point's own would be small where its own mean is small by chance.
    weights = {name: 1.0 / _mean(told[name][1], group) for name in told if name != _AT_ONCE}
    weighted = np.sum([weight * told[name][0] for name, weight in weights.items()], axis=0)
    best = weighted / np.sum(list(weights.values()), axis=0)
    reference = _mean(best, group)
    programs: dict[str, Any] = {}
    for name, done in rounds.items():
        ladder = [_errors(done[: count + 1], reference, group) for count in range(len(done))]
        core = np.sum([one.core_s for one in done], axis=0)
        wall = np.sum([one.wall_s for one in done], axis=0)
        need = (ladder[-1] / WANTED) ** 2
        at_once = name == _AT_ONCE
        combine = np.max if at_once else np.sum
        cumulated = np.cumsum([one.core_s for one in done], axis=0)
        programs[name] = {
            "cd": told[name][0].tolist(),
            "sigma_cd": (ladder[-1] * reference).tolist(),
            "core_s_to_1_percent": (core * need).tolist(),
            "all_core_s": float(combine(core * need)),
            "all_wall_s": float(combine(wall * need)),
            "core_s": float(core.max() if at_once else core.sum()),
            "wall_s": float(wall.max() if at_once else wall.sum()),
            "paths": sum(one.paths for one in done),
            "ladder_core_s": (combine(cumulated, axis=1)).tolist(),
            "ladder_median": [float(np.median(errors)) for errors in ladder],
            "ladder_worst": [float(errors.max()) for errors in ladder],
        }
    return {
        "reference_cd": reference.tolist(),
        "mirrors": group.tolist(),
        "groups": names.tolist(),
        "programs": programs,
        "agreement": _agreement(programs),
    }


def _together(done: list[Round]) -> tuple[Array, Array]:
    """Return the mean over rounds and its variance."""
    cd = np.mean([one.cd for one in done], axis=0)
    return cd, np.mean([one.sigma**2 for one in done], axis=0) / len(done)


def _errors(done: list[Round], reference: Array, group: NDArray[np.intp]) -> Array:
    """Return the relative standard error of each point, pooled over those that mirror it."""
    return np.sqrt(_mean(_together(done)[1], group)) / reference


def _mean(values: Array, group: NDArray[np.intp]) -> Array:
    return (np.bincount(group, values) / np.bincount(group))[group]


def _agreement(programs: dict[str, Any]) -> dict[str, Any]:
    """Return the largest |z| over the points of each pair, and what Šidák allows at α = 0.01."""
    from statistics import NormalDist

    pairs: dict[str, Any] = {}
    names = list(programs)
    for at, one in enumerate(names):
        for other in names[at + 1 :]:
            off = np.subtract(programs[one]["cd"], programs[other]["cd"])
            z = off / np.hypot(programs[one]["sigma_cd"], programs[other]["sigma_cd"])
            each = 1.0 - (1.0 - _ALPHA) ** (1.0 / z.size)
            limit = NormalDist().inv_cdf(1.0 - each / 2.0)
            pairs[f"{one}, {other}"] = {
                "largest": float(np.abs(z).max()),
                "limit": limit,
                "rms": float(np.sqrt((z**2).mean())),
            }
    return pairs


def as_markdown(found: dict[str, Any]) -> str:
    """Return the results as tables."""
    programs, peer = found["programs"], found["peer"]
    lines = [
        "# Candela: time to 1 % at every test point of a stop lamp",
        "",
        f"Lamplit {found['version']} against Mitsuba {', '.join(found['mitsuba']) or '(none)'}",
        f"on {machine_line(found['machine'])}.",
        "",
        f"The lit `{found['lamp']}` lamp behind its red cover, of flat triangles, no dispersion,",
        f"in the dark, at {len(found['h_deg'])} points of {found['rule']}.",
        f"Receivers of {found['receiver_deg']:g}° at {found['distance_m']:g} m.",
        "The walk from the light serves all points at once: its worst point counts. The walks from",
        "the eye, ours and Mitsuba's `volpathmis`, are made for each point: their times add up.",
        "Times are the processor's, of all threads, measured in turn; σ is that of independent",
        "repetitions, pooled over points that mirror each other, and the time to 1 % follows from",
        "it by σ ∝ 1/√time. Where few light paths arrive, σ itself is rough: take the light walk's",
        "time at its weakest points as an order of magnitude.",
        "",
        "| program | core s spent | median σ | worst σ | core s to 1 % | Mitsuba's over it |",
        "|---|---|---|---|---|---|",
    ]
    for name, own in programs.items():
        ratio = ""
        if peer is not None:
            ratio = f"{programs['Mitsuba']['all_core_s'] / own['all_core_s']:.2g}"
        lines.append(
            f"| {name} | {own['core_s']:.0f} | {own['ladder_median'][-1]:.1%} "
            f"| {own['ladder_worst'][-1]:.1%} | {_seconds(own['all_core_s'])} | {ratio} |"
        )
    lines += ["", "## By point", ""]
    lines += [
        "| ±H | ±V | points | cd | "
        + " | ".join(f"{name}: core s to 1 %" for name in programs)
        + " |",
        "|---" * (4 + len(programs)) + "|",
    ]
    mirrors = np.array(found["mirrors"])
    for number, (h, v) in enumerate(found["groups"]):
        members = np.flatnonzero(mirrors == number)
        times = [np.mean(np.take(own["core_s_to_1_percent"], members)) for own in programs.values()]
        lines.append(
            f"| {h:g}° | {v:g}° | {members.size} | {found['reference_cd'][members[0]]:.4g} | "
            + " | ".join(_seconds(float(one)) for one in times)
            + " |"
        )
    own = programs[_AT_ONCE]
    lines += ["", "## Agreement and speed", ""]
    for pair, test in found["agreement"].items():
        verdict = "agree" if test["largest"] <= test["limit"] else "DO NOT AGREE"
        lines.append(
            f"- {pair}: {verdict}; largest |z| {test['largest']:.2f}, allowed {test['limit']:.2f}; "
            f"root mean square {test['rms']:.2f}"
        )
    lines.append(
        f"- {own['paths'] / own['wall_s'] / 1e6:.3f} million light paths/s of wall time on the "
        f"machine as it was, {own['paths'] / own['core_s'] / 1e6:.3f} million per core second"
    )
    for name, speed in found["paths_per_core_s"].items():
        lines.append(f"- Mitsuba `{name}`: {speed / 1e6:.3f} million eye paths per core second")
    if peer is not None:
        nothing = f"{found['ptracer_axis_cd']:.2g} cd"
        lines += [
            f"- Mitsuba's `ptracer` reads {nothing} on the axis: it connects particles to the",
            "  sensor in straight lines, which no smooth cover lets through",
        ]
    return "\n".join([*lines, ""])


def _seconds(value: float) -> str:
    digits = 1 - math.floor(math.log10(value))
    return f"{round(value, digits):,.{max(digits, 0)}f}".replace(",", " ")


def draw(found: dict[str, Any], path: Path) -> None:
    """Draw σ against time, log–log: the median and the worst over the points."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7.0, 4.6), layout="constrained")
    for name, own in found["programs"].items():
        colour = _COLOURS[name]
        for which, dash in (("median", "-"), ("worst", "--")):
            times, errors = np.array(own["ladder_core_s"]), np.array(own[f"ladder_{which}"])
            axes.loglog(times, errors, dash, color=colour, marker=".", label=f"{name}, {which}")
            ends = np.array([1.0, (errors[-1] / WANTED) ** 2])
            axes.loglog(
                times[-1] * ends, errors[-1] / np.sqrt(ends), ":", color=colour, linewidth=1
            )
    axes.axhline(WANTED, color="0.4", linewidth=1)
    axes.set(ylabel="relative standard error")
    axes.set_xlabel("core seconds for all points, as many for each")
    axes.set_title("Candela at the test points of a stop lamp; dotted: σ ∝ 1/√time")
    axes.grid(which="both", linewidth=0.3)
    axes.legend(frameon=False)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)
