# SPDX-License-Identifier: Apache-2.0 OR MIT
"""One lit lamp, developed in four ways: the figure of docs/picture.md."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import lamplit as ll
from lamplit.colour.display import Display
from lamplit.lamps import write_lamp
from lamplit.report.develop import automatic_exposure, develop_xyz, eye_glare
from lamplit.report.false_colour import draw_false_colour
from lamplit.report.png import write_png
from lamplit.report.progress import Progress
from lamplit.report.sheet import Sheet, show_pixels
from lamplit.report.view import View

_SIZE = {"image.width": 420, "image.height": 262, "image.samples": 400}
_GAP, _HEAD = 12, 48


def draw_views(path: Path) -> None:
    """Draw a lit lamp: linear, with the photographic tone, with glare, and in false colours."""
    with tempfile.TemporaryDirectory() as folder:
        scene = ll.load_scene(write_lamp("p21w", folder, {"lit": "true"}), overrides=_SIZE)
        with Progress("views") as progress:
            image = ll.render(scene, progress=progress)
    view = View.of(scene)
    toned = replace(view, settings=view.settings.model_copy(update={"tone": "photographic"}))
    exposure = automatic_exposure(image.xyz, view)
    glare = eye_glare(image.xyz, view)
    page, _ = draw_false_colour(image.luminance_cd_m2)
    shown = (
        ("Linear", "600 cd/m² is white", develop_xyz(image.xyz, view).picture.encoded),
        ("Photographic", "all fits the display", develop_xyz(image.xyz, toned).picture.encoded),
        (
            "Glare",
            "linear, an eye of 35",
            develop_xyz(glare.xyz, view, exposure=exposure).picture.encoded,
        ),
    )
    width, height = _SIZE["image.width"], _SIZE["image.height"]
    rows, columns = page.shape[:2]
    sheet = Sheet(2 * width + 3 * _GAP, 2 * (height + _HEAD) + _GAP, unit=1.0)
    for at, (name, explanation, pixels) in enumerate(shown):
        left, top = _GAP + at % 2 * (width + _GAP), _HEAD + at // 2 * (height + _HEAD)
        sheet.title(left, top, name, explanation)
        show_pixels(sheet.axes(left, top, width, height), pixels, (width, height))
    left, top = 2 * _GAP + width, height + _HEAD
    tall = height + _HEAD
    wide = min(width, round(tall * columns / rows))
    size = (wide, round(wide * rows / columns))
    show_pixels(sheet.axes(left, top, *size), page, size)
    write_png(path, sheet.pixels(), Display.named("srgb"))
