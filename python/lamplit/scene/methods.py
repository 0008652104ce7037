# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How far rays are followed, by each method, and which one suits a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from lamplit.scene.fields import Share, Table

if TYPE_CHECKING:
    from lamplit.scene.models import Scene


def physical_method(scene: Scene) -> Literal["path", "lit"]:
    """Return what the method ``auto`` stands for: ``lit`` where an object shines."""
    return "lit" if any(thing.emission for thing in scene.objects) else "path"


class HallSettings(Table):
    """How far the recursion of the founding method goes."""

    max_depth: int = Field(default=12, ge=1, le=64, description="surfaces in one chain of rays")
    contribution_limit: Share = Field(
        default=3e-3, description="a ray that can add less than this share is not followed"
    )
    dispersion_groups: Literal[1, 2, 4, 8, 16] = Field(
        default=1, description="directions that the lanes share at a dispersive refraction"
    )
    shadows: bool = Field(
        default=True,
        description="whether bodies take light from what lies behind them",
    )


class PathSettings(Table):
    """How the walks of path transport are spent; but for max_depth, none changes what is shown."""

    max_depth: int = Field(
        default=64, ge=1, le=4096, description="surfaces and scatterings in one walk"
    )
    split_depth: int = Field(
        default=2,
        ge=0,
        le=64,
        description="surfaces where both ways on are followed; at the first rough one always",
    )
    roulette_below: Share = Field(
        default=3e-3, description="what carries a smaller share goes on by chance only"
    )
