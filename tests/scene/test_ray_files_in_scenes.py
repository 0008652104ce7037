# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``[[ray_files]]``: rays in the scene's place, in lm or W, with the spectrum that they have."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from lamplit.colour.tristimulus import luminous_efficacy
from lamplit.errors import LamplitError
from lamplit.photometry.rays import RaySet, SpectralTable, write_tm25
from lamplit.scene import Scene, check_scene, parse_scene
from lamplit.scene.ray_files import ResolvedRays
from lamplit.scene.shining import light_groups, path_notices
from lamplit.spectrum import SpectralDistribution

Table = dict[str, object]

POSITIONS = np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 4.0], [1.0, 1.0, 1.0]])
DIRECTIONS = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]])
FLUX = np.array([1.0, 2.0, 3.0, 4.0])


def scene_of(root: Path, *rays: Table, **more: object) -> Scene:
    written: Table = {
        "lamplit": 1,
        "camera": {"kind": "pinhole", "position_mm": [3, 4, 400], "target_mm": [0, 0, 0]},
        "objects": [
            {
                "name": "ball",
                "kind": "sphere",
                "centre_mm": [0, 0, -50],
                "radius_mm": 10.0,
                "material": "grey-18",
                "emission": {"source": "A", "flux_lm": 10.0},
            }
        ],
        "ray_files": list(rays),
    }
    return parse_scene(written | more, root=root)


def rays_file(root: Path, **more: object) -> Table:
    """Write four rays as TM-25 and return the table that names them."""
    values: Table = {"quantity": "luminous", **more}
    rays = RaySet(POSITIONS, DIRECTIONS, FLUX, **values)  # type: ignore[arg-type]
    write_tm25(root / "led.tm25ray", rays)
    return {"name": "led", "file": "led.tm25ray"}


def zemax_file(root: Path, unit: int, stated: float = 10.0) -> Table:
    header = struct.pack("<iI100s7f", 1010, 4, b"", 0.0, stated, 0.0, 0.0, 0.0, 0.0, 0.0)
    header += struct.pack("<i13f4i", unit, *[0.0] * 13, 0, 1, 0, 0)
    rows = np.column_stack([POSITIONS, DIRECTIONS, FLUX]).astype("<f4")
    (root / "led.dat").write_bytes(header + rows.tobytes())
    return {"name": "led", "file": "led.dat", "source": "red-led-624"}


def only(scene: Scene) -> ResolvedRays:
    (rays,) = scene.resolved_rays()
    return rays


def test_rays_stand_in_the_scene_as_their_transform_puts_them(tmp_path: Path) -> None:
    """Twice as large, then a quarter turn about z that takes x to y, then a shift along z."""
    moved = {"scale": 2.0, "rotate_deg": [0, 0, 90], "translate_mm": [0, 0, 100]}
    table = rays_file(tmp_path) | {"source": "A", "transform": moved}
    rays = only(scene_of(tmp_path, table))
    placed = [[0, 2, 100], [-4, 0, 100], [0, 0, 108], [-2, 2, 102]]
    np.testing.assert_allclose(rays.positions_mm, placed, atol=1e-12)
    turned = [[0, 1, 0], [-1, 0, 0], [0, 0, 1], [0, 0.6, 0.8]]
    np.testing.assert_allclose(rays.directions, turned, atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(rays.directions, axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(rays.flux, FLUX)


@pytest.mark.parametrize(
    ("in_file", "said", "factor"),
    [(4, None, 1.0), (0, None, 1000.0), (0, "mm", 1.0), (4, "in", 25.4)],
)
def test_the_unit_is_the_files_unless_the_scene_says_another(
    tmp_path: Path, in_file: int, said: str | None, factor: float
) -> None:
    table = zemax_file(tmp_path, in_file) | ({} if said is None else {"unit": said})
    rays = only(scene_of(tmp_path, table))
    np.testing.assert_allclose(rays.positions_mm, factor * POSITIONS, rtol=1e-7)


def test_lumens_stay_lumens_and_watts_become_them(tmp_path: Path) -> None:
    lumens = only(scene_of(tmp_path, rays_file(tmp_path) | {"source": "red-led-624"}))
    np.testing.assert_allclose(lumens.flux, FLUX)
    watts = rays_file(tmp_path, quantity="radiant") | {"source": "red-led-624"}
    found = only(scene_of(tmp_path, watts))
    np.testing.assert_allclose(found.flux, 233.0 * FLUX, rtol=3e-3)  # FACTS §3: 233 lm/W
    assert found.wavelengths_nm is None and found.spectrum is not None
    nm = np.arange(600.0, 650.0)
    assert nm[np.argmax(found.spectrum(nm))] == 624.0


def test_a_flux_in_the_scene_scales_all_rays(tmp_path: Path) -> None:
    table = rays_file(tmp_path, quantity="radiant") | {"source": "A", "flux_lm": 55.0}
    rays = only(scene_of(tmp_path, table))
    np.testing.assert_allclose(rays.flux, 5.5 * FLUX)


def test_each_ray_keeps_its_wavelength_and_its_watts(tmp_path: Path) -> None:
    nm = np.array([555.0, 600.0, 620.0, 640.0])
    table = rays_file(tmp_path, quantity="radiant", wavelengths_nm=nm)
    rays = only(scene_of(tmp_path, table))
    assert rays.spectrum is None and rays.wavelengths_nm is not None
    np.testing.assert_allclose(rays.wavelengths_nm, nm)
    np.testing.assert_allclose(rays.flux, FLUX)
    # CIE 018:2019, V(λ) at these wavelengths: 1.000, 0.631, 0.381, 0.175.
    lumens = 683.0 * float(FLUX @ [1.0, 0.631, 0.381, 0.175])
    scaled = only(scene_of(tmp_path, table | {"flux_lm": lumens}))
    np.testing.assert_allclose(scaled.flux, FLUX, rtol=1e-4)


def test_rays_that_the_picture_does_not_reach_are_left_out_and_told(tmp_path: Path) -> None:
    nm = np.array([365.0, 600.0, 620.0, 850.0])
    table = rays_file(tmp_path, quantity="radiant", wavelengths_nm=nm)
    scene = scene_of(tmp_path, table)
    rays = only(scene)
    np.testing.assert_allclose(rays.flux, [2.0, 3.0])
    assert rays.notices == (
        "led.tm25ray: 2 rays, 5 W, are left out: their wavelengths are not from 380 to 780 nm",
    )
    assert any("left out" in finding.message for finding in check_scene(scene).findings)


def test_a_table_of_the_file_is_the_spectrum_of_its_rays(tmp_path: Path) -> None:
    table = SpectralTable(np.array([600.0, 620.0, 640.0]), np.array([0.0, 100.0, 0.0]))
    rays = only(scene_of(tmp_path, rays_file(tmp_path, spectra=(table,))))
    assert rays.spectrum is not None
    np.testing.assert_allclose(rays.spectrum([380, 600, 610, 620, 780]), [0, 0, 50, 100, 0])
    np.testing.assert_allclose(rays.flux, FLUX)


def test_rays_of_several_tables_come_in_as_many_parts(tmp_path: Path) -> None:
    blue = SpectralTable(np.array([440.0, 450.0, 460.0]), np.array([0.0, 1.0, 0.0]))
    red = SpectralTable(np.array([610.0, 620.0, 630.0]), np.array([0.0, 1.0, 0.0]))
    table = rays_file(
        tmp_path,
        quantity="radiant",
        spectra=(blue, red),
        spectrum_index=np.array([0, 1, 0, 1]),
    )
    first, second = scene_of(tmp_path, table).resolved_rays()
    blue_lm, red_lm = (
        luminous_efficacy(SpectralDistribution.tabulated(*each, extension="zero"))
        for each in (blue, red)
    )
    np.testing.assert_allclose(first.flux, blue_lm * FLUX[[0, 2]], rtol=1e-6)
    np.testing.assert_allclose(second.flux, red_lm * FLUX[[1, 3]], rtol=1e-6)
    np.testing.assert_allclose(second.positions_mm, POSITIONS[[1, 3]])
    parts = scene_of(tmp_path, table | {"flux_lm": 7.0}).resolved_rays()
    assert sum(part.flux.sum() for part in parts) == pytest.approx(7.0)


def test_the_source_of_the_scene_goes_before_that_of_the_file(tmp_path: Path) -> None:
    table = rays_file(tmp_path, quantity="radiant", wavelengths_nm=np.full(4, 450.0))
    rays = only(
        scene_of(
            tmp_path,
            table | {"source": "mine"},
            sources={"mine": {"led_peak_nm": 624, "led_fwhm_nm": 18}},
        )
    )
    assert rays.wavelengths_nm is None
    np.testing.assert_allclose(rays.flux, 233.0 * FLUX, rtol=3e-3)


def test_a_header_that_states_another_flux_is_told(tmp_path: Path) -> None:
    assert only(scene_of(tmp_path, zemax_file(tmp_path, 4, stated=10.05))).notices == ()
    rays = only(scene_of(tmp_path, zemax_file(tmp_path, 4, stated=20.0)))
    (notice,) = rays.notices
    assert notice.startswith("led.dat: its header says 20 lm, and its rays have 10 lm")
    np.testing.assert_allclose(rays.flux, FLUX)


def test_ray_files_have_light_groups_and_pictures_say_that_they_leave_them_out(
    tmp_path: Path,
) -> None:
    table = rays_file(tmp_path) | {"source": "A"}
    other = table | {"name": "other", "group": "dies"}
    scene = scene_of(tmp_path, table, other)
    assert light_groups(scene) == ("background", "ball", "led", "dies")
    (notice,) = path_notices(scene)
    assert "2 of [[ray_files]]" in notice
    assert [rays.group for rays in scene.resolved_rays()] == ["led", "dies"]


def test_a_scene_lit_by_rays_alone_has_no_picture(tmp_path: Path) -> None:
    dark = [
        {
            "name": "b",
            "kind": "sphere",
            "centre_mm": [0, 0, 0],
            "radius_mm": 1.0,
            "material": "grey-18",
        }
    ]
    scene = scene_of(tmp_path, rays_file(tmp_path) | {"source": "A"}, objects=dark)
    with pytest.raises(LamplitError, match=r"\[\[ray_files\]\] belong to forward transport"):
        path_notices(scene)


def test_the_hash_of_a_scene_covers_its_rays(tmp_path: Path) -> None:
    table = rays_file(tmp_path) | {"source": "A"}
    before = scene_of(tmp_path, table).scene_hash
    assert scene_of(tmp_path, table).scene_hash == before
    with (tmp_path / "led.tm25ray").open("r+b") as stream:
        stream.seek(-1, 2)
        stream.write(b"\x41")
    assert scene_of(tmp_path, table).scene_hash != before


def test_what_cannot_be_used_is_named_by_its_key(tmp_path: Path) -> None:
    sound = rays_file(tmp_path)
    (tmp_path / "broken.dat").write_bytes(b"\0" * 300)
    (tmp_path / "dark.csv").write_text("380,0\n480,1\n600,0\n")
    for table, says in (
        (sound, r"ray_files\[0\].source: led.tm25ray says nothing of its spectrum"),
        (sound | {"file": "broken.dat"}, r"ray_files\[0\].file: broken.dat: byte 0: "),
        (sound | {"file": "absent.dat"}, r"ray_files\[0\].file: 'absent.dat' does not exist"),
        (sound | {"file": "../a.dat"}, r"ray_files\[0\].file: .* leads out"),
        (sound | {"source": "red-led-642"}, r"ray_files\[0\].source: no source is called"),
        (sound | {"source": "A", "flux_lm": 0.0}, r"ray_files\[0\].flux_lm: .* above 0|greater"),
        (sound | {"source": "A", "unit": "ft"}, r"ray_files\[0\].unit"),
        (sound | {"source": "A", "name": "a.b"}, r"ray_files\[0\].name: .* give a group"),
        (sound | {"sorce": "A"}, r"ray_files\[0\].sorce: unknown key"),
    ):
        with pytest.raises(LamplitError, match=says) as fault:
            scene_of(tmp_path, table).resolved_rays()
        assert "\n" not in str(fault.value)
    with pytest.raises(LamplitError, match=r"ray_files\[1\].name: ray_files\[0\] is called 'led'"):
        scene_of(tmp_path, sound, sound)


def test_a_check_finds_what_measuring_would(tmp_path: Path) -> None:
    report = check_scene(scene_of(tmp_path, rays_file(tmp_path)))
    assert [f.subject for f in report.findings if f.level == "error"] == ["ray_files[0].source"]
    far = rays_file(tmp_path) | {"source": "A", "transform": {"scale": 1e9}}
    report = check_scene(scene_of(tmp_path, far))
    assert [f.subject for f in report.findings if f.level == "error"] == ["ray_files[0].file"]
