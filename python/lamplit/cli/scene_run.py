# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What every command that renders is asked: which scene, how, and where the results go."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lamplit.cli.options import (
    AllowLostOption,
    DisplayOption,
    MethodOption,
    OutputOption,
    SamplesOption,
    SceneArgument,
    SeedOption,
    SetOption,
    SizeOption,
    ThreadsOption,
)
from lamplit.cli.overrides import overrides, scene_file

if TYPE_CHECKING:
    from lamplit.scene import Scene


@dataclass(frozen=True)
class SceneRun:
    """The options that commands which render share."""

    scene: SceneArgument
    output: OutputOption
    method: MethodOption = None
    samples: SamplesOption = None
    seed: SeedOption = None
    size: SizeOption = None
    threads: ThreadsOption = None
    set_: SetOption = None
    display: DisplayOption = None
    allow_lost: AllowLostOption = False

    @property
    def method_name(self) -> str | None:
        """The method that was asked for, if any."""
        return None if self.method is None else self.method.value

    def load(self) -> Scene:
        """Return the scene with what the options change in it, its display found usable.

        Raises:
            LamplitError: The scene or an option cannot be used.
        """
        from lamplit.report.develop import check_display
        from lamplit.scene import load_scene

        changed = overrides(
            assignments=self.set_ or (),
            method=self.method,
            samples=self.samples,
            seed=self.seed,
            size=self.size,
            display=self.display,
        )
        loaded = load_scene(scene_file(self.scene), overrides=changed)
        check_display(loaded)
        return loaded


def renders(command: Callable[..., None]) -> Callable[..., None]:
    """Let ``command(run: SceneRun, ...)`` take the options of `SceneRun` beside its own."""
    shared = inspect.signature(SceneRun, eval_str=True).parameters
    _, *own = inspect.signature(command, eval_str=True).parameters.values()
    every = [*shared.values(), *own]

    @functools.wraps(command)
    def run(**given: object) -> None:
        fields = {name: given.pop(name) for name in shared}
        command(SceneRun(**fields), **given)  # pyright: ignore[reportArgumentType]

    by_keyword = [option.replace(kind=inspect.Parameter.KEYWORD_ONLY) for option in every]
    vars(run)["__signature__"] = inspect.Signature(by_keyword)
    run.__annotations__ = {option.name: option.annotation for option in every}
    return run
