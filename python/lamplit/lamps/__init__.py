# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Parametric example lamps: watertight meshes and a scene file to start from.

``write_lamp("p21w", "lamp", {"pillow_pitch_mm": 6})`` writes ``lamp/scene.toml`` and its meshes.
Lengths are in mm, y is up, and the lamp's axis points along +z towards the observer.
"""

from __future__ import annotations

from lamplit.lamps.catalogue import (
    Parameter,
    lamp_description,
    lamp_names,
    lamp_parameters,
    write_lamp,
)

__all__ = ["Parameter", "lamp_description", "lamp_names", "lamp_parameters", "write_lamp"]
