# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Candela of lamps with known intensity; errors that say what to do; numbers that repeat."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.engine import BeamLight, MeasureInterrupted, Plane, RayLight
from lamplit.engine.measure import in_laboratory
from lamplit.engine.measurement import Measurement
from lamplit.photometry.rays import RaySet, write_tm25
from lamplit.scene import Scene

Table = dict[str, Any]
COARSE = (np.arange(-90.0, 91.0, 10.0), np.arange(-90.0, 91.0, 10.0))


def disc(name: str = "die", **more: Any) -> Table:
    """Return a small black disc that shines along +z."""
    emission = {"source": "red-led-624", "flux_lm": 100.0} | more.pop("emission", {})
    own = {"name": name, "kind": "disc", "centre_mm": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}
    own |= {"radius_mm": 1.0, "material": "black", "emission": emission}
    return own | more


MATERIALS: Table = {
    "black": {"kind": "diffuse", "reflectance": 0.0},
    "clear": {"kind": "dielectric", "refractive_index": 1.5},
    "white": {"kind": "mirror", "reflectance": 0.9},
}


@pytest.fixture
def lamp_of(scene_of: Callable[..., Scene]) -> Callable[..., Scene]:
    """Return a maker of scenes with an axis +z and the given objects."""

    def make(*objects: Table, measure: Table | None = None, **tables: Any) -> Scene:
        return scene_of(
            objects=list(objects),
            materials=MATERIALS,
            measure={"axis": [0.0, 0.0, 1.0]} | (measure or {}),
            **tables,
        )

    return make


def test_a_matt_disc_has_its_flux_over_pi_and_the_cosine(lamp_of: Callable[..., Scene]) -> None:
    spots = [(0.0, 0.0), (30.0, 0.0), (-20.0, 40.0), (100.0, 0.0)]
    found = ll.measure(lamp_of(disc()), spots=spots, grid=COARSE, receiver_deg=8.0, paths=1 << 20)
    seen = found.observed()
    h, v = np.radians(spots).T
    # The mean of the cosine over a cone is its own at the axis times (1 + cos r)/2.
    expected = 100.0 / np.pi * np.cos(h) * np.cos(v) * (1.0 + np.cos(np.radians(4.0))) / 2.0
    off = seen.spot_cd[:3] - expected[:3]
    assert (np.abs(off) < 3.5 * seen.spot_standard_error_cd[:3]).all()
    assert (seen.spot_standard_error_cd[:3] < 0.012 * expected[:3]).all()
    assert found.out_lm["die"] == pytest.approx(100.0, rel=1e-3)
    assert found.efficiency() == pytest.approx(1.0, rel=1e-3)
    # Over a cell: (2/π) Φ-share by closed form, ∫cos H dH ∫cos² V dV over its solid angle.
    edges_h, edges_v = np.radians(COARSE[0]), np.radians(COARSE[1])
    heights = np.diff(edges_v / 2.0 + np.sin(2.0 * edges_v) / 4.0)
    cells = 100.0 / np.pi * heights[:, None] * np.diff(np.sin(edges_h)) / found.goniometer.cell_sr
    z = (seen.grid_cd - cells) / seen.grid_standard_error_cd
    assert np.abs(z).max() < 5.5
    assert 0.7 < z.std() < 1.3


def test_no_light_in_a_receiver_is_nought_with_an_upper_bound(
    lamp_of: Callable[..., Scene],
) -> None:
    found = ll.measure(lamp_of(disc()), spots=[(120.0, 0.0)], receiver_deg=1.0, paths=1 << 12)
    seen = found.observed()
    assert seen.spot_cd[0] == 0.0
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(np.radians(0.5)))
    # No hit leaves −ln 0.0228 = 3.78 of them possible, of a path each: 2 σ.
    bound = 0.5 * 3.78 * 100.0 / found.paths / solid_angle
    assert seen.spot_standard_error_cd[0] == pytest.approx(bound, rel=0.01)
    assert seen.grid_standard_error_cd.min() > 0.0


def test_functions_are_sums_of_groups_and_colours_stay_apart(lamp_of: Callable[..., Scene]) -> None:
    amber = {"source": "pc-amber-led", "flux_lm": 50.0, "group": "indicator"}
    functions = [
        {"name": "stop", "light": {"stop": 1.0}},
        {"name": "position", "light": {"stop": 0.1}, "rule": "un-r148/R1"},
        {"name": "turn", "light": {"indicator": 1.0}},
    ]
    scene = lamp_of(
        disc(emission={"group": "stop"}),
        disc("other", emission=amber, centre_mm=[5.0, 0.0, 0.0]),
        measure={"functions": functions},
    )
    found = ll.measure(scene, spots=[(0.0, 0.0)], grid=COARSE, receiver_deg=20.0, paths=1 << 17)
    stop, position, turn = (found.observed(name) for name in ("stop", "position", "turn"))
    both = found.observed({"stop": 1.0, "indicator": 1.0})
    assert position.spot_cd == pytest.approx(0.1 * stop.spot_cd, rel=1e-12)
    assert both.spot_xyz == pytest.approx(stop.spot_xyz + turn.spot_xyz, rel=1e-12)
    assert found.observed().spot_xyz == pytest.approx(both.spot_xyz, rel=1e-12)
    assert turn.spot_cd / stop.spot_cd == pytest.approx(0.5, abs=0.02)
    for seen, name in ((stop, "red-led-624"), (turn, "pc-amber-led")):
        from lamplit.colour.tristimulus import chromaticity_xy, tristimulus

        expected = chromaticity_xy(tristimulus(scene.resolve_source(name), range_nm=(380, 780)))
        assert chromaticity_xy(seen.spot_xyz[0]) == pytest.approx(expected, abs=1e-3)
    # The spectrum's own Y is the candela: 683 Σ I ȳ Δλ over bands of 5 nm.
    from lamplit.colour.observer import colour_matching_functions

    luminosity = colour_matching_functions("cie-1931-2", found.band_centres_nm)[:, 1]
    group = found.groups.index("indicator")
    candela = 683.0 * 5.0 * found.spot_spectra[group, 0] @ luminosity
    assert candela == pytest.approx(turn.spot_cd[0], rel=3e-3)
    with pytest.raises(ll.LamplitError, match="no function 'stopp'; did you mean 'stop'"):
        found.observed("stopp")
    with pytest.raises(ll.LamplitError, match="no light group 'dye'"):
        found.observed({"dye": 1.0})


def test_the_ledger_adds_up_in_lumens(lamp_of: Callable[..., Scene]) -> None:
    block = {"name": "block", "kind": "box", "min_mm": [-9.0, -9.0, 2.0]}
    block |= {"max_mm": [9.0, 9.0, 9.0], "material": "red-pmma"}
    found = ll.measure(lamp_of(disc(), block), paths=1 << 16, grid=COARSE)
    ledger = found.ledger
    rest = ledger.cut_by_depth + ledger.lost + ledger.chance + ledger.gap
    total = ledger.out + sum(ledger.absorbed.values()) + rest
    assert total == pytest.approx(ledger.emitted, rel=1e-12)
    assert abs(ledger.gap) < 1e-9 * ledger.emitted
    assert ledger.emitted == pytest.approx(100.0, rel=1e-2)
    assert ledger.absorbed["block"] > 1.0
    assert ledger.absorbed["die"] > 0.1
    assert ledger.out == pytest.approx(found.out_lm["die"], rel=1e-9)


def test_the_same_numbers_for_any_threads_and_others_for_another_seed(
    lamp_of: Callable[..., Scene],
) -> None:
    def spots(**more: Any) -> Any:
        asked: Table = {"spots": [(0, 0), (20, 5)], "receiver_deg": 30.0, "paths": 5000} | more
        return ll.measure(lamp_of(disc()), grid=COARSE, **asked).spot_xyz

    one = spots(threads=1)
    assert np.array_equal(one, spots(threads=3))
    assert not np.array_equal(one, spots(threads=1, seed=2))


def test_the_eye_sees_what_the_light_sends(lamp_of: Callable[..., Scene]) -> None:
    block = {"name": "block", "kind": "box", "min_mm": [-9.0, -9.0, 2.0]}
    block |= {"max_mm": [9.0, 9.0, 6.0], "material": "red-pmma"}
    scene = lamp_of(disc(radius_mm=4.0), block)
    for distance in (float("inf"), 0.2):
        found = ll.measure(
            scene,
            spots=[(0.0, 0.0), (35.0, 10.0)],
            grid=COARSE,
            receiver_deg=8.0,
            distance_m=distance,
            paths=1 << 19,
        )
        check = found.cross_check(looks=1 << 18)
        assert (np.abs(check.sigmas) < 3.5).all()
        assert (check.light_standard_error_cd < 0.02 * check.light_cd).all()
        assert (check.eye_standard_error_cd < 0.03 * check.eye_cd).all()


@pytest.mark.parametrize("roughness", [0.0, 0.3])
def test_the_luminance_of_a_lit_picture_over_the_lamp_is_its_candela(
    scene_of: Callable[..., Scene], roughness: float
) -> None:
    # ∫ L dA over the lamp as seen from far away is its intensity that way.
    side, height_mm, angle = 32, 32.0, np.radians(25.0)
    cover: Table = {"kind": "dielectric", "refractive_index": 1.5, "roughness": roughness}
    scene = in_laboratory(
        scene_of(
            objects=[
                disc(),
                _box("cover", [-9.0, -9.0, 4.0], [9.0, 9.0, 7.0]),
                _box("tray", [-9.0, -9.0, -2.0], [9.0, 9.0, -1.0]),
            ],
            materials=MATERIALS | {"cover": cover, "tray": {"kind": "diffuse", "reflectance": 0.7}},
            measure={"axis": [0.0, 0.0, 1.0]},
            camera={
                "kind": "orthographic",
                "position_mm": [100.0 * np.sin(angle), 0.0, 100.0 * np.cos(angle)],
                "target_mm": [0.0, 0.0, 2.0],
                "height_mm": height_mm,
            },
            image={"method": "lit", "width": side, "height": side, "samples": 64},
        )
    )
    found = ll.measure(scene, spots=[(25.0, 0.0)], grid=COARSE, receiver_deg=9.0, paths=1 << 20)
    seen = found.observed()
    pixel_m2 = (height_mm / side * 1e-3) ** 2
    pictures = [
        ll.render(scene.changed(image=scene.image.model_copy(update={"seed": seed})))
        for seed in range(8)
    ]
    totals = [picture.xyz[..., 1].sum() * pixel_m2 for picture in pictures]
    candela, sigma = np.mean(totals), np.std(totals, ddof=1) / len(totals) ** 0.5
    both = np.hypot(sigma, seen.spot_standard_error_cd[0])
    assert abs(candela - seen.spot_cd[0]) < 4.0 * both, (candela, sigma, seen.spot_cd)
    assert both < 0.02 * candela


def _box(name: str, low_mm: list[float], high_mm: list[float]) -> Table:
    return {"name": name, "kind": "box", "min_mm": low_mm, "max_mm": high_mm, "material": name}


def test_a_plane_is_lit_by_the_inverse_square(lamp_of: Callable[..., Scene]) -> None:
    scene = lamp_of(
        {"name": "ball", "kind": "sphere", "centre_mm": [0.0, 0.0, 0.0], "radius_mm": 0.1}
        | {"material": "black", "emission": {"source": "A", "flux_lm": 4000.0 * np.pi}}
    )
    wall = Plane(centre_mm=[0, 0, 2000], normal=[0, 0, -1], width_mm=1200, height_mm=400,
                 columns=3, rows=1)  # fmt: skip
    found = ll.measure(scene, plane=wall, grid=COARSE, paths=1 << 20)
    assert found.plane_xyz is not None
    lux = found.plane_xyz[:, :, 0, :, 1].sum(axis=1)
    mean, sigma = lux.mean(axis=0), lux.std(axis=0, ddof=1) / np.sqrt(len(lux))
    # I = 1000 cd at 2 m; the pixels' own means of cos³.
    x = (np.arange(300) + 0.5) / 300 * 1.2 - 0.6
    y = (np.arange(100) + 0.5) / 100 * 0.4 - 0.2
    exact = 2000.0 / (x**2 + y[:, None] ** 2 + 4.0) ** 1.5
    expected = exact.reshape(100, 3, 100).mean(axis=(0, 2))
    assert (np.abs(mean - expected) < 3.5 * sigma).all()
    assert (sigma < 0.02 * expected).all()


def test_a_beam_gives_coefficients_of_luminous_intensity(lamp_of: Callable[..., Scene]) -> None:
    mirror = {"name": "mirror", "kind": "disc", "centre_mm": [0.0, 0.0, 0.0]}
    mirror |= {"normal": [0.0, 0.0, 1.0], "radius_mm": 30.0, "material": "white"}
    beam = BeamLight(h_deg=10.0, v_deg=0.0, angular_radius_deg=1.0)
    found = ll.measure(
        lamp_of(mirror), light=beam, spots=[(-10.0, 0.0)], grid=COARSE, receiver_deg=1.6,
        paths=1 << 17,
    )  # fmt: skip
    # R = ρ A cos θ/(π sin² a) within the mirrored disc of the source.
    area = np.pi * 0.03**2 * np.cos(np.radians(10.0))
    expected = 0.9 * area / (np.pi * np.sin(np.radians(1.0)) ** 2)
    seen = found.observed()
    assert abs(seen.spot_cd[0] - expected) < 3.5 * seen.spot_standard_error_cd[0]
    assert seen.spot_standard_error_cd[0] < 0.02 * expected
    assert found.groups == ("beam",)


def test_rays_bring_their_flux_and_their_wavelength(lamp_of: Callable[..., Scene]) -> None:
    from lamplit.colour.observer import colour_matching_functions

    ways = [[0.0, 0.0, 2.0], [1.0, 0.0, 1.0]]
    rays = RayLight(
        positions_mm=[[3.0, 0.0, 1.0]] * 2,
        directions=ways,
        flux=[0.2, 0.1],
        wavelengths_nm=[620.5, 560.5],
    )
    asked: Table = {"spots": [(0, 0), (45, 0)], "grid": COARSE, "receiver_deg": 2.0}
    found = ll.measure(lamp_of(disc()), light=rays, paths=1 << 13, **asked)
    luminosity = colour_matching_functions("cie-1931-2", np.array([620.5, 560.5]))[:, 1]
    lumens = found.observed().spot_cd * found.goniometer.spot_sr
    assert lumens == pytest.approx(683.0 * luminosity * [0.2, 0.1], rel=5e-3)
    red = RayLight(positions_mm=[[0, 0, 1]], directions=[[0, 0, 1]], flux=[7.0], spectrum="A")
    found = ll.measure(lamp_of(disc()), light=red, paths=1 << 13, **asked)
    assert found.observed().spot_cd[0] * found.goniometer.spot_sr == pytest.approx(7.0, rel=1e-2)
    for change, message in (
        ({"flux": [np.nan, 1.0]}, "ray 0: its flux must be finite"),
        ({"directions": [[0, 0, 1], [0, 0, 0]]}, "ray 1: its direction has no length"),
        ({"flux": [1.0]}, "fluxes has 1 entries for 2 rays"),
        ({"wavelengths_nm": [620.0, 900.0]}, "ray 1 has the wavelength 900 nm"),
        ({"wavelengths_nm": None}, "either one spectrum, or wavelengths_nm"),
        ({"flux": [0.0, 0.0]}, "no visible flux"),
    ):
        values = {name: getattr(rays, name) for name in ("positions_mm", "directions", "flux")}
        wrong = RayLight(**(values | {"wavelengths_nm": rays.wavelengths_nm} | change))
        with pytest.raises(ll.LamplitError, match=message):
            ll.measure(lamp_of(disc()), light=wrong, **asked)


def test_a_measurement_goes_on_until_it_is_enough(lamp_of: Callable[..., Scene]) -> None:
    scene = lamp_of(disc())
    asked: Table = {"spots": [(0.0, 0.0)], "grid": COARSE, "receiver_deg": 30.0}
    found = ll.measure(scene, error=0.004, **asked)
    assert found.complete
    assert 0.002 < found.relative_error <= 0.004
    short = ll.measure(scene, error=0.0001, paths=1 << 12, **asked)
    assert not short.complete
    assert short.paths == 1 << 12
    asked_for: list[int] = []

    def enough(so_far: Measurement) -> bool:
        asked_for.append(so_far.paths)
        return so_far.paths >= 200_000

    found = ll.measure(scene, until=enough, **asked)
    assert found.paths >= 200_000
    assert asked_for[-1] == found.paths
    assert len(asked_for) > 1
    timed = ll.measure(scene, time_s=0.3, **asked)
    assert timed.complete
    assert timed.paths > 0
    assert timed.elapsed_s < 3.0


def test_ctrl_c_keeps_what_was_walked(lamp_of: Callable[..., Scene]) -> None:
    def interrupt(_done: int, _total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(MeasureInterrupted) as caught:
        ll.measure(lamp_of(disc()), time_s=60.0, grid=COARSE, progress=interrupt)
    found = caught.value.measurement
    assert found.interrupted
    assert not found.complete
    assert found.paths > 0
    assert found.out_lm["die"] == pytest.approx(100.0, rel=0.05)


def test_what_cannot_be_measured_is_told_in_one_line(
    lamp_of: Callable[..., Scene], scene_of: Callable[..., Scene]
) -> None:
    table = {"name": "table", "kind": "disc", "centre_mm": [0.0, -20.0, 0.0], "material": "black"}
    table |= {"normal": [0.0, 1.0, 0.0], "radius_mm": 4000.0}
    faults = {
        r"measure\.axis.*axis is not given": scene_of(objects=[disc()], materials=MATERIALS),
        "no object has visible flux": lamp_of(disc(emission={"flux_lm": 0.0})),
        r"measure\.distance_m.*within the lamp": lamp_of(
            disc(), table, measure={"distance_m": 3.0}
        ),
        "nothing is left": lamp_of(disc(), measure={"leave_out": ["die"]}),
    }
    for message, scene in faults.items():
        with pytest.raises(ll.LamplitError, match=message):
            ll.measure(scene, paths=100)
    lamp = lamp_of(disc(), table, measure={"distance_m": 3.0, "leave_out": ["table"]})
    assert ll.measure(lamp, paths=100, grid=COARSE).goniometer.centre_mm == (0.0, 0.0, 0.0)
    for asked, message in (
        ({"spots": [(0.0, 91.0)]}, "V within"),
        ({"spots": [1.0, 2.0]}, "pairs of H and V"),
        ({"grid": ([0.0, 0.0], [0.0, 1.0])}, "rise"),
        ({"error": 0.0}, "target error"),
        ({"time_s": -1.0}, "time budget"),
        ({"paths": 0}, "1 path or more"),
        ({"receiver_deg": 0.0}, "receiver subtends"),
        ({"distance_m": 0.0}, "distance is above 0"),
    ):
        with pytest.raises(ll.LamplitError, match=message):
            ll.measure(lamp, **asked)


def test_names_in_the_table_mean_something(lamp_of: Callable[..., Scene]) -> None:
    for measure, message in (
        ({"leave_out": ["tabel"]}, r"measure\.leave_out\[0\].*no object"),
        ({"functions": [{"name": "a"}, {"name": "a"}]}, r"functions\[1\]\.name.*too"),
        ({"functions": [{"name": "a", "light": {"dies": 1.0}}]}, "no light group.*'dies'"),
        ({"functions": [{"name": "a", "with_position": "a"}]}, "no other function"),
        ({"up": [0.0, 0.0, -2.0]}, "parallel to axis"),
        ({"receiver_deg": 1.5}, "receiver_deg"),
        ({"axis": [0.0, 0.0, 0.0]}, "length other than zero"),
    ):
        with pytest.raises(ll.LamplitError, match=message):
            lamp_of(disc(), measure=measure)


def test_the_dataset_has_directions_wavelengths_and_units(lamp_of: Callable[..., Scene]) -> None:
    found = ll.measure(lamp_of(disc()), spots=[(0, 0)], grid=COARSE, spectra=True, paths=1 << 14)
    data = found.to_xarray()
    assert data["spectrum"].dims == ("group", "V", "H", "grid_wavelength")
    assert data["intensity"].attrs["units"] == "cd"
    assert float(data["H"][0]) == -85.0
    own = data["spectrum"].sel(group="die")
    lumens = data["intensity"].sel(group="die") * found.goniometer.cell_sr
    assert float(lumens.sum()) == pytest.approx(100.0, rel=1e-2)
    # Nearly all of the red light lies from 600 to 650 nm.
    share = own.sel(grid_wavelength=slice(600, 650)).sum() / own.sum()
    assert float(share) > 0.9


def test_ray_files_shine_beside_objects(tmp_path: Path, lamp_of: Callable[..., Scene]) -> None:
    ways = np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]])
    rays = RaySet(np.ones((2, 3)), ways, np.array([30.0, 10.0]), quantity="luminous")
    write_tm25(tmp_path / "led.tm25ray", rays)
    led = {"name": "led", "file": "led.tm25ray", "source": "red-led-624", "group": "stop"}
    scene = lamp_of(disc(emission={"group": "tail"}), ray_files=[led])
    spots = [(0.0, 0.0), (np.degrees(np.arcsin(0.6)), 0.0)]
    found = ll.measure(scene, spots=spots, grid=COARSE, receiver_deg=0.5, paths=1 << 15)
    assert found.emitted_lm["stop"] == pytest.approx(40.0, rel=1e-9)
    assert found.emitted_lm["tail"] == pytest.approx(100.0, rel=1e-9)
    assert found.out_lm["stop"] == pytest.approx(40.0, rel=0.01)
    assert found.out_lm["tail"] == pytest.approx(100.0, rel=0.01)
    lumens = found.observed({"stop": 1.0}).spot_cd * found.goniometer.spot_sr
    assert lumens == pytest.approx([30.0, 10.0], rel=0.03)
    assert set(found.ledgers) >= {"stop", "tail"}
