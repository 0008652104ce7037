# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Mitsuba`: a running Mitsuba 3 with one scene loaded, as seen from Lamplit's side."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from mitsuba_scene import write_scene
from numpy.typing import NDArray

from lamplit.scene import Scene
from peers.child import Child

Array = NDArray[np.float64]

REPOSITORY = Path(__file__).resolve().parent.parent.parent
PYTHON = REPOSITORY / "build" / "peers" / "bin" / "python"
_WORKER = Path(__file__).with_name("mitsuba_worker.py")
#: The newest first that Dr.Jit 1.5 is known to work with.
_LLVM = tuple(f"libLLVM{name}" for name in ("-19.so", ".so.19.1", "-18.so", "-17.so", "-16.so"))


@cache
def llvm_library() -> str | None:
    """Return the file of an LLVM that Dr.Jit can use; None where none is installed."""
    folders = ("/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib64", "/usr/lib")
    found = (Path(folder) / name for name in _LLVM for folder in folders)
    for path in found:
        if path.exists():
            return str(path)
    return None


def variants() -> tuple[str, ...]:
    """Return the spectral variants that can run here; none without Mitsuba."""
    if not PYTHON.exists():
        return ()
    with_llvm = ("llvm_ad_spectral",) if llvm_library() else ()
    return ("scalar_spectral", *with_llvm)


@dataclass(frozen=True)
class Pass:
    """One render: tristimulus values (H, W, 3) in cd/m², and what it took."""

    xyz: Array
    seconds: float
    #: The processor's time of all threads.
    core_s: float


class Mitsuba(Child):
    """Mitsuba 3 in a process of its own, with ``scene`` loaded; use it in a ``with``.

    ``film`` "xyz" is Mitsuba's usual film, whose colour-matching functions have steps of 5 nm:
    behind the red lens Y is 0.2 % off and Z 1 %. "observer" takes Lamplit's functions with steps
    of 1 nm, as a z-test needs them, and samples wavelengths less well for neutral light.
    """

    def __init__(self, scene: Scene, variant: str, *, film: str = "xyz", **integrator: Any) -> None:
        self.variant = variant
        self._folder = tempfile.TemporaryDirectory(prefix="lamplit-mitsuba-")
        folder = Path(self._folder.name)
        self._scale = write_scene(scene, folder, film=film, integrator=integrator)
        library = [llvm_library() or ""] if variant.startswith("llvm") else []
        command = [PYTHON, _WORKER, variant, folder / "scene.json", *library]
        super().__init__(command)
        self.load_s: float = self.greeting["load_s"]
        self.version: str = self.greeting["version"]

    def render(self, samples: int, seed: int, **instead: Mapping[str, Any]) -> Pass:
        """Render ``samples`` per pixel; another ``seed`` is independent.

        A ``sensor`` or ``integrator`` in ``instead`` stands in for the scene's own.
        """
        picture = Path(self._folder.name) / "picture.npy"
        asked = {"samples": samples, "seed": seed, "picture": str(picture), **instead}
        answer = self.ask(asked)
        return Pass(np.load(picture) * self._scale, answer["seconds"], answer["core_s"])

    def close(self) -> None:
        """End the process and remove the scene's files."""
        super().close()
        self._folder.cleanup()
