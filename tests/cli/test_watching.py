# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit render`` shows the picture in the making, and says how certain it is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image as Pillow

from lamplit import engine
from lamplit.engine import Snapshot

if TYPE_CHECKING:
    from tests.cli.conftest import Painter

Run = Callable[..., int]


@pytest.fixture
def seen(painter: Painter, monkeypatch: pytest.MonkeyPatch, scene_file: Path) -> list[Any]:
    """Let the painter show its picture once before it is done; return what lies there then."""
    paint = painter.render
    found: list[Any] = []

    def render(scene: Any, **options: Any) -> engine.Image:
        picture = painter.paint(scene, "spectral")
        shape = picture.xyz.shape[:2]
        outlook = (0.5, np.full(shape, 0.5))
        options["preview"](
            Snapshot(scene, picture.xyz, 0.08 * picture.xyz, 4 * picture.xyz.size, outlook)
        )
        options["progress"](80, 160)
        for path in (scene_file.parent / "out").iterdir():
            with Pillow.open(path) as shown:
                found.append((path.name, shown.size))
        return paint(scene, **options)

    monkeypatch.setattr(engine, "render", render)
    return found


def test_the_preview_is_there_while_the_picture_is_made_and_gone_when_it_is(
    lamplit: Run, seen: list[Any], scene_file: Path
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out) == 0
    assert seen == [("preview.png", (16, 10))]
    assert {path.name for path in out.iterdir()} == {"picture.png", "picture.exr", "summary.json"}


def test_the_preview_goes_too_when_the_render_fails_or_is_stopped(
    lamplit: Run, seen: list[Any], painter: Painter, scene_file: Path
) -> None:
    out = scene_file.parent / "out"
    painter.fault = MemoryError()
    assert lamplit("render", scene_file, "-o", out) == 1
    painter.fault, painter.samples_before_stop = None, 0
    assert lamplit("render", scene_file, "-o", out) == 130
    assert len(seen) == 2
    assert not list(out.iterdir())


def test_the_error_is_told_while_the_picture_is_made(
    lamplit: Run, seen: list[Any], scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--error", 0.05) == 0
    # Of 20 to 200 cd/m² the floor of 1 % of the mean takes little: 8 % stay nearly 8 %.
    told = capsys.readouterr().err
    assert "error 7.9 % (about 3.9 % at the end, 5 % is asked)" in told


def test_a_directory_in_the_place_of_the_preview_is_refused(
    lamplit: Run, painter: Painter, scene_file: Path
) -> None:
    out = scene_file.parent / "out"
    (out / "preview.png").mkdir(parents=True)
    assert lamplit("render", scene_file, "-o", out) == 2
    assert painter.calls == []
