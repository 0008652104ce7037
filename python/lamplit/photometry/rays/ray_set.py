# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`RaySet`: rays that leave a source, checked one by one before anybody traces them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.photometry.text import PhotometryError

FluxQuantity: TypeAlias = Literal["luminous", "radiant"]
Array: TypeAlias = NDArray[np.float64]

#: |d| may differ from 1 by this much: float32, or cosines printed with four decimals. It is put
#: right; what differs more is no direction but something else.
DIRECTION_TOLERANCE: Final = 1e-4

#: Wavelengths beyond these are in another unit.
_SHORTEST_NM, _LONGEST_NM = 100.0, 20_000.0


class SpectralTable(NamedTuple):
    """A relative spectrum: wavelengths (k,) in nm, rising, and weights (k,), 0 and above."""

    wavelengths_nm: Array
    weights: Array


@dataclass(frozen=True, eq=False)
class RaySet:
    """Rays as a file gives them, n of them, in the file's own frame and in mm.

    The flux of a ray is in lm where ``quantity`` is "luminous" and in W where it is "radiant". Of
    spectra a file has none, a wavelength for each ray, one table for all (``spectrum_index`` is
    None), or a table for each ray.
    """

    #: (n, 3), in mm.
    positions_mm: Array
    #: (n, 3), of length 1.
    directions: Array
    #: (n,), 0 and above, in lm or W.
    flux: Array
    quantity: FluxQuantity
    #: (n,), in nm; None where the file has none for each ray.
    wavelengths_nm: Array | None = None
    spectra: tuple[SpectralTable, ...] = ()
    #: (n,), which of ``spectra`` each ray has, from 0.
    spectrum_index: NDArray[np.intp] | None = None
    #: What the header says of the whole source; None where it says nothing.
    stated_flux_lm: float | None = None
    stated_flux_w: float | None = None
    #: Millimetres in the file's unit of length.
    unit_mm: float = 1.0
    description: str = ""

    @property
    def count(self) -> int:
        """How many rays there are."""
        return len(self.flux)

    @property
    def total_flux(self) -> float:
        """The sum of the rays' flux, in lm or W as ``quantity`` says."""
        return float(self.flux.sum())

    @property
    def stated_flux(self) -> float | None:
        """What the header says in the unit of ``total_flux``; None where it says nothing."""
        return self.stated_flux_lm if self.quantity == "luminous" else self.stated_flux_w


class RayFaults:
    """Raises for the first ray of a file that breaks a rule, and says how many others do.

    ``byte_of`` gives where in the file a ray (from 0) begins.
    """

    def __init__(self, file: Path, byte_of: Callable[[int], int]) -> None:
        self.file = file
        self._byte_of = byte_of

    def refuse_where(self, wrong: ArrayLike, message: str, values: Array) -> None:
        """Raise if any of ``wrong`` (n,) holds; ``values`` (n,) or (n, 3) fill ``{value}``."""
        rays = np.asarray(wrong, dtype=np.bool_)
        if not rays.any():
            return
        at = int(np.argmax(rays))
        shown = ", ".join(f"{value:.6g}" for value in np.atleast_1d(values[at]))
        others = int(np.count_nonzero(rays)) - 1
        besides = f" ({others} other rays have the same fault)" if others else ""
        raise PhotometryError(
            message.replace("{value}", shown) + besides,
            file=self.file,
            where=f"ray {at + 1} of {len(rays)}, byte {self._byte_of(at)}",
        )


def checked_directions(directions: Array, faults: RayFaults) -> Array:
    """Return ``directions`` (n, 3) with the length 1, where they had it but for rounding.

    Raises:
        PhotometryError: One is not finite, has no length, or another one than 1.
    """
    unsound = np.logical_not(np.isfinite(directions)).any(axis=1)
    faults.refuse_where(
        unsound, "the direction ({value}) is not finite; get the file anew", directions
    )
    with np.errstate(over="ignore"):
        lengths = np.sqrt(np.einsum("ij,ij->i", directions, directions))
    faults.refuse_where(
        lengths == 0.0, "the direction ({value}) has no length; get the file anew", directions
    )
    faults.refuse_where(
        ~(np.abs(lengths - 1.0) <= DIRECTION_TOLERANCE),
        "the direction has the length {value} instead of 1; export it with direction cosines",
        lengths,
    )
    return directions / lengths[:, None]


def checked_positions(positions: Array, unit_mm: float, faults: RayFaults) -> Array:
    """Return ``positions`` (n, 3), of ``unit_mm``, in mm, if they are finite."""
    unsound = np.logical_not(np.isfinite(positions)).any(axis=1)
    faults.refuse_where(unsound, "the start ({value}) is not finite; get the file anew", positions)
    return positions * unit_mm


def checked_flux(flux: Array, faults: RayFaults) -> Array:
    """Return ``flux`` (n,) if it is finite, not negative, and not all 0."""
    faults.refuse_where(
        ~(np.isfinite(flux) & (flux >= 0.0)),
        "the flux {value} must be a number of 0 or more; get the file anew",
        flux,
    )
    if not flux.any():
        raise PhotometryError(
            f"the flux of all {len(flux)} rays is 0, so nothing shines; get another file",
            file=faults.file,
        )
    return flux


def checked_wavelengths(wavelengths_nm: Array, shown: str, faults: RayFaults) -> Array:
    """Return ``wavelengths_nm`` (n,) if they are light's; ``shown`` is the unit of the file.

    Raises:
        PhotometryError: One is not finite, or so far off that its unit must be another.
    """
    within = (wavelengths_nm >= _SHORTEST_NM) & (wavelengths_nm <= _LONGEST_NM)
    faults.refuse_where(
        ~within,
        f"the wavelength {{value}} nm is no light's; this format has it in {shown}",
        wavelengths_nm,
    )
    return wavelengths_nm
