"""Point clouds as text: a point a line."""

from __future__ import annotations

import numpy as np

from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile
from kfmaps.io.text import clean_text, parse_rows, table


def parse_xyz(data: bytes, name: str) -> MeshFile:
    """Read ``x y z`` a line; further columns (a normal, a colour) are the same for all lines and left out.

    Raises
    ------
    InvalidInput
        On words that are no numbers and on lines of different lengths.
    """
    rows = parse_rows(clean_text(data, name), name)
    columns = table(rows, (3, 4, 6, 7, 9, 10), name, "x y z, the same number of columns in every line")
    return MeshFile(Mesh(columns[:, :3], np.zeros((0, 3), dtype=np.int64)))
