# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The house stands as drawn: layers point one way, files are short and name their licence."""

from __future__ import annotations

import ast
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python" / "lamplit"
CORE = ROOT / "crates" / "core" / "src"

#: What each room of the Python package may import besides itself, lower floors first.
PYTHON_ROOMS: dict[str, set[str]] = {"base": set(), "sources": {"base"}, "colour": {"base"}}
PYTHON_ROOMS["materials"] = {"base", "sources", "colour"}
PYTHON_ROOMS["lamps"] = {"base"}
PYTHON_ROOMS["photometry"] = {"base"}
PYTHON_ROOMS["scene"] = {"base", "sources", "colour", "materials", "photometry"}
PYTHON_ROOMS["engine"] = PYTHON_ROOMS["scene"] | {"scene", "_core"}
PYTHON_ROOMS["rules"] = {"base", "sources", "colour", "photometry"}
PYTHON_ROOMS["report"] = PYTHON_ROOMS["engine"] - {"_core"} | {"engine", "rules"}
PYTHON_ROOMS["cli"] = PYTHON_ROOMS["report"] | {"report", "lamps"}

#: What each module of the core may import besides itself.
_GROUND = {"math", "sampling", "spectrum"}
RUST_ROOMS = {
    "math": set[str](),
    "spectrum": set[str](),
    "sampling": {"math", "spectrum"},
    "light": _GROUND,
    "geometry": _GROUND,
    "matter": _GROUND,
    "scene": _GROUND | {"light", "geometry", "matter"},
    "transport": _GROUND | {"light", "geometry", "matter", "scene"},
    "film": _GROUND | {"light", "geometry", "matter", "scene"},
    "render": _GROUND | {"light", "geometry", "matter", "scene", "transport", "film"},
}


def python_room(dotted: str) -> str | None:
    """Return the room of a module such as ``lamplit.colour.gamut``; None outside Lamplit."""
    parts = dotted.split(".")
    if parts[0] != "lamplit":
        return None
    if len(parts) == 1:
        return "lamplit"
    in_room = parts[1] in PYTHON_ROOMS or parts[1] == "_core"
    return parts[1] if in_room else "base"


def python_imports(path: Path) -> set[str]:
    """Return the rooms that a module imports anywhere, types and lazy imports included."""
    rooms: set[str | None] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            rooms |= {python_room(alias.name) for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            if node.module == "lamplit":
                rooms |= {python_room(f"lamplit.{alias.name}") for alias in node.names}
            else:
                rooms.add(python_room(node.module))
    return {room for room in rooms if room is not None}


@pytest.mark.parametrize("room", PYTHON_ROOMS)
def test_a_python_room_imports_only_from_the_floors_below(room: str) -> None:
    paths = PACKAGE.glob("*.py") if room == "base" else (PACKAGE / room).rglob("*.py")
    files = [path for path in paths if path.name != "__init__.py" or room != "base"]
    assert files
    allowed = PYTHON_ROOMS[room] | {room}
    # The version is read from the core by the command line that prints it.
    allowed |= {"lamplit"} if room == "cli" else set()
    faults = {
        str(path.relative_to(ROOT)): beyond
        for path in files
        if (beyond := python_imports(path) - allowed)
    }
    assert not faults


@pytest.mark.parametrize("room", RUST_ROOMS)
def test_a_module_of_the_core_uses_only_the_layers_below(room: str) -> None:
    files = list((CORE / room).rglob("*.rs"))
    assert files
    for path in files:
        used = set(re.findall(r"\bcrate::(\w+)", path.read_text(encoding="utf-8")))
        assert used <= RUST_ROOMS[room] | {room}, f"{path.relative_to(ROOT)} looks up: {used}"


def test_only_the_binding_knows_python() -> None:
    for path in [*CORE.rglob("*.rs"), ROOT / "crates" / "core" / "Cargo.toml"]:
        assert "pyo3" not in path.read_text(encoding="utf-8"), path


def source_files() -> list[Path]:
    """Return the program files that git knows or would add."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    ).stdout.split("\n")
    found = [ROOT / name for name in listed if name.endswith((".rs", ".py", ".pyi"))]
    return [path for path in found if path.exists()]


def test_no_file_is_longer_than_500_lines_and_each_names_its_licence() -> None:
    files = source_files()
    assert len(files) > 100
    for path in files:
        lines = path.read_text(encoding="utf-8").splitlines()
        assert len(lines) <= 500, f"{path.relative_to(ROOT)} has {len(lines)} lines"
        assert "SPDX-License-Identifier: Apache-2.0 OR MIT" in "\n".join(lines[:3]), path


def test_unsafe_code_is_only_in_the_simd_files() -> None:
    simd = {"x86.rs", "kernel.rs", "traverse.rs"}
    for path in ROOT.glob("crates/**/*.rs"):
        text = re.sub(r"//.*", "", path.read_text(encoding="utf-8"))
        if path.name not in simd:
            assert not re.search(r"\bunsafe\s*(\{|fn|impl)", text), path
