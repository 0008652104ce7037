# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Candela read by the eye of a receiver: closed forms, the light's own reading, and honest σ."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import lamplit as ll
from lamplit.engine import CrossCheck, MeasureInterrupted, Measurement
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.eye_reading import EyeReading
from lamplit.engine.looking import Looking, eye_method
from lamplit.scene import Scene

Table = dict[str, Any]
Array = NDArray[np.float64]
COARSE = (np.arange(-90.0, 91.0, 30.0), np.arange(-90.0, 91.0, 30.0))
FEW: Table = {"grid": COARSE, "receiver_deg": 0.5, "paths": 1 << 12}


def disc(name: str = "die", **more: Any) -> Table:
    """Return a small black disc that shines along +z."""
    emission = {"source": "red-led-624", "flux_lm": 100.0} | more.pop("emission", {})
    own = {"name": name, "kind": "disc", "centre_mm": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}
    return own | {"radius_mm": 1.0, "material": "black", "emission": emission} | more


def block(material: str, **more: Any) -> Table:
    """Return a plate of 4 mm before the disc."""
    own = {"name": "block", "kind": "box", "min_mm": [-9.0, -9.0, 2.0], "max_mm": [9.0, 9.0, 6.0]}
    return own | {"material": material} | more


@pytest.fixture
def lamp_of(scene_of: Callable[..., Scene]) -> Callable[..., Scene]:
    """Return a maker of scenes with an axis +z and the given objects."""

    def make(*objects: Table, **tables: Any) -> Scene:
        materials: Table = {
            "black": {"kind": "diffuse", "reflectance": 0.0},
            "clear": {"kind": "dielectric", "refractive_index": 1.5},
        }
        tables = {"measure": {"axis": [0.0, 0.0, 1.0]}} | tables
        return scene_of(objects=list(objects), materials=materials, **tables)

    return make


def looked(
    measurement: Measurement, looks: int, *, seed: int = 1, threads: int | None = None
) -> Looking:
    """Return a reading of all spots of ``measurement`` by so many looks in all."""
    scene = measurement.scene
    carrier = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
    looking = Looking(
        assemble(scene, carrier),
        measurement.goniometer,
        eye_method(scene),
        groups=len(measurement.groups),
        seed=seed,
        threads=threads,
    )
    assert not looking.until(looks)
    return looking


def read(looking: Looking) -> tuple[Array, Array]:
    """Return candela of all groups and their standard errors, (p,) each."""
    reading = looking.reading()
    xyz, covariance = reading.observed(np.ones(reading.xyz.shape[1]))
    return xyz[:, 1], np.sqrt(covariance[:, 1, 1])


@pytest.mark.parametrize("distance_m", [float("inf"), 3.0])
def test_a_matt_disc_has_its_flux_over_pi_and_the_cosine(
    lamp_of: Callable[..., Scene], distance_m: float
) -> None:
    spots = [(0.0, 0.0), (30.0, 0.0), (-20.0, 40.0), (0.0, -70.0)]
    found = ll.measure(lamp_of(disc()), spots=spots, distance_m=distance_m, **FEW)
    cd, sigma = read(looked(found, 1 << 18))
    h, v = np.radians(spots).T
    expected = 100.0 / np.pi * np.cos(h) * np.cos(v)
    assert (np.abs(cd - expected) < 3.5 * sigma + 1e-4 * expected).all()
    assert (sigma < 0.01 * expected).all()


def test_a_wide_lamp_near_the_receiver_is_weighed_by_its_cosines(
    lamp_of: Callable[..., Scene],
) -> None:
    near = ll.measure(lamp_of(disc(radius_mm=30.0)), spots=[(0.0, 0.0)], distance_m=0.2, **FEW)
    cd, sigma = read(looked(near, 1 << 18))
    # E = π L R²/(R² + d²) on the axis, and I = E d².
    expected = 100.0 / np.pi * 0.2**2 / (0.2**2 + 0.03**2)
    assert abs(cd[0] - expected) < 3.5 * sigma[0] + 1e-4 * expected
    assert sigma[0] < 0.005 * expected


def test_what_the_lens_does_not_see_sharply_counts_in_full(lamp_of: Callable[..., Scene]) -> None:
    lamp = lamp_of(disc(centre_mm=[10.0, 0.0, 0.0]), disc("behind", centre_mm=[-10.0, 0.0, -150.0]))
    deep = FEW | {"receiver_deg": 2.0}
    found = ll.measure(
        lamp.changed(measure=lamp.measure.model_copy(update={"centre_mm": (0.0, 0.0, 0.0)})),
        spots=[(0.0, 0.0)], distance_m=0.5, **deep,
    )  # fmt: skip
    cd, sigma = read(looked(found, 1 << 18))
    # Φ/π cos⁴θ d²/z² of each; the receiver's own width, averaged over its disc, adds second order.
    rim = 500.0 * np.tan(np.radians(1.0))
    expected = sum(
        100.0 / np.pi * 500.0**2 * z**2 / (z**2 + 10.0**2 + rim**2 / 2.0) ** 2
        for z in (500.0, 650.0)
    )
    assert abs(cd[0] - expected) < 3.5 * sigma[0] + 3e-4 * expected
    assert sigma[0] < 0.005 * expected


def test_a_plate_takes_what_fresnel_says(lamp_of: Callable[..., Scene]) -> None:
    spots = [(0.0, 0.0), (50.0, 0.0)]
    found = ll.measure(lamp_of(disc(), block("clear")), spots=spots, **FEW)
    cd, sigma = read(looked(found, 1 << 18))
    outside = np.radians([0.0, 50.0])
    inside = np.arcsin(np.sin(outside) / 1.5)
    a, b = np.cos(outside), np.cos(inside)
    s, p = ((a - 1.5 * b) / (a + 1.5 * b)) ** 2, ((1.5 * a - b) / (1.5 * a + b)) ** 2
    reflected = (s + p) / 2.0
    expected = 100.0 / np.pi * a * (1.0 - reflected) / (1.0 + reflected)
    assert (np.abs(cd - expected) < 3.5 * sigma + 1e-4 * expected).all()
    assert (sigma < 0.01 * expected).all()


def test_readings_are_right_on_average_and_scatter_as_they_say(
    lamp_of: Callable[..., Scene],
) -> None:
    # A glint of 3·10⁻⁴ of the picture: most looks miss it until rounds have taught where it is.
    wall = block("black", min_mm=[-50.0, -50.0, -9.0], max_mm=[50.0, 50.0, -1.0])
    found = ll.measure(lamp_of(disc(), wall), spots=[(0.0, 0.0)], **FEW)
    runs = [looked(found, 1 << 15, seed=seed).reading().xyz[:, :, 0, 1] for seed in range(16)]
    # (run, repetition): the spread itself, without what it is let out by where hits are few.
    readings = np.array(runs).sum(axis=2)
    cd, variance = readings.mean(axis=1), readings.var(axis=1, ddof=1) / readings.shape[1]
    expected = 100.0 / np.pi
    spread = cd.std(ddof=1)
    assert abs(cd.mean() - expected) < 3.5 * spread / np.sqrt(len(cd))
    assert spread < 0.4 * expected
    # χ² of 15 degrees of freedom lies within 0.23 and 2.5 of its mean, but for 1 in 1000.
    assert 0.23 < spread**2 / variance.mean() < 2.5


def test_later_rounds_look_where_light_was_seen(lamp_of: Callable[..., Scene]) -> None:
    wall = block("black", min_mm=[-50.0, -50.0, -9.0], max_mm=[50.0, 50.0, -1.0])
    found = ll.measure(lamp_of(disc(), wall), spots=[(0.0, 0.0)], **FEW)
    errors = [read(looked(found, looks))[1][0] for looks in (1 << 14, 1 << 17)]
    # 8 times the looks would make σ 2.8 times smaller, were they spread evenly.
    assert errors[1] < errors[0] / 8.0


def test_the_eye_agrees_with_the_light(lamp_of: Callable[..., Scene]) -> None:
    lamp = lamp_of(disc(radius_mm=4.0), block("red-pmma"))
    asked = FEW | {"receiver_deg": 2.0, "paths": 1 << 19}
    found = ll.measure(lamp, spots=[(0.0, 0.0), (35.0, 10.0), (-60.0, 0.0)], **asked)
    check = found.cross_check()
    assert check.eye_cd.size == 3
    assert (np.abs(check.sigmas) < check.allowed).all()
    assert (check.light_standard_error_cd < 0.15 * check.light_cd).all()
    assert (check.eye_standard_error_cd < 0.2 * check.light_standard_error_cd).all()
    assert (found.observed().spot_cd == check.eye_cd).all()
    assert (found.observed(by="light").spot_cd == check.light_cd).all()


def test_light_groups_keep_their_strength_and_colour(lamp_of: Callable[..., Scene]) -> None:
    from lamplit.colour.tristimulus import chromaticity_xy, tristimulus

    amber = {"source": "pc-amber-led", "flux_lm": 50.0, "group": "indicator"}
    lamp = lamp_of(
        disc(emission={"group": "stop"}), disc("other", emission=amber, centre_mm=[5.0, 0.0, 0.0])
    )
    found = ll.measure(lamp, spots=[(0.0, 0.0)], **FEW | {"paths": 1 << 18})
    stop, turn = (found.observed({name: 1.0}) for name in ("stop", "indicator"))
    assert turn.spot_cd / stop.spot_cd == pytest.approx(0.5, abs=0.01)
    for seen, name in ((stop, "red-led-624"), (turn, "pc-amber-led")):
        expected = chromaticity_xy(tristimulus(lamp.resolve_source(name), range_nm=(380, 780)))
        off = np.abs(chromaticity_xy(seen.spot_xyz[0]) - expected)
        assert (off < 3.5 * seen.spot_colours.standard_error[0] + 1e-4).all()
        assert (seen.spot_colours.standard_error[0] < 0.01).all()
    assert found.observed().spot_xyz == pytest.approx(stop.spot_xyz + turn.spot_xyz, rel=1e-12)


def test_where_the_eye_sees_nothing_the_light_bounds_it(lamp_of: Callable[..., Scene]) -> None:
    found = ll.measure(lamp_of(disc()), spots=[(120.0, 0.0)], **FEW)
    assert found.eye is not None
    assert found.eye.looks[0] >= found.paths // 2
    assert not found.eye.sees.any()
    seen = found.observed()
    assert seen.spot_cd[0] == 0.0
    # −ln 0.0228 = 3.78 paths may have come: 2 σ.
    bound = 0.5 * 3.78 * 100.0 / found.paths / found.goniometer.spot_sr
    assert seen.spot_standard_error_cd[0] == pytest.approx(bound, rel=0.01)


def test_a_spot_that_met_weak_light_alone_may_have_missed_the_strong() -> None:
    # Hits of 100 cd at the first spot, one of 10⁻³ cd in one repetition at the second.
    strong, weak = np.resize([0.0, 200.0], 16), np.zeros(16)
    weak[0] = 1e-3
    xyz = np.stack([strong, weak], axis=1)[:, None, :, None] * np.ones(3)
    reading = EyeReading(xyz, np.array([1000, 1000]))
    cd, covariance = reading.observed(np.ones(1))
    sigma = np.sqrt(covariance[:, 1, 1])
    assert cd[0, 1] == pytest.approx(100.0)
    hit = np.var(strong, ddof=1) / 16.0 / 100.0
    # 3.78 hits may have been missed: 2 σ.
    assert sigma[1] == pytest.approx(3.78 / 2.0 * hit, rel=0.01)


def test_the_same_bits_for_any_threads_and_others_for_another_seed(
    lamp_of: Callable[..., Scene],
) -> None:
    def xyz(**more: Any) -> Array:
        lamp = lamp_of(disc(), block("clear"))
        found = ll.measure(lamp, spots=[(0, 0), (20, 5)], **FEW | {"paths": 1 << 15} | more)
        assert found.eye is not None
        return found.eye.xyz

    one = xyz(threads=1)
    assert np.array_equal(one, xyz(threads=2))
    assert not np.array_equal(one, xyz(threads=1, seed=2))


def test_an_error_is_reached_and_time_is_kept(lamp_of: Callable[..., Scene]) -> None:
    lamp, spots = lamp_of(disc(), block("clear")), [(0.0, 0.0), (40.0, 0.0)]
    asked: Table = {"grid": COARSE, "receiver_deg": 0.5, "spots": spots}
    found = ll.measure(lamp, error=0.02, **asked)
    assert found.complete
    assert found.relative_error <= 0.02
    timed = ll.measure(lamp, time_s=1.0, **asked)
    assert timed.elapsed_s < 6.0
    assert timed.eye is not None
    assert timed.eye.looks.sum() > 0


def test_ctrl_c_keeps_what_was_seen(lamp_of: Callable[..., Scene]) -> None:
    def interrupt(done: int, total: int) -> None:
        if done > 0.7 * total:
            raise KeyboardInterrupt

    asked = FEW | {"paths": 1 << 21}
    with pytest.raises(MeasureInterrupted) as caught:
        ll.measure(lamp_of(disc(), block("clear")), spots=[(0.0, 0.0)], progress=interrupt, **asked)
    found = caught.value.measurement
    assert found.interrupted
    assert found.eye is not None
    assert 0 < found.eye.looks[0] < found.paths
    assert found.observed().spot_cd[0] == pytest.approx(100.0 / np.pi * 0.923, rel=0.02)


def test_the_eye_reads_nothing_that_it_cannot_see_whole(lamp_of: Callable[..., Scene]) -> None:
    floor = {"name": "floor", "kind": "plane", "point_mm": [0.0, -20.0, 0.0]}
    floor |= {"normal": [0.0, 1.0, 0.0], "material": "black"}
    spots = [(0.0, 0.0)]
    assert ll.measure(lamp_of(disc(), floor), spots=spots, **FEW).eye is None
    assert ll.measure(lamp_of(disc()), spots=spots, **FEW | {"receiver_deg": 3.0}).eye is None
    assert ll.measure(lamp_of(disc()), spots=spots, eye=False, **FEW).eye is None
    assert ll.measure(lamp_of(disc()), **FEW).eye is None
    with pytest.raises(ll.LamplitError, match="endless plane 'floor'"):
        ll.measure(lamp_of(disc(), floor), spots=spots, **FEW).cross_check()
    with pytest.raises(ll.LamplitError, match="no spots"):
        ll.measure(lamp_of(disc()), **FEW).cross_check()


def test_a_cross_check_looks_anew_where_it_is_asked_or_nothing_was_seen(
    lamp_of: Callable[..., Scene],
) -> None:
    told: list[tuple[int, int]] = []
    found = ll.measure(lamp_of(disc()), spots=[(0.0, 0.0), (20.0, 0.0)], **FEW)
    again = found.cross_check(looks=1 << 14, progress=lambda *at: told.append(at))
    assert told[-1] == (2 << 14, 2 << 14)
    assert (again.eye_cd != found.cross_check().eye_cd).all()
    unseen = ll.measure(lamp_of(disc()), spots=[(0.0, 0.0)], eye=False, **FEW)
    (cd,), (sigma,) = (check := unseen.cross_check()).eye_cd, check.eye_standard_error_cd
    assert abs(cd - 100.0 / np.pi) < 3.5 * sigma + 1e-4 * cd


@pytest.mark.parametrize(("light_error", "allowed"), [(0.0, 2.947), (2.0, 2.750), (1e9, 2.744)])
def test_what_chance_allows_is_student_s_t_of_both_ways_together(
    light_error: float, allowed: float
) -> None:
    """One point, α = 0.01: t tables for 15, 30 and 31 degrees of freedom."""
    one = np.array([0.0])
    # Equal σ of 16 batches and 16 repetitions: (1 + 1)²/(1/15 + 1/15).
    batches = 16 if light_error == 2.0 else 32
    check = CrossCheck(one, one, one + 9.0, one + light_error, one + 3.0, one + 2.0, batches, 16)
    assert check.allowed == pytest.approx(allowed, abs=5e-4)
    assert check.is_apart == (6.0 / np.hypot(light_error, 2.0) > allowed)
