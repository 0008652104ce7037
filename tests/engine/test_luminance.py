# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Eq. (1) in the picture: what is asked for in cd/m² is what X, Y and Z say."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.colour.tristimulus import tristimulus

SOURCES = [
    "A",
    "D50",
    "D55",
    "D65",
    "D75",
    "E",
    "FL2",
    "FL4",
    "FL7",
    "FL11",
    "FL12",
    "FL3.1",
    "HP1",
    "HP5",
    "LED-B1",
    "LED-B3",
    "p21w-filament",
    {"temperature_kelvin": 6500},
    {"led_peak_nm": 624, "led_fwhm_nm": 18},
    {"led_peak_nm": 593, "led_fwhm_nm": 15, "model": "gaussian"},
]

FLOOR = {
    "name": "floor",
    "kind": "plane",
    "point_mm": [0, 0, 0],
    "normal": [0, 0, 1],
    "material": "white",
}
WHITE = {"kind": "diffuse", "reflectance": 1.0}
#: Sums at the middles of 400 steps of 1 nm and at 401 whole nanometres are the two sides of one
#: integral: they differ by a quarter of the second difference, largest at the kinks of FL12.
QUADRATURE = 1e-3
#: One pixel whose 25 samples visit all wavelengths.
ALL_WAVELENGTHS = {"width": 1, "height": 1, "samples": 25}


def beside(scene_of: Callable[..., Any], **tables: Any) -> Any:
    """Return a scene whose one pixel sees the background, past a ball."""
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [9, 9, 0], "radius_mm": 0.5}
    return scene_of(
        image=ALL_WAVELENGTHS | tables.pop("image", {}),
        camera={
            "kind": "orthographic",
            "position_mm": [0, 0, 100],
            "target_mm": [0, 0, 0],
            "height_mm": 20.0,
        },
        materials={"white": WHITE},
        objects=[ball | {"material": "white"}],
        **tables,
    )


@pytest.mark.parametrize("source", SOURCES, ids=str)
def test_a_background_has_the_luminance_and_colour_of_its_source(
    scene_of: Callable[..., Any], source: Any
) -> None:
    scene = beside(
        scene_of, background={"kind": "constant", "source": source, "luminance_cd_m2": 123.0}
    )
    x, y, z = ll.render(scene).xyz[0, 0]
    assert y == pytest.approx(123.0, rel=1e-9)
    spd = scene.resolve_source(scene.background.source)
    exact = tristimulus(spd, range_nm=(380.0, 780.0))
    np.testing.assert_allclose([x, z], 123.0 * exact[[0, 2]] / exact[1], rtol=QUADRATURE, atol=1e-6)


@pytest.mark.parametrize("observer", ["cie-1931-2", "cie-1964-10", "cie-2015-2"])
@pytest.mark.parametrize("range_nm", [[380.0, 780.0], [360.0, 830.0], [500.0, 640.5]])
def test_luminance_holds_for_every_observer_and_range(
    scene_of: Callable[..., Any], observer: str, range_nm: list[float]
) -> None:
    phases = int(np.ceil((range_nm[1] - range_nm[0]) / 16))
    scene = beside(
        scene_of,
        image={
            "observer": observer,
            "wavelength_range_nm": range_nm,
            "samples": phases,
            "sampling": "sobol",
        },
        background={"kind": "constant", "source": "E", "luminance_cd_m2": 7.5},
    )
    assert ll.render(scene).luminance_cd_m2[0, 0] == pytest.approx(7.5, rel=1e-9)


@pytest.mark.parametrize(
    "light",
    [
        {"kind": "directional", "direction": [0, 0, -1]},
        {"kind": "point", "position_mm": [0, 0, 1e9]},
        {"kind": "sphere", "centre_mm": [0, 0, 1e9], "radius_mm": 1.0},
    ],
    ids=lambda light: light["kind"],
)
def test_a_light_gives_a_facing_perfect_reflector_its_luminance(
    scene_of: Callable[..., Any], light: dict[str, Any]
) -> None:
    scene = scene_of(
        image=ALL_WAVELENGTHS,
        background={"kind": "constant", "source": "E", "luminance_cd_m2": 0.0},
        lights=[light | {"source": "D65", "luminance_cd_m2": 321.0}],
        materials={"white": WHITE},
        objects=[FLOOR],
    )
    assert ll.render(scene).luminance_cd_m2[0, 0] == pytest.approx(321.0, rel=1e-9)


def test_ambient_light_gives_a_perfect_reflector_its_luminance(
    scene_of: Callable[..., Any],
) -> None:
    scene = scene_of(
        image=ALL_WAVELENGTHS,
        ambient={"source": "A", "luminance_cd_m2": 55.0},
        materials={"white": WHITE},
        objects=[FLOOR],
    )
    assert ll.render(scene).luminance_cd_m2[0, 0] == pytest.approx(55.0, rel=1e-9)


def test_a_gradient_and_a_soft_box_have_the_luminances_asked(scene_of: Callable[..., Any]) -> None:
    # The eye looks up at 30° over the horizon, where the gradient is 3 : 1.
    view = {
        "kind": "orthographic",
        "position_mm": [0, 0, 0],
        "height_mm": 1e-3,
        "target_mm": [0, 100, -100 * np.sqrt(3)],
        "up": [0, 1, 0],
    }
    ball = {
        "name": "ball",
        "kind": "sphere",
        "centre_mm": [0, 100, -173],
        "radius_mm": 1,
        "material": "clear",
    }
    clear = {"clear": {"kind": "dielectric", "refractive_index": 1.0}}
    gradient = {
        "zenith": {"source": "A", "luminance_cd_m2": 200.0},
        "nadir": {"source": "D65", "luminance_cd_m2": 40.0},
    }

    def luminance(background: dict[str, Any]) -> float:
        scene = scene_of(
            image=ALL_WAVELENGTHS,
            camera=view,
            background=background,
            materials=clear,
            objects=[ball],
        )
        return float(ll.render(scene).luminance_cd_m2[0, 0])

    behind = 200.0 * 0.75 + 40.0 * 0.25
    assert luminance({"kind": "gradient"} | gradient) == pytest.approx(behind, rel=1e-9)
    direction = np.array([0, 0.5, -np.sqrt(3) / 2])
    centre = 500 * direction - 20 * np.array([0, np.sqrt(3) / 2, 0.5])
    box = {
        "source": "D50",
        "luminance_cd_m2": 900.0,
        "centre_mm": centre.tolist(),
        "facing_mm": (centre - 500 * direction).tolist(),
        "up": [0, 1, 0],
        "width_mm": 80.0,
        "height_mm": 50.0,
        "edge_softness": 0.5,
    }
    # 20 of 25 mm from the middle is 0.4 into the soft edge's 12.5 mm: smoothstep(0.4) = 0.352.
    share = 0.4**2 * (3 - 2 * 0.4)
    expected = share * 900.0 + (1 - share) * behind
    assert luminance({"kind": "studio", "soft_boxes": [box]} | gradient) == pytest.approx(
        expected, rel=1e-6
    )
