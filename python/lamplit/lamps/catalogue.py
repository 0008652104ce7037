# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The lamps by name: what each is, which parameters it takes, and writing one."""

from __future__ import annotations

import importlib
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, cast

from pydantic import ValidationError

from lamplit.errors import LamplitError, nearest_name
from lamplit.lamps.recipe import Lamp, LampParameters
from lamplit.lamps.writing import write_files

_DESCRIPTIONS = {
    "paper": "a sphere and a triangular pyramid of coloured plastic over a checker floor",
    "p21w": "housing, paraboloid, bulb with filament, red lens with pillow optics",
    "led-array": "twelve dies on a board, collimators or reflector cups, smoke or red cover",
    "light-guide": "a clear rod with notches along its back, LEDs at its ends, a white trough",
    "retro": "a reflex reflector: one red plate with a back full of cube corners",
}


class _Generator(Protocol):
    Parameters: type[LampParameters]

    def build(self, parameters: Any) -> Lamp: ...


@dataclass(frozen=True)
class Parameter:
    """One parameter of a lamp, as it is shown to people."""

    name: str
    default: object
    limits: str
    description: str


def lamp_names() -> tuple[str, ...]:
    """Return the names of the lamps that `write_lamp` knows."""
    return tuple(_DESCRIPTIONS)


def lamp_description(name: str) -> str:
    """Return one line that says what the lamp is."""
    _check_name(name)
    return _DESCRIPTIONS[name]


def lamp_parameters(name: str) -> list[Parameter]:
    """Return the parameters of a lamp with their defaults, limits and meaning.

    Raises:
        LamplitError: There is no lamp of this name.
    """
    schema = _generator(name).Parameters.model_json_schema()
    return [
        Parameter(key, entry.get("default"), _limits(entry), entry.get("description", ""))
        for key, entry in schema["properties"].items()
    ]


def write_lamp(
    name: str,
    directory: str | Path,
    parameters: Mapping[str, object] | None = None,
    *,
    force: bool = False,
) -> Path:
    """Write a lamp's meshes and scene into ``directory``; return the path of its scene.toml.

    ``parameters``: values by name, or text as on the command line. Files of the same names are
    replaced only where this function wrote them and nobody changed them, or with ``force``.

    Raises:
        LamplitError: An unknown lamp or parameter, or a value out of its range.
        OutputError: The files cannot be written, or others are in the way.
    """
    generator = _generator(name)
    given = dict(parameters or {})
    try:
        chosen = generator.Parameters.model_validate(given)
    except ValidationError as fault:
        raise _refusal(name, fault, list(generator.Parameters.model_fields)) from None
    settings = [shlex.quote(f"{key}={_plain(getattr(chosen, key))}") for key in given]
    command = " ".join(["lamplit lamp", name, *(f"--set {setting}" for setting in settings)])
    return write_files(generator.build(chosen), command, Path(directory), force=force)


def _generator(name: str) -> _Generator:
    _check_name(name)
    module = importlib.import_module(f"lamplit.lamps.{name.replace('-', '_')}")
    return cast("_Generator", module)


def _check_name(name: str) -> None:
    if name not in _DESCRIPTIONS:
        known = ", ".join(_DESCRIPTIONS)
        hint = nearest_name(name, _DESCRIPTIONS)
        raise LamplitError(f"there is no lamp {name!r}{hint}; the lamps are {known}")


def _refusal(name: str, fault: ValidationError, known: list[str]) -> LamplitError:
    first = fault.errors()[0]
    key = ".".join(str(part) for part in first["loc"])
    where = f"{name}.{key}" if key else name
    if first["type"] == "extra_forbidden":
        hint = nearest_name(key, known) or f"; known are {', '.join(known)}"
        return LamplitError(f"unknown parameter{hint}", where=where)
    message = first["msg"].removeprefix("Value error, ")
    given = "" if not key else f", not {first['input']!r}"
    return LamplitError(f"{message[:1].lower()}{message[1:]}{given}", where=where)


def _limits(entry: Mapping[str, Any]) -> str:
    if "enum" in entry:
        return " | ".join(str(choice) for choice in entry["enum"])
    if entry.get("type") == "boolean":
        return "true | false"
    low, high = entry.get("minimum"), entry.get("maximum")
    return "" if low is None or high is None else f"{low:g} to {high:g}"


def _plain(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
