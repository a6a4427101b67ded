"""The result of a match: one record, whether it was just made, loaded from a file or made in a batch."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import InvalidInput, check, like, refuse
from kfmaps._threads import limit_threads
from kfmaps.config import Config
from kfmaps.fmap.convert import nearest_reached, to_functional
from kfmaps.fmap.descriptor_guidance import descriptor_guidance
from kfmaps.fmap.precise import PointMap, invert_precise_map, nearest_vertices, to_precise_map
from kfmaps.fmap.transfer import transfer_functions
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.assemble import assemble
from kfmaps.matching.fit import fit_points
from kfmaps.matching.reindexing import VertexReindexing, reindexing
from kfmaps.matching.result_groups import MatchFit, MatchPart, MatchRegistration, MatchScore, ShapeFile
from kfmaps.shape import mirror_image

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHAPE_FIELDS = ("source", "target", "basis_source", "basis_target")
"""Fields that no file holds."""
_OPTIONAL = (
    *SHAPE_FIELDS,
    *("functional_map", "eigenvalues_source", "eigenvalues_target", "local_confidence", "config"),
)
"""Fields that a map from a file or from a list of vertices may lack; asking for one of them is an error then."""


class NotKnown(InvalidInput, AttributeError):
    """A match has no such field, because it came from a file or a list of vertices that does not hold it."""


def _lacking() -> Any:
    """Return the default of a field that a match may lack, typed so that fields of a fresh match need no checks."""


@dataclass(frozen=True, eq=False, repr=False)
class Match:
    """A map between two shapes with its evidence.

    :func:`kfmaps.match`, :func:`kfmaps.load_map` and collections return it. A file has no meshes and no bases, and a
    list of vertices has ``target_to_source`` alone. Access to a missing field raises :class:`InvalidInput`;
    ``hasattr(match, "functional_map")`` tests for one.

    Attributes
    ----------
    target_to_source : (n_t,) int64
        A source vertex for each target vertex, after refinement; −1 without a counterpart, which only parts have.
    functional_map : (k_t, k_s) float64
        Carries coefficients of functions from source to target, after refinement.
    source, target : Mesh
        The shapes as they were given; those of a :class:`Shape` have unit area.
    basis_source, basis_target : Basis
        The functions that ``functional_map`` is written in, (n_s, k_s) and (n_t, k_t), of the shapes at unit area.
    eigenvalues_source, eigenvalues_target : (k_s,), (k_t,) float64
        Of the bases; a file has these alone.
    verdict : str
        "landmarks", "sure", "likely", "ambiguous", "unlikely" or "unchecked".
    confidence : float or None
        Probability that the map is right, after a search (:mod:`kfmaps.matching.score`).
    local_confidence : (n_t,) float64
        How well distances around each target vertex are kept, 0 to 1 (:mod:`kfmaps.fmap.confidence`).
    orientation : "preserving" or "reversing"
        Whether it is a map to the target or to its mirror image.
    precise_map : PointMap or None
        A point inside a triangle of the source for each target vertex, where the registration was accepted.
    alternatives : tuple of arrays (n_t,)
        The distinct other maps that a search found, best first.
    source_to_target, functional_map_back : (n_s,) int64, (k_s, k_t) float64 or None
        The map from source to target, where the formulation asks for both directions.
    landmarks : (l, 2) int64
        The pairs "source vertex, target vertex" that were given.
    config : Config
    seed : int
    seconds : dict of str to float
        Per stage.
    score : MatchScore
    registration : MatchRegistration
    partial : MatchPart
    fit : MatchFit
    source_file, target_file : ShapeFile
        Where the shapes came from.

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> result = kfmaps.match(pair.source, pair.target)
    >>> on_target = result.transfer(result.source.vertices)  # (n_t, 3)
    >>> len(result.alternatives) == len(result.score.scores) - 1
    True
    """

    target_to_source: np.ndarray
    _: KW_ONLY
    functional_map: np.ndarray = field(default_factory=_lacking)
    source: Mesh = field(default_factory=_lacking)
    target: Mesh = field(default_factory=_lacking)
    basis_source: Basis = field(default_factory=_lacking)
    basis_target: Basis = field(default_factory=_lacking)
    eigenvalues_source: np.ndarray = field(default_factory=_lacking)
    eigenvalues_target: np.ndarray = field(default_factory=_lacking)
    verdict: str = "unchecked"
    confidence: float | None = None
    local_confidence: np.ndarray = field(default_factory=_lacking)
    orientation: str = "preserving"
    precise_map: PointMap | None = None
    alternatives: tuple[np.ndarray, ...] = ()
    source_to_target: np.ndarray | None = None
    functional_map_back: np.ndarray | None = None
    landmarks: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    config: Config = field(default_factory=_lacking)
    seed: int = 0
    seconds: dict[str, float] = field(default_factory=dict)
    score: MatchScore = field(default_factory=MatchScore)
    registration: MatchRegistration = field(default_factory=MatchRegistration)
    partial: MatchPart = field(default_factory=MatchPart)
    fit: MatchFit = field(default_factory=MatchFit)
    source_file: ShapeFile = field(default_factory=ShapeFile)
    target_file: ShapeFile = field(default_factory=ShapeFile)
    _reindexing: VertexReindexing | None = None

    def __post_init__(self) -> None:
        for name in _OPTIONAL:
            if vars(self)[name] is None:
                del vars(self)[name]

    if not TYPE_CHECKING:  # type checkers should know the fields alone

        def __getattr__(self, name: str) -> Any:
            if name in _OPTIONAL:
                got = "one from a file or a list of vertices, which does not hold it"
                raise NotKnown(f"{name}: expected a match that has it, got {got}. Match the shapes again.")
            raise AttributeError(f"Match has no attribute {name!r}")

    @property
    def n_source(self) -> int | None:
        """Number of vertices of the source, where it is known."""
        return len(self.source.vertices) if hasattr(self, "source") else self.source_file.n_vertices

    def __repr__(self) -> str:
        n_s = "" if self.n_source is None else f"{self.n_source:,} "
        sure = "" if self.confidence is None else f", confidence {self.confidence:.2f}"
        size = "; C {} × {}".format(*self.functional_map.shape) if hasattr(self, "functional_map") else ""
        return f"Match({len(self.target_to_source):,} target to {n_s}source vertices: {self.verdict}{sure}{size})"

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the picture of :meth:`plot`, and the line of ``repr``."""
        words = f"<code>{escape(repr(self))}</code>"
        max_pictured = 60_000  # vertices of both shapes together above which a notebook shows text without a picture
        if not hasattr(self, "source") or len(self.source.vertices) + len(self.target_to_source) > max_pictured:
            return words
        from kfmaps import api

        return f"{api.picture_html(self, repr(self))}<br>{words}"

    def plot(self, **options: Any) -> Figure:
        """Draw the map; :func:`kfmaps.render` lists the options."""
        from kfmaps import api

        return api.render(self, **options)

    def view(self, **options: Any) -> Path | None:
        """Show the map in the browser, or in a notebook's cell; :func:`kfmaps.view` lists the options."""
        from kfmaps import api

        return api.view(self, **options)

    def save(self, path: str | Path, *, force: bool = False) -> None:
        """Write the map to ``path`` (.npz, .mat, .txt, .vts) as :func:`kfmaps.save_map` does.

        An existing file is replaced with ``force`` alone.
        """
        from kfmaps import api

        api.save_map(path, self, force)

    def transfer(self, values: ArrayLike, products: int | None = None) -> np.ndarray:
        """Carry ``values (n_s, ...)`` from the source's vertices to the target's, (n_t, ...).

        Target vertex ``j`` gets ``values[target_to_source[j]]``, as by :func:`kfmaps.transfer`; functions, labels and
        colours alike.

        Parameters
        ----------
        values : (n_s, ...) array
        products : int, optional
            Carry the values as functions by the functional map instead, together with the products of so many of its
            first functions (:func:`kfmaps.fmap.transfer.transfer_functions`); 20, say, and 0 for no products.

        Raises
        ------
        InvalidInput
            When there is not one row per source vertex, or ``products`` is given for a map of parts or without bases.
        """
        if products is None:
            from kfmaps import api

            return api.transfer(values, self)
        if self.partial.which != "none":
            raise refuse("products", "a map of whole shapes", "a map of a part", "leave products out")
        values = np.asarray(values, dtype=np.float64)
        n = len(self.basis_source.mass)
        check(values, "values", shape=(n, *(None,) * (values.ndim - 1)), remedy="give one row per source vertex")
        return transfer_functions(
            values, self.functional_map, self.basis_source, self.basis_target, None if products == 0 else products
        )

    def energies(self, functional_map: ArrayLike | None = None) -> dict[str, float]:
        """Return the weighted value of each term of the energy that ``config`` asks for.

        The energy is assembled again, which takes about as long as one fit. It knows the landmarks that the map keeps
        to; descriptors that were handed to :func:`kfmaps.match` are not in it.

        Parameters
        ----------
        functional_map : (k_t, k_s) array, optional
            Where the energy is evaluated; by default at that of the match. For a larger map the block of the first
            ``config.basis.n_eigenfunctions`` counts.

        Raises
        ------
        InvalidInput
            When the match came from a file, is one of a part, or the map is too small.
        """
        pair, config = self._reindexing, self.config
        if pair is None or self.partial.which != "none":
            got = "one from a file" if pair is None else "one of a part"
            raise refuse("energies", "a match of whole shapes with their bases", got, "match the shapes again")
        pair = reindexing(*pair.given)
        shapes = pair.source, mirror_image(pair.target) if self.orientation == "reversing" else pair.target
        kept = np.delete(self.landmarks, self.score.rejected_landmarks, axis=0)
        points = fit_points(*shapes, config, pair.clean_landmarks(kept), rng=self.seed)
        problem = assemble(
            *points.shapes, points.bases, points.descriptors, config, np.random.default_rng(self.seed), shapes
        )
        k, C = config.basis.n_eigenfunctions, self.functional_map if functional_map is None else functional_map
        C = np.asarray(C, dtype=np.float64)[:k, :k]
        check(C, "functional map", shape=(k, k), remedy="give a map of as many functions as the energy has")
        return problem.energy.breakdown(like(C, problem.energy.rhs()))

    def precise(self) -> PointMap:
        """Return a point inside a triangle of the source for each target vertex.

        It is that of the registration where it was accepted. Else it is the nearest point of the source's surface in
        the spectral embedding (:func:`kfmaps.fmap.precise.to_precise_map`), computed with every call.

        Raises
        ------
        InvalidInput
            When one of the shapes is a point cloud, or a loaded map has no such points.
        """
        if self.precise_map is not None:
            return self.precise_map
        pair = self._reindexing
        if pair is None:
            raise refuse("precise", "a match with its shapes", "one from a file", "match the shapes again")
        for name, mesh in (("source", self.source), ("target", self.target)):
            if len(mesh.faces) == 0:
                raise refuse(name, "a surface with triangles", "a point cloud", "use target_to_source")
        refine, columns, C = self.config.refinement, None, self.functional_map
        bases = (pair.source.basis, pair.target.basis)
        if pair.is_divided:
            k_t, k_s = C.shape
            C = to_functional(pair.clean_points(self.target_to_source), bases[0].truncate(k_s), bases[1].truncate(k_t))
        weight = getattr(refine, "descriptor_weight", 0.0)
        if weight and self.orientation != "reversing":
            guidance = descriptor_guidance(pair.source.shot, pair.target.shot)
            columns = guidance and guidance.embedding_columns(weight, *bases)
        faces = pair.source.mesh.faces
        with limit_threads(self.config.threads):
            return pair.given_precise_map(to_precise_map(C, *bases, faces, columns))

    def precise_inverse(self) -> PointMap:
        """Return a point inside a triangle of the target for each source vertex: the inverse of :meth:`precise`.

        Of a map of parts it has a meaning only in the part that both shapes have (``partial.overlap_source``).

        Raises
        ------
        InvalidInput
            When one of the shapes is a point cloud or not known.
        """
        source, target = self.source, self.target
        known = self.target_to_source >= 0
        return invert_precise_map(self.precise(), source, target, None if known.all() else known)

    def inverse(self) -> np.ndarray:
        """Return a target vertex for each source vertex, (n_s,) int64; −1 outside the part that both shapes have.

        With points inside triangles it is the corner nearest to :meth:`precise_inverse`. Else it is a target vertex
        that is mapped to the source vertex or, where none is, to the nearest one along the edges that has one. Of
        several, the one nearest to their mean is taken.

        Raises
        ------
        InvalidInput
            When the shapes are not known.
        """
        source, target = self.source, self.target
        known = np.flatnonzero(self.target_to_source >= 0)
        points, n_s = self.target_to_source[known], len(source.vertices)
        if len(known) == 0:
            return np.full(n_s, -1, dtype=np.int64)
        overlap = self.partial.overlap_source
        if self.precise_map is not None and overlap is None:
            return nearest_vertices(self.precise_inverse(), target)
        positions = target.vertices[known]
        count = np.bincount(points, minlength=n_s)
        middle = np.stack([np.bincount(points, axis, minlength=n_s) for axis in positions.T], axis=1)
        middle /= np.maximum(count, 1)[:, None]
        order = np.lexsort((((positions - middle[points]) ** 2).sum(axis=1), points))
        first = np.searchsorted(points[order], np.arange(n_s))
        central = order[np.minimum(first, len(points) - 1)]
        result = known[central[nearest_reached(source, points)]].astype(np.int64)
        return result if overlap is None else np.where(overlap > 0.5, result, -1)


class _KnownFields:
    """The fields of the class; of a match those that it has, so that ``dataclasses.replace`` passes over the others."""

    def __init__(self) -> None:
        self._all = vars(Match)["__dataclass_fields__"]

    def __get__(self, match: Match | None, _: type) -> dict[str, Any]:
        return self._all if match is None else {name: one for name, one in self._all.items() if name in vars(match)}


Match.__dataclass_fields__ = _KnownFields()  # pyright: ignore[reportAttributeAccessIssue]
