# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What every command that renders is asked: which scene, how, and where the results go."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lamplit.cli.options import (
    AllowLostOption,
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
    allow_lost: AllowLostOption = False

    @property
    def method_name(self) -> str | None:
        """The method that was asked for, if any."""
        return None if self.method is None else self.method.value

    def load(self, view: Mapping[str, Any]) -> Scene:
        """Return the scene with what the options change in it, its display found usable.

        ``view`` are further values by key, of `ViewOptions` or `DisplayOption`.

        Raises:
            LamplitError: The scene or an option cannot be used.
        """
        from lamplit.report.view import check_display
        from lamplit.scene import load_scene

        changed = overrides(
            assignments=self.set_ or (),
            method=self.method,
            samples=self.samples,
            seed=self.seed,
            size=self.size,
        )
        loaded = load_scene(scene_file(self.scene), overrides={**changed, **view})
        check_display(loaded)
        return loaded
