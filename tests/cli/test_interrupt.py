# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Ctrl-C and SIGTERM on a render that really runs: what is done is kept."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from lamplit.report.exr_file import read_exr


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["INT", "TERM"]
)
def test_a_signal_ends_a_running_render_soon_and_keeps_its_samples(
    scene_file: Path, number: signal.Signals, code: int
) -> None:
    """R23: within 2 s the files are there, whole, and say how far the render came."""
    out = scene_file.parent / "out"
    options = ["--size", "320x200", "--samples", "40000", "--threads", "1"]
    running = subprocess.Popen(
        [sys.executable, "-m", "lamplit.cli", "render", str(scene_file), "-o", str(out), *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        deadline = time.monotonic() + 20.0
        while not out.is_dir() and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(2.0)
        running.send_signal(number)
        stopped = time.monotonic()
        while not (out / "summary.json").exists() and time.monotonic() < stopped + 20.0:
            time.sleep(0.01)
        kept_after_s = time.monotonic() - stopped
        _, error = running.communicate(timeout=30)
    finally:
        running.kill()
    assert running.returncode == code, error
    assert "Traceback" not in error
    assert kept_after_s <= 2.0
    numbers = json.loads((out / "summary.json").read_text())
    assert numbers["complete"] is False
    assert numbers["samples"] < numbers["samples_asked"] == 40000
    assert np.isfinite(read_exr(out / "picture.exr").xyz).all()
    assert not list(out.glob(".*"))
