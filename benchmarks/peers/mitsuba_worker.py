# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Mitsuba 3 as a child process: renders one scene as often as it is asked.

    build/peers/bin/python mitsuba_worker.py VARIANT SCENE.json [LIBLLVM]

Reads one JSON object per line, ``{"samples": n, "seed": s, "picture": "file.npy"}``, writes the
picture as float64 (rows, columns, channels) and answers ``{"seconds": t, "core_s": c}`` on one
line, c being the processor's time of all threads. A ``"sensor"`` and an ``"integrator"`` stand in
for the scene's own; making them is not counted. The first line that it writes says how long loading
took. Runs in the peers' environment and so imports no Lamplit. Mesh files are found beside the
scene file.
"""

import importlib
import json
import os
import sys
import time
from pathlib import Path
from typing import Any, cast

import numpy as np


def plain_to_mitsuba(mitsuba: Any, value: Any, folder: Path) -> Any:
    """Return a plain JSON value with matrices and file names as Mitsuba takes them."""
    if isinstance(value, dict):
        value = cast("dict[str, Any]", value)
        if "matrix" in value:
            return mitsuba.ScalarTransform4f(np.array(value["matrix"], dtype=np.float64))
        if "file" in value:
            return str(folder / value["file"])
        return {key: plain_to_mitsuba(mitsuba, own, folder) for key, own in value.items()}
    return value


def main() -> None:
    """Load the scene and serve renders until the input ends."""
    variant, scene_file = sys.argv[1], Path(sys.argv[2])
    if len(sys.argv) > 3:
        os.environ["DRJIT_LIBLLVM_PATH"] = sys.argv[3]
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what libraries print must not mix with the answers
    mitsuba = importlib.import_module("mitsuba")
    mitsuba.set_variant(variant)
    start = time.perf_counter()
    written = json.loads(scene_file.read_text(encoding="utf-8"))
    scene = mitsuba.load_dict(plain_to_mitsuba(mitsuba, written, scene_file.parent))
    load_s = time.perf_counter() - start
    print(json.dumps({"load_s": load_s, "version": mitsuba.__version__}), file=answers)
    for line in sys.stdin:
        asked = json.loads(line)
        own = {
            name: mitsuba.load_dict(plain_to_mitsuba(mitsuba, asked[name], scene_file.parent))
            for name in ("sensor", "integrator")
            if name in asked
        }
        start, core_start = time.perf_counter(), time.process_time()
        picture = mitsuba.render(scene, spp=asked["samples"], seed=asked["seed"], **own)
        pixels = np.array(picture, dtype=np.float64)  # waits for the device
        seconds = time.perf_counter() - start
        core_s = time.process_time() - core_start
        np.save(asked["picture"], pixels)
        print(json.dumps({"seconds": seconds, "core_s": core_s}), file=answers)


if __name__ == "__main__":
    main()
