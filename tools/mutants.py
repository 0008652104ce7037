# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Break the physics on purpose, one fault at a time, and see whether the tests notice.

``make mutants`` does all of it, ``.venv/bin/python tools/mutants.py name ...`` some. The faults are
in tools/mutants/*.toml: a file of crates/core/src, or of python/lamplit if it ends in .py, a text
that stands there exactly once, what it is changed into, and what that breaks. They are made in a
copy of the workspace, never here. Faults of the core meet cargo's tests, faults of the package
those of `PYTHON_TESTS`.

A fault is caught when a test fails, or when the tests do not end. It survives when all pass. The
exit status is 1 if more than one in thirty survives, and 2 if the tests fail without any fault, or
if a fault does not fit the source any more or does not compile.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from threading import Timer

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[1]
LISTS = ROOT / "tools" / "mutants"
SOURCES = Path("crates") / "core" / "src"
PACKAGE = Path("python") / "lamplit"
CARGO = ["cargo", "test", "--offline", "--package", "lamplit-core"]
STAGES = (["--test", "physics"], ["--lib"])
"""The tests: those that catch most come first."""
PYTHON_TESTS = ("photometry", "rules", "report/photometry", "engine/test_measure.py")
"""Below tests: what meets faults of the package."""
LONGEST_S = 900.0
"""How long the tests may take with a fault; without any it is a minute."""
SURVIVORS_PER_THIRTY = 1
SURVIVES = "survives"


class UnusableError(Exception):
    """A fault that says nothing about the tests, or tests that fail anyway."""


@dataclass(frozen=True)
class Mutant:
    """One fault."""

    name: str
    file: str
    original: str
    mutated: str
    breaks: str

    @property
    def is_python(self) -> bool:
        """Whether it is one of the package, not of the core."""
        return self.file.endswith(".py")

    def path(self, workspace: Path) -> Path:
        """Its file in a workspace."""
        return workspace / (PACKAGE if self.is_python else SOURCES) / self.file

    def apply(self, workspace: Path) -> str:
        """Change the file in a workspace, and return what was there."""
        path = self.path(workspace)
        text = path.read_text(encoding="utf-8")
        count = text.count(self.original)
        if count != 1:
            raise UnusableError(
                f"{self.name}: its text stands {count} times in {self.file}, not once"
            )
        path.write_text(text.replace(self.original, self.mutated), encoding="utf-8")
        return text


def read_list() -> list[Mutant]:
    """All faults of the lists."""
    found: list[Mutant] = []
    for file in sorted(LISTS.glob("*.toml")):
        written = tomllib.loads(file.read_text(encoding="utf-8"))
        found += [Mutant(name, **fields) for name, fields in written.items()]
    return found


def first_failure(workspace: Path, *, python: bool) -> str | None:
    """Run the tests of a workspace until one fails, and return its name; none if all pass."""
    if python:
        return _first_python_failure(workspace)
    failures = (_first_failure(workspace, [*CARGO, *stage]) for stage in STAGES)
    return next((failure for failure in failures if failure is not None), None)


def _first_failure(workspace: Path, command: list[str]) -> str | None:
    build = [*command, "--no-run"]
    built = subprocess.run(build, cwd=workspace, capture_output=True, check=False)  # noqa: S603
    lines = built.stderr.decode(errors="replace").splitlines()
    if built.returncode != 0:
        raise UnusableError(next((line for line in lines if line.startswith("error")), "no build"))
    if not any(line.strip().startswith("Compiling lamplit-core ") for line in lines):
        # Then the tests would be those of the fault before, and fail for its sake.
        raise UnusableError("cargo saw no change, and compiled nothing")
    return _run_until_failure(command, workspace, _cargo_failure)


def _cargo_failure(line: str) -> str | None:
    is_one = line.startswith("test ") and line.rstrip().endswith("FAILED")
    return line.split()[1] if is_one else None


def _first_python_failure(workspace: Path) -> str | None:
    tests = [f"tests/{name}" for name in PYTHON_TESTS]
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-rfE", *tests]
    return _run_until_failure(command, workspace, _pytest_failure)


def _pytest_failure(line: str) -> str | None:
    is_one = line.startswith(("FAILED ", "ERROR "))
    return line.split(" - ", maxsplit=1)[0].split(maxsplit=1)[1].strip() if is_one else None


def _run_until_failure(
    command: list[str], workspace: Path, failure: Callable[[str], str | None]
) -> str | None:
    """Run tests until a line of their output names one that failed, and return that name."""
    tests = subprocess.Popen(  # noqa: S603
        command,
        cwd=workspace,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
        env=os.environ | {"PYTHONPATH": str(workspace / "python"), "PYTHONDONTWRITEBYTECODE": "1"},
    )
    is_late: list[bool] = []

    def stop() -> None:
        is_late.append(True)
        os.killpg(tests.pid, signal.SIGKILL)

    timer = Timer(LONGEST_S, stop)
    timer.start()
    try:
        for line in tests.stdout or ():
            if (name := failure(line)) is not None:
                os.killpg(tests.pid, signal.SIGKILL)
                return name
        if tests.wait() == 0:
            return None
        return "(the tests did not end)" if is_late else "(the tests broke off)"
    finally:
        timer.cancel()
        tests.wait()


def copy_workspace(folder: Path) -> Path:
    """Copy what cargo and pytest need into a folder."""
    workspace = folder / "workspace"
    shutil.copytree(ROOT / "crates", workspace / "crates", dirs_exist_ok=True)
    for part in ("python", "tests", "docs", "examples"):
        shutil.copytree(ROOT / part, workspace / part)
    for name in ("Cargo.toml", "Cargo.lock", "pyproject.toml"):
        shutil.copy2(ROOT / name, workspace / name)
    return workspace


def try_all(mutants: list[Mutant], workspace: Path) -> dict[Mutant, str]:
    """Try each fault, say what came of it, and return the verdict on those that were not caught."""
    kinds = sorted({mutant.is_python for mutant in mutants})
    _must_pass(workspace, kinds, "without any fault")
    left: dict[Mutant, str] = {}
    width = max(len(mutant.name) for mutant in mutants)
    for mutant in mutants:
        started = time.monotonic()
        original = mutant.apply(workspace)
        try:
            failed = first_failure(workspace, python=mutant.is_python)
            verdict = f"caught by {failed}" if failed else f"SURVIVES: {mutant.breaks}"
            if not failed:
                left[mutant] = SURVIVES
        except UnusableError as fault:
            verdict = f"NOT TRIED: {fault}"
            left[mutant] = verdict
        mutant.path(workspace).write_text(original, encoding="utf-8")
        seconds = time.monotonic() - started
        print(f"{mutant.name:{width}}  {seconds:4.0f} s  {verdict}", flush=True)
    _must_pass(workspace, kinds, "with all faults taken back")
    return left


def _must_pass(workspace: Path, kinds: list[bool], when: str) -> None:
    for python in kinds:
        failed = first_failure(workspace, python=python)
        if failed is not None:
            raise UnusableError(f"{when}, this test fails: {failed}")


def main() -> int:
    """Try the faults that the command line names, or all."""
    parser = argparse.ArgumentParser(description="Try faults of physics on the tests.")
    parser.add_argument("names", nargs="*", help="faults of the list; all if none")
    chosen: list[str] = parser.parse_args().names
    mutants = read_list()
    if unknown := set(chosen) - {mutant.name for mutant in mutants}:
        print(f"mutants: no fault is named {', '.join(sorted(unknown))}: see {LISTS}")
        return 2
    mutants = [mutant for mutant in mutants if not chosen or mutant.name in chosen]
    with tempfile.TemporaryDirectory(prefix="lamplit-mutants-") as folder:
        workspace = copy_workspace(Path(folder))
        try:
            # All must fit before the first of them costs a minute.
            for mutant in mutants:
                original = mutant.apply(workspace)
                mutant.path(workspace).write_text(original, encoding="utf-8")
            left = try_all(mutants, workspace)
        except UnusableError as fault:
            print(f"mutants: {fault}")
            return 2
    survivors = sum(verdict == SURVIVES for verdict in left.values())
    print(f"{len(mutants) - len(left)} of {len(mutants)} faults caught")
    if len(left) > survivors:
        return 2
    return int(survivors * 30 > SURVIVORS_PER_THIRTY * max(len(mutants), 30))


if __name__ == "__main__":
    sys.exit(main())
