# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The files of ``lamplit render --turntable``: frames under one exposure, and an animation."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING, Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from lamplit.report.animation import FRAMES_PER_SECOND, Frame, write_animation
from lamplit.report.atomic import prepare_output, write_json
from lamplit.report.develop import Exposure, automatic_exposure, develop
from lamplit.report.exr import write_exr
from lamplit.report.png import write_png
from lamplit.report.provenance import text_provenance
from lamplit.report.summary import summary
from lamplit.report.view import View

if TYPE_CHECKING:
    from typing_extensions import Self

    from lamplit.engine.image import Image

ANIMATION_FILE = "animation.png"
_SUMMARY_FILE = "summary.json"
_FRAME_FILE = re.compile(r"frame-(\d{3})\.(?:png|exr)")
#: What the exposure is found from: so many pixels at most, taken evenly from all frames.
_MOST_POOLED = 2_000_000

Array = NDArray[np.float64]


def frame_name(at: int) -> str:
    """Return the name, without its ending, of frame ``at``, counted from 0."""
    return f"frame-{at + 1:03d}"


def view_files(count: int) -> dict[str, str]:
    """Return what is shown of the files of ``count`` frames: names, and what is in them."""
    last = frame_name(count - 1)
    return {
        f"frame-001.png to {last}.png": "the pictures, all under one exposure",
        f"frame-001.exr to {last}.exr": "XYZ in cd/m² with standard errors, and linear RGB",
        ANIMATION_FILE: f"all of them in turn, {FRAMES_PER_SECOND} a second; a browser plays it",
        _SUMMARY_FILE: "of each frame: place, luminance, chromaticity, errors; and the command",
    }


@dataclass(frozen=True, eq=False)
class _Written:
    """A frame that is on the disk."""

    #: The image without its arrays, which are kept elsewhere.
    image: Image
    exposure: Exposure
    frame: Frame
    numbers: dict[str, Any]


class ViewWriter:
    """Writes pictures as they come, and in the end all under one exposure; use it by `with`.

    What the scene states of it holds for every frame. What it leaves to the picture is that of the
    frames so far when one is written; `finish` writes those anew that all of them change.
    """

    def __init__(
        self, directory: Path, *, count: int | None, circle: bool, bits: Literal[8, 16] = 8
    ) -> None:
        """Prepare to write ``count`` frames (None: as many as come), of a full ``circle`` or not.

        Raises:
            OutputError: The directory cannot be written.
        """
        self._folder, self._count, self._circle = directory, count, circle
        self._bits: Literal[8, 16] = bits
        names = [frame_name(at) + end for at in range(count or 0) for end in (".png", ".exr")]
        prepare_output(directory, [*names, ANIMATION_FILE, _SUMMARY_FILE])
        self._written: list[_Written] = []
        self._store: _Store | None = None
        self._pool = _Pool()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._store is not None:
            self._store.close()

    def __len__(self) -> int:
        """Return how many frames are written."""
        return len(self._written)

    def add(self, image: Image) -> None:
        """Write the next frame.

        Raises:
            OutputError: A file cannot be written.
        """
        if self._store is None:
            self._store = _Store(self._folder)
        self._store.append(image)
        self._pool.add(image.xyz.reshape(-1, 3))
        self._written.append(self._write(len(self), image, self._pool.exposure(image)))

    def finish(self) -> dict[str, Any]:
        """Write what is left once no frame is to come: animation and summary; return the summary.

        Frames of an earlier run beyond the last of this one are removed.

        Raises:
            OutputError: A file cannot be written.
        """
        if self._store is not None:
            exposure = self._pool.exposure(self._written[0].image)
            for at, done in enumerate(self._written):
                if done.exposure != exposure:
                    image = self._store.image(at, done.image)
                    self._written[at] = self._write(at, image, exposure)
        _remove_frames(self._folder, beyond=len(self._written))
        shown = self._animate()
        numbers = self._summary(shown)
        write_json(self._folder / _SUMMARY_FILE, numbers)
        return numbers

    def _write(self, at: int, image: Image, exposure: Exposure) -> _Written:
        developed = develop(image, exposure=exposure)
        name, encoded = frame_name(at), developed.picture.encoded
        write_png(
            self._folder / f"{name}.png",
            encoded,
            developed.display,
            bits=self._bits,
            provenance=text_provenance(image),
        )
        write_exr(self._folder / f"{name}.exr", image, developed)
        numbers = _frame_numbers(at, image) | summary(image, developed)
        return _Written(_without_arrays(image), exposure, Frame.of(encoded), numbers)

    @property
    def _is_whole(self) -> bool:
        return self._count is None or len(self) == self._count

    def _animate(self) -> int:
        image = self._written[0].image
        return write_animation(
            self._folder / ANIMATION_FILE,
            [done.frame for done in self._written],
            View.of(image.scene).display,
            circle=self._circle and self._is_whole,
            provenance=text_provenance(image),
        )

    def _summary(self, shown: int) -> dict[str, Any]:
        frames = [done.numbers for done in self._written]
        first = self._written[0]
        return {
            "lamplit_views": 1,
            "scene": first.image.scene.name,
            "version": first.image.version,
            "command": first.image.command,
            "complete": self._is_whole and all(frame["complete"] for frame in frames),
            "frames_asked": len(self) if self._count is None else self._count,
            "white_luminance_cd_m2": first.exposure.white_luminance_cd_m2,
            "brightest_luminance_cd_m2": first.exposure.brightest_luminance_cd_m2,
            "animation": {
                "file": ANIMATION_FILE,
                "frames_per_second": FRAMES_PER_SECOND,
                "frames_in_a_round": shown,
            },
            "elapsed_s": sum(frame["elapsed_s"] for frame in frames),
            "frames": frames,
        }


def write_views(
    images: Iterable[Image],
    directory: Path | str,
    *,
    circle: bool = False,
    bits: Literal[8, 16] = 8,
) -> dict[str, Any]:
    """Write ``images`` of one scene from many places; return the summary.

    Files: ``frame-001.png``, ``frame-001.exr`` and so on, ``animation.png``, which plays there and
    back, or round where the places are a full ``circle``, and ``summary.json``. All are shown
    under one exposure: where the scene leaves it to the picture, that of all frames together. The
    pictures that came before a Ctrl-C are written.

    Raises:
        LamplitError: There is no image.
        OutputError: A file cannot be written.
    """
    from lamplit.errors import LamplitError

    with ViewWriter(Path(directory), count=None, circle=circle, bits=bits) as writer:
        try:
            for image in images:
                writer.add(image)
        except KeyboardInterrupt:
            if len(writer) > 0:
                writer.finish()
            raise
        if len(writer) == 0:
            raise LamplitError("there is no picture to write; one is the least")
        return writer.finish()


def _frame_numbers(at: int, image: Image) -> dict[str, Any]:
    camera = image.scene.camera
    return {
        "frame": at + 1,
        "files": [frame_name(at) + end for end in (".png", ".exr")],
        "position_mm": list(camera.position_mm),
        "target_mm": list(camera.target_mm),
    }


class _Pool:
    """Pixels taken evenly from all frames, as many as can be looked at again and again."""

    def __init__(self) -> None:
        self._step = 1
        self._parts: list[Array] = []

    def add(self, pixels: Array) -> None:
        """Take from XYZ (n, 3) of one more frame."""
        self._parts.append(pixels[:: self._step].copy())
        while sum(map(len, self._parts)) > _MOST_POOLED:
            self._step *= 2
            self._parts = [part[::2].copy() for part in self._parts]

    def exposure(self, image: Image) -> Exposure:
        """Return the exposure of them all, as the scene of ``image`` asks for it."""
        return automatic_exposure(np.concatenate(self._parts)[None, :, :], View.of(image.scene))


def _remove_frames(folder: Path, *, beyond: int) -> None:
    for path in folder.iterdir():
        match = _FRAME_FILE.fullmatch(path.name)
        if match is not None and int(match[1]) > beyond:
            with suppress(OSError):
                path.unlink()


_ARRAYS = ("xyz", "xyz_standard_error", "samples_per_pixel")


def _without_arrays(image: Image) -> Image:
    empty = {name: np.empty((0, 0, 3)) for name in _ARRAYS}
    return replace(image, **cast("dict[str, Any]", empty))


class _Store:
    """The arrays of images, in a file without a name that goes when the program does."""

    def __init__(self, directory: Path) -> None:
        self._file: IO[bytes] = tempfile.TemporaryFile(dir=directory)  # noqa: SIM115
        self._starts: list[int] = []

    def close(self) -> None:
        self._file.close()

    def append(self, image: Image) -> None:
        self._starts.append(self._file.seek(0, 2))
        for name in _ARRAYS:
            np.save(self._file, getattr(image, name), allow_pickle=False)

    def image(self, at: int, bare: Image) -> Image:
        """Return image ``at``, whose other values ``bare`` has."""
        self._file.seek(self._starts[at])
        arrays = {name: np.load(self._file, allow_pickle=False) for name in _ARRAYS}
        return replace(bare, **arrays)
