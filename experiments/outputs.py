"""What an experiment leaves behind: a table, pictures and its conclusions."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from data_sets import Collection
from kfmaps._arrays import refuse
from kfmaps.io import atomic_output
from kfmaps.viz import save_figure


@dataclass(frozen=True)
class Outcome:
    """Files that an experiment wrote, and its conclusions as the lines of ``conclusions``."""

    name: str
    tables: tuple[Path, ...]
    pictures: tuple[Path, ...]
    conclusions: Path
    lines: tuple[str, ...]


def output_folder(path: Path) -> Path:
    """``path``, made when it is missing.

    Raises
    ------
    InvalidInput
        When it exists and is no folder.
    """
    if path.exists() and not path.is_dir():
        raise refuse(f"output {path}", "a folder", "a file", "name a folder")
    path.mkdir(parents=True, exist_ok=True)
    return path


def write_table(path: Path, rows: Sequence[Mapping[str, Any]]) -> Path:
    """A CSV file with a header; floats to six significant digits, all rows with the same columns."""
    columns = list(rows[0])
    with atomic_output(path, force=True) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        for row in rows:
            writer.writerow({name: plain(value) for name, value in row.items()})
    return path


def plain(value: Any) -> Any:
    """A table's cell."""
    return f"{value:.6g}" if isinstance(value, float) else value


def write_pictures(folder: Path, name: str, figure: Figure) -> tuple[Path, ...]:
    """``figure`` as PNG and PDF."""
    paths = tuple(folder / f"{name}.{kind}" for kind in ("png", "pdf"))
    for path in paths:
        with atomic_output(path, force=True) as temporary:
            save_figure(figure, temporary)
    return paths


def write_conclusions(folder: Path, name: str, collections: Sequence[Collection], lines: Sequence[str]) -> Path:
    """A Markdown list of what the numbers say, headed by what they were measured on."""
    path = folder / f"{name}.md"
    generated = any(c.folder is None for c in collections)
    used = ", ".join(c.name for c in collections)
    where = "the package's own generated shapes (no data was given)" if generated else used
    text = "\n".join([f"# {name}", "", f"Measured on {where}.", "", *(f"* {line}" for line in lines), ""])
    with atomic_output(path, force=True) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return path
