# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The report: one HTML file with everything in it, which asks nothing of a network."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lamplit.colour.hue import hue
from lamplit.errors import LamplitError
from lamplit.printable import printable
from lamplit.report.photometry import reflected, table
from lamplit.report.photometry.plots import Plot, draw_plots
from lamplit.report.photometry.results import tally
from lamplit.report.photometry.style import MARKS, cd, spread

if TYPE_CHECKING:
    from lamplit.report.photometry.results import FunctionResults, ReflectorResults, Results
    from lamplit.rules.verdict import Finding, Verdict

#: What the marks of a rule's figures mean.
TRUST = {
    "V": "read in the cited text",
    "V2": "read in a transcription that cites the original, not in the official text",
    "N": "computed here",
    "M": "from memory, not read anywhere: check it before use",
}
#: Pictures that `lamplit render` and `lamplit mix` leave beside a measurement.
_PICTURES = {"picture.png": "as rendered", "mix/picture.png": "as mixed"}
#: A picture on the page has no more pixels across than this.
_WIDEST = 1400


class Picture(NamedTuple):
    """A picture for the page: its caption, and a PNG."""

    caption: str
    content: bytes


def pictures_in(directory: Path) -> list[Picture]:
    """Return the renders that lie in ``directory``, if there are any."""
    found = {directory / name: caption for name, caption in _PICTURES.items()}
    return [read_picture(path, text) for path, text in found.items() if path.is_file()]


def read_picture(path: Path, caption: str | None = None) -> Picture:
    """Return the picture at ``path``, made smaller where it is wider than the page.

    Raises:
        LamplitError: It cannot be read, or is no picture.
    """
    from PIL import Image as Raster
    from PIL import UnidentifiedImageError

    try:
        with Raster.open(path, formats=("PNG", "JPEG")) as opened:
            kept = opened.convert("RGB")
            profile = opened.info.get("icc_profile")
    except (OSError, UnidentifiedImageError, Raster.DecompressionBombError, ValueError) as fault:
        reason = getattr(fault, "strerror", None) or "it is no PNG or JPEG"
        raise LamplitError(f"cannot be shown ({reason})", file=path) from fault
    if kept.width > _WIDEST:
        size = (_WIDEST, max(round(kept.height * _WIDEST / kept.width), 1))
        kept = kept.resize(size, Raster.Resampling.LANCZOS)
    held = io.BytesIO()
    kept.save(held, "PNG", icc_profile=profile)
    return Picture(path.stem if caption is None else caption, held.getvalue())


def render_page(
    results: Results,
    pictures: Iterable[Picture] = (),
    progress: Callable[[int, int], object] | None = None,
) -> str:
    """Return the report on ``results`` as HTML: verdict first, then what it stands on.

    All text is escaped, pictures are data in the file, and a policy in its head forbids it to load
    anything else. ``progress`` is told of the plots (`draw_plots`).
    """
    from jinja2 import Environment, StrictUndefined

    environment = Environment(
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_shown,
    )
    template = environment.from_string(Path(__file__).with_name("page.html").read_text("utf-8"))
    plots = draw_plots(results, progress)
    return template.render(
        results=results,
        overall=None if results.outcome is None else MARKS[results.outcome],
        functions=[_function(one, plots) for one in results.functions],
        reflectors=[_reflector(one) for one in results.reflectors],
        pictures=[(one.caption, _source(one.content)) for one in pictures],
        lamp_plots={plot.kind: _source(plot.content) for plot in plots if plot.function is None},
        energy=_energy_rows(results),
        provenance=_provenance(results),
        trust=_trust(results),
        paths=f"{results.paths:,}".replace(",", " "),
    )


def _shown(value: Any) -> Any:
    return printable(value) if isinstance(value, str) else value


def _source(content: bytes) -> str:
    return f"data:image/png;base64,{base64.b64encode(content).decode()}"


def _function(one: FunctionResults, plots: list[Plot]) -> dict[str, Any]:
    verdict = one.verdict
    facts: dict[str, Any] = {
        "name": one.name,
        "on_axis": _on_axis(one),
        "plots": {plot.kind: _source(plot.content) for plot in plots if plot.function == one.name},
        "verdict": None,
        "spots": [] if verdict else _spots(one),
    }
    if verdict is not None:
        facts |= _judged(verdict)
        facts["rows"] = [_row(finding, count) for finding, count in _ordered(verdict, one)]
    return facts


def _judged(verdict: Verdict) -> dict[str, Any]:
    return {
        "verdict": verdict,
        "mark": MARKS[verdict.outcome],
        "decided_by": table.in_words(verdict),
        "tally": [(MARKS[name], count) for name, count in tally(verdict).items() if count],
        "chosen": ", ".join(f"{name} {choice}" for name, choice in verdict.options),
    }


def _reflector(one: ReflectorResults) -> dict[str, Any]:
    shown = reflected.rows(one)
    first = shown[0]
    facts: dict[str, Any] = {
        "name": one.name,
        "on_axis": {
            f"V {first.v}, H {first.h}, {first.observation}": f"{first.got} {first.spread}"
        },
        "verdict": None,
        "rows": [(row, None if row.outcome is None else MARKS[row.outcome]) for row in shown],
    }
    return facts if one.verdict is None else facts | _judged(one.verdict)


def _ordered(verdict: Verdict, one: FunctionResults) -> list[tuple[Finding, int]]:
    """Return the findings at test points, then one of each kind of the rest, and how many."""
    points = table.points_of(verdict, one.observed)
    at_points = [(finding, 1) for point in points for finding in point.findings]
    return [*at_points, *table.gathered(table.elsewhere(verdict, one.observed))]


def _row(finding: Finding, count: int) -> dict[str, Any]:
    many = f"worst of {count} directions" if count > 1 else ""
    return {
        "mark": MARKS[finding.outcome],
        "h": "" if finding.h_deg is None else table.angle(finding.h_deg),
        "v": "" if finding.v_deg is None else table.angle(finding.v_deg),
        "got": table.got(finding),
        "spread": table.two_sigma(finding),
        "required": table.required(finding),
        "margin": table.margin(finding),
        "requirement": finding.requirement,
        "notes": [note for note in (many, finding.remark, table.more_paths(finding)) if note],
        "clause": finding.clause,
        "trust": finding.trust,
    }


def _on_axis(one: FunctionResults) -> dict[str, str]:
    """Return intensity and colour at HV, if that was measured."""
    seen = one.observed
    at = np.flatnonzero((seen.spot_h_deg == 0.0) & (seen.spot_v_deg == 0.0))
    if at.size == 0:
        return {}
    place = int(at[0])
    facts = {
        "at HV": f"{cd(float(seen.spot_cd[place]))} "
        f"{spread(2.0 * float(seen.spot_standard_error_cd[place]))} cd"
    }
    colours = seen.spot_colours
    if colours.is_known[place]:
        facts["x"], facts["y"] = (
            f"{value:.4f} ± {2.0 * error:.1g}"
            for value, error in zip(colours.xy[place], colours.standard_error[place], strict=True)
        )
        dominant, nm, kelvin, error = hue(colours.xy[place], colours.covariance[place])
        if np.isfinite(nm):
            name = "dominant wavelength" if dominant > 0.0 else "complementary wavelength"
            facts[name] = f"{abs(dominant):.1f} ± {2.0 * nm:.1g} nm"
        if np.isfinite(error):
            facts["CCT"] = f"{kelvin:.0f} ± {2.0 * error:.2g} K"
    return facts


def _spots(one: FunctionResults) -> list[tuple[str, str, str, str]]:
    seen = one.observed
    columns = (seen.spot_h_deg, seen.spot_v_deg, seen.spot_cd, seen.spot_standard_error_cd)
    return [
        (table.angle(float(h)), table.angle(float(v)), cd(float(got)), spread(2.0 * float(error)))
        for h, v, got, error in zip(*columns, strict=True)
    ]


def _energy_rows(results: Results) -> list[tuple[str, str, str]]:
    """Return name, lm and percent of everything that the flux of the sources became."""
    energy = results.energy
    if energy is None or not energy.total_lm > 0.0:
        return []
    entries = [*energy.ends(), ("not accounted for", energy.gap_lm)]
    return [(name, f"{lm:.4g}", f"{100.0 * lm / energy.total_lm:.3g}") for name, lm in entries]


def _provenance(results: Results) -> Mapping[str, str]:
    return {
        "scene": results.scene,
        "scene hash (SHA-256)": results.scene_hash,
        "seed": str(results.seed),
        "paths": f"{results.paths:,}".replace(",", " "),
        "complete": "yes" if results.complete else "no: stopped before all was done",
        **results.geometry,
        "time": f"{results.elapsed_s:.1f} s",
        "Lamplit": results.version,
        "command": results.command,
    }


def _trust(results: Results) -> list[tuple[str, str, int]]:
    """Return each mark of trust that occurs, what it means, and how many findings carry it."""
    counts: dict[str, int] = {}
    for _, verdict in results.verdicts():
        for finding in verdict.findings:
            counts[finding.trust] = counts.get(finding.trust, 0) + 1
    return [
        (mark, TRUST.get(mark, "not explained by the rule file"), n) for mark, n in counts.items()
    ]
