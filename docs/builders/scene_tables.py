# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The tables of docs/scene.md, from the JSON Schema that the loader's own models give."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, TypeAlias

from builders.sections import table
from lamplit.scene.schema import scene_schema

Node: TypeAlias = Mapping[str, Any]

#: The sections of the page; in each, models of the schema under the titles they are shown with.
#: A model without a title is titled by its own ``kind``.
_SECTIONS: dict[str, dict[str, str]] = {
    "camera": {"PinholeCamera": "", "ThinLensCamera": "", "OrthographicCamera": ""},
    "eyes": {"Eye": "`[[eyes]]`"},
    "image": {"ImageSettings": "`[image]`"},
    "display": {
        "DisplaySettings": "`[display]`",
        "EyeSettings": "`[display.eye]`",
        "CustomDisplay": "`space = { primaries_xy, white_xy, gamma }`",
        "IccDisplay": "`space = { icc }`",
    },
    "path": {"PathSettings": "`[path]`"},
    "hall": {"HallSettings": "`[hall]`"},
    "measure": {
        "MeasureSettings": "`[measure]`",
        "LampFunction": "`[[measure.functions]]`",
        "Reflector": "`[[measure.reflectors]]`",
    },
    "ambient": {"Ambient": "`[ambient]`"},
    "background": {
        "ConstantBackground": "",
        "GradientBackground": "",
        "StudioBackground": "",
        "SkyBackground": "",
        "ImageBackground": "",
        "SoftBox": "`[[background.soft_boxes]]`",
        "Sun": "`[[background.suns]]`",
    },
    "lights": {"PointLight": "", "DirectionalLight": "", "SphereLight": ""},
    "objects": dict.fromkeys(
        ["MeshObject", "Sphere", "Tetrahedron", "Box", "Cylinder", "Cone", "Disc", "Plane"], ""
    ),
    "transform": {"Transform": "`transform = { .. }`"},
    "emission": {
        "Emission": "`[objects.emission]`",
        "CosineDistribution": "`distribution = { cosine_exponent }`",
        "FileDistribution": "`distribution = { file, axis, up }`",
    },
    "ray-files": {"RayFile": "`[[ray_files]]`"},
    "materials": dict.fromkeys(
        ["Dielectric", "Conductor", "Mirror", "Diffuse", "DiffuseTransmitter", "Checker", "Glossy"],
        "",
    ),
    "finish": {
        "Texture": "`texture = { .. }`",
        "Lacquer": "`lacquer = { .. }`",
        "Scattering": "`scattering = { .. }`",
    },
    "hall-terms": {"HallTerms": "`hall = { .. }`"},
    "spectra": {
        "TabulatedSpectrum": "`{ wavelengths_nm, values }`",
        "CsvSpectrum": "`{ csv }`",
        "SpdxSpectrum": "`{ spdx }`",
    },
    "sources": {
        "BlackbodySource": "`{ temperature_kelvin }`",
        "LedSource": "`{ led_peak_nm, led_fwhm_nm }`",
    },
    "index": {
        "CauchyIndex": "`{ cauchy }`",
        "SellmeierIndex": "`{ sellmeier_b, sellmeier_c_um2 }`",
        "FormulaIndex": "`{ formula, coefficients }`",
        "TabulatedIndex": "`{ wavelengths_nm, n }`",
        "IndexPageFile": "`{ refractiveindex_info }`",
    },
    "metal": {
        "ConstantComplexIndex": "`{ n, k }`",
        "TabulatedComplexIndex": "`{ wavelengths_nm, n, k }`",
        "ComplexIndexPageFile": "`{ refractiveindex_info }`",
    },
    "transmittance": {
        "TabulatedTransmittance": "`{ thickness_mm, wavelengths_nm, values }`",
        "ConstantTransmittance": "`{ thickness_mm, value }`",
        "Dye": "`{ dye = { .. } }`",
        "ExtinctionTransmittance": "`{ wavelengths_nm, k }`",
        "PageTransmittance": "`{ refractiveindex_info }`",
    },
}

#: Keys that a section tells once, in its text above the tables.
_TOLD_ABOVE = {
    "background": {"group", "suns"},
    "objects": {"name", "material", "priority", "transform", "emission"},
    "ray-files": {"transform"},
    "materials": {"description", "references", "licence", "hall", "roughness", "texture"},
    "lights": {"name", "source", "luminance_cd_m2"},
    "spectra": {"interpolation", "extension", "scale"},
    "index": {"interpolation", "extension", "range_nm"},
    "metal": {"interpolation", "extension"},
    "transmittance": {"interpolation", "extension", "scale"},
}

#: How values of a model are told; the first of a family of forms stands for them all.
_FORMS = {
    "NamedSource": "[source](#light-sources)",
    "ConstantSpectrum": "[spectrum](#spectra)",
    "ConstantIndex": "[index](#refractive-index)",
    "ConstantComplexIndex": "[n and k](#metals)",
    "TabulatedTransmittance": "[transmittance](#internal-transmittance)",
    "SoftBox": "soft box",
    "LampFunction": "function",
    "Reflector": "reflector",
    "Radiator": "`{ source, luminance_cd_m2 }`",
    "CustomDisplay": "a table",
    "EyeSettings": "a table",
    "CosineDistribution": "`{ cosine_exponent }`",
    "FileDistribution": "`{ file, axis, up }`",
    "Lacquer": "[a table](#finish)",
    "Scattering": "[a table](#finish)",
}

_PLAIN = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true, false"}
_NULL = {"type": "null"}


def scene_sections() -> dict[str, str]:
    """Return the generated sections of docs/scene.md by name."""
    models = scene_schema()["$defs"]
    return {
        section: "\n\n".join(_shown(models[name], section, title) for name, title in titles.items())
        for section, titles in _SECTIONS.items()
    }


def _shown(model: Node, section: str, title: str) -> str:
    hidden = _TOLD_ABOVE.get(section, set[str]()) | {"kind"}
    keys = {key: node for key, node in model["properties"].items() if key not in hidden}
    needed = model.get("required", ())
    rows = [
        (f"`{key}`", _values(node), _default(node, needed=key in needed), _meaning(node))
        for key, node in keys.items()
    ]
    title = title or _by_kind(model)
    sentence = model["description"].split("\n\n")[0].replace("``", "`").strip()
    heading = f"**{title}** {sentence}"
    if not rows:
        return heading
    silent = not any(row[3] for row in rows)
    headings = ("key", "values", "default", "meaning")[: 3 if silent else 4]
    return f"{heading}\n\n{table(headings, (row[: len(headings)] for row in rows))}"


def _by_kind(model: Node) -> str:
    kind = model["properties"]["kind"]["const"]
    return f'`kind = "{kind}"`'


def _meaning(node: Node) -> str:
    return node.get("description", "")


def _default(node: Node, *, needed: bool) -> str:
    if needed:
        return "must be given"
    value = node.get("default")
    return "–" if value in (None, "", [], {}) else f"`{json.dumps(value, ensure_ascii=False)}`"


def _values(node: Node) -> str:
    """Return in few words what values a key takes."""
    if "$ref" in node:
        return _FORMS[_model(node)]
    choices = [part for part in node.get("anyOf", node.get("oneOf", ())) if part != _NULL]
    if choices:
        told = [_values(part) for part in choices if "$ref" not in part or _model(part) in _FORMS]
        return " or ".join(dict.fromkeys(told))
    if "const" in node:
        return f"`{json.dumps(node['const'])}`"
    if "enum" in node:
        return ", ".join(f"`{json.dumps(choice)}`" for choice in node["enum"])
    if node["type"] in {"array", "object"}:
        return _array(node)
    return _PLAIN[node["type"]] + _limits(node)


def _model(node: Node) -> str:
    return node["$ref"].rsplit("/", 1)[-1]


def _array(node: Node) -> str:
    if node["type"] == "object":
        return f"`{{ name = {_PLAIN[node['additionalProperties']['type']]}, .. }}`"
    parts = node.get("prefixItems")
    if parts is None:
        noun = _values(node["items"])
        noun, comma, limits = noun.partition(", ")
        ending = "es" if noun.endswith("x") else "" if noun.endswith("s") else "s"
        return f"list of {noun}{ending}{comma}{limits}"
    if all(part.get("type") == "number" for part in parts):
        return f"{len(parts)} numbers"
    return f"{len(parts)} times {_values(parts[0])}"


def _limits(node: Node) -> str:
    low, high = node.get("minimum"), node.get("maximum")
    above, below = node.get("exclusiveMinimum"), node.get("exclusiveMaximum")
    if low is not None and high is not None:
        return f", {low:.7g} to {high:.7g}"
    if above is not None:
        end = "" if below is None else f", below {below:g}"
        return f", above {above:g}" + (end if high is None else f", at most {high:g}")
    return "" if low is None else f", {low:g} or more"
