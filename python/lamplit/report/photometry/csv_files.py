# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Measurements as CSV: comma, point, CRLF (RFC 4180), UTF-8, units in the headers."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.colour.hue import hue
from lamplit.errors import LamplitError
from lamplit.report.photometry.isocandela import middles

if TYPE_CHECKING:
    from lamplit.engine.cross_check import CrossCheck
    from lamplit.report.photometry.results import FunctionResults, Results

Array = NDArray[np.float64]

POINTS_HEADER = (
    "function", "rule", "requirement", "clause", "trust", "H_deg", "V_deg", "sense", "required",
    "got", "standard_error", "unit", "margin_percent", "outcome", "paths_factor", "remark",
)  # fmt: skip
SPOTS_HEADER = (
    "function", "H_deg", "V_deg", "intensity_cd", "standard_error_cd", "X_cd", "Z_cd",
    "x", "y", "standard_error_x", "standard_error_y", "correlation_xy",
    "dominant_wavelength_nm", "standard_error_dominant_wavelength_nm", "CCT_K",
    "standard_error_CCT_K",
)  # fmt: skip
REFLEX_HEADER = (
    "reflector", "entrance_V_deg", "entrance_H_deg", "observation_deg", "CIL_mcd_per_lx",
    "standard_error_mcd_per_lx",
)  # fmt: skip
CROSS_CHECK_FILE = "cross-check.csv"
CROSS_CHECK_HEADER = (
    "H_deg", "V_deg", "from_light_cd", "standard_error_from_light_cd", "from_receiver_cd",
    "standard_error_from_receiver_cd", "apart_sigmas",
)  # fmt: skip
CANDELA_HEADER = (
    "function", "H_deg", "V_deg", "intensity_cd", "standard_error_cd", "X_cd", "Z_cd",
)  # fmt: skip


def points_csv(results: Results) -> bytes:
    """Return a line for each finding: what was required, and got, by which clause."""
    rows = [
        (
            name, verdict.rule, found.requirement, found.clause, found.trust,
            found.h_deg, found.v_deg, found.sense, found.required, found.got,
            found.standard_error, found.unit, found.margin_percent, found.outcome,
            found.paths_factor, found.remark,
        )
        for name, verdict in results.verdicts()
        for found in verdict.findings
    ]  # fmt: skip
    return _written(POINTS_HEADER, rows)


def spots_csv(results: Results) -> bytes:
    """Return a line for each direction that was measured: intensity and chromaticity."""
    return _written(SPOTS_HEADER, (row for one in results.functions for row in _spots(one)))


def reflex_csv(results: Results) -> bytes:
    """Return a line for each pair of angles at which a retro-reflector was measured."""
    rows = [(one.name, *vars(own).values()) for one in results.reflectors for own in one.readings]
    return _written(REFLEX_HEADER, rows)


def cross_check_csv(both: CrossCheck) -> bytes:
    """Return a line for each direction that was measured by both ways."""
    columns = (
        both.spot_h_deg, both.spot_v_deg, both.light_cd, both.light_standard_error_cd,
        both.eye_cd, both.eye_standard_error_cd, both.sigmas,
    )  # fmt: skip
    return _written(CROSS_CHECK_HEADER, zip(*columns, strict=True))


def candela_csv(results: Results) -> bytes:
    """Return a line for each cell of the grids: the mean intensity about its middle."""
    return _written(CANDELA_HEADER, (row for one in results.functions for row in _cells(one)))


def read_grid(path: Path, shapes: Mapping[str, tuple[int, int]]) -> dict[str, tuple[Array, Array]]:
    """Return X, Y, Z (v, h, 3) and the standard error of Y (v, h), in cd, by function.

    ``shapes`` says how many rows and columns the grid of each function has.

    Raises:
        LamplitError: The file cannot be read, or is not one that `candela_csv` made.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            header, *lines = csv.reader(file, strict=True)
    except OSError as fault:
        raise LamplitError(f"cannot be read ({fault.strerror})", file=path) from fault
    except (csv.Error, UnicodeDecodeError, ValueError) as fault:
        raise LamplitError("is no CSV file of `lamplit measure`", file=path) from fault
    if tuple(header) != CANDELA_HEADER:
        raise LamplitError(f"has other columns than {', '.join(CANDELA_HEADER)}", file=path)
    found: dict[str, tuple[Array, Array]] = {}
    for name, (rows, columns) in shapes.items():
        own = [line[3:] for line in lines if line and line[0] == name]
        try:
            numbers = np.array(own, dtype=np.float64).reshape(rows, columns, 4)
        except ValueError as fault:
            raise LamplitError(
                f"does not hold {rows} × {columns} cells of {name!r}; measure again", file=path
            ) from fault
        if not np.isfinite(numbers).all():
            raise LamplitError(f"holds a number of {name!r} that is not finite", file=path)
        found[name] = numbers[..., [2, 0, 3]], numbers[..., 1]
    return found


def _spots(one: FunctionResults) -> Iterable[Sequence[object]]:
    seen = one.observed
    colours = seen.spot_colours
    xy, errors = colours.xy, colours.standard_error
    with np.errstate(divide="ignore", invalid="ignore"):
        correlation = colours.covariance[:, 0, 1] / errors.prod(axis=-1)
    for at in range(len(seen.spot_h_deg)):
        yield (
            one.name, seen.spot_h_deg[at], seen.spot_v_deg[at], seen.spot_cd[at],
            seen.spot_standard_error_cd[at], seen.spot_xyz[at, 0], seen.spot_xyz[at, 2],
            *xy[at], *errors[at], correlation[at], *hue(xy[at], colours.covariance[at]),
        )  # fmt: skip


def _cells(one: FunctionResults) -> Iterable[Sequence[object]]:
    seen = one.observed
    h, v = middles(seen.grid_h_edges_deg), middles(seen.grid_v_edges_deg)
    for row, column in np.ndindex(*seen.grid_cd.shape):
        x, y, z = seen.grid_xyz[row, column]
        yield one.name, h[column], v[row], y, seen.grid_standard_error_cd[row, column], x, z


def _written(header: Sequence[str], rows: Iterable[Sequence[object]]) -> bytes:
    held = io.StringIO(newline="")
    writer = csv.writer(held)
    writer.writerow(header)
    for row in rows:
        writer.writerow([_cell(value) for value in row])
    return held.getvalue().encode()


def _cell(value: object) -> str:
    """Return a number to its last digit, so that it reads back the same; nothing for none."""
    if value is None:
        return ""
    if isinstance(value, float):  # as are the doubles of numpy
        return repr(float(value)) if np.isfinite(value) else ""
    return str(value)
