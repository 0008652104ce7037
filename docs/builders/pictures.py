# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The pictures of the pages, rendered anew."""

from __future__ import annotations

import runpy
import shutil
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image as Raster

import lamplit as ll
from builders.failures import Outcome, draw_failures
from builders.views import draw_views
from lamplit.colour.display import Display
from lamplit.lamps import write_lamp
from lamplit.materials import material
from lamplit.materials.plot import plot_transmittance
from lamplit.report.develop import develop
from lamplit.report.png import write_png
from lamplit.report.progress import Progress
from lamplit.report.provenance import text_provenance
from lamplit.report.sheet import Sheet, show_pixels
from lamplit.spectrum import Array

_DEMO = Path("out/demo")
_LAMPS = ("paper", "led-array", "retro")
_LAMP_SIZE = {"image.width": 480, "image.height": 300, "image.samples": 9}
_PLASTICS = ("red-pmma", "amber-pmma")


def draw_pictures(images: Path, outcomes: list[Outcome]) -> None:
    """Write every picture of the pages into ``images``."""
    draw_failures(outcomes, images / "rgb-against-spectral.png")
    for name in _PLASTICS:
        plot_transmittance(material(name), images / f"{name}.png", name=name)
    runpy.run_path("examples/demo.py", run_name="__main__")
    shutil.copyfile(_DEMO / "spectral.png", images / "p21w.png")
    _draw_demo_comparison(images / "p21w-rgb-against-spectral.png")
    draw_views(images / "views.png", images / "false-colour.png")
    for name in _LAMPS:
        _draw_lamp(name, images / f"{name}.png")


def _draw_lamp(name: str, path: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        scene = ll.load_scene(write_lamp(name, folder), overrides=_LAMP_SIZE)
        with Progress(name) as progress:
            image = ll.render(scene, progress=progress)
        shown = develop(image)
        write_png(path, shown.picture.encoded, shown.display, provenance=text_provenance(image))


def _draw_demo_comparison(path: Path) -> None:
    """Lay the demo's two pictures and their difference in one row."""
    width, height, gap = 420, 262, 12
    sheet = Sheet(3 * width + 4 * gap, height + 48 + gap, unit=1.0)
    parts = (
        ("RGB", "three numbers", "rgb.png"),
        ("Spectral", "every wavelength", "spectral.png"),
        ("ΔE₀₀", "where they differ", "difference.png"),
    )
    for at, (name, explanation, file) in enumerate(parts):
        left = gap + at * (width + gap)
        sheet.title(left, 48, name, explanation)
        pixels = _pixels(_DEMO / file)
        rows = round(pixels.shape[1] * height / width)
        show_pixels(sheet.axes(left, 48, width, height), pixels[:rows], (width, height))
    write_png(path, sheet.pixels(), Display.named("srgb"))


def _pixels(path: Path) -> Array:
    with Raster.open(path) as picture:
        return np.asarray(picture.convert("RGB"), dtype=np.float64) / 255.0
