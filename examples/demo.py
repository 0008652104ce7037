# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The example rear lamp, from nothing to a measured difference: ``make demo``.

Writes the meshes and the scene of a lamp for a P21W bulb. Follows its light physically, each of the
studio's lights in a layer of its own, and dims the studio afterwards. Then renders the lamp once in
RGB and once in spectra along the same rays, and says how far the two are apart. At last lights the
bulb, and measures the lamp as the command line does.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import lamplit as ll
from lamplit.lamps import write_lamp
from lamplit.report.atomic import prepare_output
from lamplit.report.comparison import COMPARISON_FILES, write_comparison
from lamplit.report.layers import LAYERS_FILE, read_layers
from lamplit.report.mixture import mix, write_mixture
from lamplit.report.progress import Progress
from lamplit.scene.lighting import StudioBackground

OUTPUT = Path("out/demo")
PATH_SECONDS = 20.0
MEASURE_SECONDS = 10
#: How much of each soft box of the studio is left in the dimmed picture.
DIMMED = 0.2
SIZE = {"image.width": 560, "image.height": 350, "image.samples": 9}  # 55 million rays in all


def follow_light(scene: ll.Scene) -> ll.Image:
    """Render ``scene`` by path with a layer per soft box, write it, and mix a dimmed picture."""
    studio = scene.background
    if not isinstance(studio, StudioBackground):
        raise ll.LamplitError("the demo's lamp stands in a studio")
    boxes = tuple(
        box.model_copy(update={"group": f"soft box {number}"})
        for number, box in enumerate(studio.soft_boxes, start=1)
    )
    grouped = scene.changed(background=studio.model_copy(update={"soft_boxes": boxes}))
    pixels = scene.image.width * scene.image.height
    with Progress("Path", pixels=pixels, time_s=PATH_SECONDS) as progress:
        image = ll.render(
            grouped,
            method="path",
            time_s=PATH_SECONDS,
            layers=True,
            features=True,
            progress=progress,
        )
    folder = OUTPUT / "path"
    ll.write_picture(image, folder)
    dimmed = mix(read_layers(folder / LAYERS_FILE), {box.group: DIMMED for box in boxes})
    prepare_output(folder / "mix")
    write_mixture(dimmed, folder / "mix", command="examples/demo.py", version=ll.__version__)
    return image


def measure_candela() -> None:
    """Light the lamp's bulb, measure its candela and colours, and put them on a page."""
    lit, measured = OUTPUT / "lit", OUTPUT / "measured"
    scene = write_lamp("p21w", lit, {"lit": True})
    for command in (
        ["measure", str(scene), "-o", str(measured), "--time", str(MEASURE_SECONDS)],
        ["report", str(measured), "-o", str(OUTPUT / "measured.html")],
    ):
        program = [sys.executable, "-m", "lamplit.cli"]
        done = subprocess.run([*program, *command], check=False)  # noqa: S603
        if done.returncode == 130:
            raise KeyboardInterrupt
        if done.returncode:
            raise ll.LamplitError(f"lamplit {command[0]} ended with code {done.returncode}")


def main() -> None:
    """Write the lamp, render, compare and measure it, and say which files to open."""
    scene = ll.load_scene(write_lamp("p21w", OUTPUT / "lamp"), overrides=SIZE)
    print(f"{scene.name}: {scene.image.width} × {scene.image.height} pixels")
    image = follow_light(scene)

    with Progress("RGB and spectral") as progress:
        pair = ll.compare(scene, progress=progress)
    difference = write_comparison(pair.spectral, pair.rgb, OUTPUT)

    measure_candela()

    seconds = pair.spectral.elapsed_s + pair.rgb.elapsed_s
    rays = sum(
        image.statistics["eye_rays"] + image.statistics["shadow_rays"]
        for image in (pair.spectral, pair.rgb)
    )
    print(
        f"\nby path           {image.samples} samples per pixel in {image.elapsed_s:.0f} s, "
        f"relative error {100 * image.relative_error:.1f} %\n"
        f"compared          {rays / 1e6:.0f} million rays in {seconds:.0f} s\n"
        f"mean luminance    {pair.spectral.luminance_cd_m2.mean():.1f} cd/m²\n"
        f"outside sRGB      {100 * difference.spectral.picture.gamut_share:.1f} % of the pixels\n"
        f"RGB is off by     ΔE00 {difference.mean:.1f} on average; "
        f"95 % of the pixels lie below {difference.percentile_95:.1f}\n"
        f"\nFiles to open, in {OUTPUT}:"
    )
    files = {
        "measured.html": "candela and colour of the lit lamp, and whether it passes",
        "path/picture.png": "the lamp, its light followed physically",
        "path/layers.exr": "the light of each part of the studio by itself",
        "path/mix/picture.png": f"the same with its soft boxes at {100 * DIMMED:.0f} %",
    }
    for name, content in (files | COMPARISON_FILES).items():
        print(f"  {name:20} {content}")
    print(
        f"  {'lamp/scene.toml':20} the scene: change it, then\n"
        f"  {'':20} lamplit render {OUTPUT}/lamp -o {OUTPUT}/pictures"
    )


if __name__ == "__main__":
    try:
        main()
    except ll.LamplitError as fault:
        sys.exit(f"error: {fault}")
    except KeyboardInterrupt:
        sys.exit(130)
