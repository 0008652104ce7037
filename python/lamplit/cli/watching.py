# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What is made of a picture in the making: a preview, and an honest word on its error."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamplit.engine.snapshot import PreviewCallback, Snapshot
    from lamplit.report.preview import PreviewFile
    from lamplit.report.progress import Progress


def watched(progress: Progress, preview: PreviewFile) -> PreviewCallback:
    """Return what tells ``progress`` how certain the picture is, and shows it as ``preview``."""

    def look(snapshot: Snapshot) -> None:
        progress.foresee(
            snapshot.relative_error,
            done_share=snapshot.done_share,
            at_end=snapshot.relative_error_at_end,
        )
        preview.show(snapshot)

    return look
