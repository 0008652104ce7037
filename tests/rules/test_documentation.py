# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The page on rules: its example is a sound file, and its lists are complete."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from lamplit.rules import judge, load_rules, rule_set_names
from lamplit.rules.models import (
    Distribution,
    Entry,
    Maximum,
    Ratio,
    Reflex,
    VisibilityField,
    Zone,
)

from .conftest import observe, power_law

PAGE = (Path(__file__).parents[2] / "docs" / "rules.md").read_text("utf-8")


def test_the_example_is_read_and_judges_a_lamp(tmp_path: Path) -> None:
    file = tmp_path / "my-rules.toml"
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    file.write_text(example, encoding="utf-8")
    tail = load_rules(file).entry("tail").under(side="left")
    assert judge(tail, observe(tail, power_law(4.7, 1.0))).outcome == "pass"
    premium = tail.under(grade="premium")
    assert judge(premium, observe(premium, power_law(4.7, 1.0))).outcome == "fail"


def test_every_set_and_entry_is_listed() -> None:
    for name in rule_set_names():
        (line,) = [line for line in PAGE.splitlines() if line.startswith(f"| `{name}`")]
        for entry in load_rules(name).entries:
            assert re.search(rf"\b{re.escape(entry)}\b", line), (name, entry)


@pytest.mark.parametrize(
    ("heading", "model"),
    [
        ("distribution", Distribution),
        ("maximum", Maximum),
        ("zone", Zone),
        ("field", VisibilityField),
        ("ratio", Ratio),
        ("reflex", Reflex),
        ("[entries.N]", Entry),
    ],
)
def test_every_key_of_a_requirement_is_listed(heading: str, model: type) -> None:
    (line,) = [line for line in PAGE.splitlines() if line.startswith(f"| `{heading}` |")]
    common = {"clause", "trust", "when", "unit"}
    lists = {"distribution", "maximum", "zone", "field", "ratio", "reflex"}
    keys = set(model.model_fields) - common - (lists if model is Entry else set())  # type: ignore[attr-defined]
    assert [key for key in keys if f"`{key}" not in line] == []
