# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The tables of docs/materials.md and docs/lamps.md, from the library and the generators."""

from __future__ import annotations

import numpy as np

from builders.sections import table
from lamplit.colour.locus import dominant_wavelength
from lamplit.colour.tristimulus import chromaticity_xy, luminous_efficacy, tristimulus
from lamplit.lamps import lamp_description, lamp_names, lamp_parameters
from lamplit.materials import Checker, Dielectric, Glossy, Material, material, material_names
from lamplit.materials.appearance import (
    VISIBLE_NM,
    plate_transmittance,
    seen_xyz,
    surface_reflectance,
)
from lamplit.materials.optics import LINE_D_NM, abbe_number, normal_reflectance
from lamplit.sources import BulbName, bulb, bulb_names, source, source_names

#: A usual lamp lens, the thickness at which a plate's numbers are given.
_LENS_MM = 2.5


def material_sections() -> dict[str, str]:
    """Return the generated sections of docs/materials.md by name."""
    names = material_names()
    numbers = [(f"`{name}`", *_optics(material(name)), *_seen(material(name))) for name in names]
    return {
        "materials": table(
            ("name", "kind", "n_d", "V_d", "R0 in %", "T or R in %", "x", "y"), numbers
        ),
        "references": "\n".join(_card(name) for name in names),
        "sources": table(
            ("name", "x", "y", "λ_d in nm", "lm/W", "what it is"),
            (_source_row(name) for name in source_names()),
        ),
        "bulbs": table(
            ("name", "lm", "±", "bulb", "reference"),
            (_bulb_row(name) for name in bulb_names()),
        ),
        "source-references": "\n".join(_source_references()),
    }


def _optics(entry: Material) -> tuple[str, str, str, str]:
    """Return kind, n_d, V_d, and the reflectance of one face at normal incidence."""
    if isinstance(entry, (Dielectric, Glossy)):
        index = float(entry.index(LINE_D_NM))
        abbe = abbe_number(entry.index)
        shown = f"{abbe:.1f}" if np.isfinite(abbe) else "–"
        return entry.kind, f"{index:.4f}", shown, f"{100 * float(normal_reflectance(index)):.2f}"
    if isinstance(entry, Checker):
        return entry.kind, "–", "–", "–"
    return entry.kind, "–", "–", f"{100 * float(surface_reflectance(entry, LINE_D_NM)):.2f}"


def _seen(entry: Material) -> tuple[str, str, str]:
    """Return luminous transmittance or reflectance, x and y under illuminant A."""
    values = (
        plate_transmittance(entry, VISIBLE_NM, _LENS_MM)
        if isinstance(entry, Dielectric)
        else surface_reflectance(entry, VISIBLE_NM)
    )
    xyz = seen_xyz(values, "A")
    x, y = chromaticity_xy(xyz)
    return f"{xyz[1]:.1f}", f"{x:.4f}", f"{y:.4f}"


def _card(name: str) -> str:
    entry = material(name)
    references = "".join(f"\n  - {reference}" for reference in entry.references)
    return f"- **`{name}`** {entry.description}. Licence: {entry.licence}.{references}"


def _source_row(name: str) -> tuple[str, ...]:
    entry = source(name)
    spd = entry.distribution()
    xy = chromaticity_xy(tristimulus(spd, normalisation="relative"))
    wavelength, purity = dominant_wavelength(xy)
    hue = f"{wavelength:.1f}" if purity > 0.5 else "–"
    efficacy = f"{luminous_efficacy(spd):.0f}"
    return f"`{name}`", f"{xy[0]:.4f}", f"{xy[1]:.4f}", hue, efficacy, entry.description


def _bulb_row(name: BulbName) -> tuple[str, ...]:
    entry = bulb(name)
    spread = f"{100 * entry.tolerance:g} %"
    return f"`{name}`", f"{entry.flux_lm:g}", spread, entry.description, entry.reference


def _source_references() -> list[str]:
    """Return one line for each reference, with the sources that rest on it."""
    names: dict[tuple[str, str], list[str]] = {}
    for name in source_names():
        entry = source(name)
        names.setdefault((entry.reference, entry.licence), []).append(f"`{name}`")
    return [
        f"- {', '.join(those)}: {reference}. Licence: {licence}."
        for (reference, licence), those in names.items()
    ]


def lamp_sections() -> dict[str, str]:
    """Return the generated sections of docs/lamps.md by name: one of parameters for each lamp."""
    return {name: _lamp(name) for name in lamp_names()}


def _lamp(name: str) -> str:
    rows = [
        (f"`{each.name}`", f"`{_plain(each.default)}`", each.limits, each.description)
        for each in lamp_parameters(name)
    ]
    parameters = table(("parameter", "default", "limits", "meaning"), rows)
    return f"`lamplit lamp {name} -o DIR`: {lamp_description(name)}.\n\n{parameters}"


def _plain(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
