"""Read and write landmarks in the formats of 3D Slicer, MorphoJ, tpsDig, Landmark Editor, ShapeWorks, and tables."""

from __future__ import annotations

import csv
import io
import json
import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.io.atomic import csv_text, table_cell, write_text
from kfmaps.io.text import REPAIR, complete_or_refuse, is_number, read_text

LPS, RAS = "LPS", "RAS"
"""The two conventions of medical images: the patient's left, back and top, or right, front and top, are positive."""
SPACES = {"0": RAS, "1": LPS, RAS: RAS, LPS: LPS}
"""Names of the two in 3D Slicer's files."""
MISSING = ("", "na", "nan", "n/a", "#n/a", "null")
UNPLACED = 9999.0
"""Landmark Editor's coordinate of a point that was not placed."""
NAME_COLUMNS = ("name", "label", "landmark", "lm", "point", "id")
SPECIMEN_COLUMNS = ("specimen", "subject", "sample", "individual", "file", "scan")
SCHEMA = "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
FCSV_COLUMNS = "id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID"


_CURVE_TYPES = {"Curve": "curve", "ClosedCurve": "loop"}
"""3D Slicer's types of curves, and the prefix of their points' names."""
_CURVE_POINT = re.compile(r"(curve|loop)(.*)_(\d+)")


@dataclass(frozen=True)
class LandmarkCurve:
    """A curve among landmarks."""

    name: str
    rows: tuple[int, ...]  # its points, in order
    closed: bool  # whether the last point is next to the first


def find_curves(names: Sequence[str]) -> list[LandmarkCurve]:
    """Return the curves among landmarks: "curveNAME_1", "curveNAME_2", ..., or "loopNAME_1" of a closed curve."""
    points: dict[tuple[str, str], list[tuple[int, int]]] = {}
    for row, label in enumerate(names):
        match = _CURVE_POINT.fullmatch(label)
        if match is not None:
            points.setdefault((match[1], match[2]), []).append((int(match[3]), row))
    return [
        LandmarkCurve(name, tuple(row for _, row in sorted(members)), kind == "loop")
        for (kind, name), members in points.items()
    ]


def fixed_rows(names: Sequence[str]) -> list[int]:
    """Return the rows of the landmarks that belong to no curve."""
    return [row for row, label in enumerate(names) if _CURVE_POINT.fullmatch(label) is None]


@dataclass(frozen=True, eq=False)
class LandmarkSet:
    """The landmarks of one specimen in a file; :func:`find_curves` says how points of curves are named."""

    names: tuple[str, ...]
    points: np.ndarray  # (l, 3): NaN for a missing landmark. Points of a plane have a third coordinate of 0.
    specimen: str = ""  # empty where the file does not say
    space: str = ""  # "LPS", "RAS" or "": the file's coordinate system; empty where it does not say
    vertices: np.ndarray | None = None  # (l,): of a table that names vertices, from 0; the points are then NaN
    # A remark on each landmark, for formats that have room for one; or empty. A landmark with a remark is written as
    # not selected, so that 3D Slicer shows it in another colour.
    notes: tuple[str, ...] = ()


def read_landmark_sets(path: str | Path) -> list[LandmarkSet]:
    """Read landmarks of one or more specimens; the extension decides the format.

    ``.mrk.json`` and ``.fcsv`` (3D Slicer), ``.tps`` (tpsDig, MorphoJ, geomorph), ``.pts``
    (Landmark Editor), ``.particles`` (ShapeWorks), and ``.csv``: a row for each landmark ("name, x, y, z", "name,
    vertex", or columns with titles, among them a specimen) or for each specimen (columns ``x_NAME``, ``y_NAME``,
    ``z_NAME``, or ``NAME.X`` and so on).
    """
    read = landmark_format(path, "landmarks")[0]
    name = str(path)
    with complete_or_refuse(name, f"a complete {_suffix(path)} file"):
        sets = read(read_text(path), name)
    if not sets or not any(len(one.names) for one in sets):
        raise refuse(name, "landmarks", "none", "check that it is the right file")
    for one in sets:
        again = next((label for label, count in Counter(one.names).items() if count > 1), None)
        if again is not None:
            raise refuse(name, "each name once", f"{again!r} twice", "rename one")
        if np.isinf(one.points).any():
            raise refuse(name, "finite numbers", "infinite ones", REPAIR)
    return sets


def write_landmark_sets(path: str | Path, sets: Sequence[LandmarkSet], force: bool = False) -> None:
    """Write landmarks so that :func:`read_landmark_sets` reads them back; the extension decides the format."""
    _, write, many = landmark_format(path, "output")
    if len(sets) != 1 and not many:
        raise refuse(f"output {path}", "one specimen", str(len(sets)), "write .csv or .tps, or a file for each")
    write_text(path, write(sets), force)


def landmark_suffix(path: str | Path) -> str:
    """Return the extension of a landmark file with its dots, ``.mrk.json`` as one; empty for another file."""
    suffix = _suffix(path)
    return suffix if suffix in _FORMATS else ""


def landmark_stem(path: str | Path) -> str:
    """Return the name of a landmark file without folder and extension."""
    name = Path(path).name
    return name[: len(name) - len(_suffix(path))]


def mesh_space(path: str | Path) -> str:
    """Return the coordinate system that 3D Slicer wrote into the head of a mesh file: "LPS", "RAS", or "" for none."""
    try:
        with open(path, "rb") as file:
            head = file.read(4096)
    except (OSError, ValueError):
        return ""
    match = re.search(rb"SPACE\b.{1,24}?(LPS|RAS)\b", head, re.DOTALL)
    return "" if match is None else match[1].decode("ascii")


def _suffix(path: str | Path) -> str:
    name = Path(path).name.lower()
    return ".mrk.json" if name.endswith(".mrk.json") else Path(name).suffix


def landmark_format(path: str | Path, what: str) -> tuple[Callable, Callable, bool]:
    """Return reader and writer of a landmark file, and whether the format holds several specimens.

    ``what``: name of the file in messages.
    """
    format = _FORMATS.get(_suffix(path))
    if format is None:
        got = _suffix(path) or "no extension"
        raise refuse(f"{what} {path}", f"one of {' '.join(_FORMATS)}", got, "convert or rename the file")
    return format


def _points(rows: Sequence[Sequence[str]], name: str) -> np.ndarray:
    """Return rows of two or three cells as points (l, 3); NaN for missing ones."""
    points = np.full((len(rows), 3), np.nan)
    for i, row in enumerate(rows):
        if len(row) not in (2, 3):
            raise refuse(name, "two or three coordinates a point", f"{len(row)}", REPAIR)
        if all(cell.strip().lower() in MISSING for cell in row):
            continue
        bad = next((cell for cell in row if not is_number(cell.strip())), None)
        if bad is not None:
            raise refuse(name, "numbers after the name", repr(bad), REPAIR)
        points[i] = [*map(float, row), *[0.0] * (3 - len(row))]
    points[np.isnan(points).any(axis=1)] = np.nan
    return points


def _read_json(text: str, name: str) -> list[LandmarkSet]:
    """Read markups of 3D Slicer: https://github.com/Slicer/Slicer, ``markups-schema-v1.0.3.json``."""
    content = json.loads(text)
    names, points, spaces, curves = [], [], set(), 0
    for markup in content["markups"]:
        spaces.add(_space(markup.get("coordinateSystem", LPS), name))
        kind = _CURVE_TYPES.get(markup.get("type", ""))
        curves += kind is not None
        for i, one in enumerate(markup.get("controlPoints", []), 1):
            label = str(one.get("label") or len(names) + 1)
            names.append(f"{kind}{markup.get('name') or curves}_{i}" if kind else label)
            position = one.get("positionStatus", "defined") == "defined" and one.get("position")
            points.append([float(x) for x in one["position"]] if position else [np.nan] * 3)
    if len(spaces) > 1:
        raise refuse(name, "one coordinate system", "two", "save the lists in files of their own")
    array = np.array(points, dtype=np.float64).reshape(-1, 3)
    return [LandmarkSet(tuple(names), array, space=spaces.pop() if spaces else "")]


def _space(word: object, name: str) -> str:
    space = SPACES.get(str(word).strip().upper())
    if space is None:
        raise refuse(name, "the coordinate system LPS or RAS", repr(word), "save the points in one of them")
    return space


def _write_json(sets: Sequence[LandmarkSet]) -> str:
    one = sets[0]
    fixed, curves = fixed_rows(one.names), find_curves(one.names)
    lists = [({"type": "Fiducial"}, fixed)] if fixed or not curves else []
    for curve in curves:
        lists.append(({"type": "ClosedCurve" if curve.closed else "Curve", "name": curve.name}, list(curve.rows)))
    markups = []
    for head, rows in lists:
        markup = {
            **head,
            "coordinateSystem": one.space or LPS,
            "coordinateUnits": "mm",
            "locked": False,
            "fixedNumberOfControlPoints": False,
            "labelFormat": "%N-%d",
            "lastUsedControlPointNumber": len(rows),
            "controlPoints": [_control_point(one, row, i) for i, row in enumerate(rows, 1)],
        }
        markups.append(markup)
    return json.dumps({"@schema": f"{SCHEMA}markups-schema-v1.0.3.json#", "markups": markups}, indent=1) + "\n"


def _control_point(one: LandmarkSet, row: int, number: int) -> dict[str, object]:
    point = one.points[row].tolist()
    is_placed = not np.isnan(point).any()
    return {
        "id": str(number),
        "label": one.names[row],
        "description": _note(one, row),
        "associatedNodeID": "",
        **({"position": point} if is_placed else {}),
        "orientation": [-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0],
        "selected": not _note(one, row),
        "locked": False,
        "visibility": True,
        "positionStatus": "defined" if is_placed else "undefined",
    }


def _note(one: LandmarkSet, i: int) -> str:
    return one.notes[i] if one.notes else ""


def _read_fcsv(text: str, name: str) -> list[LandmarkSet]:
    """Read fiducials of 3D Slicer before 5: CSV below comments that name columns and coordinate system."""
    space, columns = RAS, [str(column) for column in FCSV_COLUMNS.split(",")]
    lines = text.splitlines()
    for line in lines:
        key, _, value = line.lstrip("# ").partition("=")
        if line.startswith("#") and key.strip() == "CoordinateSystem":
            space = _space(value, name)
        elif line.startswith("#") and key.strip() == "columns":
            columns = [column.strip() for column in value.split(",")]
    rows = list(csv.reader(line for line in lines if line.strip() and not line.startswith("#")))
    where = [columns.index(axis) for axis in ("x", "y", "z")]
    label = columns.index("label") if "label" in columns else 0
    names = tuple((row[label].strip() if len(row) > label else "") or str(i + 1) for i, row in enumerate(rows))
    return [LandmarkSet(names, _points([[row[i] for i in where] for row in rows], name), space=space)]


def _write_fcsv(sets: Sequence[LandmarkSet]) -> str:
    one, rows = sets[0], []
    for i, (label, point) in enumerate(zip(one.names, one.points.tolist(), strict=True)):
        if not np.isnan(point).any():
            note = _note(one, i)
            rows.append([i + 1, *map(repr, point), 0, 0, 0, 1, 1, int(not note), 0, label, note, ""])
    space = f"# CoordinateSystem = {one.space or LPS}\n"
    return f"# Markups fiducial file version = 4.11\n{space}# columns = {FCSV_COLUMNS}\n" + csv_text(rows)


def _read_tps(text: str, name: str) -> list[LandmarkSet]:
    """Read Rohlf's TPS: ``LM=`` or ``LM3=`` and the points, curves by ``POINTS=``, ``IMAGE=``, ``ID=``, ``SCALE=``."""
    lines = (line.strip() for line in text.splitlines() if line.strip())
    specimens: list[tuple[list[str], list[list[str]], dict[str, str]]] = []
    curves = 0
    for line in lines:
        key, equals, value = (part.strip() for part in line.partition("="))
        key = key.upper()
        if key in ("LM", "LM3"):
            specimens.append(([], [], {}))
            curves = 0
        if not equals or not specimens:
            raise refuse(name, "a keyword such as LM3= and its points", repr(line[:24]), REPAIR)
        labels, rows, keywords = specimens[-1]
        if key not in ("LM", "LM3", "POINTS", "POINTS3"):
            keywords[key] = value
            continue
        prefix = ""
        if key.startswith("POINTS"):
            curves += 1
            prefix = f"curve{curves}_"
        point_lines = list(islice(lines, int(value)))
        if len(point_lines) < int(value):
            raise refuse(name, f"{value} points after {key}=", f"{len(point_lines)}", REPAIR)
        rows += [point.split() for point in point_lines]
        labels += [f"{prefix}{i + 1}" for i in range(len(point_lines))]
    sets = []
    for labels, rows, keywords in specimens:
        image = Path(keywords.get("IMAGE", "").replace("\\", "/")).stem
        number = keywords.get("ID", "")
        specimen = image if image and (not number or number.isdecimal()) else number
        points = _points(rows, name) * float(keywords.get("SCALE", "1"))
        sets.append(LandmarkSet(tuple(labels), points, specimen or str(len(sets) + 1)))
    return sets


def _write_tps(sets: Sequence[LandmarkSet]) -> str:
    """Write landmarks and then curves; geomorph reads curves only as ``POINTS=``, in three dimensions too."""
    lines = []
    for one in sets:
        fixed, curves = fixed_rows(one.names), find_curves(one.names)
        parts = [(f"LM3={len(fixed)}", fixed), *((f"POINTS={len(curve.rows)}", curve.rows) for curve in curves)]
        for i, (head, rows) in enumerate(parts):
            lines += [f"CURVES={len(curves)}", head] if i == 1 else [head]
            points = one.points[list(rows)].tolist()
            lines += [" ".join(table_cell(x, ".9g") for x in point) for point in points]
        lines.append(f"ID={' '.join(one.specimen.split())}")
    return "\n".join(lines) + "\n"


def _read_pts(text: str, name: str) -> list[LandmarkSet]:
    """Read Landmark Editor's format (Wiley et al. 2005): "Version 1.0", the number of points, "name x y z" each."""
    lines = [line.split() for line in text.splitlines() if line.strip()]
    if not lines[0][0].lower().startswith("version"):
        raise refuse(
            name, "the first line Version 1.0", repr(" ".join(lines[0])[:24]), "check that it is the right file"
        )
    count, rows = int(lines[1][0]), lines[2:]
    if len(rows) != count:
        raise refuse(name, f"{count} points", f"{len(rows)}", REPAIR)
    points = _points([row[-3:] for row in rows], name)
    points[(points == UNPLACED).all(axis=1)] = np.nan
    names = tuple(" ".join(row[:-3]) or str(i + 1) for i, row in enumerate(rows))
    return [LandmarkSet(names, points)]


def _write_pts(sets: Sequence[LandmarkSet]) -> str:
    one = sets[0]
    rows = np.where(np.isnan(one.points), UNPLACED, one.points).tolist()
    names = ["_".join(label.split()) for label in one.names]
    points = [" ".join([label, *(f"{x:.9g}" for x in row)]) for label, row in zip(names, rows, strict=True)]
    return "\n".join(["Version 1.0", str(len(names)), *points]) + "\n"


def _read_particles(text: str, name: str) -> list[LandmarkSet]:
    """Read ShapeWorks' format: a point "x y z" a line."""
    rows = [line.split() for line in text.splitlines() if line.strip()]
    return [LandmarkSet(tuple(str(i + 1) for i in range(len(rows))), _points(rows, name))]


def _write_particles(sets: Sequence[LandmarkSet]) -> str:
    return "".join(" ".join(f"{x:.17g}" for x in row) + "\n" for row in sets[0].points.tolist())


def _read_csv(text: str, name: str) -> list[LandmarkSet]:
    """Read a table with a row for each landmark, or with a row for each specimen."""
    first_line = text.partition("\n")[0]
    mark = max(",;\t", key=first_line.count)
    try:
        table = csv.reader(io.StringIO(text, newline=""), delimiter=mark, strict=True)
        rows = [[cell.strip() for cell in row] for row in table]
    except csv.Error as error:
        raise refuse(name, "comma-separated values", str(error), REPAIR) from error
    rows = [row for row in rows if any(row)]
    if not rows:
        return []
    titles = [cell.lower() for cell in rows[0]]
    if all(axis in titles for axis in "xyz") or "vertex" in titles:
        return _long(titles, rows[1:], name)
    triples = _triples(rows[0])
    if triples:
        return _wide(titles, triples, rows[1:], name)
    if not is_number(rows[0][-1]) and rows[0][-1].lower() not in MISSING:
        rows = rows[1:]  # titles without a known name
    widths = sorted({len(row) for row in rows})
    if len(widths) != 1 or widths[0] > 4:
        got = f"rows of {', '.join(map(str, widths))} cells" if widths else "none"
        expected = 'rows "name, vertex" or "name, x, y, z", or titles such as specimen, name, x, y, z'
        raise refuse(name, expected, got, REPAIR)
    kind = {1: ["vertex"], 2: ["name", "vertex"], 3: ["x", "y", "z"], 4: ["name", "x", "y", "z"]}[widths[0]]
    return _long(kind, rows, name)


def _long(titles: list[str], rows: list[list[str]], name: str) -> list[LandmarkSet]:
    """Return the sets of a table with a row for each landmark, or each landmark and specimen."""
    bad = next((row for row in rows if len(row) != len(titles)), None)
    if bad is not None:
        raise refuse(name, f"{len(titles)} cells a row", f"{len(bad)}", REPAIR)
    name_column = next((titles.index(one) for one in NAME_COLUMNS if one in titles), None)
    specimen_column = next((titles.index(one) for one in SPECIMEN_COLUMNS if one in titles), None)
    has_points = all(axis in titles for axis in "xyz")
    columns = [titles.index(axis) for axis in "xyz"] if has_points else [titles.index("vertex")]
    groups: dict[str, list[list[str]]] = {}
    for row in rows:
        groups.setdefault("" if specimen_column is None else row[specimen_column], []).append(row)
    sets = []
    for specimen, group in groups.items():
        names = tuple(str(i) if name_column is None else row[name_column] for i, row in enumerate(group, 1))
        cells = [[row[i] for i in columns] for row in group]
        if has_points:
            sets.append(LandmarkSet(names, _points(cells, name), specimen))
            continue
        wrong = next((row[0] for row in cells if not re.fullmatch(r"[+-]?\d+(\.0*)?", row[0])), None)
        if wrong is not None:
            raise refuse(name, "whole numbers of vertices after the name", repr(wrong), REPAIR)
        vertices = np.array([int(float(row[0])) for row in cells], dtype=np.int64)
        sets.append(LandmarkSet(names, np.full((len(group), 3), np.nan), specimen, vertices=vertices))
    return sets


def _triples(titles: Sequence[str]) -> dict[str, list[int]]:
    """Return the columns of x, y and z of each landmark, for a table with a row for each specimen."""
    columns: dict[str, dict[str, int]] = {}
    for i, title in enumerate(titles):
        match = re.fullmatch(r"([xyzXYZ])[._ -]?(.+)|(.+?)[._ -]?([xyzXYZ])", title)
        if match is not None:
            label, axis = (match[2], match[1]) if match[1] else (match[3], match[4])
            columns.setdefault(label, {})[axis.lower()] = i
    return {label: [axes[a] for a in "xyz"] for label, axes in columns.items() if len(axes) == 3}


def _wide(titles: list[str], triples: dict[str, list[int]], rows: list[list[str]], name: str) -> list[LandmarkSet]:
    owner = next((titles.index(one) for one in (*SPECIMEN_COLUMNS, "id", "name", "") if one in titles), None)
    sets = []
    for number, row in enumerate(rows, 1):
        if len(row) != len(titles):
            raise refuse(f"{name}, row {number + 1}", f"{len(titles)} cells", f"{len(row)}", REPAIR)
        points = _points([[row[i] for i in columns] for columns in triples.values()], name)
        sets.append(LandmarkSet(tuple(triples), points, str(number) if owner is None else row[owner]))
    return sets


def _write_csv(sets: Sequence[LandmarkSet]) -> str:
    rows = [["specimen", "name", "x", "y", "z"]]
    for one in sets:
        for label, point in zip(one.names, one.points.tolist(), strict=True):
            rows.append([one.specimen, label, *map(table_cell, point)])
    return csv_text(rows)


def wide_rows(sets: Sequence[LandmarkSet]) -> list[list[str]]:
    """Return a table with a row for each specimen and columns ``x_NAME``, ``y_NAME``, ``z_NAME``; titles first.

    R reads the titles without changing them; a missing point is NA.
    """
    labels = [re.sub(r"[^A-Za-z0-9_.]", ".", label) for label in sets[0].names]
    rows = [["specimen", *(f"{axis}_{label}" for label in labels for axis in "xyz")]]
    for one in sets:
        if one.names != sets[0].names:
            raise refuse(
                f"specimen {one.specimen}", "the same landmarks in all of them", "others", "write a long table"
            )
        rows.append([one.specimen, *map(table_cell, one.points.ravel())])
    return rows


_FORMATS: dict[str, tuple[Callable, Callable, bool]] = {
    ".mrk.json": (_read_json, _write_json, False),
    ".json": (_read_json, _write_json, False),
    ".fcsv": (_read_fcsv, _write_fcsv, False),
    ".tps": (_read_tps, _write_tps, True),
    ".pts": (_read_pts, _write_pts, False),
    ".particles": (_read_particles, _write_particles, False),
    ".csv": (_read_csv, _write_csv, True),
}
"""By extension: reader, writer, and whether a file holds several specimens."""
