# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Options that several commands share, written once as the fields of a dataclass."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import is_dataclass


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Let ``command`` take the fields of its dataclass parameters as options, beside its own.

    Of ``command(run: SceneRun, view: ViewOptions, bits: ...)`` the command line shows the fields of
    `SceneRun`, those of `ViewOptions`, and ``--bits``.
    """
    parameters = inspect.signature(command, eval_str=True).parameters
    groups: dict[str, Callable[..., object]] = {
        name: own.annotation for name, own in parameters.items() if _is_group(own.annotation)
    }
    fields = {
        name: inspect.signature(group, eval_str=True).parameters for name, group in groups.items()
    }
    every = [
        option
        for name, own in parameters.items()
        for option in (fields[name].values() if name in groups else (own,))
    ]

    @functools.wraps(command)
    def run(**given: object) -> None:
        made = {
            name: group(**{field: given.pop(field) for field in fields[name]})
            for name, group in groups.items()
        }
        command(**made, **given)

    by_keyword = [option.replace(kind=inspect.Parameter.KEYWORD_ONLY) for option in every]
    vars(run)["__signature__"] = inspect.Signature(by_keyword)
    run.__annotations__ = {option.name: option.annotation for option in every}
    return run


def _is_group(annotation: object) -> bool:
    return isinstance(annotation, type) and is_dataclass(annotation)
