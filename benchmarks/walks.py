# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What splitting, roulette and allotted samples bring: error against rays, the same on any machine.

The figure of merit is relMSE × rays per pixel: the lower, the fewer rays for the same error. Rays
are counted, not timed, so that the table does not depend on how busy the machine is. Each error
comes from four renders with different seeds. Writes ``walks.json`` and ``walks.md``:

    python benchmarks/run.py --parts walks
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from comparison_scenes import Light, unlit_lamp
from errors import dark_scale

import lamplit as ll
from lamplit.engine import render
from lamplit.scene.methods import PathSettings

SIZE = {"width": 160, "height": 80}
SCENES: tuple[tuple[str, Light], ...] = (
    ("p21w", "surround"),
    ("p21w", "studio"),
    ("led-array", "surround"),
    ("led-array", "studio"),
)
SEEDS = (11, 12, 13, 14)
#: (split_depth, roulette_below, samples, adaptive); the default settings stand first.
VARIANTS = (
    (2, 3e-3, 16, True),
    (0, 3e-3, 16, True),
    (1, 3e-3, 16, True),
    (3, 3e-3, 16, True),
    (5, 3e-3, 16, True),
    (2, 5e-2, 16, True),
    (2, 1e-2, 16, True),
    (2, 1e-3, 16, True),
    (2, 3e-3, 16, False),
    (2, 3e-3, 64, True),
    (2, 3e-3, 64, False),
)


def measure(results: Path) -> None:
    """Measure every variant on every scene and write the table into the folder ``results``."""
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory(prefix="lamplit-bench-") as folder:
        for lamp, light in SCENES:
            scene = unlit_lamp(lamp, Path(folder), triangles=150_000, light=light)
            scene = scene.changed(image=scene.image.model_copy(update=SIZE))
            for split, roulette, samples, adaptive in VARIANTS:
                settings = PathSettings(split_depth=split, roulette_below=roulette)
                found = _cost(scene.changed(path_settings=settings), samples, adaptive=adaptive)
                rows.append(
                    {
                        "scene": f"{lamp}, {light}",
                        "split_depth": split,
                        "roulette_below": roulette,
                        "samples": samples,
                        "adaptive": adaptive,
                        **found,
                    }
                )
    (results / "walks.json").write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    page = _as_markdown(rows)
    (results / "walks.md").write_text(page, encoding="utf-8")
    print(page)


def _cost(scene: ll.Scene, samples: int, *, adaptive: bool) -> dict[str, float]:
    pictures = [
        render(
            scene.changed(image=scene.image.model_copy(update={"seed": seed})),
            method="path",
            samples=samples,
            adaptive=adaptive,
        )
        for seed in SEEDS
    ]
    mean = np.mean([picture.xyz for picture in pictures], axis=0)
    luminance = np.array([picture.xyz[..., 1] for picture in pictures])
    error = float((luminance.var(axis=0, ddof=1) / dark_scale(mean) ** 2).mean())
    rays = float(np.mean([picture.statistics["eye_rays"] for picture in pictures]))
    rays /= luminance[0].size
    return {"relative_mse": error, "rays_per_pixel": rays, "product": error * rays}


def _as_markdown(rows: list[dict[str, Any]]) -> str:
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    lines = [
        "# relMSE × rays per pixel",
        "",
        "Lower is better; in brackets relative to the first line, the default settings.",
        "",
        "| split_depth | roulette_below | samples | " + " | ".join(scenes) + " |",
        "|---" * (3 + len(scenes)) + "|",
    ]
    base = {row["scene"]: row["product"] for row in reversed(rows)}
    variants = dict.fromkeys(_variant(row) for row in rows)
    for variant in variants:
        cells = [
            f"{row['product']:.3g} ({row['product'] / base[row['scene']]:.2f})"
            for row in rows
            if _variant(row) == variant
        ]
        split, roulette, samples, adaptive = variant
        allotted = ", allotted" if adaptive else ""
        lines.append(f"| {split} | {roulette:g} | {samples}{allotted} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _variant(row: Mapping[str, Any]) -> tuple[int, float, int, bool]:
    return (row["split_depth"], row["roulette_below"], row["samples"], row["adaptive"])
