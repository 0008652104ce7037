# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What pydantic finds wrong in a scene, as one line with the key path and the nearest name."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from lamplit.errors import SceneError
from lamplit.table_faults import table_fault


def scene_fault(
    fault: ValidationError, written: Mapping[str, object], file: Path | None
) -> SceneError:
    """Return the one error to show for ``fault``, found in the tables ``written``."""
    message, where = table_fault(fault, written, _schema())
    return SceneError(message, file=file, where=where or None)


@lru_cache(maxsize=1)
def _schema() -> dict[str, Any]:
    from lamplit.scene.schema import scene_schema

    return scene_schema()
