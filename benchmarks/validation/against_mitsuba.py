# SPDX-License-Identifier: Apache-2.0 OR MIT
"""T8: the same scenes in Mitsuba 3, rendered here and now, by the test of `agreement`.

Where the two models are known to differ the case says so and allows for it: Mitsuba loses the light
that rough surfaces scatter more than once, which Lamplit keeps. A perfect mirror seen straight on
reflects 0.988 of the light in Mitsuba at α = 0.1, and 0.878 at 0.3, where nothing could be learnt
from it any more: furnaces, reciprocity and χ² tests of the core stand for the rougher ones. Masking
and shadowing are independent there and height-correlated here; up to α = 0.1 that is much less.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from comparison_scenes import picture
from peers.mitsuba_process import Array, Mitsuba, variants

import lamplit as ll
from validation import scenes
from validation.agreement import ALPHA, compare
from validation.registry import Case, Finding, add

SEEDS = 16
GROUP = "The same pictures as Mitsuba 3"

#: Builds a scene; the folder takes the files that it needs.
Scenery = Callable[[Path], ll.Scene]


@dataclass(frozen=True)
class Picture:
    """A scene and how long each side renders it: samples per pixel for each of `SEEDS` seeds."""

    key: str
    title: str
    scene: Scenery
    mine: int = 64
    theirs: int = 256
    #: Side of a block in pixels.
    side: int = 8
    #: Relative difference by which the models are known to differ, and why.
    allowance: float = 0.0
    why: str = ""


def _body(build: Callable[[scenes.Table], ll.Scene], material: scenes.Table) -> Scenery:
    return lambda _: build(material)


_LOSS = "light scattered more than once between facets, which Mitsuba loses"

PICTURES = (
    Picture("paint", "matt sphere and floor, soft boxes", _body(scenes.sphere, scenes.paint())),
    Picture("mirror", "aluminium sphere", _body(scenes.sphere, scenes.metal())),
    Picture("plastic", "painted sphere under a clear coat", _body(scenes.sphere, scenes.plastic())),
    Picture(
        "red-sphere", "absorbing glass sphere", _body(scenes.sphere, scenes.glass(absorbing=True))
    ),
    Picture("red-slab", "absorbing glass slab", _body(scenes.slab, scenes.glass(absorbing=True))),
    *(
        Picture(
            f"rough-{name}-{alpha:g}",
            f"rough {title}, α = {alpha:g}",
            _body(build, make(roughness=alpha)),
            allowance=allowance,
            why=_LOSS,
        )
        for name, title, build, make, allowances in (
            ("slab", "glass slab", scenes.slab, scenes.glass, (0.006, 0.1)),
            ("sphere", "glass sphere", scenes.sphere, scenes.glass, (0.006, 0.1)),
            ("metal", "aluminium sphere", scenes.sphere, scenes.metal, (0.003, 0.045)),
        )
        for alpha, allowance in zip((0.02, 0.1), allowances, strict=True)
    ),
    *(
        Picture(
            f"opal-{g:g}", f"scattering sphere, g = {g:g}", _body(scenes.sphere, scenes.opal(g))
        )
        for g in (0.0, 0.7)
    ),
    Picture("lit-box", "room of matt walls, lit by a disc", lambda _: scenes.lit_box()),
    Picture("lit-bulb", "glowing ball in a glass bulb over a floor", scenes.lit_bulb),
    Picture("p21w", "unlit lamp p21w", partial(scenes.small_lamp, "p21w")),
    Picture("led-array", "unlit lamp led-array", partial(scenes.small_lamp, "led-array")),
)


def run(one: Picture) -> Iterator[Finding]:
    """Render ``one`` with both programs and compare."""
    with tempfile.TemporaryDirectory(prefix="lamplit-validate-") as name:
        scene = one.scene(Path(name))
        mine = [
            ll.render(picture(scene, seed=seed, samples=one.mine), method="path").xyz
            for seed in range(1, SEEDS + 1)
        ]
        variant = variants()[-1]
        with Mitsuba(scene, variant, film="observer") as peer:
            theirs = [peer.render(one.theirs, seed).xyz for seed in range(1, SEEDS + 1)]
    yield _verdict(one, mine, theirs, f"Mitsuba {peer.version} {variant}")


def _verdict(one: Picture, mine: list[Array], theirs: list[Array], peer: str) -> Finding:
    found = compare(mine, theirs, side=one.side, allowance=one.allowance)
    allowed = f"; allowed for: {one.allowance:.1%}, {one.why}" if one.allowance else ""
    return Finding(
        "mean luminance",
        expected=found.theirs_cd_m2,
        got=found.mine_cd_m2,
        sigma=found.sigma_cd_m2,
        unit="cd/m²",
        note=(
            f"max |z| {found.largest_z:.2f} of {found.threshold:.2f} over {found.tests} tests "
            f"(Šidák, α = {ALPHA:g}); would see {found.detectable:.2%} overall, "
            f"{found.detectable_in_block:.1%} in one block{allowed}; {peer}"
        ),
        passed=found.agree,
    )


for _one in PICTURES:
    add(Case(_one.key, _one.title, "W. Jakob et al., Mitsuba 3", GROUP, partial(run, _one)))
