# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The compiled part of Lamplit: arrays in, arrays out.

A spectrum is an array over all wavelengths of the picture, rising. Lengths are in mm. A group is
the number of a light group. A fault of the input is a `ValueError` with one line.
"""

from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias, TypedDict, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "BATCHES",
    "LANES",
    "Background",
    "Emission",
    "HallMethod",
    "HallTerms",
    "LightGuide",
    "LitMethod",
    "Matter",
    "PathMethod",
    "Photometer",
    "Rays",
    "Receivers",
    "Render",
    "Scene",
    "SceneBuilder",
    "__version__",
]

__version__: Final[str]
BATCHES: Final[int]
LANES: Final[int]

_Array: TypeAlias = NDArray[np.float64]
_Spectrum: TypeAlias = _Array
_Triple: TypeAlias = Sequence[float]
#: Name, material number, priority.
_Body: TypeAlias = tuple[str, int, int]

class _Lumens(TypedDict):
    emitted: float
    out: float
    absorbed: dict[str, float]
    cut_by_depth: float
    lost: float
    chance: float
    gap: float

class _Ledger(TypedDict):
    escaped: float
    absorbed: dict[str, float]
    cut_by_depth: float
    lost: float
    chance: float
    gap: float

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
class Matter:
    @staticmethod
    def dielectric(
        index: _Spectrum,
        index_d: float,
        absorption_per_mm: _Spectrum,
        *,
        scattering_per_mm: _Spectrum | None = None,
        anisotropy: float = 0.0,
    ) -> Matter: ...
    @staticmethod
    def conductor(
        n: _Spectrum,
        k: _Spectrum,
        factor: float,
        *,
        lacquer: tuple[_Spectrum, _Spectrum] | None = None,
    ) -> Matter: ...
    @staticmethod
    def mirror(reflectance: _Spectrum) -> Matter: ...
    @staticmethod
    def diffuse(reflectance: _Spectrum) -> Matter: ...
    @staticmethod
    def transmitter(reflectance: _Spectrum, transmittance: _Spectrum) -> Matter: ...
    @staticmethod
    def checker(first: _Spectrum, second: _Spectrum, square_mm: float) -> Matter: ...
    @staticmethod
    def glossy(index: _Spectrum, reflectance: _Spectrum) -> Matter: ...

@final
class Background:
    @staticmethod
    def constant(radiance: _Spectrum, group: int) -> Background: ...
    @staticmethod
    def gradient(zenith: _Spectrum, nadir: _Spectrum, group: int) -> Background: ...
    @staticmethod
    def sky(
        zenith: _Spectrum,
        ground: _Spectrum,
        group: int,
        *,
        kind: int | None = None,
        towards_sun: _Triple | None = None,
    ) -> Background: ...
    @staticmethod
    def image(
        pixels: NDArray[np.float32], bases: Sequence[_Spectrum], turn_rad: float, group: int
    ) -> Background: ...
    def add_soft_box(
        self,
        radiance: _Spectrum,
        centre_mm: _Triple,
        half_width_mm: _Triple,
        half_height_mm: _Triple,
        edge_softness: float,
        group: int,
    ) -> None: ...
    def add_sun(
        self, radiance: _Spectrum, towards: _Triple, angular_radius_rad: float, group: int
    ) -> None: ...

@final
class Emission:
    @staticmethod
    def radiance(radiance: _Spectrum) -> Emission: ...
    @staticmethod
    def flux(flux: _Spectrum) -> Emission: ...
    def set_cosine(self, exponent: float) -> None: ...
    def set_intensities(
        self,
        polar_rad: _Array,
        azimuths_rad: _Array,
        intensities: _Array,
        axes: Sequence[_Triple],
    ) -> None: ...

@final
class SceneBuilder:
    def __new__(cls, count: int) -> SceneBuilder: ...
    def add_material(
        self,
        matter: Matter,
        hall: HallTerms,
        *,
        roughness: float = 0.0,
        texture: tuple[_Triple, float] | None = None,
    ) -> int: ...
    def add_mesh(
        self,
        owner: _Body,
        vertices_mm: _Array,
        triangles: NDArray[np.uint32],
        normals: _Array | None = None,
    ) -> int: ...
    def add_primitive(
        self,
        owner: _Body,
        kind: str,
        numbers: Sequence[float],
        transform: Sequence[Sequence[float]],
    ) -> int: ...
    def add_emission(self, body: int, emission: Emission, group: int) -> None: ...
    def set_camera(
        self,
        position_mm: _Triple,
        target_mm: _Triple,
        up: _Triple,
        *,
        field_of_view_deg: float | None = None,
        height_mm: float | None = None,
        lens_mm: tuple[float, float] | None = None,
    ) -> None: ...
    def add_point_light(self, strength: _Spectrum, position_mm: _Triple) -> None: ...
    def add_directional_light(self, strength: _Spectrum, travels: _Triple) -> None: ...
    def add_sphere_light(
        self, strength: _Spectrum, centre_mm: _Triple, radius_mm: float
    ) -> None: ...
    def set_ambient(self, strength: _Spectrum) -> None: ...
    def set_background(self, background: Background) -> None: ...
    def build(self, colour_matching: Sequence[_Spectrum], groups: Sequence[str]) -> Scene: ...

@final
class HallMethod:
    def __new__(
        cls, *, max_depth: int, contribution_limit: float, dispersion_groups: int, shadows: bool
    ) -> HallMethod: ...

@final
class PathMethod:
    def __new__(cls, *, max_depth: int, split_depth: int, roulette_below: float) -> PathMethod: ...

@final
class LitMethod:
    def __new__(cls, path: PathMethod, guide: LightGuide | None = None) -> LitMethod: ...

@final
class LightGuide:
    def __new__(
        cls, scene: Scene, path: PathMethod, *, seed: int = 1, threads: int = 0
    ) -> LightGuide: ...

@final
class Scene:
    @property
    def memory_bytes(self) -> int: ...
    @property
    def bounds_mm(self) -> tuple[_Triple, _Triple] | None: ...
    def look(
        self,
        position_mm: _Triple,
        target_mm: _Triple,
        up: _Triple,
        *,
        field_of_view_deg: float | None = None,
        height_mm: float | None = None,
        lens_mm: tuple[float, float] | None = None,
    ) -> None: ...
    def render(
        self,
        width: int,
        height: int,
        samples: int,
        method: HallMethod | PathMethod | LitMethod,
        *,
        first_sample: int = 0,
        adaptive: bool = False,
        target_error: float | None = None,
        time_budget_s: float | None = None,
        counts: Sequence[int] | None = None,
        sampling: str = "sobol",
        filter: str = "gaussian",
        seed: int = 1,
        bands_per_lane: int = 0,
        layers: bool = False,
        threads: int = 0,
        tile: int = 64,
        progress: Callable[[int, int], object] | None = None,
        preview: Callable[[_Array, _Array, int, tuple[float, _Array] | None], object] | None = None,
    ) -> Render: ...
    def features(self, width: int, height: int, *, threads: int = 0) -> _Array: ...

@final
class Render:
    @property
    def interrupted(self) -> bool: ...
    @property
    def groups(self) -> list[str]: ...
    def xyz(self) -> _Array: ...
    def xyz_standard_error(self) -> _Array: ...
    def samples(self) -> NDArray[np.uint32]: ...
    def spectral_radiance(self) -> _Array: ...
    def layers(self) -> _Array: ...
    def layers_standard_error(self) -> _Array: ...
    def ledger(self) -> _Ledger | None: ...
    def found(self) -> dict[str, float]: ...
    def statistics(self) -> dict[str, Any]: ...

@final
class Receivers:
    def __new__(
        cls,
        axis: _Triple,
        up: _Triple,
        centre_mm: _Triple,
        *,
        distance_mm: float | None = None,
        spots: _Array | None = None,
        cell_edges: tuple[_Array, _Array] | None = None,
        map: tuple[_Triple, _Triple, _Triple, Sequence[int]] | None = None,
        spot_bands: int = 0,
        cell_bands: int = 0,
    ) -> Receivers: ...

@final
class Rays:
    def __new__(
        cls,
        scene: Scene,
        positions_mm: _Array,
        directions: _Array,
        fluxes: _Array,
        *,
        spectrum: _Spectrum | None = None,
        wavelengths: NDArray[np.uint32] | None = None,
        step_nm: float = 1.0,
        group: int = 0,
    ) -> Rays: ...

@final
class Photometer:
    @staticmethod
    def shining(
        scene: Scene,
        receivers: Receivers,
        method: PathMethod,
        *,
        rays: Sequence[Rays] = ...,
        seed: int = 1,
    ) -> Photometer: ...
    @staticmethod
    def rays(
        scene: Scene, receivers: Receivers, method: PathMethod, rays: Rays, *, seed: int = 1
    ) -> Photometer: ...
    @staticmethod
    def beam(
        scene: Scene,
        receivers: Receivers,
        method: PathMethod,
        travels: _Triple,
        angular_radius_rad: float,
        irradiance: _Spectrum,
        *,
        seed: int = 1,
    ) -> Photometer: ...
    @property
    def paths_per_batch(self) -> int: ...
    def walk(
        self,
        more: int,
        *,
        time_budget_s: float | None = None,
        threads: int = 0,
        progress: Callable[[int, int], object] | None = None,
    ) -> bool: ...
    def emitted(self) -> _Array: ...
    def out(self) -> _Array: ...
    def spots(self) -> _Array: ...
    def cells(self) -> _Array: ...
    def map(self) -> _Array: ...
    def out_bands(self) -> _Array: ...
    def spot_bands(self) -> _Array: ...
    def cell_bands(self) -> _Array: ...
    def ledger(self, group: int) -> _Lumens | None: ...
    def statistics(self) -> dict[str, Any]: ...
