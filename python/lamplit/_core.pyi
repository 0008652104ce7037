# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The compiled part of Lamplit: arrays in, arrays out."""

from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = ["LANES", "HallTerms", "Render", "Scene", "SceneBuilder", "__version__"]

__version__: Final[str]
LANES: Final[int]

_Spectrum: TypeAlias = NDArray[np.float64]
_Triple: TypeAlias = Sequence[float]
_Body: TypeAlias = tuple[str, int, int]

@final
class HallTerms:
    def __new__(
        cls,
        *,
        k_sr: float,
        k_st: float,
        k_sa: float,
        highlight_exponent: float,
        f_sr: _Spectrum | None = None,
        f_st: _Spectrum | None = None,
        f_sa: _Spectrum | None = None,
    ) -> HallTerms: ...

@final
class SceneBuilder:
    def __new__(cls, count: int) -> SceneBuilder: ...
    def add_dielectric(
        self, index: _Spectrum, index_d: float, absorption_per_mm: _Spectrum, hall: HallTerms
    ) -> int: ...
    def add_conductor(self, n: _Spectrum, k: _Spectrum, factor: float, hall: HallTerms) -> int: ...
    def add_mirror(self, reflectance: _Spectrum, hall: HallTerms) -> int: ...
    def add_diffuse(self, reflectance: _Spectrum, hall: HallTerms) -> int: ...
    def add_checker(
        self, first: _Spectrum, second: _Spectrum, square_mm: float, hall: HallTerms
    ) -> int: ...
    def add_glossy(self, index: _Spectrum, reflectance: _Spectrum, hall: HallTerms) -> int: ...
    def add_mesh(
        self,
        owner: _Body,
        vertices_mm: NDArray[np.float64],
        triangles: NDArray[np.uint32],
        normals: NDArray[np.float64] | None = None,
    ) -> None: ...
    def add_primitive(
        self,
        owner: _Body,
        kind: str,
        numbers: Sequence[float],
        transform: Sequence[Sequence[float]],
    ) -> None: ...
    def set_camera(
        self,
        position_mm: _Triple,
        target_mm: _Triple,
        up: _Triple,
        *,
        field_of_view_deg: float | None = None,
        height_mm: float | None = None,
    ) -> None: ...
    def add_point_light(self, strength: _Spectrum, position_mm: _Triple) -> None: ...
    def add_directional_light(self, strength: _Spectrum, direction: _Triple) -> None: ...
    def add_sphere_light(
        self, strength: _Spectrum, centre_mm: _Triple, radius_mm: float
    ) -> None: ...
    def set_ambient(self, strength: _Spectrum) -> None: ...
    def set_constant_background(self, radiance: _Spectrum) -> None: ...
    def set_gradient_background(self, zenith: _Spectrum, nadir: _Spectrum) -> None: ...
    def add_soft_box(
        self,
        radiance: _Spectrum,
        centre_mm: _Triple,
        half_width_mm: _Triple,
        half_height_mm: _Triple,
        edge_softness: float,
    ) -> None: ...
    def build(self, colour_matching: Sequence[_Spectrum]) -> Scene: ...

@final
class Scene:
    @property
    def memory_bytes(self) -> int: ...
    def render(
        self,
        width: int,
        height: int,
        samples: int,
        *,
        first_sample: int = 0,
        sampling: str = "grid",
        filter: str = "gaussian",
        seed: int = 1,
        max_depth: int = 12,
        contribution_limit: float = 1e-4,
        dispersion_groups: int = 1,
        shadows: bool = True,
        bands_per_lane: int = 0,
        threads: int = 0,
        tile: int = 64,
        progress: Callable[[int, int], object] | None = None,
    ) -> Render: ...

@final
class Render:
    @property
    def interrupted(self) -> bool: ...
    def xyz(self) -> NDArray[np.float64]: ...
    def xyz_standard_error(self) -> NDArray[np.float64]: ...
    def samples(self) -> NDArray[np.uint32]: ...
    def spectral_radiance(self) -> NDArray[np.float64]: ...
    def statistics(self) -> dict[str, Any]: ...
