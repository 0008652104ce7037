# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a result must carry so that anybody can make it again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lamplit.engine.image import Image


def provenance(image: Image) -> dict[str, Any]:
    """Return everything that decides the numbers of ``image``, as plain JSON values.

    The same scene hash, seed, samples, method, colour and version give the same numbers on any
    machine, unless a time budget chose how many samples an adaptive render takes; ``command``
    starts such a run.
    """
    scene = image.scene
    return {
        "scene": scene.name,
        "scene_hash": scene.scene_hash,
        "version": image.version,
        "method": image.method,
        "colour": image.colour,
        "seed": image.seed,
        "samples": image.samples,
        "samples_asked": image.samples_asked,
        "error_asked": image.error_asked,
        "complete": image.complete,
        "observer": scene.image.observer,
        "white": described(scene.display.white),
        "command": image.command,
    }


def text_provenance(image: Image) -> dict[str, str]:
    """Return `provenance` as the text chunks of a PNG, keyed by PNG's own keywords."""
    return text_facts(image.scene.name, image.version, provenance(image))


def text_facts(title: str, version: str, facts: Mapping[str, Any]) -> dict[str, str]:
    """Return ``facts`` as the text chunks of a PNG, keyed by PNG's own keywords."""
    lines = "\n".join(f"{name}: {value}" for name, value in facts.items())
    return {"Title": title, "Software": f"Lamplit {version}", "Comment": lines}


def described(specification: Any) -> Any:
    """Return a scene's value (a name, or a model of a spectrum or display) as plain JSON."""
    if hasattr(specification, "model_dump"):
        return specification.model_dump(mode="json", exclude_none=True)
    return specification
