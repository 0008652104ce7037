# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What the bench of unlit lamps shows: ratios as a table, ladders as a plot, pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from errors import Array, time_to_reach
from ladder import Rung
from machine import machine_line

import lamplit as ll
from lamplit.colour.picture import to_picture
from lamplit.report.png import write_png
from lamplit.report.view import display_of, scene_white_xy

_COLOURS = {"lamplit": "#c1121f", "scalar_spectral": "#8d99ae", "llvm_ad_spectral": "#33658a"}
#: Pixels of black between pictures.
_GAP = 4


def at_time(row: dict[str, Any], program: str) -> dict[str, float]:
    """Return the means over seeds of a program's errors at the judged time.

    ``merit`` is the mean of error times time, which noise keeps constant; seconds are what was
    really used.
    """
    rungs = [_nearest(ladder, row["judged_s"]) for ladder in row["ladders"][program]]
    keys = ("seconds", "samples", "relative_mse", "delta_e")
    means = {key: float(np.mean([rung[key] for rung in rungs])) for key in keys}
    merits = [rung["relative_mse"] * rung["seconds"] for rung in rungs]
    spread = float(np.std(merits, ddof=1) / len(merits) ** 0.5) if len(merits) > 1 else 0.0
    return {**means, "merit": float(np.mean(merits)), "merit_sigma": spread}


def ratios(row: dict[str, Any], peer: str) -> dict[str, float]:
    """Return S1 against ``peer``: by squared error × time, and by time to an equal ΔE₀₀."""
    mine, theirs = at_time(row, "lamplit"), at_time(row, peer)
    reached = [
        time_to_reach(
            [rung["seconds"] for rung in ladder],
            [rung["delta_e"] for rung in ladder],
            theirs["delta_e"],
        )
        for ladder in row["ladders"]["lamplit"]
    ]
    return {
        "luminance": theirs["merit"] / mine["merit"],
        "colour": theirs["seconds"] / float(np.exp(np.mean(np.log(reached)))),
    }


def as_markdown(found: dict[str, Any]) -> str:
    """Return the results as tables."""
    rows = found["rows"]
    programs = list(rows[0]["ladders"])
    lines = [
        "# Unlit lamps: time to the same error",
        "",
        f"Lamplit {found['version']} against Mitsuba {', '.join(rows[0]['mitsuba']) or '(none)'}",
        f"on {machine_line(found['machine'])}.",
        "",
        f"400 × 200 pixels; interleaved; means over seeds at {rows[0]['judged_s']:g} s of tracing.",
        "Relative MSE of luminance: mean of ((Y − Y₀)/(Y₀ + 1 % of the mean))². Time × error is",
        "what a program needs: it does not depend on how long one waits. Colour: time to the mean",
        "ΔE₀₀ that Mitsuba has then, by log–log interpolation; below Lamplit's first rung by",
        "ΔE ∝ 1/√time. ± is the standard error over seeds: rare bright paths in dark pixels make",
        "the squared error of both programs jump.",
        "",
        "| lamp, light | program | paths/pixel | s | rel. MSE | MSE × s | ΔE₀₀ | Y, × | ΔE, × |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        for program in programs:
            here = at_time(row, program)
            against = {} if program == "lamplit" else ratios(row, program)
            told = [f"{against[key]:.1f}" if against else "" for key in ("luminance", "colour")]
            lines.append(
                f"| {row['lamp']}, {row['light']} | {program} | {here['samples']:.0f} "
                f"| {here['seconds']:.2f} | {here['relative_mse']:.2e} "
                f"| {here['merit']:.4f} ± {here['merit_sigma']:.4f} "
                f"| {here['delta_e']:.2f} | {told[0]} | {told[1]} |"
            )
    if "llvm_ad_spectral" not in programs:
        lines += ["", "No LLVM was found, so Mitsuba's `llvm_ad_spectral` is left out."]
    lines += ["", "## The converged picture, and loading", ""]
    lines += [
        "| lamp, light | triangles | its relative MSE | Mitsuba's mean Y against it | loading, s |",
        "|---|---|---|---|---|",
    ]
    for row in rows:
        check = row["cross_check"]
        told = f"{check['difference']:+.2%} ± {check['sigma']:.2%}" if check else ""
        loading = ", ".join(f"{name} {seconds:.2f}" for name, seconds in row["load_s"].items())
        lines.append(
            f"| {row['lamp']}, {row['light']} | {row['triangles']} | {row['reference_noise']:.1e} "
            f"| {told} | {loading} |"
        )
    return "\n".join([*lines, ""])


def draw(found: dict[str, Any], path: Path) -> None:
    """Draw error against time for all programs, log–log."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    rows = found["rows"]
    figure, axes = pyplot.subplots(
        2, len(rows), figsize=(3.4 * len(rows), 6.4), sharex=True, layout="constrained"
    )
    grid = np.asarray(axes).reshape(2, len(rows))
    for at, row in enumerate(rows):
        for program, ladders in row["ladders"].items():
            for which, key in enumerate(("relative_mse", "delta_e")):
                for seed, ladder in enumerate(ladders):
                    grid[which, at].loglog(
                        [rung["seconds"] for rung in ladder],
                        [rung[key] for rung in ladder],
                        color=_COLOURS.get(program, "0.4"),
                        marker=".",
                        linewidth=1,
                        label=program if seed == 0 else None,
                    )
        grid[0, at].set_title(f"{row['lamp']}, {row['light']}")
        grid[1, at].set_xlabel("tracing time, s")
    for at in range(2 * len(rows)):
        grid.flat[at].grid(which="both", linewidth=0.3)
    grid[0, 0].set_ylabel("relative MSE of luminance")
    grid[1, 0].set_ylabel("mean ΔE₀₀")
    grid[0, 0].legend(frameon=False)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def write_pictures(scene: ll.Scene, shown: dict[str, Rung], folder: Path) -> None:
    """Write the programs' pictures at equal time side by side, in the order of ``shown``."""
    display = display_of(scene.display.space, root=scene.root)
    white = float(scene.display.white_luminance_cd_m2)
    parts: list[Array] = []
    for rung in shown.values():
        developed = to_picture(
            rung.xyz,
            display=display,
            white_luminance_cd_m2=white,
            white_xy=scene_white_xy(scene),
            adaptation=scene.display.adaptation,
            gamut=scene.display.gamut,
        )
        parts += [developed.encoded, np.zeros((rung.xyz.shape[0], _GAP, 3))]
    name = f"unlit-{scene.root.name.rpartition('-')[0]}-{scene.background.kind}.png"
    write_png(folder / name, np.concatenate(parts[:-1], axis=1), display)


def _nearest(ladder: list[dict[str, float]], time_s: float) -> dict[str, float]:
    return min(ladder, key=lambda rung: abs(np.log(rung["seconds"] / time_s)))
