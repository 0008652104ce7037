# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Reading a material page of the refractiveindex.info database (YAML, CC0)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

import numpy as np
import yaml

from lamplit.errors import SpectrumError
from lamplit.materials.dispersion import check_coefficients, refractive_index
from lamplit.spectrum import Array, SpectralDistribution

#: The largest page of the database has some 0.5 MB; larger files are refused unread.
MAX_BYTES = 2 * 2**20

#: A page nests five deep and holds some dozens of nodes; its tables are single strings.
_MAX_DEPTH = 16
_MAX_NODES = 20_000

IndexExtension = Literal["error", "constant", "formula"]


@dataclass(frozen=True)
class IndexPage:
    """The optical constants of one page: n(λ) and k(λ), either of which may be missing."""

    n: SpectralDistribution | None
    k: SpectralDistribution | None
    references: str


def read_page(path: Path, *, extension: IndexExtension = "error") -> IndexPage:
    """Return n and k of a database page: formulas 1-9, tabulated n, k, and nk.

    Where a page gives n or k twice, the first counts. ``extension`` says what holds outside the
    page's range: an error, the end value, or, for a formula, the formula itself.

    Raises:
        SpectrumError: The file is too large, no YAML, nested too deep, or no such page; the
            message names the file and the entry of ``DATA``.
    """
    page = _mapping(_load(path), path, "the page")
    entries = page.get("DATA")
    if not isinstance(entries, list) or not entries:
        raise SpectrumError(
            "this is no page of refractiveindex.info: a list DATA is expected", file=path
        )
    n: SpectralDistribution | None = None
    k: SpectralDistribution | None = None
    for number, raw in enumerate(cast("list[object]", entries)):
        where = f"DATA[{number}]"
        for kind, distribution in _entry(_mapping(raw, path, where), path, where, extension):
            if kind == "n":
                n = n or distribution
            else:
                k = k or distribution
    return IndexPage(n, k, " ".join(str(page.get("REFERENCES", "")).split()))


def formula_distribution(
    formula: int,
    coefficients: tuple[float, ...],
    range_nm: tuple[float, float],
    *,
    extension: IndexExtension = "error",
    label: str = "the refractive index",
) -> SpectralDistribution:
    """Return n(λ) of one of the nine formulas, defined on ``range_nm``.

    Raises:
        SpectrumError: The formula or the number of its coefficients does not exist, or the range
            does not rise.
    """
    check_coefficients(formula, coefficients)
    low, high = range_nm
    if not 0 < low < high:
        raise SpectrumError(
            f"a range rises from a positive wavelength; here it is {low:g}-{high:g}"
        )
    return SpectralDistribution(
        lambda nm: refractive_index(formula, coefficients, nm / 1000.0),
        (1e-3, float("inf")) if extension == "formula" else range_nm,
        "constant" if extension == "constant" else "error",
        label,
    )


def _entry(
    entry: Mapping[str, object], path: Path, where: str, extension: IndexExtension
) -> Iterator[tuple[str, SpectralDistribution]]:
    """Yield ('n' or 'k', distribution) for one entry of DATA."""
    kind = " ".join(str(entry.get("type", "")).split())
    label = f"{path.name}: {where}"
    try:
        if kind.startswith("formula "):
            limits = _numbers(entry, "wavelength_range" if "wavelength_range" in entry else "range")
            if len(limits) != 2:
                raise SpectrumError("wavelength_range needs two numbers in µm")
            formula = int(kind.split()[1]) if kind.split()[1].isdecimal() else 0
            coefficients = _numbers(entry, "coefficients")
            range_nm = (1000.0 * limits[0], 1000.0 * limits[1])
            yield (
                "n",
                formula_distribution(
                    formula, coefficients, range_nm, extension=extension, label=label
                ),
            )
        elif kind in ("tabulated n", "tabulated k", "tabulated nk"):
            letters = kind.split()[1]
            table = _table(entry, columns=1 + len(letters))
            for letter, column in zip(letters, table[1:], strict=True):
                yield (
                    letter,
                    SpectralDistribution.tabulated(
                        1000.0 * table[0],
                        column,
                        extension="constant" if extension == "constant" else "error",
                        label=label,
                    ),
                )
        else:
            raise SpectrumError(
                f"the type {kind[:40]!r} is unknown; 'formula 1' to 'formula 9', 'tabulated n', "
                "'tabulated k' and 'tabulated nk' are read"
            )
    except SpectrumError as fault:
        raise SpectrumError(fault.message, file=path, where=where) from fault


def _table(entry: Mapping[str, object], *, columns: int) -> Array:
    """Return the table of an entry, one row of the array per column of the file."""
    rows: list[list[str]] = []
    for number, line in enumerate(str(entry.get("data", "")).splitlines(), start=1):
        words = line.partition("#")[0].split()
        if words and len(words) != columns:
            raise SpectrumError(
                f"data line {number} has {len(words)} columns, and {columns} are expected"
            )
        if words:
            rows.append(words)
    if len(rows) < 2:
        raise SpectrumError(f"a table needs two rows at least, and this one has {len(rows)}")
    try:
        table = np.array(rows, dtype=np.float64)
    except ValueError:
        table = np.full((1, columns), np.nan)
    if not np.isfinite(table).all():
        for number, words in enumerate(rows, start=1):
            for word in words:
                _number(word, f"data row {number}")
    return np.transpose(table)


def _numbers(entry: Mapping[str, object], key: str) -> tuple[float, ...]:
    return tuple(_number(word, key) for word in str(entry.get(key, "")).split())


def _number(word: str, where: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = float("nan")
    if not np.isfinite(number):
        raise SpectrumError(f"{where}: {word[:40]!r} is not a finite number")
    return number


def _mapping(value: object, path: Path, where: str) -> Mapping[str, object]:
    if not isinstance(value, dict):
        raise SpectrumError("a mapping of keys is expected", file=path, where=where)
    return cast("dict[str, object]", value)


def _load(path: Path) -> object:
    """Return the YAML document of ``path``; runs no code, follows no alias."""
    try:
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise SpectrumError(
                f"{size / 2**20:.0f} MB is too large for a page of refractiveindex.info; "
                f"{MAX_BYTES // 2**20} MB is the limit",
                file=path,
            )
        text = path.read_text(encoding="utf-8-sig")
    except OSError as fault:
        raise SpectrumError(f"cannot be read: {fault.strerror}", file=path) from fault
    except UnicodeDecodeError as fault:
        raise SpectrumError("this is no UTF-8 text", file=path) from fault
    loader = cast("type[yaml.SafeLoader]", getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    try:
        _check_shape(text, loader, path)
        return cast("object", loader(text).get_single_data())
    except (yaml.YAMLError, ValueError) as fault:
        mark = getattr(fault, "problem_mark", None)
        line = f"line {mark.line + 1}" if mark is not None else None
        problem = getattr(fault, "problem", None) or str(fault)
        raise SpectrumError(f"the YAML is broken: {problem}", file=path, where=line) from fault


def _check_shape(text: str, loader: type[yaml.SafeLoader], path: Path) -> None:
    """Refuse deep nesting, aliases and floods of nodes while they are still a flat event stream."""
    depth = 0
    for count, event in enumerate(yaml.parse(text, Loader=loader)):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > _MAX_DEPTH or count > _MAX_NODES or isinstance(event, yaml.AliasEvent):
            mark = event.start_mark
            raise SpectrumError(
                "no page of refractiveindex.info nests or repeats like this",
                file=path,
                where=f"line {mark.line + 1}" if mark else None,
            )
