# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit check`` prints what was found, and its exit code says whether the scene is sound."""

from __future__ import annotations

from pathlib import Path

import pytest
import typer

from lamplit.cli.check import check
from lamplit.errors import LamplitError


def test_a_sound_scene_is_called_sound(sound: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check(sound)
    printed = capsys.readouterr().out
    assert "sound (0 errors, 0 warnings, 1 notice)" in printed
    assert "nothing uses 'my-led'" in " ".join(printed.split())
    assert "ball" in printed
    assert "MiB" in printed


def test_an_unsound_scene_ends_with_code_1(sound: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = sound.with_name("part.obj")
    mesh.write_text(mesh.read_text().replace("f 3 1 4\n", ""))
    with pytest.raises(typer.Exit) as ended:
        check(sound, ["objects[1].material=cover"])
    assert ended.value.exit_code == 1
    printed = capsys.readouterr().out
    assert "not sound (1 error," in printed
    assert "'part' is open: 3 edges" in printed


def test_an_unreadable_scene_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(LamplitError, match="does not exist"):
        check(tmp_path / "none.toml")
