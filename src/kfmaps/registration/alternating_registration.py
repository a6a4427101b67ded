"""Shapes that differ much: bent onto each other and matched in turn, before the finish.

Their functions correspond only roughly, so that ZoomOut leaves a limb torn or everything a little off; bending alone
cannot jump. Together they can: the source is bent onto the target as the map says, stiffly, and where both then lie,
positions and normals, takes part in the next refinement beside functions and descriptors. That is how Smooth Shells
(Eisenberger et al. 2020) join functions, coordinates and normals; here an as-rigid-as-possible fit bends the source.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import to_numpy
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, combine_guidance
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.coarsen import CoarseProxy
from kfmaps.geometry.mesh import Mesh, vertex_areas, vertex_normals
from kfmaps.geometry.sampling import SampledBasis
from kfmaps.registration.deformable import closest_point_query, deformable_mesh
from kfmaps.registration.nonrigid_icp import MeshPair, NonRigid, mesh_pair
from kfmaps.shape import Shape

_ROUNDS = 2  # fits, each followed by a refinement on the copies
FIT = NonRigid(stiffness=5e-3, n_levels=2, steps=4, local_scaling=0.05)
"""Stiff, so that what is torn is not bent to fit; but limbs may be longer or thicker."""
_REFINE = ZoomOut(start=20, stop=100, step=20, descriptor_weight=36.0)
"""On the copies; the high functions of shapes that differ much do not correspond."""
WEIGHT = 10.0
"""Of where both lie beside SHOT."""
_NORMAL_WEIGHT = 0.3  # distance at unit area that counts as much as normals that differ by 1


@dataclass(frozen=True, eq=False)
class ProxyPair:
    """Coarse copies of two shapes, ready to be bent onto each other as maps say; made by :func:`proxy_pair`."""

    source: Shape
    target: Shape
    copies: tuple[CoarseProxy, CoarseProxy]
    forth: MeshPair  # the source's copy to be bent onto the target's, and the other way
    back: MeshPair

    @cached_property
    def bases(self) -> tuple[SampledBasis, SampledBasis]:
        """The bases of both shapes at the vertices of their copies."""
        (a, b), source, target = self.copies, self.source.basis, self.target.basis
        return _sampled(source, a), _sampled(target, b)

    def swapped(self) -> ProxyPair:
        """Return the same for maps the other way."""
        a, b = self.copies
        return ProxyPair(self.target, self.source, (b, a), self.back, self.forth)

    def nearest(self, landmarks: np.ndarray) -> np.ndarray:
        """Return the vertices of the copies that are nearest to ``landmarks (l, 2)``, (l, 2)."""
        near = [
            KDTree(shape.mesh.vertices[copy.vertices]).query(shape.mesh.vertices[at])[1]
            for shape, copy, at in zip((self.source, self.target), self.copies, landmarks.T, strict=True)
        ]
        return np.stack(near, axis=1)


@dataclass(frozen=True, eq=False)
class AlternatingResult:
    """What a round of :func:`alternating_registration` makes."""

    functional_map: np.ndarray  # (k, k)
    registered_vertices: np.ndarray  # (n_s, 3): the source's, on the target


def proxy_pair(source: Shape, target: Shape, copies: tuple[CoarseProxy, CoarseProxy]) -> ProxyPair:
    """Return coarse ``copies`` of two shapes ready to be registered, so that what depends on no map is found once."""
    a, b = (deformable_mesh(copy.mesh, {}) for copy in copies)
    on_a, on_b = (closest_point_query(body.mesh, around=body.around) for body in (a, b))
    return ProxyPair(source, target, copies, mesh_pair(a, b.mesh, on_b), mesh_pair(b, a.mesh, on_a))


def alternating_registration(
    C: np.ndarray, on: ProxyPair, led: DescriptorGuidance | None, landmarks: np.ndarray
) -> Iterator[AlternatingResult]:
    """Improve a map between unlike shapes by registrations and refinements in turn; yields what each round has made.

    ``C (k_t, k_s)``; ``led``: guides the refinements, for all vertices; ``landmarks (l, 2)``: vertices of the shapes.
    """
    a, b = on.copies
    k = min(*(len(basis.eigenvalues) for basis in on.bases), _REFINE.stop)
    refine = replace(_REFINE, stop=k, start=min(_REFINE.start, k))
    here, marks = led and led.at(a.vertices, b.vertices), on.nearest(landmarks)
    found = refine(C, *on.bases, guide=here)
    for _ in range(_ROUNDS):
        bent = FIT.bent(on.forth, found.target_to_source, marks=marks)[0]
        lie = position_normal_guidance(Mesh(bent, a.mesh.faces), b.mesh)
        found = refine(found.functional_map, *on.bases, guide=combine_guidance([(1.0, here), (WEIGHT, lie)]))
        yield AlternatingResult(to_numpy(found.functional_map), _project_positions(bent, on.bases[0], on.source.basis))


def position_normal_guidance(source: Mesh, target: Mesh) -> DescriptorGuidance:
    """Return guidance by positions and normals of two surfaces that lie on each other.

    Positions of two random points differ by 1 on average, normals by about as much.
    """
    middle = target.vertices.mean(axis=0)
    size = np.sqrt(2 * ((target.vertices - middle) ** 2).sum(axis=1).mean())
    return DescriptorGuidance(
        *((position_normals(mesh) - np.append(middle, np.zeros(3))) / size for mesh in (source, target))
    )


def position_normals(mesh: Mesh) -> np.ndarray:
    """Return positions and weighted normals of the vertices of a mesh, (n, 6), in units of length."""
    return np.hstack([mesh.vertices, _NORMAL_WEIGHT * vertex_normals(mesh)])


def _project_positions(positions: np.ndarray, samples: SampledBasis, basis: Basis) -> np.ndarray:
    """``positions (q, 3)`` at samples as smooth functions on all vertices, (n, 3), by damped least squares."""
    phi = to_numpy(samples.functions)[:, :100]
    weighted = (to_numpy(samples.mass)[:, None] * phi).T
    found = np.linalg.solve(weighted @ phi + 1e-3 * np.eye(phi.shape[1]), weighted @ positions)
    return to_numpy(basis.functions)[:, : phi.shape[1]] @ found


def _sampled(basis: Basis, copy: CoarseProxy) -> SampledBasis:
    areas = vertex_areas(copy.mesh)
    areas = areas * (float(to_numpy(basis.mass).sum()) / areas.sum())
    return SampledBasis(basis.eigenvalues, to_numpy(basis.functions)[copy.vertices], areas)
