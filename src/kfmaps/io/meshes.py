"""Read and write meshes and point clouds."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

from kfmaps._arrays import KfmapsWarning, check, printable, refuse
from kfmaps._texts import plural
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.connectivity import unique_vertices
from kfmaps.geometry.mesh import Mesh, check_is_mesh, check_mesh
from kfmaps.geometry.topology import topology
from kfmaps.io.atomic import write_bytes
from kfmaps.io.glb import format_glb
from kfmaps.io.gltf import parse_gltf
from kfmaps.io.obj import format_obj, parse_obj
from kfmaps.io.off import format_off, parse_off
from kfmaps.io.ply import format_ply, parse_ply
from kfmaps.io.record import MeshFile, check_colors
from kfmaps.io.stl import parse_stl
from kfmaps.io.text import as_table, check_suffix, clean_text, complete_or_refuse, parse_rows, read_bytes
from kfmaps.io.vtk import parse_vtk, parse_vtp


def _parse_xyz(data: bytes, name: str) -> MeshFile:
    """Read a point cloud: ``x y z`` a line; further columns (a normal, a colour) are left out."""
    rows = parse_rows(clean_text(data, name), name)
    columns = as_table(rows, (3, 4, 6, 7, 9, 10), name, "x y z, the same number of columns in every line")
    return MeshFile(Mesh(columns[:, :3], np.zeros((0, 3), dtype=np.int64)))


READERS = {
    ".off": parse_off,
    ".obj": parse_obj,
    ".ply": parse_ply,
    ".stl": parse_stl,
    ".vtk": parse_vtk,
    ".vtp": parse_vtp,
    ".glb": parse_gltf,
    ".gltf": parse_gltf,
    ".xyz": _parse_xyz,
}
_WRITERS = {".off": format_off, ".obj": format_obj, ".ply": format_ply, ".glb": format_glb}

_MAX_UNPLACED = 1e-3
"""Fraction of vertices that may have NaN coordinates; surfaces extracted from CT volumes have one now and then."""
_MAX_COORDINATE = 1e70  # larger coordinates overflow in areas; no unit makes them meaningful


def read_mesh(path: str | Path, *, cloud: bool = True) -> Mesh:
    """Read a mesh or point cloud.

    Formats are OFF (COFF, NOFF, STOFF), OBJ, PLY (text, binary), STL, polygonal data of VTK (``.vtk``, ``.vtp``), glTF,
    GLB, and ``.xyz`` for point clouds; the extension decides. Vertices keep their order and number and nothing
    is merged, except in STL, which has no shared vertices (see :func:`kfmaps.io.stl.parse_stl`). Polygons become fans
    of triangles.

    Parameters
    ----------
    path : str or Path
    cloud : bool
        Whether a file without faces is read as a point cloud; else it is refused.

    Returns
    -------
    Mesh
        In the unit of the file.

    Raises
    ------
    InvalidInput
        On a file that is missing, empty, cut short, of an unknown extension or not what its extension says; on NaN,
        infinite or absurdly large (beyond 1e70) coordinates; and as :func:`check_mesh`.

    Warns
    -----
    KfmapsWarning
        About vertices without a position (NaN), at most one in a thousand, which are put between their neighbours.
        About several components, boundaries, non-manifold edges, inconsistent orientation, duplicated or
        unreferenced vertices, and faces without area. All of them are kept.

    Examples
    --------
    >>> kfmaps.write_mesh("sphere.ply", kfmaps.datasets.sphere(500), force=True)
    >>> kfmaps.read_mesh("sphere.ply")
    Mesh(500 vertices, 996 faces)
    """
    return read_mesh_file(path, cloud=cloud).mesh


def read_shape_mesh(path: str | Path) -> Mesh:
    """Read a mesh, or a point cloud from ``.xyz``. Another file without faces is refused, since it lost them."""
    return read_mesh(path, cloud=Path(path).suffix.lower() == ".xyz")


def read_mesh_file(path: str | Path, *, cloud: bool = True) -> MeshFile:
    """Read ``path`` as :func:`read_mesh` does, with its colours, texture, morph targets and skin."""
    name, suffix = str(path), check_suffix(path, READERS, remedy="convert or rename the file")
    with np.errstate(all="ignore"), complete_or_refuse(name, f"a complete {suffix} file"):  # wild numbers: see below
        content = READERS[suffix](read_bytes(path), name)
    content = _place_unplaced(content, name)
    vertices, weights = content.mesh.vertices, None if content.skin is None else content.skin.weights
    arrays = {
        "vertices": vertices,
        "colors": content.colors,
        "texture": content.uv,
        "weights": weights,
        **content.morphs,
    }
    for what, values in arrays.items():
        if values is not None:
            check(values, f"{name}: {what}", remedy="repair or re-export the file")
    size = np.abs(vertices).max(initial=0.0)
    if size > _MAX_COORDINATE:
        raise refuse(f"{name}: vertices", f"coordinates up to {_MAX_COORDINATE:g}", f"{size:g}", "repair the file")
    check_mesh(content.mesh, name, cloud=cloud)
    _warn_of_oddities(content.mesh, name)
    return content


def _place_unplaced(content: MeshFile, name: str) -> MeshFile:
    """Put vertices with NaN coordinates at the mean of their neighbours, where these vertices are few."""
    vertices, faces = content.mesh.vertices, content.mesh.faces
    is_unplaced = np.asarray(np.isnan(vertices).any(axis=1))
    if not is_unplaced.any() or is_unplaced.mean() > _MAX_UNPLACED:
        return content
    vertices = vertices.copy()
    for v in np.flatnonzero(is_unplaced):
        neighbours = np.unique(faces[(faces == v).any(axis=1)])
        neighbours = neighbours[~is_unplaced[neighbours]]
        if len(neighbours) == 0:
            return content
        vertices[v] = content.mesh.vertices[neighbours].mean(axis=0)
    message = f"vertices without a position (NaN): {is_unplaced.sum()}; put between neighbours, the numbering stays"
    warnings.warn(f"{printable(name)}: {message}", KfmapsWarning, stacklevel=4)
    return replace(content, mesh=Mesh(vertices, faces))


def _warn_of_oddities(mesh: Mesh, name: str) -> None:
    """Warn once of everything unusual about the surface."""
    if len(mesh.faces) == 0:
        return
    counts = topology(mesh)
    cleaned, first = clean_mesh(mesh), unique_vertices(mesh.vertices)
    is_welded = (cleaned.to_clean == cleaned.to_clean[first]) & ~cleaned.unreferenced  # who welds them reports them
    n_duplicated = int(((first != np.arange(len(first))) & ~is_welded).sum())
    oddities = [
        (counts.components if counts.components > 1 else 0, "component", "components"),
        (counts.boundary_loops, "boundary loop", "boundary loops"),
        (counts.nonmanifold_edges, "non-manifold edge", "non-manifold edges"),
        (counts.nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices"),
        (counts.inconsistent_edges, "inconsistently oriented edge", "inconsistently oriented edges"),
        (n_duplicated, "duplicated vertex", "duplicated vertices"),
    ]
    message = ", ".join(plural(*oddity) for oddity in oddities if oddity[0])
    if message:
        warnings.warn(f"{printable(name)}: {message}. All is kept as it is.", KfmapsWarning, stacklevel=4)


def write_mesh(path: str | Path, mesh: Mesh, *, colors: np.ndarray | None = None, force: bool = False) -> None:
    """Write OFF (COFF with colours), OBJ, binary PLY or GLB, as the extension says; text keeps every digit.

    Parameters
    ----------
    path : str or Path
    mesh : Mesh
    colors : (n, 3) or (n, 4) array, optional
        Fractions from 0 to 1, or whole numbers from 0 to 255 (an integer dtype); alpha is left out.
    force : bool
        Whether an existing file may be replaced.

    Raises
    ------
    InvalidInput
        On an unknown extension, colours that do not fit, and as :func:`atomic_output`.

    Examples
    --------
    >>> kfmaps.write_mesh("torus.obj", kfmaps.datasets.torus(500))
    """
    check_is_mesh(mesh)
    writer = _WRITERS[check_suffix(path, _WRITERS, "output", "choose one of these")]
    fractions = None if colors is None else check_colors(colors, len(mesh.vertices))
    write_bytes(path, writer(MeshFile(mesh, fractions)), force)
