# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What the bench of lit lamps shows: tables and ladders."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from lit_runners import MITSUBA
from machine import machine_line

_COLOURS = {"path": "#33658a", "lit": "#c1121f", MITSUBA: "#8d99ae"}
#: The rungs of a ladder that tell its slope.
_SLOPE_RUNGS = 3
#: A ladder that falls no faster than this tells no time: error ∝ time^slope.
_FLATTEST = -0.1


def judged(view: Mapping[str, Any], program: str) -> dict[str, float]:
    """Return means over seeds of a program's last rungs, and the standard error of two of them."""
    rungs = [ladder[-1] for ladder in view["ladders"][program]]
    told = {key: float(np.mean([rung[key] for rung in rungs])) for key in rungs[0]}
    for key in ("tone", "trim"):
        values = [rung[key] for rung in rungs]
        told[f"{key}_sigma"] = float(np.std(values, ddof=1) / len(values) ** 0.5)
    return told


def slope(ladders: Sequence[Sequence[Mapping[str, float]]]) -> float:
    """Return d log(tone) / d log(time) over the last rungs of the seeds that have them."""
    whole = [ladder[-_SLOPE_RUNGS:] for ladder in ladders if len(ladder) >= _SLOPE_RUNGS]
    times, errors = (
        np.log([[rung[key] for rung in ladder] for ladder in whole]).mean(axis=0)
        for key in ("core_s", "tone")
    )
    off = times - times.mean()
    return float(off @ errors / (off @ off))


def against_mitsuba(view: Mapping[str, Any], method: str) -> dict[str, float]:
    """Return how many times as long Mitsuba takes to an equal tone error, told three ways.

    ``at_least``: to the method's error at the judged time, if Mitsuba's fell as 1/time from there
    on. ``by_slope``: to the same error by the ``slope`` of Mitsuba's last rungs; infinite where
    these hardly fall. ``at_theirs``: to Mitsuba's own error, by the method's ladder; where that is
    below it from the first rung on, it is that rung's time, and the ratio is ``at_theirs_or_more``.
    """
    mine, theirs = judged(view, method), judged(view, MITSUBA)
    steepness = slope(view["ladders"][MITSUBA])
    gain, longer = theirs["tone"] / mine["tone"], theirs["core_s"] / mine["core_s"]
    told = {"slope": steepness, "at_least": longer * gain, "by_slope": float("inf")}
    if steepness < _FLATTEST:
        told["by_slope"] = longer * gain ** (-1.0 / steepness)
    ladder = view["ladders"][method][0]
    times = np.log([rung["core_s"] for rung in ladder])
    errors = np.minimum.accumulate(np.log([rung["tone"] for rung in ladder]))
    goal = float(np.log(theirs["tone"]))
    if goal >= errors[0]:
        return {**told, "at_theirs_or_more": theirs["core_s"] / ladder[0]["core_s"]}
    if goal < errors[-1]:  # not reached
        return {**told, "at_theirs": longer * gain}
    return {**told, "at_theirs": theirs["core_s"] / float(np.exp(np.interp(-goal, -errors, times)))}


def as_markdown(found: Mapping[str, Any]) -> str:
    """Return the results as tables."""
    rows, settings = found["rows"], found["settings"]
    peers = sorted({f"{r['mitsuba']['version']}" for r in rows if "mitsuba" in r})
    lines = [
        "# Lit lamps: methods at equal time",
        "",
        f"Lamplit {found['version']} and Mitsuba {', '.join(peers) or '(none)'}",
        f"on {machine_line(found['machine'])}.",
        "",
        "The lamps of `benchmarks/lit_scene.py`, in the dark, 17.6° off their axis if not said to",
        f"be on it, flat triangles, no dispersion; {settings['seeds']} seeds, programs in turn;",
        "core seconds are the processor's, over all threads. Tone: relative MSE of Y/(Y + mean).",
        "Trim: relative MSE of Y without the worst 0.1 % of the pixels; both with ε = 0.01. Dots:",
        "pixels off by more than ten times. ± is the standard error over seeds. Gains (×) are the",
        "first method's error over this one's.",
        "",
        "| lamp, pixels | program | core s | paths/pixel | tone | trim | dots | tone × | trim × |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        for view in (row["full"], row["half"]):
            lines += _errors_of(row["lamp"], view)
    lines += _beside_mitsuba(rows)
    lines += _agreements(rows)
    return "\n".join([*lines, ""])


def _errors_of(lamp: str, view: Mapping[str, Any]) -> list[str]:
    programs = list(view["ladders"])
    base = judged(view, programs[0])
    lines: list[str] = []
    for name in programs:
        here = judged(view, name)
        gains = [f"{base[key] / here[key]:.1f}" for key in ("tone", "trim")]
        lines.append(
            f"| {lamp}, {view['size'][0]} × {view['size'][1]} | {name} | {here['core_s']:.1f} "
            f"| {here['samples']:.0f} | {here['tone']:.3g} ± {here['tone_sigma']:.1g} "
            f"| {here['trim']:.3g} ± {here['trim_sigma']:.1g} | {here['dots']:.0f} "
            f"| {' | '.join(gains if name != programs[0] else ('', ''))} |"
        )
    return lines


def _beside_mitsuba(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    lines = [
        "",
        "## Time to equal tone error, Mitsuba's over Lamplit's",
        "",
        "At Lamplit's error: at least, if Mitsuba's error fell as 1/time from its longest run on;",
        "and by the slope of its last rungs, tone ∝ time^slope. At Mitsuba's error: Lamplit's time",
        "is read off its own ladder; ≥ where its shortest run is better already.",
        "",
        "| lamp | variant | slope | method | at Lamplit's: least × | by slope × | at Mitsuba's × |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        if "mitsuba" not in row:
            continue
        for name in row["full"]["ladders"]:
            if name != MITSUBA:
                told = against_mitsuba(row["full"], name)
                by_slope = "–" if np.isinf(told["by_slope"]) else f"{told['by_slope']:.3g}"
                theirs = [f"{told[k]:.3g}" for k in ("at_theirs",) if k in told]
                theirs += [f"≥ {told[k]:.3g}" for k in ("at_theirs_or_more",) if k in told]
                lines.append(
                    f"| {row['lamp']} | {row['mitsuba']['variant']} | {told['slope']:.2f} | {name} "
                    f"| {told['at_least']:.3g} | {by_slope} | {theirs[0]} |"
                )
    return lines


def _agreements(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    lines = [
        "",
        "## Agreement",
        "",
        "Flux: mean luminance over the reference's, less 1. Blocks: 10 × 10 pixels brighter than",
        "the mean; the root mean square of z, beside what right pictures of so few seeds would",
        "have (Student's t), and the largest. Where light is rare, σ from few seeds is too small.",
        "",
        "| lamp, pixels | program | flux | its z | rms z of blocks (expected) | largest |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        for view in (row["full"], row["half"]):
            size = f"{view['size'][0]} × {view['size'][1]}"
            for name, one in view["agreement"].items():
                lines.append(f"| {row['lamp']}, {size} | {name} | {_agreed(one)} |")
    lines += [
        "",
        "## The converged pictures",
        "",
        "Means of Lamplit's methods, one weight each; tone and trim are what they themselves still",
        "have, from half the difference of halves. Mitsuba's rough glass loses light that meets",
        "more than one facet (docs/validation.md): there, it is held against the picture times its",
        "scale. Long runs: unscaled, against the weightiest method's.",
        "",
        "| lamp | triangles | weights | parts | scale for Mitsuba | tone | trim |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        told = row["reference"]
        weights = ", ".join(f"{name} {weight:.2f}" for name, weight in told["weights"].items())
        made = ", ".join(f"{name} {one[0]:g} core s" for name, one in told["made"].items())
        own, scale = told["own_errors"], told["scales"].get(MITSUBA, 1.0)
        lines.append(
            f"| {row['lamp']} | {row['triangles']} | {weights} | {made} "
            f"| {scale:.3f} | {own['tone']:.2g} | {own['trim']:.2g} |"
        )
    lines += [
        "",
        "| lamp | long run of | flux | its z | rms z of blocks (expected) | largest |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        for name, one in row["reference"]["long_runs"].items():
            lines.append(f"| {row['lamp']} | {name} | {_agreed(one)} |")
    return lines


def _agreed(one: Mapping[str, float]) -> str:
    expected = one["expected_rms_z"]
    beside = "" if np.isinf(expected) else f" ({expected:.2f})"
    return (
        f"{one['flux']:+.2%} ± {one['flux_sigma']:.2%} | {one['flux_z']:+.1f} "
        f"| {one['rms_z']:.2f}{beside} | {one['largest_z']:.1f}"
    )


def draw(found: Mapping[str, Any], path: Path) -> None:
    """Draw the tone error against time for all programs, log–log."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot, ticker

    rows = found["rows"]
    figure, axes = pyplot.subplots(
        1, len(rows), figsize=(3.4 * len(rows), 3.4), sharey=True, squeeze=False
    )
    for panel, row in zip(axes[0], rows, strict=True):
        for name, ladders in row["full"]["ladders"].items():
            for seed, ladder in enumerate(ladders):
                panel.loglog(
                    [rung["core_s"] for rung in ladder],
                    [rung["tone"] for rung in ladder],
                    color=_COLOURS.get(name, "0.4"),
                    marker=".",
                    linewidth=1,
                    label=name if seed == 0 else None,
                )
        panel.set(title=row["lamp"], xlabel="core seconds")
        panel.xaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        panel.xaxis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
        panel.xaxis.set_minor_formatter(ticker.NullFormatter())
        panel.grid(which="both", linewidth=0.3)
    axes[0, 0].set_ylabel("tone: relative MSE of Y/(Y + mean)")
    axes[0, 0].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    pyplot.close(figure)
