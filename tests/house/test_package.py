# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What is shipped: public names, the version, the start-up, and the wheel."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import lamplit
from lamplit.lamps import write_lamp

ROOT = Path(__file__).resolve().parents[2]

#: What every Linux has that can run Python at all.
SYSTEM_LIBRARIES = ("c.so.6", "m.so.6", "gcc_s.so.1", "pthread.so.0", "dl.so.2")


def test_the_public_names_exist_and_are_few() -> None:
    assert len(lamplit.__all__) <= 13
    for name in lamplit.__all__:
        assert getattr(lamplit, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'rendr'"):
        lamplit.rendr  # noqa: B018


def test_the_version_is_the_one_in_the_change_log_and_the_citation() -> None:
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(rf"^## \[{re.escape(lamplit.__version__)}\]", changes, re.MULTILINE)
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"version: {lamplit.__version__}" in citation


def test_importing_lamplit_loads_no_heavy_library() -> None:
    code = "import sys, lamplit, lamplit.cli; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    ).stdout.split()
    heavy = {"numpy", "scipy", "colour", "matplotlib", "trimesh", "OpenEXR", "xarray", "pydantic"}
    assert not heavy & set(loaded)


@pytest.mark.parametrize(
    "command",
    [
        ["render", "lamp/scene.toml", "-o", "out", "--size", "16x10", "--samples", "4"],
        ["compare", "lamp/scene.toml", "-o", "out", "--size", "16x10", "--samples", "4"],
        ["sources", "D65", "--plot", "source.png"],
        ["materials", "red-pmma", "--plot", "material.png"],
        ["check", "lamp/scene.toml"],
    ],
    ids=lambda command: command[0],
)
def test_no_command_needs_the_libraries_that_only_tests_have(
    tmp_path: Path, command: list[str]
) -> None:
    write_lamp("paper", tmp_path / "lamp", {})
    code = (
        "import sys; from lamplit.cli import main; code = main(sys.argv[1:]); "
        "print(*sys.modules, file=sys.stderr); sys.exit(code)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *command],
        check=False,
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    assert not {"colour", "trimesh", "pandas", "xarray"} & set(done.stderr.split())


def test_the_wheel_installs_into_an_empty_environment_and_renders(tmp_path: Path) -> None:
    maturin = Path(sys.executable).with_name("maturin")
    subprocess.run(
        [maturin, "build", "--release", "--locked", "--quiet", "--out", tmp_path],
        cwd=ROOT,
        check=True,
    )
    (wheel,) = tmp_path.glob("*.whl")
    assert "-cp310-abi3-" in wheel.name
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        core = archive.read("lamplit/_core.abi3.so")
    assert "lamplit/materials/library/red-pmma.toml" in names
    assert "lamplit/rules/library/un-r148.toml" in names
    assert "lamplit/scene/scene.schema.json" in names
    assert "lamplit/py.typed" in names
    assert "lamplit/cie/cie-1931-2.csv" in names
    assert any(name.endswith(".dist-info/licenses/THIRD_PARTY.md") for name in names)
    needed = set(re.findall(rb"lib[\w+-]+\.so\.\d+", core))
    assert needed <= {f"lib{name}".encode() for name in SYSTEM_LIBRARIES}

    environment = tmp_path / "empty"
    subprocess.run([sys.executable, "-m", "venv", environment], check=True)
    python = environment / "bin" / "python"
    pip = [python, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    lock = ROOT / "requirements" / "run.lock"
    subprocess.run([*pip, "install", "--no-deps", "-r", lock, wheel], check=True)
    clean = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    lamplit_command = environment / "bin" / "lamplit"
    for arguments in (
        ["lamp", "paper", "-o", "lamp"],
        ["render", "lamp/scene.toml", "-o", "out", "--size", "16x10", "--samples", "1"],
    ):
        subprocess.run([lamplit_command, *arguments], cwd=tmp_path, env=clean, check=True)
    assert (tmp_path / "out" / "picture.png").stat().st_size > 100
    assert (tmp_path / "out" / "picture.exr").stat().st_size > 1000
