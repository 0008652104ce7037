# SPDX-License-Identifier: Apache-2.0 OR MIT
"""One lit lamp, looked at in four ways: the figures of docs/picture.md."""

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

_WIDTH, _HEIGHT, _SAMPLES = 420, 262, 400
_GAP, _HEAD = 12, 48


def draw_views(views: Path, false_colour: Path) -> None:
    """Draw a lit lamp: linear, with the photographic tone, with glare; and in false colours."""
    size = {"image.width": _WIDTH, "image.height": _HEIGHT, "image.samples": _SAMPLES}
    with tempfile.TemporaryDirectory() as folder:
        scene = ll.load_scene(write_lamp("p21w", folder, {"lit": "true"}), overrides=size)
        with Progress("views") as progress:
            image = ll.render(scene, progress=progress)
    view = View.of(scene)
    toned = replace(view, settings=view.settings.model_copy(update={"tone": "photographic"}))
    exposure = automatic_exposure(image.xyz, view)
    glare = eye_glare(image.xyz, view)
    shown = (
        ("Linear", "600 cd/m² is white", develop_xyz(image.xyz, view)),
        ("Photographic", "the same white", develop_xyz(image.xyz, toned)),
        ("Glare", "linear, an eye of 35", develop_xyz(glare.xyz, view, exposure=exposure)),
    )
    sheet = Sheet(3 * _WIDTH + 4 * _GAP, _HEIGHT + _HEAD + _GAP, unit=1.0)
    for at, (name, explanation, developed) in enumerate(shown):
        left = _GAP + at * (_WIDTH + _GAP)
        sheet.title(left, _HEAD, name, explanation)
        axes = sheet.axes(left, _HEAD, _WIDTH, _HEIGHT)
        show_pixels(axes, developed.picture.encoded, (_WIDTH, _HEIGHT))
    write_png(views, sheet.pixels(), Display.named("srgb"))
    page, _ = draw_false_colour(image.luminance_cd_m2)
    write_png(false_colour, page, Display.named("srgb"))
