# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Rays that were lost and samples that were dropped, and whether the picture can be trusted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lamplit.engine.image import Image

#: Above this share of lost rays there is a warning, and above the next the picture is refused.
LOST_SHARE_WARNS, LOST_SHARE_FAILS = 1e-4, 1e-2

#: Above this share of dropped samples the picture is refused.
DROPPED_SHARE_FAILS = 1e-6

_CAUSES = {
    "left_without_entering": "left a body they were not in",
    "entered_twice": "entered a body they were in",
    "ended_inside": "ended inside a body",
    "too_many_bodies": "were in too many bodies at once",
}


@dataclass(frozen=True)
class Losses:
    """What of a render's rays and samples is missing from its picture.

    ``segments``: pieces of rays that were traced, from the eye and towards lights. ``lost_rays``:
    by body and cause; their light counts as black. ``samples``: over all pixels; dropped are those
    that were not finite or negative. ``first_dropped``: (column, row, sample), which, with the
    seed, makes that sample again.
    """

    segments: int
    lost_rays: Mapping[str, Mapping[str, int]]
    samples: int
    dropped_samples: int
    first_dropped: tuple[int, int, int] | None

    @classmethod
    def of(cls, image: Image) -> Losses:
        """Return the losses of ``image`` from the counts of its engine."""
        counts = image.statistics
        done = image.samples
        first: tuple[int, int] | None = counts.get("first_dropped_sample")
        place = None
        if first is not None:
            row, column = divmod(first[0], image.width)
            place = (column, row, first[1])
        return cls(
            segments=counts.get("eye_rays", 0) + counts.get("shadow_rays", 0),
            lost_rays=counts.get("lost_rays", {}),
            samples=done * image.width * image.height,
            dropped_samples=counts.get("dropped_samples", 0),
            first_dropped=place,
        )

    @property
    def lost_share(self) -> float:
        """Lost rays among all segments."""
        lost = sum(sum(causes.values()) for causes in self.lost_rays.values())
        return lost / max(self.segments, 1)

    @property
    def dropped_share(self) -> float:
        """Dropped samples among all."""
        return self.dropped_samples / max(self.samples, 1)

    def fault(self, *, allow_lost: bool = False) -> str | None:
        """Return why the picture must not pass as a result, or None if it may.

        ``allow_lost`` forgives lost rays; nothing forgives dropped samples.
        """
        if self.dropped_share > DROPPED_SHARE_FAILS:
            return f"{100 * self.dropped_share:.2g} % of its samples were dropped"
        if self.lost_share > LOST_SHARE_FAILS and not allow_lost:
            return (
                f"{100 * self.lost_share:.2g} % of its rays were lost, and "
                f"{100 * LOST_SHARE_FAILS:g} % is the most; repair the bodies, "
                "or accept it with --allow-lost"
            )
        return None

    def warnings(self) -> list[str]:
        """Return what a user must know, one line each; none for a sound picture."""
        found: list[str] = []
        if self.lost_share > LOST_SHARE_WARNS:
            found.append(
                f"{100 * self.lost_share:.2g} % of the rays were lost: {self._most_lost()}; "
                "`lamplit check` finds open and overlapping bodies"
            )
        if self.dropped_share > DROPPED_SHARE_FAILS:
            where = ""
            if self.first_dropped is not None:
                column, row, sample = self.first_dropped
                where = f", the first at column {column}, row {row}, sample {sample}"
            found.append(
                f"{self.dropped_samples} samples were not finite or negative and were dropped"
                f"{where}; this is a fault of Lamplit: please report it with the scene and the seed"
            )
        return found

    def _most_lost(self, most: int = 3) -> str:
        counted = [
            (count, body, cause)
            for body, causes in self.lost_rays.items()
            for cause, count in causes.items()
        ]
        worst = sorted(counted, reverse=True)[:most]
        return "; ".join(f"{count} at {body!r} {_CAUSES[cause]}" for count, body, cause in worst)

    def as_json(self) -> dict[str, Any]:
        """Return everything as plain JSON values."""
        names = ("column", "row", "sample")
        first = self.first_dropped
        return {
            "segments": self.segments,
            "lost_rays": {name: dict(causes) for name, causes in self.lost_rays.items()},
            "lost_share": self.lost_share,
            "samples": self.samples,
            "dropped_samples": self.dropped_samples,
            "dropped_share": self.dropped_share,
            "first_dropped_sample": first and dict(zip(names, first, strict=True)),
            "fault": self.fault(),
        }
