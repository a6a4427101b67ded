"""Alternating registration and refinement of shapes that differ much.

Their functions correspond only roughly, so that ZoomOut leaves limbs torn or everything a little off. A registration
alone stays near its initial map. So the source is registered onto the target, stiffly, and the positions and normals of
both guide the next ZoomOut beside functions and descriptors. Smooth Shells (Eisenberger et al. 2020) join functions,
coordinates and normals in the same way; here the deformation is as rigid as possible.
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

_ROUNDS = 2  # registrations, each followed by a refinement on the proxies
FIT = NonRigid(stiffness=5e-3, n_levels=2, steps=4, local_scaling=0.05)
"""A stiff registration, which does not follow tears; but limbs may become longer or thicker."""
_REFINE = ZoomOut(start=20, stop=100, step=20, descriptor_weight=36.0)
"""The refinement on proxies. High functions of shapes that differ much do not correspond."""
WEIGHT = 10.0
"""Weight of the guidance by positions and normals, relative to that by SHOT."""
_NORMAL_WEIGHT = 0.3  # distance at unit area that counts as much as normals that differ by 1


@dataclass(frozen=True, eq=False)
class ProxyPair:
    """Coarse proxies of two shapes, prepared for registrations in both directions; made by :func:`proxy_pair`."""

    source: Shape
    target: Shape
    proxies: tuple[CoarseProxy, CoarseProxy]
    forth: MeshPair  # from the source's proxy to the target's, and back
    back: MeshPair

    @cached_property
    def bases(self) -> tuple[SampledBasis, SampledBasis]:
        """The bases of both shapes at the vertices of their proxies."""
        a, b = self.proxies
        return _sampled_basis(self.source.basis, a), _sampled_basis(self.target.basis, b)

    def swapped(self) -> ProxyPair:
        """Return the same for maps the other way."""
        a, b = self.proxies
        return ProxyPair(self.target, self.source, (b, a), self.back, self.forth)

    def nearest(self, landmarks: np.ndarray) -> np.ndarray:
        """Return the vertices of the proxies that are nearest to ``landmarks (l, 2)``, (l, 2)."""
        columns = [
            KDTree(shape.mesh.vertices[proxy.vertices]).query(shape.mesh.vertices[vertices])[1]
            for shape, proxy, vertices in zip((self.source, self.target), self.proxies, landmarks.T, strict=True)
        ]
        return np.stack(columns, axis=1)


@dataclass(frozen=True, eq=False)
class AlternatingResult:
    """The result of a round of :func:`alternating_registration`."""

    functional_map: np.ndarray  # (k, k)
    registered_vertices: np.ndarray  # (n_s, 3): of the source, on the target


def proxy_pair(source: Shape, target: Shape, proxies: tuple[CoarseProxy, CoarseProxy]) -> ProxyPair:
    """Return coarse proxies, ``proxies``, of two shapes with everything that their registrations share."""
    a, b = (deformable_mesh(proxy.mesh, {}) for proxy in proxies)
    query_a, query_b = (closest_point_query(body.mesh, around=body.around) for body in (a, b))
    return ProxyPair(source, target, proxies, mesh_pair(a, b.mesh, query_b), mesh_pair(b, a.mesh, query_a))


def alternating_registration(
    C: np.ndarray, pair: ProxyPair, guidance: DescriptorGuidance | None, landmarks: np.ndarray
) -> Iterator[AlternatingResult]:
    """Improve a map between unlike shapes by registrations and refinements in turn; yield the result of each round.

    ``C (k_t, k_s)``; ``guidance``: of the refinements, for all vertices; ``landmarks (l, 2)``: vertices of the shapes.
    """
    a, b = pair.proxies
    k = min(*(len(basis.eigenvalues) for basis in pair.bases), _REFINE.stop)
    refine = replace(_REFINE, stop=k, start=min(_REFINE.start, k))
    guidance, landmarks = guidance and guidance.at(a.vertices, b.vertices), pair.nearest(landmarks)
    refined = refine(C, *pair.bases, guidance=guidance)
    for _ in range(_ROUNDS):
        x = FIT.register_vertices(pair.forth, refined.target_to_source, landmarks=landmarks)[0]
        positions = position_normal_guidance(Mesh(x, a.mesh.faces), b.mesh)
        both = combine_guidance([(1.0, guidance), (WEIGHT, positions)])
        refined = refine(refined.functional_map, *pair.bases, guidance=both)
        vertices = _project_positions(x, pair.bases[0], pair.source.basis)
        yield AlternatingResult(to_numpy(refined.functional_map), vertices)


def position_normal_guidance(source: Mesh, target: Mesh) -> DescriptorGuidance:
    """Return guidance by positions and normals of two registered surfaces.

    Positions of two random points differ by 1 on average, normals by about as much.
    """
    centre = target.vertices.mean(axis=0)
    size = np.sqrt(2 * ((target.vertices - centre) ** 2).sum(axis=1).mean())
    origin = np.append(centre, np.zeros(3))
    return DescriptorGuidance(*((position_normals(mesh) - origin) / size for mesh in (source, target)))


def position_normals(mesh: Mesh) -> np.ndarray:
    """Return positions and weighted normals of the vertices of a mesh, (n, 6), in units of length."""
    return np.hstack([mesh.vertices, _NORMAL_WEIGHT * vertex_normals(mesh)])


def _project_positions(positions: np.ndarray, samples: SampledBasis, basis: Basis) -> np.ndarray:
    """Extend ``positions (q, 3)`` at samples smoothly to all vertices, (n, 3), by damped least squares."""
    phi = to_numpy(samples.functions)[:, :100]
    weighted = (to_numpy(samples.mass)[:, None] * phi).T
    coefficients = np.linalg.solve(weighted @ phi + 1e-3 * np.eye(phi.shape[1]), weighted @ positions)
    return to_numpy(basis.functions)[:, : phi.shape[1]] @ coefficients


def _sampled_basis(basis: Basis, proxy: CoarseProxy) -> SampledBasis:
    areas = vertex_areas(proxy.mesh)
    areas = areas * (float(to_numpy(basis.mass).sum()) / areas.sum())
    return SampledBasis(basis.eigenvalues, to_numpy(basis.functions)[proxy.vertices], areas)
