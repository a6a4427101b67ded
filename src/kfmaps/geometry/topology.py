"""What kind of surface a mesh is, and what is wrong with it: counts from its faces alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps.geometry.connectivity import component_labels, half_edges_by_edge, proper_faces, unique_vertices
from kfmaps.geometry.mesh import Mesh, face_areas
from kfmaps.geometry.weld import weld_vertices


@dataclass(frozen=True)
class Topology:
    """Counts that describe a triangle mesh. Faces that name a vertex twice enter only ``degenerate_faces``.

    Open edges that lie along each other count as connected (:func:`kfmaps.geometry.weld.weld_vertices`): a mesh cut
    along seams, or into single triangles, is the surface that it looks like.
    """

    components: int  # connected pieces of surface, joined where they share a vertex
    # Edges of one face only, and the closed curves that they form. Where edges are non-manifold, an open chain between
    # two of them counts as a loop.
    boundary_edges: int
    boundary_loops: int
    euler_characteristic: int  # vertices - edges + faces; vertices that no face uses do not count
    is_orientable: bool  # whether all faces can be turned to agree with their neighbours
    # Handles, summed over the components, each boundary loop filled by a disc: ``(2 components - loops -
    # euler_characteristic) / 2``. None unless the surface is an orientable manifold.
    genus: int | None
    nonmanifold_edges: int  # edges of three faces or more
    nonmanifold_vertices: int  # vertices whose faces form several fans instead of one
    inconsistent_edges: int  # edges along which two neighbours are oriented against each other
    degenerate_faces: int  # faces that name a vertex twice or have no area (1e-14 of the largest, or less)
    unreferenced_vertices: int  # vertices that no face uses
    duplicated_vertices: int  # vertices in exactly the place of an earlier one

    @property
    def is_closed(self) -> bool:
        """Whether every edge has exactly two faces."""
        return self.boundary_edges == 0 and self.nonmanifold_edges == 0

    @property
    def is_manifold(self) -> bool:
        """Whether every vertex has one fan of faces around it, closed or open."""
        return self.nonmanifold_edges == 0 and self.nonmanifold_vertices == 0


def topology(mesh: Mesh) -> Topology:
    """Count components, boundaries, handles and defects of ``mesh``.

    ``mesh``: its face numbers within range (see :func:`kfmaps.geometry.mesh.check_mesh`). A point cloud has no
    components.
    """
    n = len(mesh.vertices)
    corners = weld_vertices(mesh)[mesh.faces]
    repeated = ~proper_faces(corners)
    areas = face_areas(mesh)
    flat = areas <= 1e-14 * areas.max(initial=0.0)
    faces = corners[~repeated]
    f = len(faces)

    # A half-edge has the same number as its tail's corner.
    tail = faces.ravel()
    following = np.arange(3 * f).reshape(f, 3)[:, [1, 2, 0]].ravel()
    head = tail[following]
    rim, (one, two), sharing = half_edges_by_edge(faces, n)
    against = tail[one] == tail[two]

    used = np.flatnonzero(np.bincount(tail, minlength=n))
    _, label = component_labels(n, tail, head)
    components = len(np.unique(label[used]))

    # Corners that meet across an edge belong to one fan around their vertex.
    fans, fan = component_labels(
        3 * f,
        np.concatenate([one, following[one]]),
        np.concatenate([np.where(against, two, following[two]), np.where(against, following[two], two)]),
    )
    centre = np.zeros(fans, dtype=np.int64)
    centre[fan] = tail
    nonmanifold_vertices = int((np.bincount(centre, minlength=n) > 1).sum())
    # A boundary edge leads from one open fan to the next.
    _, loop = component_labels(fans, fan[rim], fan[following[rim]])
    loops = len(np.unique(loop[fan[rim]]))

    orientable = _is_orientable(f, one // 3, two // 3, against)
    characteristic = len(used) - len(sharing) + f
    nonmanifold_edges = int((sharing > 2).sum())
    manifold = f > 0 and nonmanifold_edges == 0 and nonmanifold_vertices == 0
    return Topology(
        components=components,
        boundary_edges=len(rim),
        boundary_loops=loops,
        euler_characteristic=characteristic,
        is_orientable=orientable,
        genus=(2 * components - loops - characteristic) // 2 if manifold and orientable else None,
        nonmanifold_edges=nonmanifold_edges,
        nonmanifold_vertices=nonmanifold_vertices,
        inconsistent_edges=int(against.sum()),
        degenerate_faces=int((repeated | flat).sum()),
        unreferenced_vertices=int((np.bincount(mesh.faces.ravel(), minlength=n) == 0).sum()),
        duplicated_vertices=int((unique_vertices(mesh.vertices) != np.arange(n)).sum()),
    )


def _is_orientable(f: int, one: np.ndarray, two: np.ndarray, against: np.ndarray) -> bool:
    """Whether the double cover of ``f`` faces by (face, side) falls into twice as many pieces as the faces.

    ``one (e,)`` and ``two (e,)`` are neighbours, oriented ``against (e,)`` each other or alike.
    """
    pieces, _ = component_labels(f, one, two)
    ends = np.concatenate([one, one + f]), np.concatenate([two + f * against, two + f * ~against])
    return component_labels(2 * f, *ends)[0] == 2 * pieces
