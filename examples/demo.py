# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The example rear lamp, from nothing to a measured difference: ``make demo``.

Writes the meshes and the scene of a lamp for a P21W bulb, renders it once in RGB and once in
spectra along the same rays, and says how far the two are apart.
"""

from __future__ import annotations

import sys
from pathlib import Path

import lamplit as ll
from lamplit.lamps import write_lamp
from lamplit.report.comparison import COMPARISON_FILES, write_comparison
from lamplit.report.progress import Progress

OUTPUT = Path("out/demo")
SIZE = {"image.width": 560, "image.height": 350, "image.samples": 9}  # 55 million rays in all


def main() -> None:
    """Write the lamp, render and compare it, and say which files to open."""
    scene = ll.load_scene(write_lamp("p21w", OUTPUT / "lamp"), overrides=SIZE)
    print(f"{scene.name}: {scene.image.width} × {scene.image.height} pixels, RGB and spectral")

    with Progress("Rendering") as progress:
        pair = ll.compare(scene, progress=progress)
    difference = write_comparison(pair.spectral, pair.rgb, OUTPUT)

    seconds = pair.spectral.elapsed_s + pair.rgb.elapsed_s
    rays = sum(
        image.statistics["eye_rays"] + image.statistics["shadow_rays"]
        for image in (pair.spectral, pair.rgb)
    )
    print(
        f"\nrendered          {rays / 1e6:.0f} million rays in {seconds:.0f} s\n"
        f"mean luminance    {pair.spectral.luminance_cd_m2.mean():.1f} cd/m²\n"
        f"outside sRGB      {100 * difference.spectral.picture.gamut_share:.1f} % of the pixels\n"
        f"RGB is off by     ΔE00 {difference.mean:.1f} on average; "
        f"95 % of the pixels lie below {difference.percentile_95:.1f}\n"
        f"\nFiles to open, in {OUTPUT}:"
    )
    for name, content in COMPARISON_FILES.items():
        print(f"  {name:18} {content}")
    print(
        f"  {'lamp/scene.toml':18} the scene: change it, then\n"
        f"  {'':18} lamplit render {OUTPUT}/lamp -o {OUTPUT}/pictures"
    )


if __name__ == "__main__":
    try:
        main()
    except ll.LamplitError as fault:
        sys.exit(f"error: {fault}")
    except KeyboardInterrupt:
        sys.exit(130)
