# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The library of light sources."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lamplit.cli.sources import sources as sources_command
from lamplit.colour.tristimulus import chromaticity_xy, luminous_efficacy, tristimulus
from lamplit.errors import LamplitError, OutputError, SpectrumError
from lamplit.report.source_plot import plot_source
from lamplit.sources import bulb, bulb_names, source, source_names

NM = np.arange(380.0, 781.0)


@pytest.mark.parametrize("name", source_names())
def test_every_source_emits_and_says_where_it_comes_from(name: str) -> None:
    entry = source(name)
    power = entry.distribution()(NM)
    assert (power >= 0).all()
    assert power.max() > 0
    assert entry.name == name
    for text in (entry.description, entry.reference, entry.licence):
        assert len(text) > 8


@pytest.mark.parametrize("name", [n for n in source_names() if n[0] in "ADEFHL" and n != "A"])
def test_the_cies_illuminants_are_those_of_colour_science(name: str) -> None:
    import colour

    table = colour.SDS_ILLUMINANTS[name]
    np.testing.assert_allclose(source(name).distribution()(table.wavelengths), table.values)


def test_illuminant_a_is_its_formula_and_so_its_printed_table() -> None:
    """ISO/CIE 11664-2:2022, table 1: A at 380, 450, 560, 600, 700, 780 nm."""
    printed = [9.79510, 33.0859, 100.0, 129.043, 198.261, 241.675]
    values = source("A").distribution()([380, 450, 560, 600, 700, 780])
    np.testing.assert_allclose(values, printed, rtol=5e-6)


def test_the_filament_is_illuminant_a_within_a_thousandth() -> None:
    filament, a = source("p21w-filament").distribution(), source("A").distribution()
    np.testing.assert_allclose(filament(NM) / filament(560.0), a(NM) / 100.0, rtol=1e-3)


@pytest.mark.parametrize(
    ("name", "xy", "lumen_per_watt"),
    [
        ("red-led-624", (0.689, 0.311), 233),
        ("red-led-645", (0.717, 0.284), 103),
        ("amber-led-593", (0.586, 0.414), 489),
    ],
)
def test_led_models_have_the_colour_and_efficacy_computed_elsewhere(
    name: str, xy: tuple[float, float], lumen_per_watt: float
) -> None:
    """Figures of FACTS §3, from colour-science's own Ohno model."""
    spd = source(name).distribution()
    np.testing.assert_allclose(chromaticity_xy(tristimulus(spd)), xy, atol=6e-4)
    assert luminous_efficacy(spd) == pytest.approx(lumen_per_watt, abs=0.6)


def test_the_phosphor_models_meet_the_chromaticities_that_they_claim() -> None:
    amber = chromaticity_xy(tristimulus(source("pc-amber-led").distribution()))
    white = chromaticity_xy(tristimulus(source("white-led").distribution()))
    np.testing.assert_allclose(amber, (0.589, 0.406), atol=3e-3)
    np.testing.assert_allclose(white, (0.3217, 0.3378), atol=5e-4)


def test_the_phosphor_amber_is_97_nm_wide() -> None:
    nm = np.arange(500.0, 800.0, 0.1)
    above = nm[source("pc-amber-led").distribution()(nm) >= 0.5]
    assert above[-1] - above[0] == pytest.approx(97.0, abs=0.2)


@pytest.mark.parametrize("wrong", ["d65", "D-65", "red-led-642", "LED-B6"])
def test_an_unknown_source_is_named_with_the_nearest(wrong: str) -> None:
    with pytest.raises(SpectrumError, match=rf"'{wrong}'; did you mean '.+'"):
        source(wrong)


def test_listing_names_does_not_read_the_tables() -> None:
    script = (
        "import sys, lamplit.sources as s, lamplit.spectra_spec; s.source('D65'); s.source_names();"
        "sys.exit('colour' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_the_command_lists_every_source(capsys: pytest.CaptureFixture[str]) -> None:
    sources_command()
    shown = capsys.readouterr().out
    assert all(name in shown for name in source_names())


def test_the_command_tells_reference_and_licence(capsys: pytest.CaptureFixture[str]) -> None:
    sources_command("red-led-624")
    shown = capsys.readouterr().out
    assert "0.6886, 0.3112" in shown
    assert "Ohno" in shown
    assert "Apache-2.0" in shown


def test_the_command_draws_a_source(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sources_command("red-led-624", tmp_path / "led.png")
    assert (tmp_path / "led.png").read_bytes().startswith(b"\x89PNG")
    assert "led.png" in capsys.readouterr().out.replace("\n", "")


def test_a_plot_needs_a_source_and_a_place_to_go(tmp_path: Path) -> None:
    with pytest.raises(LamplitError, match="name it"):
        sources_command(None, tmp_path / "led.png")
    for path in (tmp_path / "absent" / "led.png", tmp_path / "led.unknown"):
        with pytest.raises(OutputError, match="cannot be written"):
            plot_source(source("A"), path)


#: Lamp, luminous flux in lm, tolerance: FACTS §3, from the sheets of UN R37 at 13.5 V.
BULBS = {
    "p21w": (460.0, 0.15),
    "p21-5w-bright": (440.0, 0.15),
    "p21-5w-dim": (35.0, 0.2),
    "py21w": (280.0, 0.2),
    "py21-5w-bright": (270.0, 0.2),
    "py21-5w-dim": (21.0, 0.2),
    "w5w": (50.0, 0.2),
}


def test_bulbs_have_the_flux_of_their_sheets_and_say_how_far_to_trust_it() -> None:
    assert set(bulb_names()) == set(BULBS)
    for name, (flux_lm, tolerance) in BULBS.items():
        entry = bulb(name)
        assert (entry.name, entry.flux_lm, entry.tolerance) == (name, flux_lm, tolerance)
        assert entry.test_voltage_v == 13.5
        assert re.search(r"flux (and tolerance )?V2?\b", entry.reference)


def test_the_command_tells_a_bulb(capsys: pytest.CaptureFixture[str]) -> None:
    sources_command("p21-5w-dim")
    shown = " ".join(capsys.readouterr().out.split())
    assert "35 lm ± 20 %" in shown
    assert 'bulb = "p21-5w-dim"' in shown
    sources_command()
    assert "w5w 50 lm" in capsys.readouterr().out
