# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The errors that the bench of lit lamps tells are those of its definitions, by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
#: 40 × 50 pixels of luminance 100 cd/m².
EVEN = np.full((40, 50, 3), 100.0)


@pytest.fixture
def errors(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    return pytest.importorskip("lit_errors")


def with_dots(count: int, luminance: float) -> np.ndarray:
    picture = EVEN.copy()
    picture.reshape(-1, 3)[:count] = luminance
    return picture


def test_the_tone_error_of_one_dot_does_not_depend_on_how_bright_it_is(errors: Any) -> None:
    """T₀ = 1/2 everywhere; a dot of 10⁶ or 10⁹ has T = 1: (1/2)²/(1/4 + 0.01) over 2000 pixels."""
    by_hand = 0.25 / 0.26 / 2000
    assert errors.tone(with_dots(1, 1e9), EVEN) == pytest.approx(by_hand, rel=1e-6)
    assert errors.tone(with_dots(1, 1e6), EVEN) == pytest.approx(by_hand, rel=1e-3)
    assert errors.tone(EVEN, EVEN) == 0.0


def test_a_thousandth_of_the_pixels_does_not_count_in_the_trimmed_error(errors: Any) -> None:
    """Two of 2000 are left out; the third dot of 300 adds (3 − 1)²/(1 + 0.01) over 1998 pixels."""
    assert errors.trim(with_dots(2, 1e9), EVEN) == 0.0
    assert errors.trim(with_dots(3, 300.0), EVEN) == pytest.approx(4.0 / 1.01 / 1998)


def test_dots_are_pixels_off_by_more_than_ten_times_either_way(errors: Any) -> None:
    """With 1 % of the mean added on both sides, 10.1 times is 1009 and a tenth is 9.1 cd/m²."""
    assert errors.dots(with_dots(7, 1010.0), EVEN) == 7
    assert errors.dots(with_dots(7, 1008.0), EVEN) == 0
    assert errors.dots(with_dots(7, 9.0), EVEN) == 7
    assert errors.dots(with_dots(7, 9.2), EVEN) == 0


def test_a_halved_picture_has_the_mean_of_four_pixels_in_each(errors: Any) -> None:
    luminance = np.arange(16.0).reshape(4, 4)
    halved = errors.halved(np.stack([luminance] * 3, axis=-1))[..., 1]
    assert halved.tolist() == [[2.5, 4.5], [10.5, 12.5]]


def test_right_pictures_agree_and_wrong_ones_do_not(errors: Any) -> None:
    """Noise of 20 % per pixel in eight pictures: a block's mean has 0.7 %, so 3 % stands out."""
    noise = np.random.default_rng(5)
    pictures = EVEN * noise.normal(1.0, 0.2, (8, 40, 50, 1))
    brighter_left = np.concatenate([1.2 * EVEN[:, :25], EVEN[:, 25:]], axis=1)
    known = errors.Estimate.of(np.stack([brighter_left, brighter_left]))
    right = errors.Estimate.of(pictures * brighter_left / EVEN).against(known)
    assert abs(right["flux_z"]) < 4.0
    assert right["rms_z"] < 2.5
    wrong = errors.Estimate.of(1.03 * pictures * brighter_left / EVEN).against(known)
    assert wrong["flux"] == pytest.approx(0.03, abs=0.01)
    assert wrong["flux_z"] > 4.0
    assert wrong["rms_z"] > 2.5
