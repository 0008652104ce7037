# SPDX-License-Identifier: Apache-2.0 OR MIT
"""All files of a measurement, in a folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from lamplit.photometry import PhotometryError
from lamplit.photometry.measured import from_hv
from lamplit.photometry.writing import FileLabels, write_ies, write_ldt
from lamplit.report.atomic import prepare_output, write_bytes
from lamplit.report.photometry.csv_files import candela_csv, points_csv, reflex_csv, spots_csv
from lamplit.report.photometry.isocandela import middles
from lamplit.report.photometry.kept import CANDELA_FILE, MEASUREMENT_FILE, measurement_json
from lamplit.report.photometry.plots import KINDS, draw_plots, stems

if TYPE_CHECKING:
    from lamplit.report.photometry.results import FunctionResults, Results

POINTS_FILE, SPOTS_FILE, REFLEX_FILE = "points.csv", "spots.csv", "reflex.csv"


def write_measurement(
    results: Results, directory: Path, progress: Callable[[int, int], object] | None = None
) -> dict[str, str]:
    """Write the tables, plots and numbers of ``results``; return the files and what is in each.

    ``measurement.json`` is taken away first and written last, so that a folder which has one is
    complete. Plots take longest: they are drawn before anything is touched, and ``progress`` is
    told of them (`draw_plots`).

    Raises:
        OutputError: The folder or a file in it cannot be written.
        PhotometryError: The grid of a function cannot be said in an IES or EULUMDAT file.
    """
    files = (POINTS_FILE, SPOTS_FILE, CANDELA_FILE, REFLEX_FILE, MEASUREMENT_FILE)
    prepare_output(directory, files)
    plots = draw_plots(results, progress)
    (directory / MEASUREMENT_FILE).unlink(missing_ok=True)
    written: dict[str, str] = {}
    if results.outcome is not None:
        write_bytes(directory / POINTS_FILE, points_csv(results))
        written[POINTS_FILE] = "every requirement: required, got, standard error, outcome"
    if results.functions:
        write_bytes(directory / SPOTS_FILE, spots_csv(results))
        written[SPOTS_FILE] = "intensity and chromaticity in the directions of the test points"
        write_bytes(directory / CANDELA_FILE, candela_csv(results))
        written[CANDELA_FILE] = "intensity over the grid of H and V"
    if results.reflectors:
        write_bytes(directory / REFLEX_FILE, reflex_csv(results))
        written[REFLEX_FILE] = "what reflectors send back, by entrance and observation angle"
    for one, stem in zip(results.functions, stems(results), strict=True):
        written |= _write_photometric_files(results, one, directory, stem)
    for plot in plots:
        write_bytes(directory / plot.file, plot.content)
        written[plot.file] = KINDS[plot.kind]
    write_bytes(directory / MEASUREMENT_FILE, measurement_json(results))
    written[MEASUREMENT_FILE] = "all numbers, and what makes them again"
    return written


def _write_photometric_files(
    results: Results, one: FunctionResults, directory: Path, stem: str
) -> dict[str, str]:
    """Write the grid of a function for other programs; nothing of the dark, or of one row."""
    seen = one.observed
    if min(seen.grid_cd.shape) < 2 or not seen.grid_cd.any():
        return {}
    grid = from_hv(middles(seen.grid_h_edges_deg), middles(seen.grid_v_edges_deg), seen.grid_cd)
    labels = FileLabels(
        luminaire=f"{results.scene}, {one.name}",
        lamp=", ".join(results.energy.emitted_lm) if results.energy else "",
        report=results.scene_hash[:12],
        laboratory=f"computed by Lamplit {results.version}",
        others={"OTHER": f"seed {results.seed}, {results.paths} paths"},
    )
    ies, ldt = f"{stem}.ies", f"{stem}.ldt"
    write_ies(directory / ies, grid, labels)
    written = {ies: "IES LM-63-2019, type A: the grid as it is"}
    try:
        write_ldt(directory / ldt, grid, labels)
    except PhotometryError:
        # The grid could be said in an IES file, so it is that its C-planes meet no light at all.
        (directory / ldt).unlink(missing_ok=True)
        return written
    return written | {ldt: "EULUMDAT, C-planes through the grid; 0 beyond it"}
