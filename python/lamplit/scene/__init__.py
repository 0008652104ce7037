# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Scenes: one strict TOML file, its models, its meshes, and whether all of it is sound."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamplit.scene.load import load_scene, parse_scene
    from lamplit.scene.memory import memory_estimate
    from lamplit.scene.meshes import Mesh, load_mesh
    from lamplit.scene.models import Scene
    from lamplit.scene.resolve import ResolvedObject
    from lamplit.scene.soundness import Finding, Report, check_scene

_HOMES = {
    "Finding": "soundness",
    "Mesh": "meshes",
    "Report": "soundness",
    "ResolvedObject": "resolve",
    "Scene": "models",
    "check_scene": "soundness",
    "load_mesh": "meshes",
    "load_scene": "load",
    "memory_estimate": "memory",
    "parse_scene": "load",
}

__all__ = [
    "Finding",
    "Mesh",
    "Report",
    "ResolvedObject",
    "Scene",
    "check_scene",
    "load_mesh",
    "load_scene",
    "memory_estimate",
    "parse_scene",
]


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"lamplit.scene.{_HOMES[name]}"), name)
