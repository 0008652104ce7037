# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Two ways to a picture: scenes as a file describes them, and lanes put straight into the core."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from lamplit import _core
from lamplit.scene import Scene
from lamplit.scene.load import parse_scene

Array = NDArray[np.float64]
Table = dict[str, Any]

UNTURNED = np.eye(4).tolist()

#: How far Hall's method goes unless a test says otherwise: every ray, for 64 steps, no shadows.
HALL: Table = {
    "max_depth": 64,
    "contribution_limit": 0.0,
    "dispersion_groups": 1,
    "shadows": False,
}


class LaneScene:
    """A scene of 16 lanes without meaning, whose radiances come back lane by lane.

    A spectrum is a number, or one number for each lane.
    """

    def __init__(self) -> None:
        self.builder = _core.SceneBuilder(_core.LANES)
        self.surround(0.0)

    @staticmethod
    def spectrum(values: ArrayLike) -> Array:
        """Return ``values`` on every lane."""
        return np.ascontiguousarray(np.broadcast_to(np.asarray(values, float), _core.LANES))

    def terms(self, **given: Any) -> _core.HallTerms:
        """Return the terms of Hall's model: all weights 1, n = 1, and what is given."""
        usual: Table = {"k_sr": 1.0, "k_st": 1.0, "k_sa": 1.0, "highlight_exponent": 1.0}
        spectra = {
            name: self.spectrum(given.pop(name)) for name in ("f_sr", "f_st", "f_sa") & given.keys()
        }
        return _core.HallTerms(**(usual | given | spectra))

    def glass(self, index: ArrayLike, absorption: ArrayLike = 0.0, **terms: Any) -> int:
        """Add a transparent material; lanes that share directions follow the first one's."""
        n = self.spectrum(index)
        matter = _core.Matter.dielectric(n, float(n[0]), self.spectrum(absorption))
        return self.builder.add_material(matter, self.terms(**terms))

    def mirror(self, reflectance: ArrayLike = 1.0, **terms: Any) -> int:
        """Add a mirror."""
        matter = _core.Matter.mirror(self.spectrum(reflectance))
        return self.builder.add_material(matter, self.terms(**terms))

    def metal(self, n: ArrayLike, k: ArrayLike, factor: float = 1.0) -> int:
        """Add a metal."""
        matter = _core.Matter.conductor(self.spectrum(n), self.spectrum(k), factor)
        return self.builder.add_material(matter, self.terms())

    def matt(self, reflectance: ArrayLike = 1.0, **terms: Any) -> int:
        """Add a matt material."""
        matter = _core.Matter.diffuse(self.spectrum(reflectance))
        return self.builder.add_material(matter, self.terms(**terms))

    def glossy(self, index: ArrayLike, base: ArrayLike, **terms: Any) -> int:
        """Add a matt material under a smooth clear coat."""
        matter = _core.Matter.glossy(self.spectrum(index), self.spectrum(base))
        return self.builder.add_material(matter, self.terms(**terms))

    def checker(self, first: ArrayLike, second: ArrayLike, square_mm: float) -> int:
        """Add a matt material in two colours."""
        spectra = self.spectrum(first), self.spectrum(second)
        return self.builder.add_material(_core.Matter.checker(*spectra, square_mm), self.terms())

    def body(
        self,
        kind: str,
        numbers: Sequence[float],
        material: int,
        *,
        name: str = "",
        priority: int = 0,
    ) -> None:
        """Add a primitive by its defining numbers."""
        owner = (name or kind, material, priority)
        self.builder.add_primitive(owner, kind, [float(n) for n in numbers], UNTURNED)

    def mesh(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        material: int,
        *,
        name: str = "mesh",
        normals: Array | None = None,
    ) -> None:
        """Add a body of triangles."""
        corners, faces = np.asarray(vertices, np.float64), np.asarray(triangles, np.uint32)
        self.builder.add_mesh((name, material, 0), corners, faces, normals)

    def gradient(self, zenith: ArrayLike = 1.0, nadir: ArrayLike = 0.0) -> None:
        """Set a background: usually of radiance (1 + y)/2 in the direction (x, y, z)."""
        spectra = self.spectrum(zenith), self.spectrum(nadir)
        self.builder.set_background(_core.Background.gradient(*spectra, 0))

    def surround(self, radiance: ArrayLike = 1.0) -> None:
        """Set a background that is the same all round."""
        self.builder.set_background(_core.Background.constant(self.spectrum(radiance), 0))

    def look(
        self,
        position: ArrayLike,
        target: ArrayLike,
        *,
        up: ArrayLike = (0.0, 1.0, 0.0),
        height_mm: float | None = 1e-6,
        field_of_view_deg: float | None = None,
    ) -> None:
        """Set the camera: by default one that looks along a single line."""
        places = [tuple(np.asarray(place, float).tolist()) for place in (position, target, up)]
        height_mm = None if field_of_view_deg else height_mm
        self.builder.set_camera(*places, height_mm=height_mm, field_of_view_deg=field_of_view_deg)

    def build(self, weight: float = 0.0) -> _core.Scene:
        """Return the scene; X, Y and Z are the sum of all lanes times ``weight``."""
        return self.builder.build([self.spectrum(weight)] * 3, ["background"])

    def render(self, width: int = 1, height: int = 1, **settings: Any) -> _core.Render:
        """Render the middle of every pixel by Hall's method, following every ray for 64 steps."""
        usual: Table = {"filter": "box", "sampling": "grid", "threads": 1, "samples": 1}
        usual |= {"bands_per_lane": 1}
        hall = HALL | {name: settings.pop(name) for name in HALL.keys() & settings.keys()}
        usual["method"] = _core.HallMethod(**hall)
        return self.build().render(width, height, **(usual | settings))

    def radiance(self, width: int = 1, height: int = 1, **settings: Any) -> Array:
        """Render and return the lanes, (height, width, 16); (16,) of a single pixel."""
        lanes = self.render(width, height, **settings).spectral_radiance()
        return lanes[0, 0] if width == height == 1 else lanes


@pytest.fixture
def lane_scene() -> Callable[[], LaneScene]:
    """Return a maker of empty `LaneScene`."""
    return LaneScene


@pytest.fixture
def scene_of(tmp_path: Path) -> Callable[..., Scene]:
    """Return a maker of scenes; tables given stand in for the usual ones, key by key.

    Usually an orthographic camera looks from z = 100 mm along −z at 20 mm of a white surround of
    100 cd/m², in 8×8 pixels of one sample.
    """

    def make(**tables: Any) -> Scene:
        usual: Table = {
            "camera": {
                "kind": "orthographic",
                "position_mm": [0.0, 0.0, 100.0],
                "target_mm": [0.0, 0.0, 0.0],
                "height_mm": 20.0,
            },
            "image": {"method": "hall", "width": 8, "height": 8, "samples": 1, "filter": "box"},
            "hall": {"contribution_limit": 0.0},
            "background": {"kind": "constant", "source": "E", "luminance_cd_m2": 100.0},
        }
        for name, table in tables.items():
            replaces = not isinstance(table, dict) or "kind" in table
            usual[name] = table if replaces else usual.get(name, {}) | table
        return parse_scene({"lamplit": 1} | usual, root=tmp_path)

    return make


def cube_mesh(low: ArrayLike, high: ArrayLike) -> tuple[Array, NDArray[np.uint32]]:
    """Return the 8 corners and 12 triangles, facing outward, of a box along the axes."""
    share = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)], dtype=np.float64)
    corners = np.asarray(low) + share * np.subtract(high, low)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners, np.array(triangles, dtype=np.uint32)


@pytest.fixture
def box_mesh() -> Callable[[ArrayLike, ArrayLike], tuple[Array, NDArray[np.uint32]]]:
    """Return the maker of a box's corners and triangles."""
    return cube_mesh


@pytest.fixture
def write_ply(tmp_path: Path) -> Callable[..., str]:
    """Return a writer of ASCII PLY files into the scene's folder, which returns the file's name."""

    def write(name: str, vertices: ArrayLike, triangles: ArrayLike) -> str:
        corners, faces = np.asarray(vertices, float).tolist(), np.asarray(triangles).tolist()
        header = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\n"
        header += "".join(f"property double {axis}\n" for axis in "xyz")
        header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        lines = [" ".join(map(repr, corner)) for corner in corners]
        lines += [" ".join(map(str, [3, *face])) for face in faces]
        (tmp_path / name).write_text(header + "\n".join(lines) + "\n")
        return name

    return write
