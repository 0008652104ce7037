# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The JSON Schema of a scene file, for editors.

``python -m lamplit.scene.schema`` writes it anew beside this module.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

SCHEMA_FILE = Path(__file__).with_name("scene.schema.json")


def scene_schema() -> dict[str, Any]:
    """Return the schema, generated from the models of the scene."""
    from lamplit.scene.models import Scene

    schema = Scene.model_json_schema()
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "title": "Lamplit scene",
    }


def schema_text() -> str:
    """Return the text of the schema file."""
    return json.dumps(scene_schema(), indent=2, ensure_ascii=False, sort_keys=True) + "\n"


if __name__ == "__main__":
    SCHEMA_FILE.write_text(schema_text(), encoding="utf-8")
