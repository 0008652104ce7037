# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A small sound scene in a folder of its own, to be spoiled in one place at a time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

SOUND = """\
lamplit = 1
name = "a sound scene"
[camera]
kind = "pinhole"
position_mm = [0.0, 0.0, 400.0]
target_mm = [0.0, 0.0, 0.0]
field_of_view_deg = 30.0
[image]
method = "hall"
width = 32
height = 20
samples = 4
[[lights]]
kind = "point"
source = "D65"
luminance_cd_m2 = 1000.0
position_mm = [0.0, 300.0, 300.0]
[sources.my-led]
led_peak_nm = 624
led_fwhm_nm = 18
[materials.cover]
kind = "dielectric"
refractive_index = 1.49
[materials.cover.internal_transmittance]
thickness_mm = 3.0
wavelengths_nm = [380, 600, 780]
values = [0.01, 0.1, 0.9]
[materials.paint]
kind = "diffuse"
reflectance = 0.5
[[objects]]
name = "ball"
kind = "sphere"
centre_mm = [0.0, 0.0, 0.0]
radius_mm = 10.0
material = "cover"
[[objects]]
name = "part"
kind = "mesh"
file = "part.obj"
unit = "mm"
material = "paint"
"""

TETRAHEDRON_OBJ = """\
v 30 0 0
v 40 0 0
v 30 10 0
v 30 0 10
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
"""


@pytest.fixture(scope="session")
def sound_text() -> str:
    """Return the text of the sound scene."""
    return SOUND


@pytest.fixture(scope="session")
def tetrahedron_obj() -> str:
    """Return the text of the mesh that it names."""
    return TETRAHEDRON_OBJ


@pytest.fixture
def sound(tmp_path: Path) -> Path:
    """Return the scene file of a sound scene with a mesh beside it."""
    (tmp_path / "part.obj").write_text(TETRAHEDRON_OBJ)
    path = tmp_path / "scene.toml"
    path.write_text(SOUND)
    return path


@pytest.fixture
def spoilt(sound: Path) -> Callable[[str, str], Path]:
    """Return a function that replaces a piece of the sound scene, which must be there."""

    def spoil(piece: str, by: str) -> Path:
        text = sound.read_text()
        assert piece in text
        sound.write_text(text.replace(piece, by, 1))
        return sound

    return spoil


def cube_triangles() -> tuple[np.ndarray, np.ndarray]:
    """Return the 8 corners of the unit cube and 12 triangles that face outward."""
    corners = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)], dtype=np.float64)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners, np.array(triangles)


@pytest.fixture
def cube() -> tuple[np.ndarray, np.ndarray]:
    """Return the corners (8, 3) and triangles (12, 3) of the unit cube, facing outward."""
    return cube_triangles()
