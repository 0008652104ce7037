# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The preview is a whole picture each time, and is gone at the end."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Pillow

from lamplit.engine import Snapshot
from lamplit.report.preview import PreviewFile

MakeImage = Callable[..., Any]


def snapshot_of(image: Any, xyz: np.ndarray) -> Snapshot:
    return Snapshot(image.scene, xyz, np.full_like(xyz, np.inf), 1)


def codes(path: Path) -> np.ndarray:
    with Pillow.open(path) as picture:
        return np.asarray(picture)


def test_the_preview_is_replaced_each_time_and_goes_at_the_end(
    tmp_path: Path, make_image: MakeImage
) -> None:
    image = make_image()
    with PreviewFile(tmp_path) as preview:
        assert not list(tmp_path.iterdir())
        preview.show(snapshot_of(image, np.full((4, 6, 3), 10.0)))
        dark = codes(tmp_path / "preview.png")
        preview.show(snapshot_of(image, np.full((4, 6, 3), 500.0)))
        assert codes(tmp_path / "preview.png").mean() > dark.mean() > 0.0
        assert [path.name for path in tmp_path.iterdir()] == ["preview.png"]
    assert not list(tmp_path.iterdir())


def test_a_large_picture_is_shown_by_the_means_of_its_blocks(
    tmp_path: Path, make_image: MakeImage, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 4 × 6 pixels at most 6 are shown: blocks of 2 × 2, each half dark and half bright."""
    monkeypatch.setattr("lamplit.report.preview._MOST_PIXELS", 6)
    image = make_image()
    chequered = 400.0 * (np.indices((4, 6)).sum(axis=0) % 2)[..., None] * np.ones(3)
    with PreviewFile(tmp_path) as preview:
        preview.show(snapshot_of(image, np.full((2, 3, 3), 200.0)))
        even = codes(tmp_path / "preview.png")
        preview.show(snapshot_of(image, chequered))
        np.testing.assert_array_equal(codes(tmp_path / "preview.png"), even)


def test_a_preview_that_cannot_be_written_holds_up_nothing(
    tmp_path: Path, make_image: MakeImage
) -> None:
    with PreviewFile(tmp_path / "gone") as preview:
        preview.show(snapshot_of(make_image(), np.full((4, 6, 3), 10.0)))
        preview.show(snapshot_of(make_image(), np.full((4, 6, 3), 10.0)))
    assert not list(tmp_path.iterdir())
