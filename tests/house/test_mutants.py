# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The faults that `make mutants` makes fit the source: each text stands there exactly once."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[2]
FAULTS = {
    f"{name} of {path.name}": fault
    for path in sorted(ROOT.glob("tools/mutants/*.toml"))
    for name, fault in tomllib.loads(path.read_text("utf-8")).items()
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_can_be_made_in_one_place_and_changes_it(name: str) -> None:
    fault = FAULTS[name]
    sources = "python/lamplit" if fault["file"].endswith(".py") else "crates/core/src"
    source = (ROOT / sources / fault["file"]).read_text("utf-8")

    assert source.count(fault["original"]) == 1
    assert fault["mutated"] != fault["original"]
