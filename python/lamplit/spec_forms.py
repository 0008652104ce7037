# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What the models that read TOML values have in common: choosing a form, faults, files."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, TypeAlias, cast

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo
from pydantic_core import PydanticCustomError

from lamplit.errors import LamplitError
from lamplit.files import resolve_inside

#: A finite number; text and true/false are refused.
Number: TypeAlias = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive: TypeAlias = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]


class Form(BaseModel):
    """One way to write a value: every key known, none changed later."""

    model_config = ConfigDict(frozen=True, extra="forbid")


def form_tag(value: object, forms: Mapping[str, type[BaseModel]]) -> str | None:
    """Return the tag of the form in ``forms`` that ``value`` was meant to have, or None.

    A number is ``<number>``, where there is such a form. A table belongs to the form most of whose
    required keys it has, misspelt keys counting half, so that a fault is reported against the form
    that its author had in mind.
    """
    if isinstance(value, BaseModel):
        return next((tag for tag, form in forms.items() if type(value) is form), None)
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return "<number>" if "<number>" in forms else None
    if not isinstance(value, Mapping):
        return None
    keys = [str(key) for key in cast("Mapping[object, object]", value)]

    def fit(tag: str) -> float:
        required = [name for name, field in forms[tag].model_fields.items() if field.is_required()]
        spelt = sum(name in keys for name in required)
        close = sum(bool(difflib.get_close_matches(name, keys, n=1)) for name in required)
        return spelt + 0.5 * (close - spelt)

    best = max((tag for tag in forms if tag != "<number>"), key=fit, default=None)
    return best if best is not None and fit(best) > 0 else None


def spec_fault(message: str) -> PydanticCustomError:
    """Return the fault that pydantic reports under the key that it is raised for."""
    return PydanticCustomError("spectrum", "{message}", {"message": message})


def file_below_root(text: str, info: ValidationInfo) -> Path:
    """Return the file ``text`` names below ``root`` of the validation context.

    Raises:
        PydanticCustomError: There is no root, or `resolve_inside` refuses the path.
    """
    context = cast("Mapping[str, object]", info.context or {})
    root = context.get("root")
    if not isinstance(root, Path):
        raise spec_fault(f"{text!r} is a file, and no folder is given to look for it in")
    try:
        return resolve_inside(root, text)
    except LamplitError as fault:
        raise spec_fault(str(fault)) from fault
