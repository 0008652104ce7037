# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The pictures of a material, and the command that draws and lists."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lamplit.cli import main
from lamplit.errors import OutputError, SceneError
from lamplit.materials import material, material_names
from lamplit.materials.plot import plot_reflectance, plot_transmittance


def test_a_red_plastic_is_drawn_in_red(tmp_path: Path) -> None:
    path = tmp_path / "red.png"
    plot_transmittance(material("red-pmma"), path, name="red-pmma")
    with Image.open(path) as picture:
        pixels = np.asarray(picture.convert("RGB"), dtype=float)
    assert pixels.shape == (990, 1590, 3)
    red = (pixels[..., 0] > 100) & (pixels[..., 1] < 40) & (pixels[..., 2] < 40)
    assert 0.02 < red.mean() < 0.2
    assert [path] == list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", ["svg", "pdf"])
def test_a_vector_file_is_drawn_by_its_suffix(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"bezel.{suffix}"
    plot_reflectance(material("aluminium-bezel"), path, name="aluminium-bezel")
    assert path.read_bytes()[:5] in (b"<?xml", b"%PDF-")


def test_an_opaque_material_has_no_transmittance_to_draw(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="conductor lets no light through"):
        plot_transmittance(material("aluminium"), tmp_path / "x.png")


@pytest.mark.parametrize("thicknesses_mm", [(), (0.0,), (-1.0,), (float("nan"),), (float("inf"),)])
def test_a_plate_has_a_positive_thickness(
    tmp_path: Path, thicknesses_mm: tuple[float, ...]
) -> None:
    with pytest.raises(SceneError, match="positive numbers of mm"):
        plot_transmittance(material("bk7"), tmp_path / "x.png", thicknesses_mm)


def test_a_plot_that_cannot_be_written_says_so(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"nowhere/x\.png: cannot be written"):
        plot_reflectance(material("grey-18"), tmp_path / "nowhere" / "x.png")
    with pytest.raises(OutputError, match=r"\.png, \.svg or \.pdf"):
        plot_reflectance(material("grey-18"), tmp_path / "x.jpeg")


def test_the_command_lists_every_material(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["materials"]) == 0
    listed = capsys.readouterr().out
    assert all(f"{name} " in listed for name in material_names())


def test_the_command_tells_numbers_references_and_licence(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    assert main(["materials", "red-pmma"]) == 0
    card = capsys.readouterr().out
    for said in ("1.4925", "59.4", "xy 0.693, 0.307", "10.1364/AO.54.00F139", "CC0"):
        assert said in card


def test_the_command_draws_the_chosen_thicknesses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "smoke.svg"
    arguments = ["smoke-pmma", "--plot", str(path), "--thicknesses-mm", "2.5,4"]
    assert main(["materials", *arguments]) == 0
    assert str(path) in capsys.readouterr().out
    assert path.is_file()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["red-pma"], "did you mean 'red-pmma'"),
        (["--plot", "x.png"], "--plot draws one material"),
        (["bk7", "--plot", "x.png", "--thicknesses-mm", "1,b"], "is not a list of numbers"),
        (["bk7", "--plot", "nowhere/x.png"], "cannot be written"),
    ],
)
def test_what_the_command_cannot_do_is_one_line_and_exit_code_2(
    arguments: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["materials", *arguments]) == 2
    printed = capsys.readouterr()
    assert said in printed.err
    assert printed.err.count("\n") == 1
    assert printed.out == ""
