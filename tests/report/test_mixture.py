# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Layers come back from their file, and their sums are what was asked for."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lamplit.engine.image import Image
from lamplit.errors import LamplitError, OutputError
from lamplit.report.develop import develop
from lamplit.report.exr import write_exr
from lamplit.report.exr_file import read_exr, save_exr
from lamplit.report.layers import Layers, read_layers, write_layers
from lamplit.report.mixture import mix, mixture_files, write_mixture
from lamplit.scene.camera import CustomDisplay, IccDisplay

MakeImage = Callable[..., Image]


@pytest.fixture
def layers(tmp_path: Path, layered_image: MakeImage) -> Layers:
    """Return the layers of an image as they come back from their file."""
    write_layers(tmp_path / "layers.exr", layered_image())
    return read_layers(tmp_path / "layers.exr")


def test_layers_come_back_as_their_exact_float32(layers: Layers, layered_image: MakeImage) -> None:
    image = layered_image()
    assert list(layers.xyz) == ["background", "tail lamp"]
    for name, xyz in image.layers.items():
        assert np.array_equal(layers.xyz[name], xyz.astype(np.float32))
        error = image.layers_standard_error[name].astype(np.float32)
        assert np.array_equal(layers.standard_error[name], error)
    assert layers.render["seed"] == 1
    assert layers.render["complete"] is True
    assert layers.render["scene_hash"] == image.scene.scene_hash


def test_the_file_names_its_channels_by_group_and_their_unit(
    tmp_path: Path, layers: Layers
) -> None:
    read = read_exr(tmp_path / "layers.exr")
    parts = [f"{error}{axis}" for error in ("", "standard_error.") for axis in "XYZ"]
    groups = ("background", "tail lamp")
    assert set(read.channels) == {f"{group}.{part}" for group in groups for part in parts}
    assert {channel.dtype for channel in read.channels.values()} == {np.dtype(np.float32)}
    assert "cd/m2" in read.attributes["lamplit.units"]


def test_a_mixture_of_all_is_the_picture(
    tmp_path: Path, layers: Layers, layered_image: MakeImage
) -> None:
    image = layered_image()
    write_exr(tmp_path / "whole.exr", image, develop(image))
    numbers = write_mixture(mix(layers, {}), tmp_path, command="lamplit mix", version="0.1.0")
    whole, mixed = (read_exr(tmp_path / name) for name in ("whole.exr", "picture.exr"))
    np.testing.assert_allclose(mixed.xyz, whole.xyz, rtol=1e-6)
    np.testing.assert_allclose(mixed.vectors("", "RGB"), whole.vectors("", "RGB"), atol=1e-6)
    assert mixed.attributes["whiteLuminance"] == whole.attributes["whiteLuminance"]
    assert numbers["weights"] == {"background": 1.0, "tail lamp": 1.0}


def test_half_a_lamp_is_half_its_light_and_errors_add_up_at_most(layers: Layers) -> None:
    half = mix(layers, {"tail lamp": 0.5})
    expected = layers.xyz["background"] + 0.5 * layers.xyz["tail lamp"]
    np.testing.assert_array_equal(half.xyz, expected)
    np.testing.assert_allclose(half.standard_error_bound, 0.2 + 0.5 * 0.15, rtol=1e-6)
    off = mix(layers, {"background": 0.0, "tail lamp": 2.0})
    np.testing.assert_array_equal(off.xyz, 2.0 * layers.xyz["tail lamp"])


def test_a_mixture_is_written_with_its_weights_and_its_render(
    tmp_path: Path, layers: Layers
) -> None:
    out = tmp_path / "mix"
    out.mkdir()
    write_mixture(mix(layers, {"background": 0.25}), out, command="lamplit mix d", version="9")
    assert {path.name for path in out.iterdir()} == set(mixture_files(layers.view.settings))
    numbers = json.loads((out / "summary.json").read_text())
    assert numbers["weights"] == {"background": 0.25, "tail lamp": 1.0}
    assert numbers["command"] == "lamplit mix d"
    assert numbers["render"]["command"] == "lamplit render scene.toml -o out"
    luminance = numbers["luminance_cd_m2"]
    mean = 0.25 * layers.xyz["background"][..., 1] + layers.xyz["tail lamp"][..., 1]
    assert luminance["mean"] == pytest.approx(mean.mean())
    bound = (0.25 * 0.2 + 0.15) / np.sqrt(mean.size)
    assert luminance["mean_standard_error_bound"] == pytest.approx(bound)
    header = read_exr(out / "picture.exr").attributes
    assert "upper bound" in header["lamplit.units"]
    assert json.loads(header["lamplit.weights"])["background"] == 0.25


@pytest.mark.parametrize(
    ("weights", "told"),
    [
        ({"tail lamb": 1.0}, "no light group 'tail lamb'; did you mean 'tail lamp'?"),
        ({"background": -0.1}, "must be 0 or more, not -0.1"),
        ({"background": float("nan")}, "must be 0 or more"),
        ({"background": float("inf")}, "must be 0 or more"),
    ],
)
def test_a_weight_that_makes_no_sense_is_refused(
    layers: Layers, weights: dict[str, float], told: str
) -> None:
    with pytest.raises(LamplitError) as refused:
        mix(layers, weights)
    assert told in str(refused.value)


def test_a_display_of_primaries_comes_back_and_a_profile_must_be_named(
    tmp_path: Path, layered_image: MakeImage
) -> None:
    own = CustomDisplay(
        primaries_xy=((0.66, 0.33), (0.28, 0.62), (0.15, 0.07)), white_xy=(0.31, 0.33), gamma=2.2
    )
    image = layered_image()
    image.scene.space = own  # type: ignore[attr-defined]
    write_layers(tmp_path / "a.exr", image)
    assert read_layers(tmp_path / "a.exr").view.display.primaries_xy[0] == (0.66, 0.33)
    assert (
        read_layers(tmp_path / "a.exr", changed={"display.space": "srgb"}).view.display.name
        == "srgb"
    )
    header = read_exr(tmp_path / "a.exr")
    view = json.loads(header.attributes["lamplit.view"]) | {"space": {"icc": "screen.icc"}}
    words = {name: header.attributes[f"lamplit.{name}"] for name in ("groups", "render")}
    attributes = {f"lamplit.{name}": text for name, text in words.items()}
    save_exr(tmp_path / "b.exr", header.channels, attributes | {"lamplit.view": json.dumps(view)})
    with pytest.raises(LamplitError, match=r"b\.exr: its display was .* name a --display"):
        read_layers(tmp_path / "b.exr")
    assert (
        read_layers(tmp_path / "b.exr", changed={"display.space": "rec2020"}).view.display.name
        == "rec2020"
    )
    assert IccDisplay(icc="screen.icc").model_dump() == view["space"]


def test_a_file_without_layers_is_refused(tmp_path: Path, layered_image: MakeImage) -> None:
    image = layered_image()
    write_exr(tmp_path / "picture.exr", image, develop(image))
    with pytest.raises(OutputError, match="no layers that Lamplit wrote"):
        read_layers(tmp_path / "picture.exr")
    with pytest.raises(OutputError, match="lamplit render --layers"):
        read_layers(tmp_path / "layers.exr")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("groups", '["background", "brake"]'),
        ("groups", "7"),
        ("view", "[1, 2]"),
        ("view", '{"space": "srgb", "white_xy": [0.3]}'),
        ("view", '{"space": "sRBG", "white_xy": [0.3, 0.3]}'),
        ("render", "not JSON"),
    ],
)
def test_a_header_that_lies_is_refused(
    tmp_path: Path, layers: Layers, name: str, text: str
) -> None:
    read = read_exr(tmp_path / "layers.exr")
    kept = {key: value for key, value in read.attributes.items() if key.startswith("lamplit.")}
    save_exr(tmp_path / "b.exr", read.channels, kept | {f"lamplit.{name}": text})
    with pytest.raises(OutputError, match="no layers that Lamplit wrote"):
        read_layers(tmp_path / "b.exr")
