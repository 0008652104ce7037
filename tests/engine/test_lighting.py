# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What shines in a scene file shows with its strength in a picture by path transport."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.scene import parse_scene

Table = dict[str, Any]

BLACK: Table = {"kind": "constant", "source": "E", "luminance_cd_m2": 0.0}


def seen(root: Path, objects: list[Table], background: Table, **more: Any) -> ll.Image:
    """Return an 8 × 8 picture of things about the origin, seen from +z, 2 mm high."""
    scene = parse_scene(
        {
            "lamplit": 1,
            "camera": {
                "kind": "orthographic",
                "position_mm": [0.0, 0.0, 500.0],
                "target_mm": [0.0, 0.0, 0.0],
                "height_mm": 2.0,
            },
            "image": {"width": 8, "height": 8, "samples": 100, "filter": "box"},
            "background": background,
            "materials": {"grey": {"kind": "diffuse", "reflectance": 0.5}},
            "objects": objects,
            **more,
        },
        root=root,
    )
    return ll.render(scene, method="path")


def disc(**emission: Any) -> Table:
    """Return a disc of 10 mm radius that faces the eye and shines."""
    return {
        "name": "die",
        "kind": "disc",
        "material": "grey",
        "centre_mm": [0.0, 0.0, 0.0],
        "normal": [0.0, 0.0, 1.0],
        "radius_mm": 10.0,
        "emission": emission,
    }


AREA_M2 = np.pi * 0.01**2


def test_a_flux_becomes_the_luminance_of_a_lambertian_disc(tmp_path: Path) -> None:
    image = seen(tmp_path, [disc(source="A", flux_lm=20.0)], BLACK)
    assert image.luminance_cd_m2 == pytest.approx(20.0 / (np.pi * AREA_M2), rel=1e-6)


def test_a_cosine_exponent_narrows_the_light_of_a_flux(tmp_path: Path) -> None:
    narrow = {"cosine_exponent": 3.0}
    image = seen(tmp_path, [disc(source="A", flux_lm=20.0, distribution=narrow)], BLACK)
    # I(0) = Φ (n + 1)/2π.
    assert image.luminance_cd_m2 == pytest.approx(20.0 * 4.0 / (2.0 * np.pi * AREA_M2), rel=1e-6)


def test_radiant_flux_counts_watts_within_the_pictures_wavelengths(tmp_path: Path) -> None:
    image = seen(tmp_path, [disc(source="E", radiant_flux_w=0.4)], BLACK)
    # Equal energy of 1 W over 380 to 780 nm: K_m ∫ȳ dλ / 400 nm, ∫ȳ = 106.857 nm.
    lumens = 0.4 * 683.002 * 106.857 / 400.0
    assert image.luminance_cd_m2 == pytest.approx(lumens / (np.pi * AREA_M2), rel=1e-4)


def test_a_glowing_disc_has_plancks_luminance(tmp_path: Path) -> None:
    image = seen(tmp_path, [disc(temperature_kelvin=2042.0)], BLACK)
    # Platinum at its freezing point, 2042 K: 60 cd/cm², by which the candela was once defined.
    assert image.luminance_cd_m2 == pytest.approx(6.0e5, rel=5e-3)


@pytest.mark.parametrize("degrees", [0.0, 30.0, 60.0])
def test_a_photometric_file_gives_its_intensity_from_any_side(
    tmp_path: Path, degrees: float
) -> None:
    angles = np.arange(0, 91, 5)
    candela = 100.0 * np.cos(np.radians(angles)) ** 2
    lines = [
        "IESNA:LM-63-2002",
        "TILT=NONE",
        f"1 -1 1 {len(angles)} 1 1 2 0 0 0",
        "1 1 10",
        " ".join(map(str, angles)),
        "0",
        " ".join(f"{value:.6f}" for value in candela),
    ]
    (tmp_path / "spot.ies").write_text("\n".join(lines) + "\n", encoding="ascii")
    law = {"file": "spot.ies", "axis": [0.0, 0.0, 1.0]}
    flux = 2.0 * np.pi * 100.0 / 3.0
    angle = np.radians(degrees)
    eye = [500.0 * float(np.sin(angle)), 0.0, 500.0 * float(np.cos(angle))]
    camera = {
        "kind": "orthographic",
        "position_mm": eye,
        "target_mm": [0.0, 0.0, 0.0],
        "height_mm": 2.0,
    }
    emitter = disc(source="A", flux_lm=flux, distribution=law)
    image = seen(tmp_path, [emitter], BLACK, camera=camera)
    # I = 100 cos² θ cd spread over the projected disc; the table's straight lines cost 0.4 %.
    expected = 100.0 * np.cos(angle) / AREA_M2
    assert image.luminance_cd_m2.mean() == pytest.approx(expected, rel=6e-3)


def test_a_picture_shines_at_its_scale_and_its_spectra_are_told_to_be_a_guess(
    tmp_path: Path,
) -> None:
    import OpenEXR

    rgb = np.ones((4, 8, 3), np.float32)
    header = {"type": OpenEXR.scanlineimage}
    channels = {name: np.ascontiguousarray(rgb[..., k]) for k, name in enumerate("RGB")}
    OpenEXR.File(header, channels).write(str(tmp_path / "sky.exr"))
    ball: Table = {
        "name": "ball",
        "kind": "sphere",
        "material": "grey",
        "centre_mm": [0.0, 0.0, 0.0],
        "radius_mm": 20.0,
    }
    sky: Table = {"kind": "image", "file": "sky.exr", "scale": 250.0}
    image = seen(tmp_path, [ball], sky)
    assert image.luminance_cd_m2.mean() == pytest.approx(125.0, rel=5e-3)
    assert "derived from RGB" in " ".join(image.notices)


def test_a_sun_lights_by_its_illuminance(tmp_path: Path) -> None:
    floor = {**disc(source="A", flux_lm=0.0), "radius_mm": 50.0}
    sun = {"direction": [0.0, 1.0, 1.0], "source": "D65", "illuminance_lx": 1000.0}
    image = seen(tmp_path, [floor], {**BLACK, "suns": [sun]})
    expected = 0.5 / np.pi * 1000.0 * np.sqrt(0.5)
    assert image.luminance_cd_m2.mean() == pytest.approx(expected, rel=2e-3)


def test_an_eye_inside_glass_starts_in_it(tmp_path: Path) -> None:
    transmits = {"value": 0.99, "thickness_mm": 1.0}
    materials = {
        "dye": {"kind": "dielectric", "refractive_index": 1.5, "internal_transmittance": transmits},
        "grey": {"kind": "diffuse", "reflectance": 0.0},
    }
    ball = {
        "name": "ball",
        "kind": "sphere",
        "material": "dye",
        "centre_mm": [0.0, 0.0, 0.0],
        "radius_mm": 1000.0,
    }
    die = disc(source="E", luminance_cd_m2=100.0)
    image = seen(tmp_path, [ball, die], BLACK, materials=materials)
    assert image.luminance_cd_m2 == pytest.approx(100.0 * 0.99**500, rel=1e-6)
