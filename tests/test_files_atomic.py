"""Output is there whole or not at all."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from kfmaps._arrays import InvalidInput
from kfmaps.io import atomic_output, check_output


def test_written_under_another_name_then_renamed(tmp_path: Path) -> None:
    path = tmp_path / "a.tar.npz"
    with atomic_output(path) as temporary:
        temporary.write_text("new")
        assert not path.exists()
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".npz"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit])
@pytest.mark.parametrize("old", [None, "old"])
def test_failure_leaves_everything_as_it_was(tmp_path: Path, error: type[BaseException], old: str | None) -> None:
    path = tmp_path / "a.txt"
    if old:
        path.write_text(old)

    def interrupted() -> None:
        with atomic_output(path, force=True) as temporary:
            temporary.write_text("half")
            raise error

    with pytest.raises(error):
        interrupted()
    assert [p.read_text() for p in tmp_path.iterdir()] == ([old] if old else [])


def test_an_existing_file_needs_force(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")
    path.chmod(0o640)
    with pytest.raises(InvalidInput, match="--force"), atomic_output(path):
        raise AssertionError("the block must not be entered")
    with pytest.raises(InvalidInput, match="--force"):
        check_output(path)
    with atomic_output(path, force=True) as temporary:
        temporary.write_text("new")
    assert path.read_text() == "new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_file_made_meanwhile_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"

    def raced() -> None:
        with atomic_output(path) as temporary:
            temporary.write_text("mine")
            path.write_text("theirs")

    with pytest.raises(InvalidInput, match="--force"):
        raced()
    assert path.read_text() == "theirs"
    assert list(tmp_path.iterdir()) == [path]


def test_permissions_follow_the_umask(tmp_path: Path) -> None:
    old = os.umask(0o027)
    try:
        with atomic_output(tmp_path / "a.txt") as temporary:
            temporary.write_text("new")
    finally:
        os.umask(old)
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == 0o640


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to("real.txt")
    with atomic_output(tmp_path / "link.txt", force=True) as temporary:
        temporary.write_text("new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "real.txt").read_text() == "new"


@pytest.mark.parametrize(
    ("name", "output"),
    [
        ("none/a.txt", "existing folder"),
        ("", "a folder"),
        ("/dev/null", "a device"),
        ("/dev/stdout", "a device"),
        ("/proc/self/fd/1", "a device"),
        ("a" * 300 + ".txt", "too long"),
        ("a\0.txt", "null"),
    ],
)
def test_places_that_cannot_be_written(tmp_path: Path, name: str, output: str) -> None:
    with pytest.raises(InvalidInput, match=output), atomic_output(tmp_path / name, force=True) as temporary:
        temporary.write_text("x")
    assert not list(tmp_path.iterdir())
    assert Path("/dev/null").is_char_device()


def test_a_folder_without_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(*_: object) -> int:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", denied)
    with pytest.raises(PermissionError, match=r"Permission denied.*a\.txt"), atomic_output(tmp_path / "a.txt"):
        raise AssertionError("the block must not be entered")
