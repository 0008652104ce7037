# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What shines in a scene, in which light groups, and whether path transport can follow it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import LamplitError, SceneError
from lamplit.files import resolve_inside
from lamplit.scene.emitters import emission_faults, file_fault
from lamplit.scene.hdr import read_environment
from lamplit.scene.lighting import (
    ConstantBackground,
    GradientBackground,
    ImageBackground,
    SkyBackground,
    StudioBackground,
)
from lamplit.scene.models import Scene


def light_groups(scene: Scene) -> tuple[str, ...]:
    """Return the names of the light groups: the background's, then the others as they come.

    Soft boxes come before suns, these before objects, and ray files last.
    """
    background = scene.background
    names = [background.group]
    if isinstance(background, StudioBackground):
        names += [soft_box.group for soft_box in background.soft_boxes]
    names += [sun.group for sun in background.suns]
    names += [own.emission.group or own.name for own in scene.objects if own.emission is not None]
    names += [own.group or own.name for own in scene.ray_files]
    return tuple(dict.fromkeys(names))


def read_background_image(scene: Scene) -> NDArray[np.float32] | None:
    """See `Scene.environment`."""
    own = scene.background
    if not isinstance(own, ImageBackground):
        return None
    path = resolve_inside(scene.root, own.file, where="background.file")
    try:
        return read_environment(path)
    except LamplitError as fault:
        raise file_fault(scene, own.file, fault, "background.file") from fault


def light_faults(scene: Scene) -> list[LamplitError]:
    """Return an error for each emission and background picture that cannot be used."""
    faults = emission_faults(scene)
    try:
        _ = scene.environment
    except LamplitError as fault:
        faults.append(fault)
    return faults


def light_notices(scene: Scene) -> tuple[str, ...]:
    """Return what to know of the light of a scene, by whichever method, one line each."""
    if not isinstance(scene.background, ImageBackground):
        return ()
    notice = (
        f"the spectra of {scene.background.file} are derived from RGB: colours of dyed matter "
        "under it are a guess"
    )
    return (notice,)


def path_notices(scene: Scene) -> tuple[str, ...]:
    """Return what to know of a scene that path transport is about to render, one line each.

    Raises:
        SceneError: Nothing in it shines that path transport can follow, or its background cannot
            be read.
    """
    dark = scene.ambient is None or scene.ambient.luminance_cd_m2 == 0.0
    lit = [light for light in scene.lights if light.luminance_cd_m2 > 0.0]
    left_out = [] if dark else ["[ambient]"]
    rays = _ray_notices(scene)
    if lit:
        left_out.append("1 of [[lights]]" if len(lit) == 1 else f"{len(lit)} of [[lights]]")
    if not any(_shining(scene)):
        besides = " ([[lights]] and [ambient] belong to the Hall method)" if left_out else ""
        besides += " ([[ray_files]] belong to forward transport)" if rays else ""
        raise SceneError(
            f"nothing shines that path transport can follow{besides}: give an object an emission, "
            'or the scene a background, or say method = "hall"',
            file=scene.path,
            where="image.method",
        )
    if not left_out:
        return rays
    notice = (
        f"path transport leaves out {' and '.join(left_out)} of the Hall method; it follows "
        "emissions and the background"
    )
    return (notice, *rays)


def _ray_notices(scene: Scene) -> tuple[str, ...]:
    count = len(scene.ray_files)
    if count == 0:
        return ()
    files = "1 of [[ray_files]]" if count == 1 else f"{count} of [[ray_files]]"
    return (
        f"a picture leaves out {files}: rays are followed forward only, when a lamp is measured",
    )


def _shining(scene: Scene) -> Iterator[bool]:
    """Yield for each thing that path transport follows whether any light comes of it."""
    own = scene.background
    yield from (sun.disc_luminance_cd_m2 > 0.0 for sun in own.suns)
    if isinstance(own, StudioBackground):
        yield from (soft_box.luminance_cd_m2 > 0.0 for soft_box in own.soft_boxes)
        own = own.base
    if isinstance(own, ConstantBackground):
        yield own.luminance_cd_m2 > 0.0
    elif isinstance(own, GradientBackground):
        yield max(own.zenith.luminance_cd_m2, own.nadir.luminance_cd_m2) > 0.0
    elif isinstance(own, SkyBackground):
        yield own.zenith_luminance_cd_m2 > 0.0
        yield own.ground is not None and own.ground.luminance_cd_m2 > 0.0
    elif scene.environment is not None:
        yield bool(scene.environment.any())
    yield from (
        thing.emission is not None and thing.emission.shines for thing in scene.objects_as_read
    )
