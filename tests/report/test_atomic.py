# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Results are whole or not there, and an unwritable place is refused before any work."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from lamplit.errors import OutputError
from lamplit.report.atomic import prepare_output, replacing, write_bytes, write_json


def test_a_written_file_has_its_content_and_leaves_nothing_beside_it(tmp_path: Path) -> None:
    write_bytes(tmp_path / "a.bin", b"new")
    assert (tmp_path / "a.bin").read_bytes() == b"new"
    assert [path.name for path in tmp_path.iterdir()] == ["a.bin"]


@pytest.mark.parametrize("call", ["open", "fsync", "close"])
@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO, errno.EROFS])
def test_a_failing_disk_leaves_the_old_file_intact(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str, code: int
) -> None:
    path = tmp_path / "picture.png"
    path.write_bytes(b"old")

    def fail(*_: object, **__: object) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(f"lamplit.atomic.os.{call}", fail)
    with pytest.raises(OutputError, match=os.strerror(code).lower()):
        write_bytes(path, b"new")
    monkeypatch.undo()
    assert path.read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["picture.png"]


@pytest.mark.parametrize("fault", [RuntimeError, KeyboardInterrupt])
def test_a_fault_while_writing_leaves_the_old_file_intact(
    tmp_path: Path, fault: type[BaseException]
) -> None:
    path = tmp_path / "picture.png"
    path.write_bytes(b"old")

    def write_half() -> None:
        with replacing(path) as partial:
            partial.write_bytes(b"half")
            raise fault

    with pytest.raises(fault):
        write_half()
    assert path.read_bytes() == b"old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["picture.png"]


def test_an_output_below_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="not a directory"):
        prepare_output(tmp_path / "file" / "out")


def test_an_output_that_takes_no_files_is_refused() -> None:
    with pytest.raises(OutputError, match="cannot be written"):
        prepare_output(Path("/proc/self"))


def test_a_directory_in_the_place_of_a_result_is_refused(tmp_path: Path) -> None:
    (tmp_path / "picture.png").mkdir()
    with pytest.raises(OutputError, match=r"picture\.png"):
        prepare_output(tmp_path, ["picture.png"])


def test_a_missing_output_directory_is_made_and_left_empty(tmp_path: Path) -> None:
    prepare_output(tmp_path / "deep" / "out", ["picture.png"])
    assert list((tmp_path / "deep" / "out").iterdir()) == []


def test_json_with_a_number_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="JSON"):
        write_json(tmp_path / "summary.json", {"mean": float("nan")})
    assert list(tmp_path.iterdir()) == []
