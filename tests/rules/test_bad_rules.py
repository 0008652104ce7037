# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A rule file with one fault: one line that says what, where, and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from lamplit.errors import RuleError
from lamplit.rules import find_rule, load_rules

SOUND = """\
lamplit_rules = 1
title = "own"
document = "company standard"
[options.sections]
description = "lighted sections"
choices = ["1", "2"]
[grids.square]
clause = "figure 1"
trust = "M"
unit = "%"
h_deg = [-5, 0, 5]
v_deg = [5, 0]
rows = [
  [20, "-", 20],
  [50, 100, 50],
]
[groupings.all]
groups = [["H-5L", "H-V", "H-5R"]]
[entries.lamp]
title = "lamp"
colour = { clause = "2", trust = "M", region = "un-red" }
[[entries.lamp.distribution]]
clause = "1"
trust = "M"
grid = "square"
minimum_cd = 10.0
rule = "floor"
floor_percent = 60
groups = "all"
sums_cd = { by = "sections", of = { 1 = [30], 2 = [40] } }
between = "cells"
[[entries.lamp.maximum]]
clause = "3"
trust = "M"
cd = 100.0
"""

#: What is replaced, by what, and words of the one line that answers.
FAULTS = {
    "a missing grid value": ("[50, 100, 50]", "[50, 100]", "rows[1] has 2 values, and h_deg has 3"),
    "a missing row": ("  [50, 100, 50],\n", "", "there are 1 rows, and v_deg has 2"),
    "an unknown point": ('"H-5L"', '"H-6L"', "no point of grid 'square' 'H-6L'; did you mean"),
    "no such grid": ('grid = "square"', 'grid = "squre"', "did you mean 'square'"),
    "an unknown key": ("trust = ", "trsut = ", "unknown key 'trsut'; did you mean 'trust'"),
    "a missing key": ('clause = "figure 1"\n', "", "grids.square.clause: this key is missing"),
    "an unknown unit": ('unit = "%"', 'unit = "candela"', "'candela' is not '%', 'cd' or '1'"),
    "a percentage of nothing": ("minimum_cd = 10.0\n", "", "minimum_cd belongs to a grid in %"),
    "a minimum above the maximum": ("cd = 100.0", "cd = 9.0", "10 cd at H-V is above the maximum"),
    "an unknown colour": ('"un-red"', '"un-rde"', "no colour region 'un-rde'; did you mean"),
    "an unknown option": ('by = "sections"', 'by = "section"', "did you mean 'sections'"),
    "an unknown choice": ("2 = [40]", "3 = [40]", "no choice of sections '3'"),
    "sums of other groups": ("1 = [30]", "1 = [30, 30]", "2 sums are given for the 1 groups"),
    "no floor": ("floor_percent = 60\n", "", "floor_percent belongs to rule = 'floor'"),
    "another rule": ('"floor"', '"flor"', "'flor' is not 'each', 'floor' or 'point-or-group'"),
    "another between": ('"cells"', '"cell"', "no rule between points 'cell'; did you mean 'cells'"),
    "another mark": ('trust = "M"\nunit', 'trust = "sure"\nunit', "'sure' is not 'V', 'V2', 'N'"),
    "columns out of order": ("[-5, 0, 5]", "[5, 0, -5]", "h_deg must ascend"),
    "a negative value": ("[20, ", "[-20, ", "greater than or equal to 0"),
    "a value that is no number": ("[20, ", "[nan, ", "grids.square.rows[0]: nan is given"),
    "TOML that breaks off": ("[5, 0]\n", "[5, 0\n", "not sound TOML"),
    "another format": ("lamplit_rules = 1\n", "", "a rule file begins with lamplit_rules = 1"),
}


def written(folder: Path, text: str) -> Path:
    file = folder / "own.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_the_file_that_is_spoiled_is_sound(tmp_path: Path) -> None:
    assert load_rules(written(tmp_path, SOUND)).entry("lamp").title == "lamp"


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_told_in_one_line_with_the_file_and_the_key(tmp_path: Path, fault: str) -> None:
    found, instead, words = FAULTS[fault]
    assert SOUND.count(found) >= 1
    file = written(tmp_path, SOUND.replace(found, instead, 1))
    with pytest.raises(RuleError) as told:
        load_rules(file)
    text = str(told.value)
    assert words in text
    assert text.startswith(str(file)) and "\n" not in text
    assert told.value.where


def test_a_cell_without_a_value_on_its_lines_is_refused(tmp_path: Path) -> None:
    text = SOUND.replace(
        '  [20, "-", 20],\n  [50, 100, 50],\n', '  ["-", "-", 20],\n  ["-", "-", 100],\n'
    )
    text = text.replace('[["H-5L", "H-V", "H-5R"]]', '[["H-5L"]]')
    with pytest.raises(
        RuleError, match=r"no value on the lines round the cell of H -5 to 0, V 0 to 5"
    ):
        load_rules(written(tmp_path, text))


def test_toml_faults_say_the_line(tmp_path: Path) -> None:
    with pytest.raises(RuleError, match=r"own\.toml: line 3, column 12: this is not sound TOML"):
        load_rules(
            written(tmp_path, SOUND.replace('document = "company standard"', "document = company"))
        )


def test_unknown_sets_entries_options_and_choices_are_named_with_the_nearest(
    tmp_path: Path,
) -> None:
    with pytest.raises(RuleError, match=r"no rules 'un-r184'; did you mean 'un-r148'"):
        find_rule("un-r184/S1")
    with pytest.raises(RuleError, match=r"no entry 'S9'; did you mean"):
        find_rule("un-r148/S9")
    with pytest.raises(RuleError, match=r"no option 'section'; did you mean 'sections'"):
        find_rule("fmvss-108/stop").under(section=1)
    with pytest.raises(
        RuleError, match=r"sections = '4' is no choice of fmvss-108; it has 1, 2, 3"
    ):
        find_rule("fmvss-108/stop").under(sections=4)
    for text in ("S1", "un-r148/", "/S1", "", "un-r148/S1?", "un-r148/S1?side", "un-r148/S1?=left"):
        with pytest.raises(RuleError, match="names no rule"):
            find_rule(text)


def test_options_follow_a_rule_in_its_name_or_come_from_what_a_scene_says() -> None:
    night = find_rule("un-r148/S2?period=night&side=left")
    assert (night.options["period"], night.side, night.id) == ("night", "left", "un-r148/S2")
    with pytest.raises(RuleError, match="no option 'perod'; did you mean 'period'"):
        find_rule("un-r148/S2?perod=night")
    stop = find_rule("fmvss-108/stop").where_known(sections=2, assembly="D", side="left")
    assert stop.options == {"sections": "2", "backup_lamps": "1", "mounting": "normal"}
    assert find_rule("un-r148/S1").where_known(sections=2, side=None).side == "either"


def test_an_own_file_is_found_below_the_scenes_folder_and_nowhere_else(tmp_path: Path) -> None:
    folder = tmp_path / "scene"
    folder.mkdir()
    written(folder, SOUND)
    written(tmp_path, SOUND)
    (folder / "link.toml").symlink_to(tmp_path / "own.toml")
    assert find_rule("own.toml/lamp", root=folder).id == "own.toml/lamp"
    for hostile in ("../own.toml", str(tmp_path / "own.toml"), "link.toml", "http://x/own.toml"):
        with pytest.raises(RuleError) as told:
            find_rule(f"{hostile}/lamp", root=folder)
        assert "\n" not in str(told.value)


def test_hostile_files_end_in_one_line(tmp_path: Path) -> None:
    for content in (b"\xff\xfe\x00", b"\0", b"a = " + b"[" * 5000, b"a." * 5000 + b"b = 1"):
        file = tmp_path / "own.toml"
        file.write_bytes(content)
        with pytest.raises(RuleError) as told:
            load_rules(file)
        assert "\n" not in str(told.value)
    with pytest.raises(RuleError, match="does not exist"):
        load_rules(tmp_path / "gone.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(RuleError, match="not a file"):
        load_rules(tmp_path / "folder.toml")


def test_a_rule_that_asks_for_a_side_says_so(tmp_path: Path) -> None:
    text = (
        SOUND
        + """
[[entries.lamp.field]]
clause = "4"
trust = "M"
cd = 0.1
inboard_deg = 45
outboard_deg = 80
up_deg = 15
down_deg = 15
"""
    )
    with pytest.raises(RuleError, match="needs an option side"):
        load_rules(written(tmp_path, text))
    with pytest.raises(RuleError, match=r"for side = 'either' the rule has no value; choose side"):
        find_rule("un-r148/AR").under(installation="pair").points()
