# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Lamplit in a process of its own: renders an unlit lamp by `path` as often as it is asked.

    python path_worker.py LAMP LIGHT TRIANGLES FOLDER

Reads one JSON object per line, ``{"samples": n, "seed": s, "threads": t}``, and answers on one line
with the seconds of tracing, the rays, and the most memory that the process has taken. The first
line that it writes says how much memory was foretold.
"""

import json
import resource
import sys
from pathlib import Path

from comparison_scenes import picture, unlit_lamp

import lamplit as ll
from lamplit.scene.memory import memory_estimate


def main() -> None:
    """Build the scene and serve renders until the input ends."""
    lamp, light, triangles, folder = sys.argv[1:]
    assert light in ("surround", "studio")
    scene = unlit_lamp(lamp, Path(folder), triangles=int(triangles), light=light)
    print(json.dumps({"foretold_bytes": memory_estimate(scene).total_bytes}), flush=True)
    for line in sys.stdin:
        asked = json.loads(line)
        own = picture(scene, seed=asked["seed"])
        done = ll.render(
            own, method="path", samples=asked["samples"], threads=asked["threads"]
        ).statistics
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        answer = {
            "seconds": done["trace_s"],
            "build_s": done["build_s"],
            "rays": done["eye_rays"] + done["shadow_rays"],
            "peak_bytes": peak,
        }
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
