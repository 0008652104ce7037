# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The library against tables that were typed here on their own, row by row as they are printed."""

from __future__ import annotations

import itertools

import pytest

from lamplit.rules import Rule, find_rule, judge, load_rules, rule_set_names
from lamplit.rules.points import point_name

from .conftest import AMBER, RED, WHITE, observe, power_law

#: UN R148: minimum on the axis, maximum of one lamp, of an assembly D, at night; None: no such.
R148 = {
    "R1": (4.0, 17.0, 8.5, None),
    "R2": (4.0, 42.0, 21.0, 17.0),
    "RM1": (4.0, 17.0, 8.5, None),
    "RM2": (4.0, 42.0, 21.0, 17.0),
    "S1": (60.0, 260.0, 130.0, None),
    "S2": (60.0, 730.0, 365.0, 260.0),
    "S3": (25.0, 110.0, 55.0, None),
    "S4": (25.0, 160.0, 80.0, 110.0),
    "2a": (50.0, 500.0, 250.0, None),
    "2b": (50.0, 1000.0, 500.0, 500.0),
    "F1": (150.0, 300.0, None, None),
    "F2": (150.0, 840.0, None, 300.0),
    "77R": (2.0, 30.0, None, None),
    "SM1": (4.0, 25.0, None, None),
    "SM2": (0.6, 25.0, None, None),
}
#: Field of visibility: cd by day, cd at night, inboard, outboard, up, down.
FIELDS = {
    "R1": (0.05, 0.05, 45, 80, 15, 15),
    "R2": (0.05, 0.05, 45, 80, 15, 15),
    "RM1": (0.05, 0.05, 0, 80, 15, 15),
    "RM2": (0.05, 0.05, 0, 80, 15, 15),
    "S1": (0.3, 0.3, 45, 45, 15, 15),
    "S2": (0.3, 0.07, 45, 45, 15, 15),
    "S3": (0.3, 0.3, 10, 10, 10, 5),
    "S4": (0.3, 0.07, 10, 10, 10, 5),
    "2a": (0.3, 0.3, 45, 80, 15, 15),
    "2b": (0.3, 0.07, 45, 80, 15, 15),
    "77R": (0.05, 0.05, 0, 45, 15, 15),
    "SM1": (0.6, 0.6, 45, 45, 10, 10),
    "SM2": (0.6, 0.6, 30, 30, 10, 10),
}
#: Percent of the minimum, by (H, V) without signs.
A3_I = {(0, 0): 100, (5, 0): 90, (0, 5): 70, (10, 0): 35, (5, 10): 20, (10, 5): 20, (20, 5): 10}
A3_V = {(10, 10): 10, (0, 10): 15, (45, 5): 15, (10, 5): 20, (0, 5): 25}
A3_V |= {(45, 0): 15, (30, 0): 25, (10, 0): 50, (0, 0): 80}
A3_V |= {(45, -5): 15, (30, -5): 25, (10, -5): 50, (0, -5): 80}
A3_III = {(10, 10): 32, (0, 10): 64}
A3_III |= {(10, v): 64 for v in (5, 0, -5)} | {(h, v): 100 for h in (0, 5) for v in (5, 0, -5)}

#: FMVSS 108: rows 5U/5D-20, 10U/10D-5, 5U/5D-10, H-10, 5U/5D-V, H-5, H-V; sums 1 to 3; maximum.
FMVSS = {
    ("tail", "1"): ([0.3, 0.4, 0.8, 0.8, 1.8, 2.0, 2.0], [1.4, 2.4, 9.6], 18.0),
    ("tail", "2"): ([0.5, 0.7, 1.4, 1.4, 3.1, 3.5, 3.5], [2.4, 4.2, 16.8], 20.0),
    ("tail", "3"): ([0.7, 1.0, 2.0, 2.0, 4.5, 5.0, 5.0], [3.5, 6.0, 24.0], 25.0),
    ("stop", "1"): ([10, 16, 30, 40, 70, 80, 80], [50, 100, 380], 300.0),
    ("stop", "2"): ([12, 19, 35, 47, 82, 95, 95], [60, 115, 445], 360.0),
    ("stop", "3"): ([15, 22, 40, 55, 95, 110, 110], [70, 135, 520], 420.0),
    ("turn-amber", "1"): ([15, 26, 50, 65, 110, 130, 130], [80, 165, 610], 750.0),
    ("turn-amber", "2"): ([20, 30, 55, 75, 130, 150, 150], [100, 185, 710], 900.0),
    ("turn-amber", "3"): ([25, 35, 65, 90, 150, 175, 175], [120, 220, 825], 900.0),
    ("parking", "1"): ([0.4, 0.8, 0.8, 1.4, 2.8, 3.6, 4.0], [2.4, 3.0, 16.8], 125.0),
}
ROWS = [(20, 5), (5, 10), (10, 5), (10, 0), (0, 5), (5, 0), (0, 0)]


def minima(rule: Rule) -> dict[tuple[float, float], float]:
    return {(own.h_deg, own.v_deg): own.minimum_cd for own in rule.points()}


def everywhere(table: dict[tuple[int, int], float]) -> dict[tuple[float, float], float]:
    return {(h * side, v): value for (h, v), value in table.items() for side in (1, -1)}


def up_and_down(table: dict[tuple[int, int], float]) -> dict[tuple[float, float], float]:
    return everywhere({(h, v * up): value for (h, v), value in table.items() for up in (1, -1)})


def limits(rule: Rule, words: str) -> list[float | None]:
    light = power_law(1.0, 1.0)
    xy = WHITE if rule.name in {"AR", "backup", "parking"} else RED
    verdict = judge(rule, observe(rule, light, xy=xy, cell_deg=5.0))
    return [own.required for own in verdict.findings if own.requirement.startswith(words)]


@pytest.mark.parametrize("name", R148)
def test_axis_and_maxima_of_r148_are_those_of_its_tables(name: str) -> None:
    axis, single, assembly, night = R148[name]
    rule = find_rule(f"un-r148/{name}")
    assert minima(rule)[0.0, 0.0] == axis
    assert limits(rule, "maximum")[0] == single
    if assembly is not None:
        assert limits(rule.under(assembly="D"), "maximum")[0] == assembly
    if night is not None:
        assert limits(rule.under(period="night"), "maximum")[0] == night


@pytest.mark.parametrize("name", FIELDS)
def test_fields_of_visibility_of_r148_are_those_of_its_tables(name: str) -> None:
    day, night, inboard, outboard, up, down = FIELDS[name]
    rule = find_rule(f"un-r148/{name}").under(side="right")
    (own,) = rule.entry.field
    assert limits(rule, "field") == [day]
    assert limits(rule.under(period="night"), "field") == [night]
    # The field by what is found dark: one cell at a time, in each corner of it and outside.
    for h, v, inside in (
        (-inboard + 0.5, up - 0.5, True),
        (outboard - 0.5, up - 0.5, True),
        (outboard - 0.5, -down + 0.5, True),
        (-inboard + 0.5, -down + 0.5, True),
        (-inboard - 0.5, 0.5, False),
        (outboard + 0.5, 0.5, False),
        (0.5, up + 0.5, False),
        (0.5, -down - 0.5, False),
    ):

        def light(own_h: object, own_v: object, h: float = h, v: float = v) -> object:
            there = (abs(own_h - h) < 0.1) & (abs(own_v - v) < 0.1)  # type: ignore[operator]
            return 1.0 - there

        verdict = judge(rule, observe(rule, light))  # type: ignore[arg-type]
        (field,) = [one for one in verdict.findings if one.requirement.startswith("field")]
        assert (field.outcome == "fail") is inside, (h, v)
    assert own.trust == "V2"


@pytest.mark.parametrize("name", ["R1", "R2", "RM1", "RM2", "S1", "S2", "2a", "2b", "77R"])
def test_figure_a3_i_is_reproduced(name: str) -> None:
    axis = R148[name][0]
    expected = up_and_down({where: axis * percent / 100 for where, percent in A3_I.items()})
    assert minima(find_rule(f"un-r148/{name}")) == pytest.approx(expected)


@pytest.mark.parametrize("name", ["S3", "S4"])
def test_figure_a3_iii_is_reproduced(name: str) -> None:
    expected = everywhere({where: percent / 4 for where, percent in A3_III.items()})
    assert minima(find_rule(f"un-r148/{name}")) == pytest.approx(expected)


def test_figure_a3_v_is_reproduced_and_a_pair_is_looked_at_to_30_degrees_inboard() -> None:
    rule = find_rule("un-r148/AR")
    assert minima(rule) == everywhere(A3_V)
    assert limits(rule, "maximum") == [300.0, 600.0, 8000.0]
    right = minima(rule.under(installation="pair", side="right"))
    left = minima(rule.under(installation="pair", side="left"))
    assert right == {where: cd for where, cd in everywhere(A3_V).items() if where[0] > -45}
    assert left == {where: cd for where, cd in everywhere(A3_V).items() if where[0] < 45}


def test_fog_lamps_have_150_cd_on_both_axes_and_75_in_the_rhombus_if_it_looks_uneven() -> None:
    rule = find_rule("un-r148/F1")
    on_axes = {(h, 0): 150 for h in (-10, -5, 0, 5, 10)} | {(0, v): 150 for v in (-5, 5)}
    assert minima(rule) == on_axes
    assert limits(rule, "minimum in the zone") == []
    uneven = rule.under(local_variation="yes")
    verdict = judge(uneven, observe(uneven, power_law(1.0, 1.0)))
    zone = next(own for own in verdict.findings if own.requirement == "minimum in the zone")
    assert zone.required == 75.0
    # Twice 10° × 5°, halved: a rhombus of 100 square degrees, in cells of 1°.
    assert "of 100 cells" in zone.remark or "of 104 cells" in zone.remark


def test_side_marker_lamps_have_a_box() -> None:
    box = {(h * 45, v * 10): 0.6 for h, v in itertools.product((-1, 0, 1), repeat=2)}
    assert minima(find_rule("un-r148/SM1")) == box | {(0, 0): 4.0}
    small = {(h * 30, v * 10): 0.6 for h, v in itertools.product((-1, 0, 1), repeat=2)}
    assert minima(find_rule("un-r148/SM2")) == small
    red = find_rule("un-r148/SM1").under(emits="red", side="left")
    assert limits(red, "maximum, H -90 to -60, V -20 to 20") == [0.25]


@pytest.mark.parametrize(("name", "sections"), FMVSS)
def test_the_nineteen_points_of_fmvss_108_are_those_of_its_tables(name: str, sections: str) -> None:
    rows, sums, most = FMVSS[name, sections]
    rule = find_rule(f"fmvss-108/{name}").under(sections=sections)
    assert minima(rule) == up_and_down(dict(zip(ROWS, rows, strict=True)))
    verdict = judge(
        rule, observe(rule, power_law(1.0, 1.0), xy=WHITE if name == "parking" else AMBER)
    )
    found = [own.required for own in verdict.findings if own.requirement.endswith("sum")]
    assert found == [*sums, sums[1], sums[0]]
    maxima = [own for own in verdict.findings if own.sense == "max"]
    assert maxima[0].required == most


def test_the_red_turn_signal_has_the_stop_lamps_values() -> None:
    for sections in (1, 2, 3):
        turn, stop = (
            find_rule(f"fmvss-108/{name}").under(sections=sections) for name in ("turn-red", "stop")
        )
        assert minima(turn) == minima(stop)


def test_parking_lamps_may_have_twice_as_much_below_the_horizontal() -> None:
    rule = find_rule("fmvss-108/parking")
    verdict = judge(rule, observe(rule, power_law(1.0, 1.0), xy=WHITE))
    found = {(own.h_deg, own.v_deg): own.required for own in verdict.findings if own.sense == "max"}
    assert found == {where: 250.0 if where[1] < 0 else 125.0 for where in minima(rule)}


def test_the_high_mounted_stop_lamp_of_table_xv_is_reproduced() -> None:
    rule = find_rule("fmvss-108/high-mounted-stop")
    inner = {(h, v): 25.0 for h in (0, 5) for v in (5, 0, -5)}
    outer = {(10, v): 16.0 for v in (5, 0, -5)} | {(0, 10): 16.0, (10, 10): 8.0}
    assert minima(rule) == everywhere(inner | outer)
    verdict = judge(rule, observe(rule, power_law(1.0, 1.0)))
    sums = [own.required for own in verdict.findings if own.requirement.endswith("sum")]
    assert sums == [125.0, 98.0, 98.0, 32.0]
    assert [own.required for own in verdict.findings if own.sense == "max"] == [160.0]


def test_a_single_backup_lamp_needs_twice_what_each_of_two_needs() -> None:
    one = find_rule("fmvss-108/backup")
    rule = one.under(backup_lamps=2)
    assert minima(rule) == everywhere(A3_V)
    assert minima(one) == {where: 2 * cd for where, cd in everywhere(A3_V).items()}
    for own, factor in ((rule, 1), (one, 2)):
        verdict = judge(own, observe(own, power_law(1.0, 1.0), xy=WHITE))
        sums = [f.required for f in verdict.findings if f.requirement.endswith("sum")]
        assert sums == [factor * cd for cd in (45, 50, 100, 360, 50, 45)]
        most = {f.required for f in verdict.findings if f.sense == "max"}
        assert most == {300.0 * factor}
        below = [f for f in verdict.findings if f.sense == "max" and (f.v_deg or 0.0) < 0.0]
        assert below == []


def test_groups_hold_the_points_that_the_tables_put_into_them() -> None:
    groups: dict[int | None, set[str]] = {}
    for own in find_rule("fmvss-108/stop").points():
        groups.setdefault(own.group, set()).add(point_name(own.h_deg, own.v_deg))
    assert groups == {
        0: {"5U-20L", "5D-20L", "10U-5L", "10D-5L"},
        1: {"5U-10L", "H-10L", "5D-10L"},
        2: {"5U-V", "H-5L", "H-V", "H-5R", "5D-V"},
        3: {"5U-10R", "H-10R", "5D-10R"},
        4: {"10U-5R", "10D-5R", "5U-20R", "5D-20R"},
    }


def test_low_mounting_moves_or_leaves_out_the_points_below_5_degrees() -> None:
    low = minima(find_rule("un-r148/S1").under(mounting="low"))
    assert len(low) == 17 and min(v for _, v in low) == -5.0
    points = find_rule("fmvss-108/stop").under(mounting="low").points()
    assert len(points) == 19
    moved = {own.name: (own.h_deg, own.v_deg) for own in points if own.name.startswith("10D")}
    assert moved == {"10D-5L": (5.0, -5.0), "10D-5R": (-5.0, -5.0)}


def test_retro_reflectors_have_the_values_of_r3_and_j594() -> None:
    cil = {
        "un-r150/IA": {(0.333333, 0): (300, 200, 100), (1.5, 0): (5, 2.8, 2.5)},
        "un-r150/IIIA": {(0.333333, 0): (450, 200, 150), (1.5, 0): (12, 8, 8)},
        "sae-j594/red": {(0.2, 0): (420, 280, 140), (1.5, 0): (6, 5, 3)},
    }
    for name, tables in cil.items():
        for own, ((observation, _), (straight, up, side)) in zip(
            find_rule(name).reflex(), tables.items(), strict=True
        ):
            assert own.observation_deg == observation
            for (v, h), minimum in zip(own.entrance_deg, own.minimum, strict=True):
                expected = straight if v == h == 0 else side if abs(h) == 20 else up
                assert minimum == expected
                assert (abs(v), abs(h)) in {(0, 0), (10, 0), (5, 20), (0, 20)}


def test_every_value_says_where_it_is_from_and_every_set_how_it_was_read() -> None:
    for name in rule_set_names():
        rules = load_rules(name)
        assert rules.file.notices, name
        marks = {grid.trust for grid in rules.file.grids.values()}
        assert marks <= {"V2"}, name
    verdict = judge(find_rule("un-r148/S1"), observe(find_rule("un-r148/S1"), power_law(70.0, 1.0)))
    assert all(own.clause and own.trust == "V2" for own in verdict.findings)
    assert any("not at hand" in notice for notice in verdict.notices)
