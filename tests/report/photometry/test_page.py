# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The HTML report: verdict first, all in one file, nothing from a network, nothing injected."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
from PIL import Image as Raster

from lamplit.errors import LamplitError
from lamplit.report.photometry.page import pictures_in, read_picture, render_page
from lamplit.report.photometry.results import FunctionResults, Results
from lamplit.rules.verdict import Finding, Verdict

HOSTILE = "<script>alert('x')</script> & \"quoted\" ' onload=x"


class Reader(HTMLParser):
    """Collects tags, what they refer to, and the text that is seen."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.sources: list[str] = []
        self.attributes: set[str] = set()
        self.text = ""
        self._silent = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self._silent = tag in ("style", "title")
        for name, value in attrs:
            self.attributes.add(name)
            if name in ("src", "href", "srcset", "data", "action"):
                self.sources.append(value or "")

    def handle_endtag(self, tag: str) -> None:  # noqa: ARG002
        self._silent = False

    def handle_data(self, data: str) -> None:
        if not self._silent:
            self.text += data


def read(page: str) -> Reader:
    reader = Reader()
    reader.feed(page)
    reader.close()
    return reader


def test_the_verdicts_stand_before_everything_else(make_results: Callable[..., Results]) -> None:
    text = read(render_page(make_results())).text
    first = text.index("? undecided")
    assert first < text.index("✓ pass") < text.index("Every requirement on stop")
    head = text[: text.index("A function is as good as")]
    assert "stop: Stop lamp, category S1 (UN R148)" in head
    assert "6.09 cd ± 0.48, required ≥ 6 cd, margin +1.5 %" in head
    assert "30 × as many paths would decide it" in head


def test_it_loads_nothing_and_runs_nothing(make_results: Callable[..., Results]) -> None:
    page = render_page(make_results())
    reader = read(page)
    assert not {"script", "link", "iframe", "object", "embed", "base", "form"} & set(reader.tags)
    assert reader.sources
    assert all(source.startswith("data:image/png;base64,") for source in reader.sources)
    bare = re.sub(r"base64,[A-Za-z0-9+/=]+", "", page)
    assert not re.search(r"https?:|//[a-z]|url\(|@import", bare)
    assert "default-src 'none'" in page


def test_hostile_names_are_text(
    make_results: Callable[..., Results], make_finding: Callable[..., Finding]
) -> None:
    usual = make_results()
    seen = replace(usual.functions[0].observed, name=HOSTILE)
    found = make_finding(
        1.0, 0.0, 2.0, requirement=HOSTILE, clause=HOSTILE, trust=HOSTILE, unit=HOSTILE,
        remark=HOSTILE,
    )  # fmt: skip
    verdict = Verdict(rule=HOSTILE, title=HOSTILE, function=HOSTILE, findings=(found,))
    hostile = replace(
        usual, scene=HOSTILE, command=HOSTILE, scene_hash=HOSTILE, notices=(HOSTILE,),
        geometry={HOSTILE: HOSTILE}, functions=(FunctionResults(seen, verdict),),
    )  # fmt: skip
    reader = read(render_page(hostile))
    assert "script" not in reader.tags
    assert "onload" not in reader.attributes
    assert reader.text.count("<script>alert('x')</script>") > 8


def test_each_requirement_stands_in_the_table_with_its_clause_and_trust(
    make_results: Callable[..., Results],
) -> None:
    text = read(render_page(make_results())).text
    assert text.count("UN R148, table 3; figure A3-I [V2]") == 2 * 20
    assert "in a transcription that cites the original, not in the official text" in text
    assert "read in the cited text" in text


def test_a_function_without_a_rule_is_shown_and_not_judged(
    make_results: Callable[..., Results],
) -> None:
    usual = make_results()
    bare = FunctionResults(usual.functions[0].observed)
    text = read(render_page(replace(usual, functions=(bare,), energy=None, spectra=()))).text
    assert "stop: no rule is named for it, so nothing is judged" in text
    assert "pass: inside the limit" in text
    assert "Where the lumens go" not in text


def test_a_stopped_measurement_says_so(make_results: Callable[..., Results]) -> None:
    text = read(render_page(make_results(complete=False))).text
    assert "Stopped before all was done." in text


def test_energy_stands_as_numbers_too(make_results: Callable[..., Results]) -> None:
    text = " ".join(read(render_page(make_results())).text.split())
    assert "lens168.236.6" in text.replace(" ", "")
    assert "not accounted for" in text


def test_pictures_beside_a_measurement_are_shown(
    tmp_path: Path, make_results: Callable[..., Results]
) -> None:
    (tmp_path / "mix").mkdir()
    for name in ("picture.png", "mix/picture.png"):
        Raster.new("RGB", (2000, 1000), "red").save(tmp_path / name)
    pictures = pictures_in(tmp_path)
    assert [one.caption for one in pictures] == ["as rendered", "as mixed"]
    page = render_page(make_results(), pictures)
    assert "the lamp, as rendered" in page
    assert Raster.open(io.BytesIO(pictures[0].content)).size == (1400, 700)


def test_what_is_no_picture_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "picture.png"
    path.write_bytes(b"<svg onload='x'/>")
    with pytest.raises(LamplitError, match="no PNG or JPEG"):
        read_picture(path)
    with pytest.raises(LamplitError, match="cannot be shown"):
        read_picture(tmp_path / "gone.png")
