# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Break the physics of the core on purpose, one fault at a time, and see whether its tests notice.

``make mutants`` does all of it, ``.venv/bin/python tools/mutants.py name ...`` some. The faults are
in tools/mutants/physics.toml: a file of crates/core/src, a text that stands there exactly once,
what it is changed into, and what that breaks. They are made in a copy of the workspace, never here.

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
from dataclasses import dataclass
from pathlib import Path
from threading import Timer

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[1]
LIST = ROOT / "tools" / "mutants" / "physics.toml"
SOURCES = Path("crates") / "core" / "src"
CARGO = ["cargo", "test", "--offline", "--package", "lamplit-core"]
STAGES = (["--test", "physics"], ["--lib"])
"""The tests: those that catch most come first."""
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

    def apply(self, workspace: Path) -> str:
        """Change the file in a workspace, and return what was there."""
        path = workspace / SOURCES / self.file
        text = path.read_text(encoding="utf-8")
        count = text.count(self.original)
        if count != 1:
            raise UnusableError(
                f"{self.name}: its text stands {count} times in {self.file}, not once"
            )
        path.write_text(text.replace(self.original, self.mutated), encoding="utf-8")
        return text


def read_list() -> list[Mutant]:
    """All faults of the list."""
    with LIST.open("rb") as stream:
        written = tomllib.load(stream)
    return [Mutant(name, **fields) for name, fields in written.items()]


def first_failure(workspace: Path) -> str | None:
    """Run the tests of a workspace until one fails, and return its name; none if all pass."""
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
    tests = subprocess.Popen(  # noqa: S603
        command,
        cwd=workspace,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    is_late: list[bool] = []

    def stop() -> None:
        is_late.append(True)
        os.killpg(tests.pid, signal.SIGKILL)

    timer = Timer(LONGEST_S, stop)
    timer.start()
    try:
        for line in tests.stdout or ():
            if line.startswith("test ") and line.rstrip().endswith("FAILED"):
                os.killpg(tests.pid, signal.SIGKILL)
                return line.split()[1]
        if tests.wait() == 0:
            return None
        return "(the tests did not end)" if is_late else "(the tests broke off)"
    finally:
        timer.cancel()
        tests.wait()


def copy_workspace(folder: Path) -> Path:
    """Copy what cargo needs into a folder."""
    workspace = folder / "workspace"
    shutil.copytree(ROOT / "crates", workspace / "crates", dirs_exist_ok=True)
    for name in ("Cargo.toml", "Cargo.lock"):
        shutil.copy2(ROOT / name, workspace / name)
    return workspace


def try_all(mutants: list[Mutant], workspace: Path) -> dict[Mutant, str]:
    """Try each fault, say what came of it, and return the verdict on those that were not caught."""
    failed = first_failure(workspace)
    if failed is not None:
        raise UnusableError(f"without any fault, this test fails: {failed}")
    left: dict[Mutant, str] = {}
    width = max(len(mutant.name) for mutant in mutants)
    for mutant in mutants:
        started = time.monotonic()
        original = mutant.apply(workspace)
        try:
            failed = first_failure(workspace)
            verdict = f"caught by {failed}" if failed else f"SURVIVES: {mutant.breaks}"
            if not failed:
                left[mutant] = SURVIVES
        except UnusableError as fault:
            verdict = f"NOT TRIED: {fault}"
            left[mutant] = verdict
        (workspace / SOURCES / mutant.file).write_text(original, encoding="utf-8")
        seconds = time.monotonic() - started
        print(f"{mutant.name:{width}}  {seconds:4.0f} s  {verdict}", flush=True)
    failed = first_failure(workspace)
    if failed is not None:
        raise UnusableError(f"with all faults taken back, this test fails: {failed}")
    return left


def main() -> int:
    """Try the faults that the command line names, or all."""
    parser = argparse.ArgumentParser(description="Try faults of physics on the tests of the core.")
    parser.add_argument("names", nargs="*", help="faults of the list; all if none")
    chosen: list[str] = parser.parse_args().names
    mutants = read_list()
    if unknown := set(chosen) - {mutant.name for mutant in mutants}:
        print(f"mutants: no fault is named {', '.join(sorted(unknown))}: see {LIST.name}")
        return 2
    mutants = [mutant for mutant in mutants if not chosen or mutant.name in chosen]
    with tempfile.TemporaryDirectory(prefix="lamplit-mutants-") as folder:
        workspace = copy_workspace(Path(folder))
        try:
            # All must fit before the first of them costs a minute.
            for mutant in mutants:
                original = mutant.apply(workspace)
                (workspace / SOURCES / mutant.file).write_text(original, encoding="utf-8")
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
