# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`cross_check`: the same candela by the other way, walked from the eye of the receiver.

A receiver reads the mean intensity over its own aperture: I = ∫ L cos θ dA over what shines, seen
along each direction of the aperture. An orthographic camera that covers the lamp sees L, and the
mean of its luminances times its area is I. At a finite distance d the camera is a pinhole at the
receiver, which reads E·d² with E = ∫ L cos⁴ θ over its picture at the distance 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.errors import LamplitError, SceneError

if TYPE_CHECKING:
    from lamplit.engine.measurement import Lit, Measurement
    from lamplit.engine.receivers import Goniometer
    from lamplit.scene import Scene

Array = NDArray[np.float64]

_M2_PER_MM2 = 1e-6
#: How often the farthest of all points may be called apart by chance.
_ALPHA = 0.01


@dataclass(frozen=True, eq=False)
class CrossCheck:
    """Luminous intensities at spots by both ways, p of them, with one standard error each."""

    spot_h_deg: Array
    spot_v_deg: Array
    #: (p,), in cd, walked from the light.
    light_cd: Array
    light_standard_error_cd: Array
    #: (p,), in cd, walked from the eye.
    eye_cd: Array
    eye_standard_error_cd: Array
    #: Independent rounds of the eye's walks, whose spread is its standard error.
    rounds: int = 8

    @property
    def sigmas(self) -> Array:
        """How many standard errors both are apart, (p,); 0 where they are equal."""
        off = self.light_cd - self.eye_cd
        sigma = np.hypot(self.light_standard_error_cd, self.eye_standard_error_cd)
        return np.divide(off, sigma, out=np.zeros_like(off), where=off != 0.0)

    @property
    def allowed(self) -> float:
        """How many standard errors the farthest of p points is apart by chance in 1 of 100.

        By Student's t, since most of σ comes from few rounds, and over all points (Šidák).
        """
        from scipy.stats import t as student_t

        quantile: Any = student_t.ppf
        each = 1.0 - (1.0 - _ALPHA) ** (1.0 / max(1, len(self.light_cd)))
        return float(quantile(1.0 - each / 2.0, self.rounds - 1))


def check_visible(scene: Scene) -> None:
    """Check that an eye can see all that shines in ``scene``.

    Raises:
        SceneError: Rays of a file start in no surface that an eye could see.
    """
    if scene.ray_files:
        raise SceneError(
            "the rays of a file are followed forward only: no eye sees them, and so there is "
            "nothing to cross-check; leave --cross-check out",
            file=scene.path,
            where="ray_files",
        )


def cross_check(
    measurement: Measurement,
    lit: Lit = None,
    *,
    spots: NDArray[np.intp] | list[int] | None = None,
    pixels: int = 96,
    samples: int = 16,
    eyes: int = 2,
    rounds: int = 8,
    progress: Callable[[int, int], object] | None = None,
) -> CrossCheck:
    """Return both intensities of ``spots`` (their numbers; None: the brightest three).

    ``eyes`` places in the receiver's aperture in each of ``rounds`` rounds look at the lamp in
    pictures of ``pixels`` on the longer side, with ``samples`` each. What shines behind smooth
    glass and is smaller than a pixel is found by chance: a large standard error says so.
    ``progress`` is called with the rounds done and to do, of all spots together.

    Raises:
        LamplitError: There is no spot, fewer than two rounds, or light that no eye can see.
        KeyboardInterrupt: Ctrl-C; half of a comparison says nothing.
    """
    from lamplit.engine.measure import in_laboratory

    if measurement.light is not None:
        raise LamplitError("only what shines in the scene can be seen by an eye; leave light out")
    if rounds < 2:
        raise LamplitError(f"a standard error takes 2 rounds or more, not {rounds}")
    seen = measurement.observed(lit)
    if seen.spot_cd.size == 0:
        raise LamplitError("there are no spots to check; measure some")
    brightest = np.argsort(seen.spot_cd)[::-1][:3]
    chosen = np.sort(brightest) if spots is None else np.asarray(spots, dtype=np.intp)
    scene = measurement.scene
    check_visible(scene)
    carrier = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
    world = assemble(in_laboratory(scene), carrier)
    eye = _Eye(world, measurement, measurement.weights(lit), (pixels, samples, eyes))
    towards = measurement.goniometer.directions()[chosen]
    read = np.zeros((len(chosen), rounds))
    for at, turn in np.ndindex(*read.shape):
        read[at, turn] = eye.intensity(towards[at], turn)
        if progress is not None:
            progress(at * rounds + turn + 1, read.size)
    return CrossCheck(
        seen.spot_h_deg[chosen],
        seen.spot_v_deg[chosen],
        seen.spot_cd[chosen],
        seen.spot_standard_error_cd[chosen],
        read.mean(axis=1),
        read.std(axis=1, ddof=1) / np.sqrt(rounds),
        rounds,
    )


class _Eye:
    def __init__(
        self,
        world: _core.Scene,
        measurement: Measurement,
        weights: Array,
        fineness: tuple[int, int, int],
    ) -> None:
        self._world, self._weights = world, weights
        self._pixels, self._samples, self._eyes = fineness
        self._gonio: Goniometer = measurement.goniometer
        self._seed, self._threads = measurement.seed, measurement.threads
        path = measurement.scene.path_settings
        self._method = _core.PathMethod(
            max_depth=path.max_depth,
            split_depth=path.split_depth,
            roulette_below=path.roulette_below,
        )
        bounds = world.bounds_mm
        if bounds is None:
            raise LamplitError("an eye cannot see endless planes whole")
        low, high = np.asarray(bounds[0]), np.asarray(bounds[1])
        share = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)], dtype=np.float64)
        self._corners: Array = low + share * (high - low)

    def intensity(self, direction: Array, turn: int) -> float:
        """Return the intensity towards a receiver, as round ``turn`` sees it."""
        return float(np.mean([self._look(way, at) for way, at in self._aperture(direction, turn)]))

    def _aperture(self, direction: Array, turn: int) -> list[tuple[Array, int]]:
        """Return directions spread over the receiver, and a seed for each."""
        right, up = _square(direction)
        half = np.radians(self._gonio.receiver_deg) / 2.0
        ways: list[tuple[Array, int]] = []
        for eye in range(self._eyes):
            number = turn * self._eyes + eye
            u, v = (0.754877666 * number + 0.3) % 1.0, (0.569840291 * number + 0.7) % 1.0
            cos = 1.0 - u * (1.0 - np.cos(half))
            sin, phi = np.sqrt(1.0 - cos * cos), 2.0 * np.pi * v
            way = direction * cos + (right * np.cos(phi) + up * np.sin(phi)) * sin
            ways.append((way, self._seed + 7919 * (number + 1)))
        return ways

    def _look(self, way: Array, seed: int) -> float:
        """Return the intensity along one direction from the lamp."""
        right, up = _square(way)
        if self._gonio.distance_m is None:
            x, y = self._corners @ right, self._corners @ up
            middle = self._corners.mean(axis=0)
            middle = middle + right * (np.mean(_ends(x)) - middle @ right)
            middle = middle + up * (np.mean(_ends(y)) - middle @ up)
            reach = float((self._corners @ way).max() - middle @ way) + 1.0
            width, height = float(np.ptp(x)), float(np.ptp(y))
            position = middle + way * reach
            self._world.look(position.tolist(), middle.tolist(), up.tolist(), height_mm=height)
            columns, rows = self._size(width, height)
            area = height * height * columns / rows * _M2_PER_MM2
            return float((self._luminances(columns, rows, seed) * area / (columns * rows)).sum())
        distance = 1e3 * self._gonio.distance_m
        position = np.asarray(self._gonio.centre_mm) + way * distance
        rays = self._corners - position
        depth = -(rays @ way)
        reach = max(np.abs(rays @ right / depth).max(), np.abs(rays @ up / depth).max())
        angle = float(np.degrees(2.0 * np.arctan(reach)))
        target = self._gonio.centre_mm
        self._world.look(position.tolist(), target, up.tolist(), field_of_view_deg=angle)
        side = self._pixels
        middles = reach * (2.0 * (np.arange(side) + 0.5) / side - 1.0)
        cos2 = 1.0 / (1.0 + middles[:, None] ** 2 + middles[None, :] ** 2)
        pixel = (2.0 * reach / side) ** 2
        illuminance = float((self._luminances(side, side, seed) * cos2**2).sum()) * pixel
        return illuminance * self._gonio.distance_m**2

    def _size(self, width: float, height: float) -> tuple[int, int]:
        """Return columns and rows of square pixels; the columns cover the width."""
        if width >= height:
            rows = max(1, round(self._pixels * height / width))
            return int(np.ceil(width / (height / rows) - 1e-9)), rows
        return max(1, int(np.ceil(width / (height / self._pixels) - 1e-9))), self._pixels

    def _luminances(self, columns: int, rows: int, seed: int) -> Array:
        """Return the luminances (rows, columns) of the lit groups, in cd/m²."""
        outcome = self._world.render(
            columns,
            rows,
            self._samples,
            self._method,
            filter="box",
            seed=seed,
            layers=True,
            threads=self._threads or 0,
        )
        if outcome.interrupted:
            raise KeyboardInterrupt
        return np.einsum("g,grc->rc", self._weights, outcome.layers()[..., 1])


def _square(way: Array) -> tuple[Array, Array]:
    """Return two unit vectors square to ``way`` and to each other."""
    helper = np.eye(3)[int(np.argmin(np.abs(way)))]
    right = np.cross(helper, way)
    right /= np.linalg.norm(right)
    return right, np.cross(way, right)


def _ends(values: Array) -> list[float]:
    return [float(values.min()), float(values.max())]
