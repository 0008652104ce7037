# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What the numbers were measured on."""

from __future__ import annotations

import os
import platform
import subprocess
from pathlib import Path
from typing import Any


def machine() -> dict[str, Any]:
    """Return processor, cores, load, system and versions."""
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    rust = subprocess.run(["rustc", "--version"], check=True, capture_output=True, text=True)
    return {
        "processor": names[0] if names else platform.processor(),
        "cores": os.cpu_count(),
        "load_before": round(os.getloadavg()[0], 2),
        "system": platform.platform(),
        "rust": rust.stdout.strip(),
        "python": platform.python_version(),
    }


def machine_line(about: dict[str, Any]) -> str:
    """Return the machine in a sentence's worth of words."""
    return (
        f"{about['processor']}, {about['cores']} cores (load {about['load_before']} before the "
        f"start), {about['rust']}, Python {about['python']}"
    )
