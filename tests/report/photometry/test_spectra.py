# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Measured spectra are shown no finer than their hits allow."""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.report.photometry.measured import in_bands
from lamplit.report.photometry.results import Spectrum
from lamplit.report.photometry.spectra import draw_spectra

NM = 380.0 + 5.0 * (np.arange(80) + 0.5)
LED = np.exp(-0.5 * ((NM - 620.0) / 20.0) ** 2)


def seen(values: np.ndarray, *, hits: float) -> Spectrum | None:
    """Show ``values`` (n,) without scatter, or those of batches (b, n)."""
    batches = np.tile(values, (4, 1)) if values.ndim == 1 else values
    return in_bands(Spectrum("light", NM, np.empty(0), "W/nm"), batches, hits)


@pytest.mark.parametrize(
    ("hits", "band_nm"), [(2500, 5.0), (2300, 25.0), (490, 25.0), (470, 50.0), (125, 100.0)]
)
def test_bands_widen_until_each_has_thirty_hits(hits: float, band_nm: float) -> None:
    found = seen(LED, hits=hits)
    assert found is not None
    assert found.band_nm == band_nm
    # The power stays: Σ values · width.
    assert found.values.sum() * band_nm == pytest.approx(LED.sum() * 5.0)
    assert np.diff(found.wavelengths_nm) == pytest.approx(band_nm)


def test_a_handful_of_hits_has_no_spectrum() -> None:
    assert seen(LED, hits=110) is None


def test_the_dips_of_few_paths_do_not_look_like_physics() -> None:
    """Hits that each fill one band of 5 nm, by their Poisson counts: one peak must stay."""
    random = np.random.default_rng(2)
    batches = random.poisson(1000 * LED / LED.sum() / 32, (32, 80)).astype(float)
    ragged = batches.mean(axis=0)
    ups = np.sign(np.diff(ragged[ragged > 0]))
    assert np.count_nonzero(np.diff(ups)) > 1
    found = seen(batches, hits=1000)
    assert found is not None
    rises = np.sign(np.diff(found.values))
    assert np.count_nonzero(np.diff(rises[rises != 0])) == 1


def test_the_standard_error_of_a_band_is_that_of_its_batches() -> None:
    """Two batches of 0.9 and 1.1 of a light: s = 0.1 √2, and σ of the mean is 0.1."""
    found = seen(np.stack([0.9 * LED, 1.1 * LED]), hits=490)
    assert found is not None
    assert found.band_nm == 25.0
    assert found.values == pytest.approx(LED.reshape(-1, 5).mean(axis=1))
    assert found.standard_error == pytest.approx(0.1 * found.values)


def test_bands_widen_until_a_stray_hit_is_no_line() -> None:
    """One of 32 batches has a strong hit at 722.5 nm: over 5 nm it would be a peak of its own."""
    batches = np.tile(LED, (32, 1))
    batches[3, 68] += 32.0
    found = seen(batches, hits=1e6)
    assert found is not None
    assert found.standard_error is not None
    assert found.band_nm == 50.0
    assert np.argmax(found.values) == np.argmax(LED.reshape(-1, 10).mean(axis=1))


def test_measured_spectra_are_drawn_as_steps_and_sources_as_lines() -> None:
    measured = seen(LED, hits=490)
    assert measured is not None
    figure = draw_spectra([measured, Spectrum("source", NM, LED, "")], title="spectra")
    assert figure is not None
    lines = figure.axes[0].get_lines()
    assert [line.get_drawstyle() for line in lines] == ["steps-post", "default"]
    assert lines[0].get_xdata()[[0, -1]] == pytest.approx([380.0, 780.0])
    assert "bands of 25 nm" in str(lines[0].get_label())
    (spread,) = figure.axes[0].collections
    assert spread.get_label() != lines[0].get_label()
