# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Measured spectra from CSV and IES TM-27 files, sound and broken."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from lamplit import spectrum_files
from lamplit.errors import SpectrumError
from lamplit.spectrum import SpectralDistribution
from lamplit.spectrum_files import read_csv, read_spdx

ROWS = ((380.0, 0.1), (385.0, 0.25), (390.0, 0.5))


def _csv(folder: Path, text: str | bytes) -> Path:
    path = folder / "measured.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def _spdx(folder: Path, text: str | bytes) -> Path:
    path = folder / "measured.spdx"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def _tm27(points: str, head: str = '<?xml version="1.0" encoding="UTF-8"?>\n') -> str:
    return (
        f'{head}<IESTM2714 xmlns="iestm2714" version="1.0">\n'
        "<Header><Description>LED</Description></Header>\n"
        f"<SpectralDistribution>\n{points}</SpectralDistribution></IESTM2714>\n"
    )


def _point(nm: object, value: object) -> str:
    return f'<SpectralData wavelength="{nm}">{value}</SpectralData>\n'


@pytest.mark.parametrize(
    "text",
    [
        "380,0.1\n385,0.25\n390,0.5\n",
        "wavelength_nm,transmittance\n380,0.1\n385,0.25\n390,0.5",
        "# a comment\n\n380 0.1 # dark\n385\t0.25\n390   5e-1\n",
        "380;0,1\n385;0,25\n390;0,5\n",
        "380,0\t0,1\n385,0\t0,25\n390,0\t0,5\n",
        "380, 0.1\r\n385, 0.25\r\n390, 0.5\r\n",
        '"nm","T"\n"380","0.1"\n"385","0.25"\n"390","0.5"\n',
        "\ufeff380,0.1\n385,0.25\n390,0.5\n",
        "+380.0 , .1\n385. , 2.5E-1\n390,0.50\n",
    ],
)
def test_two_columns_are_read_however_they_part(text: str, tmp_path: Path) -> None:
    table = read_csv(_csv(tmp_path, text))
    assert tuple(zip(table.wavelengths_nm, table.values, strict=True)) == ROWS


@pytest.mark.parametrize(
    ("text", "where", "message"),
    [
        ("380,0.1\n385,abc\n", "line 2", "'abc' is not a number"),
        ("380,0.1\n385,0.2,0.3\n", "line 2", "two columns .* here are 3"),
        ("380,0.1\n\n# x\n385\n", "line 4", "two columns .* here are 1"),
        ("380,0.1\n385,nan\n", "line 2", "'nan' is not a finite number"),
        ("nan,0.1\n385,0.2\n", "line 1", "'nan' is not a finite number"),
        ("380,0.1\n385,inf\n", "line 2", "not a finite"),
        ("380,0.1\n385,1e999\n", "line 2", "not a finite"),
        ("380,0.1\n390,0.2\n385,0.3\n", "line 3", "385 nm follows 390 nm; sort"),
        ("380,0.1\n380,0.2\n", "line 2", "380 nm follows 380 nm"),
        ("nm,T\nWellenlänge,T\n380,0.1\n", "line 2", "is not a number"),
        ("380,0.1\n385,\n", "line 2", "'' is not a number"),
    ],
)
def test_a_broken_row_is_named_by_file_and_line(
    text: str, where: str, message: str, tmp_path: Path
) -> None:
    path = _csv(tmp_path, text)
    with pytest.raises(SpectrumError, match=message) as caught:
        read_csv(path)
    assert str(caught.value).startswith(f"{path}: {where}: ")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "here are 0"),
        ("nm,T\n", "here are 0"),
        ("# nothing\n380,0.1\n", "here are 1"),
        (b"\xff\xfe3\x008\x000\x00", "no UTF-8"),
        (b"\x00" * 100, "here are 0|not a number|two columns"),
    ],
)
def test_a_file_without_a_table_is_refused(text: str | bytes, message: str, tmp_path: Path) -> None:
    with pytest.raises(SpectrumError, match=message):
        read_csv(_csv(tmp_path, text))


def test_a_hole_is_refused_unless_interpolation_is_stated(tmp_path: Path) -> None:
    path = _csv(tmp_path, "380,0\n385,0\n390,0\n395,0\n500,1\n505,1\n")
    with pytest.raises(SpectrumError, match="nothing is given between 395 and 500 nm"):
        SpectralDistribution.from_csv(path)
    accepted = SpectralDistribution.from_csv(path, interpolation="linear")
    assert accepted(447.5) == pytest.approx(0.5)


def test_micrometres_are_noticed(tmp_path: Path) -> None:
    with pytest.raises(SpectrumError, match="micrometres"):
        SpectralDistribution.from_csv(_csv(tmp_path, "0.38,0.1\n0.39,0.2\n"))


def test_a_file_too_large_for_a_spectrum_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(spectrum_files, "MAX_BYTES", 20)
    with pytest.raises(SpectrumError, match="too large for a spectrum"):
        read_csv(_csv(tmp_path, "380,0.1\n385,0.2\n390,0.3\n"))


def test_a_missing_file_and_a_folder_are_clear_errors(tmp_path: Path) -> None:
    for path in (tmp_path / "absent.csv", tmp_path):
        for read in (read_csv, read_spdx):
            with pytest.raises(SpectrumError, match="cannot be read"):
                read(path)


def test_a_tm27_file_reads_as_colour_science_reads_it(tmp_path: Path) -> None:
    import colour

    nm = np.arange(380.0, 781.0, 5.0)
    spd = colour.SpectralDistribution_IESTM2714(
        str(tmp_path / "led.spdx"), data=np.exp(-(((nm - 624) / 20) ** 2)), domain=nm
    )
    spd.header.description = "LED"
    spd.spectral_quantity = "flux"
    assert spd.write()
    back = colour.SpectralDistribution_IESTM2714(str(tmp_path / "led.spdx"))
    table = read_spdx(tmp_path / "led.spdx")
    np.testing.assert_array_equal(table.wavelengths_nm, back.wavelengths)
    np.testing.assert_array_equal(table.values, back.values)
    ours = SpectralDistribution.from_spdx(tmp_path / "led.spdx")
    np.testing.assert_allclose(ours(nm), back.values)


def test_tm27_points_may_come_in_any_order(tmp_path: Path) -> None:
    text = _tm27(_point(390, 0.5) + _point(380, 0.1) + _point(385, 0.25))
    table = read_spdx(_spdx(tmp_path, text))
    assert tuple(zip(table.wavelengths_nm, table.values, strict=True)) == ROWS


def test_a_tm27_point_given_twice_is_refused(tmp_path: Path) -> None:
    text = _tm27(_point(380, 0.1) + _point(380, 0.2))
    with pytest.raises(SpectrumError, match="380 nm follows 380 nm"):
        SpectralDistribution.from_spdx(_spdx(tmp_path, text))


_LAUGHS = "".join(f'<!ENTITY l{i} "{f"&l{i - 1};" * 10}">\n' for i in range(1, 12))
_POINTS = _point(380, 0.1) + _point(385, 0.2)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            _tm27(_POINTS, '<!DOCTYPE x [<!ENTITY l0 "ha">\n' + _LAUGHS + "]>\n"),
            "line 1.*document type",
        ),
        (_tm27(_POINTS, '<!DOCTYPE x SYSTEM "file:///etc/passwd">\n'), "document type"),
        (_tm27(_POINTS, '<!DOCTYPE x [<!ENTITY % p SYSTEM "http://a.b/">%p;]>\n'), "document type"),
        (
            (
                '<?xml version="1.0" encoding="UTF-16"?>'
                + _tm27(_POINTS, '<!DOCTYPE x [<!ENTITY a "b">]>')
            ).encode("utf-16"),
            "document type",
        ),
        (_tm27(_point(380, "&xxe;") + _point(385, 0.2)), "XML is broken: undefined entity"),
        (
            _tm27(_point(380, 0.1) + _point("abc", 0.2)),
            "line 6: SpectralData: 'abc' is not a number",
        ),
        (_tm27(_point(380, 0.1) + "<SpectralData>0.2</SpectralData>"), "'' is not a number"),
        (_tm27(_point(380, 0.1) + _point(385, "nan")), "line 6: .*not a finite"),
        (_tm27(_point(380, 0.1)), "no IES TM-27"),
        (_tm27(""), "no IES TM-27"),
        ("<svg>" + _POINTS + "</svg>", "no IES TM-27"),
        (_tm27(_POINTS)[:-30], "XML is broken"),
        ("", "XML is broken"),
        (b"\x00\xff" * 50, "XML is broken"),
    ],
)
def test_a_hostile_or_broken_tm27_file_is_refused_at_once(
    content: str | bytes, message: str, tmp_path: Path
) -> None:
    path = _spdx(tmp_path, content)
    start = time.perf_counter()
    with pytest.raises(SpectrumError, match=message) as caught:
        read_spdx(path)
    assert time.perf_counter() - start < 1.0
    assert str(caught.value).startswith(str(path))


def test_xml_a_hundred_thousand_deep_does_no_harm(tmp_path: Path) -> None:
    deep = "<a>" * 100_000 + "</a>" * 100_000
    with pytest.raises(SpectrumError, match="no IES TM-27"):
        read_spdx(_spdx(tmp_path, deep))


def test_no_random_bytes_do_worse_than_a_clear_error(tmp_path: Path) -> None:
    random = np.random.default_rng(21)
    sound = _tm27(_POINTS).encode(), b"380,0.1\n385,0.2\n390,0.3\n"
    for content, read in zip(sound, (read_spdx, read_csv), strict=True):
        for _ in range(300):
            damaged = bytearray(content)
            for at in random.integers(0, len(content), 3):
                damaged[at] = int(random.integers(0, 256))
            try:
                read(_csv(tmp_path, bytes(damaged)))
            except SpectrumError:
                continue
