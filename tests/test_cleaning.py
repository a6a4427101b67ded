"""What surrounds a surface does not disturb it: soup, seams, unused vertices and specks."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import ConvexHull

from conftest import NO_FACES, blob, fibonacci_sphere, joined, small_fit
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.descriptors.shot import shot
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.evaluate import coverage, geodesic_errors
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.clean import _MAX_SPECK_AREA, _body_faces, clean_mesh, flatten_spikes, smooth_noise
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.geodesics import geodesic_distance_pairs, geodesic_distances
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area
from kfmaps.geometry.subdivision import divide_faces
from kfmaps.geometry.topology import topology
from kfmaps.geometry.weld import _MAX_GAP, _MAX_GAP_OF_BODY, _MAX_ROUNDING, _pairs_within, weld_vertices
from kfmaps.matching.match import match
from kfmaps.registration.nonrigid_icp import NonRigid
from kfmaps.shape import prepare

GUARDS = ("kfmaps.descriptors.shot", "kfmaps.geometry", "kfmaps.matching", "kfmaps.shape")

SMALL = small_fit(20, 40, 40, 60, refinement=ZoomOut(start=10, stop=40, step=10))
MARKS = np.array([[5, 5], [100, 110], [200, 190], [300, 290]])
TETRAHEDRON = Mesh(
    np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
)


def placed(mesh: Mesh, size: float, at: tuple[float, float, float] = (3.0, 1.0, 0.0)) -> Mesh:
    return Mesh(size * mesh.vertices + np.array(at), mesh.faces)


def soup(mesh: Mesh) -> tuple[Mesh, np.ndarray]:
    """Every triangle on its own, and which vertex each corner was."""
    was = mesh.faces.ravel()
    return Mesh(mesh.vertices[was], np.arange(len(was)).reshape(-1, 3)), was


def seamed(mesh: Mesh) -> tuple[Mesh, np.ndarray]:
    """Cut in two charts, faces left and right of a plane, and which vertex each one was."""
    right = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0.1
    halves = [np.unique(mesh.faces[side]) for side in (~right, right)]
    number = [np.searchsorted(half, mesh.faces[side]) for half, side in zip(halves, (~right, right), strict=True)]
    was = np.concatenate(halves)
    return Mesh(mesh.vertices[was], np.concatenate([number[0], number[1] + len(halves[0])])), was


def littered(mesh: Mesh) -> Mesh:
    """With a dozen specks and some vertices that no face uses behind it."""
    rng = np.random.default_rng(0)
    specks = [placed(TETRAHEDRON, size, tuple(rng.normal(size=3))) for size in np.geomspace(1e-5, 0.05, 12)]
    return joined(mesh, *specks, Mesh(rng.normal(size=(5, 3)), NO_FACES))


def quietly(function, *arguments, **more):
    """What it returns, whatever it warns of."""
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        return function(*arguments, **more)


@pytest.fixture(scope="module")
def plain():
    """The match of two clean blobs."""
    return match(blob(400), blob(360, twist=0.4), SMALL, landmarks=MARKS)


@pytest.mark.parametrize("cut", [soup, seamed])
def test_cut_surfaces_are_connected_inside(cut) -> None:
    mesh = blob(300)
    pieces, was = cut(mesh)
    part = clean_mesh(pieces)
    np.testing.assert_array_equal(part.to_clean, part.to_clean[part.to_original][part.to_clean])
    np.testing.assert_array_equal(was[part.to_original][part.to_clean], was)
    np.testing.assert_array_equal(was[part.to_original[part.mesh.faces]], was[pieces.faces])
    assert not part.unreferenced.any()
    assert (len(part.to_original), part.n_welded) == (300, len(was) - 300)
    assert clean_mesh(part.mesh).mesh is part.mesh  # nothing is left to do


@pytest.mark.parametrize("cut", [soup, seamed])
def test_cut_surfaces_are_the_surface_that_they_look_like(cut) -> None:
    mesh = blob(300)
    pieces, was = cut(mesh)
    whole, counts = topology(mesh), topology(pieces)
    assert (counts.components, counts.boundary_edges, counts.genus, counts.is_closed) == (1, 0, 0, True)
    assert (counts.euler_characteristic, counts.nonmanifold_vertices) == (whole.euler_characteristic, 0)
    assert counts.duplicated_vertices == len(was) - 300
    one, other = laplace_basis(mesh, 12), laplace_basis(pieces, 12)
    np.testing.assert_allclose(other.eigenvalues, one.eigenvalues, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(np.abs(other.functions), np.abs(one.functions[was]), atol=1e-7)
    np.testing.assert_allclose(np.bincount(was, other.mass), one.mass, rtol=1e-9)
    np.testing.assert_allclose(other.project(other.functions), np.eye(12), atol=1e-9)
    np.testing.assert_allclose(shot(pieces), shot(mesh)[was], atol=1e-6)
    apart = geodesic_distances(mesh, was[[3, 70]])[:, was]
    np.testing.assert_allclose(geodesic_distances(pieces, [3, 70]), apart, rtol=1e-6)
    for depth in (0, 2):
        apart = dijkstra(geodesic_graph(mesh, depth), indices=was[[3, 70]])[:, was]
        found = dijkstra(geodesic_graph(pieces, depth), indices=[3, 70])
        np.testing.assert_allclose(found, apart, rtol=1e-12, atol=1e-300)
    copies = np.flatnonzero(was == was[-1])
    assert len(copies) > 1
    assert not geodesic_distance_pairs(pieces, np.repeat(copies[0], len(copies)), copies).any()


def test_surfaces_that_only_touch_stay_apart() -> None:
    two = joined(TETRAHEDRON, placed(TETRAHEDRON, -1.0, (0, 0, 0)))  # closed, with one corner in common
    np.testing.assert_array_equal(weld_vertices(two), np.arange(8))
    open_two = Mesh(two.vertices, two.faces[[0, 1, 4, 5]])  # open, and still in one corner only
    np.testing.assert_array_equal(weld_vertices(open_two), np.arange(8))


def shortest_edge(mesh: Mesh) -> float:
    return float(
        np.linalg.norm(mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)], axis=2).min()
    )


@pytest.mark.parametrize("cut", [soup, seamed])
@pytest.mark.parametrize("amount", [1e-6, 0.4])
def test_rounded_open_edges_are_connected(cut, amount) -> None:
    mesh = blob(300)
    pieces, was = cut(mesh)
    noise = np.random.default_rng(0).uniform(-1, 1, pieces.vertices.shape) / np.sqrt(12)
    moved = Mesh(pieces.vertices + amount * _MAX_ROUNDING * shortest_edge(mesh) * noise, pieces.faces)
    np.testing.assert_array_equal(weld_vertices(moved), weld_vertices(pieces))
    assert topology(moved).is_closed
    # As links are as long as they are, distances change no more than positions.
    apart = geodesic_distances(mesh, was[[3, 70]])[:, was]
    np.testing.assert_allclose(geodesic_distances(moved, [3, 70]), apart, rtol=0.1, atol=0.1 * shortest_edge(mesh))


@pytest.mark.parametrize(("width", "edges"), [(0.05, 0), (0.2, 8)])
def test_a_slit_is_closed_if_it_is_as_narrow_as_rounding(width, edges) -> None:
    """A closed sheet of 12 x 12 squares around a torus, slit along four edges, three of whose ends are doubled."""
    row, column = np.meshgrid(np.arange(12), np.arange(12), indexing="ij")
    angle, around = 2 * np.pi * row / 12, 2 * np.pi * column / 12
    radius = 3 + np.cos(around)
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.sin(around)], axis=2).reshape(-1, 3)
    corner = np.arange(144).reshape(12, 12)
    right, above, over = (np.roll(corner, shift, axis=axes) for shift, axes in ((-1, 1), (-1, 0), ((-1, -1), (0, 1))))
    faces = np.concatenate([np.stack([corner, above, right], 2), np.stack([right, above, over], 2)]).reshape(-1, 3)
    slit = corner[3, 2:5]
    is_above = (faces.min(axis=1) >= 36) & (faces.max(axis=1) < 60)
    number = np.arange(144)
    number[slit] = 144 + np.arange(3)
    faces[is_above] = number[faces[is_above]]
    shortest = np.linalg.norm(places[corner] - places[right], axis=2).min()
    mesh = Mesh(np.vstack([places, places[slit] + [0, 0, width * shortest]]), faces)
    assert (topology(mesh).components, topology(mesh).boundary_edges) == (1, edges)


def t_junctions(mesh: Mesh, in_pieces: bool) -> tuple[Mesh, np.ndarray]:
    """Above a plane, faces cut in four on one side and in sixteen on the other; and the middles of those below.

    They are connected at corners, or three pieces.
    """
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    times = np.where(middle[:, 2] < 0.1, 0, np.where(middle[:, 0] < 0, 1, 2))
    vertices, faces = mesh.vertices, [mesh.faces[times == time] for time in range(3)]
    for i in (1, 2, 2):
        ends, faces[i] = divide_faces(faces[i], len(vertices))
        vertices = np.vstack([vertices, vertices[ends].mean(axis=1)])
    if in_pieces:
        return joined(*(Mesh(vertices, some) for some in faces)), middle[times == 0]
    return Mesh(vertices, np.vstack(faces)), middle[times == 0]


@pytest.mark.parametrize("in_pieces", [False, True])
@pytest.mark.parametrize("is_turned", [False, True])
def test_t_junctions_are_connected(in_pieces, is_turned) -> None:
    mesh = blob(300)
    junctions, coarse = t_junctions(mesh, in_pieces)
    if is_turned:  # the finer part first
        junctions = Mesh(junctions.vertices[::-1], len(junctions.vertices) - 1 - junctions.faces)
    counts, part = topology(junctions), clean_mesh(junctions)
    assert (counts.components, counts.is_closed, counts.genus) == (1, True, 0)
    assert (counts.nonmanifold_vertices, counts.inconsistent_edges) == (0, 0)
    np.testing.assert_allclose(surface_area(part.mesh), surface_area(mesh), rtol=1e-3)
    # The coarse part is as it was, and no vertex has gone farther than to the next end of a coarse edge.
    moved = junctions.vertices[part.to_original[part.to_clean]] - junctions.vertices
    longest = np.linalg.norm(mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)], axis=2).max()
    assert np.linalg.norm(moved[~part.unreferenced], axis=1).max() <= longest / 2 + 1e-12
    kept = {tuple(np.round(face, 9)) for face in part.mesh.vertices[part.mesh.faces].mean(axis=1)}
    assert {tuple(np.round(face, 9)) for face in coarse} <= kept


def tube(count: int, turn: float, start: float, side: float, jitter: float = 0.0) -> Mesh:
    """A tube of radius 1, about 0.47 long, of ``count`` squares around with rows of height ``side``."""
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, count, endpoint=False), np.arange(round(0.47 / side) + 1))
    angle = angle + turn + jitter / count * np.random.default_rng(count).uniform(-1, 1, count)
    corner = np.arange((len(height) - 1) * count).reshape(-1, count)
    right, above = np.roll(corner, -1, axis=1), corner + count
    faces = np.concatenate([np.stack([corner, right, above], 2), np.stack([right, right + count, above], 2)])
    places = np.stack([np.cos(angle), np.sin(angle), start + side * height], axis=2)
    return Mesh(places.reshape(-1, 3), faces.reshape(-1, 3))


@pytest.mark.parametrize(
    ("count", "finer", "gap", "components"),
    [(160, 1, 0.4, 1), (160, 1, 0.52, 2), (40, 1, 0.15, 1), (40, 1, 0.16, 2), (160, 3, 0.15, 1), (160, 3, 0.4, 2)],
)
def test_pieces_with_a_narrow_gap_are_connected(count, finer, gap, components) -> None:
    """It may be half of the shorter open edges wide, but not wider than 0.01 √area, 0.155 of a side of the coarsest."""
    side = 2 * np.sin(np.pi / count)
    below = tube(count, 0, 0, side)
    above = tube(finer * count, 0.3 * side, below.vertices[:, 2].max() + gap * side, side / finer)
    assert (_MAX_GAP, _MAX_GAP_OF_BODY) == (0.5, 0.01)
    counts = topology(joined(above, below))
    n_edges = (1 + finer) * count * components
    assert (counts.components, counts.boundary_edges) == (components, n_edges)
    assert np.isfinite(geodesic_distances(joined(above, below), [0])).all() == (components == 1)


@pytest.mark.parametrize("seed", range(4))
def test_pieces_whose_borders_cross_stay_apart(seed) -> None:
    mesh, rng = blob(1500), np.random.default_rng(seed)
    first, second, _ = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    angle = np.arctan2(mesh.vertices @ first, mesh.vertices @ second)
    pieces = []
    for middle in (0, 2 * np.pi / 3, 4 * np.pi / 3):
        is_near = np.abs((angle - middle + np.pi) % (2 * np.pi) - np.pi) < np.pi / 3 + 0.25
        pieces.append(Mesh(mesh.vertices + 0.03 * rng.normal(size=3), mesh.faces[is_near[mesh.faces].all(axis=1)]))
    assert topology(joined(*pieces)).components == 3


@pytest.mark.parametrize(
    ("turn", "height", "components"), [(180, 0.15, 1), (80, 0.15, 1), (60, 0.15, 2), (60, 0.01, 1)]
)
def test_sheets_on_the_same_side_of_their_borders_stay_apart_unless_these_coincide(turn, height, components) -> None:
    """Two strips whose long sides are near each other, with an angle of ``turn`` between them."""
    x, y = np.meshgrid(np.arange(40.0), np.arange(5.0))
    corner = np.arange(160).reshape(4, 40)[:, :-1].ravel()
    faces = np.concatenate(
        [np.stack([corner, corner + 1, corner + 40], 1), np.stack([corner + 1, corner + 41, corner + 40], 1)]
    )
    angle = np.radians(turn)
    flat = np.stack([x, y, 0 * y], axis=2).reshape(-1, 3)
    turned = np.stack([x + 0.3 * (height > 0.1), y * np.cos(angle), y * np.sin(angle) + height], axis=2).reshape(-1, 3)
    sheets = joined(Mesh(flat, faces), Mesh(turned, faces))
    assert topology(Mesh(sheets.vertices + np.array([0, 9, -5]), sheets.faces)).components == components


def test_vertices_of_the_coarser_piece_stay_as_they_are() -> None:
    side = 2 * np.sin(np.pi / 100)
    below = tube(100, 0, 0, side, jitter=2.0)
    above = tube(110, 0.01, below.vertices[:, 2].max() + 0.1 * side, side, jitter=2.0)
    welded = weld_vertices(joined(above, below))
    n, top = len(above.vertices), below.vertices[:, 2] > below.vertices[:, 2].max() - 1e-9
    np.testing.assert_array_equal(welded[n:], n + np.arange(len(below.vertices)))
    assert (welded[:110] >= n).all()
    # Each goes to the nearest end of the edge below it.
    edge = np.linalg.norm(below.vertices[top] - np.roll(below.vertices[top], 1, axis=0), axis=1).max()
    moved = np.linalg.norm(below.vertices[welded[:110] - n] - above.vertices[:110], axis=1)
    assert moved.max() < np.hypot(edge / 2, 0.1 * side) * 1.01


def test_a_short_edge_keeps_its_ends_apart() -> None:
    """Two triangles with edges 0.05 apart, whose ends coincide but where one has a short edge."""
    one = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, -1, 0]])
    for height, n_welded in ((1.0, 2), (0.2, 0)):
        other = np.array([[0.0, 0.05, 0], [1, 0.05, 0], [0, 0.05 + height, 0]])
        pair = Mesh(np.vstack([one, other]), np.array([[0, 2, 1], [3, 4, 5]]))
        assert (weld_vertices(pair) != np.arange(6)).sum() == n_welded


def test_edges_much_longer_than_those_around_are_passed_over() -> None:
    """So that random faces do not take a time that grows with the square of their number."""
    points = np.random.default_rng(0).uniform(size=(300, 3))
    centre, point = _pairs_within(points[:2], np.array([2.0, 1e-6]), points)
    np.testing.assert_array_equal((centre, point), ([1], [1]))


def test_a_thin_face_on_a_border_does_not_collapse() -> None:
    thin = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0.4, 0.02, 0], [0.5, 0.3, 0]]), np.array([[0, 1, 2], [2, 1, 3]]))
    np.testing.assert_array_equal(weld_vertices(thin), np.arange(4))


@pytest.mark.parametrize("cut", [soup, seamed])
def test_vertices_doubled_along_a_cut_have_the_map_of_the_whole(plain, cut) -> None:
    (pieces_s, was_s), (pieces_t, was_t) = cut(plain.source), cut(plain.target)
    landmark_vertices = [
        [np.flatnonzero(was == v)[-1] for v in at] for was, at in zip((was_s, was_t), MARKS.T, strict=True)
    ]
    with pytest.warns(KfmapsWarning, match="vertices on seams are connected; the numbering is kept"):
        other = match(pieces_s, pieces_t, SMALL, landmarks=np.transpose(landmark_vertices))
    points = was_s[other.target_to_source]
    assert geodesic_errors(plain.source, points, plain.target_to_source[was_t]).max() < 0.1
    assert (points == plain.target_to_source[was_t]).mean() > 0.9  # another first sample
    np.testing.assert_allclose(other.local_confidence, plain.local_confidence[was_t], atol=0.15)
    # Welded in the order in which the places are met there is no difference at all.
    part_s, part_t = clean_mesh(pieces_s), clean_mesh(pieces_t)
    inside = np.stack([part_s.to_clean[landmark_vertices[0]], part_t.to_clean[landmark_vertices[1]]], axis=1)
    again = match(part_s.mesh, part_t.mesh, SMALL, landmarks=inside)
    np.testing.assert_array_equal(other.target_to_source, part_s.to_original[again.target_to_source][part_t.to_clean])
    np.testing.assert_array_equal(other.functional_map, again.functional_map)


def test_landmarks_on_duplicates_of_one_vertex_are_refused() -> None:
    pieces, was = soup(blob(300))
    copies = np.flatnonzero(was == 7)[:2]
    landmark_vertices = np.stack([copies, [3, 40]], axis=1)
    with pytest.raises(InvalidInput, match=f"vertices {copies[0]} and {copies[1]}, which count as one"):
        quietly(match, pieces, blob(300), SMALL, landmarks=landmark_vertices)


def test_specks_change_no_bit_of_the_rest(plain) -> None:
    dirty = littered(plain.source), littered(plain.target)
    with warnings.catch_warnings(record=True) as output:
        warnings.simplefilter("always")
        other = match(*dirty, SMALL, landmarks=MARKS)
    assert sorted(str(w.message) for w in output) == [
        f"{name}: {what}"
        for name in ("source", "target")
        for what in (
            "5 vertices that no face uses are kept",
            "for the match 12 specks are left out; the numbering is kept",
        )
    ]
    np.testing.assert_array_equal(other.target_to_source[:360], plain.target_to_source)
    np.testing.assert_array_equal(other.functional_map, plain.functional_map)
    np.testing.assert_array_equal(other.local_confidence[:360], plain.local_confidence)
    assert not other.local_confidence[360:].any()  # a guess
    assert other.target_to_source.max() < 400
    assert len(other.target_to_source) == len(dirty[1].vertices)


def test_descriptors_of_what_is_left_out_change_nothing() -> None:
    """The first vertex is of no face; its descriptors may be anything."""
    source, target = blob(400), blob(360, twist=0.4)
    config = replace(SMALL, descriptors=replace(SMALL.descriptors, signature="none", landmark_descriptor="none"))
    one = match(source, target, config, descriptors=(source.vertices, target.vertices))
    far = Mesh(np.full((1, 3), 9.0), NO_FACES)
    a, b = joined(far, source), joined(far, target)
    given = [np.vstack([np.full((1, 3), np.nan), mesh.vertices]) for mesh in (source, target)]
    other = quietly(match, a, b, config, descriptors=given)
    np.testing.assert_array_equal(other.target_to_source[1:], one.target_to_source + 1)
    with pytest.raises(InvalidInput, match=r"descriptors of source.*one row per vertex"):
        quietly(match, a, b, config, descriptors=(source.vertices, given[1]))


def test_specks_have_no_confidence_and_cover_nothing() -> None:
    mesh = littered(blob(400))
    n = len(mesh.vertices)
    trust = local_confidence(mesh, mesh, np.arange(n))
    assert trust[:400] == pytest.approx(1)
    assert not trust[400:].any()
    points = np.full(n, n - 1)
    points[0] = 7
    assert coverage(points, mesh) == pytest.approx(coverage(np.full(400, 7), blob(400)), rel=0.01)


def test_specks_are_told_by_their_part_of_the_area() -> None:
    mesh = blob(300)
    for factor, specks in ((0.9, 1), (1.1, 0)):
        size = np.sqrt(factor * _MAX_SPECK_AREA * surface_area(mesh) / surface_area(TETRAHEDRON))
        part = clean_mesh(joined(placed(TETRAHEDRON, size), mesh), specks=True)
        assert (part.specks, part.unreferenced.sum()) == (specks, 4 * specks)
    leaves = joined(*(placed(TETRAHEDRON, 1.0, (3.0 * i, 0, 0)) for i in range(400)))
    assert clean_mesh(leaves, specks=True).mesh is leaves  # equals of each other


@pytest.mark.parametrize(("factor", "specks"), [(0.9, 1), (1.1, 0)])
def test_a_small_fin_is_a_speck(factor, specks) -> None:
    """A triangle that stands on an edge of the surface."""
    mesh = blob(300)
    a, b = mesh.vertices[mesh.faces[7, :2]]
    height = 2 * factor * _MAX_SPECK_AREA * surface_area(mesh) / np.linalg.norm(a - b)
    across = np.cross(b - a, np.ones(3))
    tip = (a + b) / 2 + height * across / np.linalg.norm(across)
    finned = Mesh(np.vstack([mesh.vertices, tip]), np.vstack([mesh.faces, [*mesh.faces[7, :2], 300]]))
    part = clean_mesh(finned, specks=True)
    assert part.specks == specks
    np.testing.assert_array_equal(part.faces_to_original, np.arange(len(finned.faces) - specks))
    assert clean_mesh(finned).mesh is finned


def test_a_patch_at_a_hole_or_without_an_open_edge_is_no_fin() -> None:
    mesh = blob(300)
    a, b, c = mesh.faces[7]
    tent = Mesh(
        np.vstack([mesh.vertices, 1.02 * mesh.vertices[[a, b, c]].mean(axis=0)]),
        np.vstack([mesh.faces, [[a, b, 300], [b, c, 300], [c, a, 300]]]),
    )
    assert clean_mesh(tent, specks=True).specks == 0
    beside = np.unique(mesh.faces[np.isin(mesh.faces, [a, b]).any(axis=1)])
    others = np.setdiff1d(np.arange(300), beside)
    near = others[np.linalg.norm(mesh.vertices[others] - mesh.vertices[a], axis=1).argmin()]
    assert _body_faces(Mesh(mesh.vertices, np.vstack([mesh.faces, [a, b, near]])))[1] == 0  # its tip is on the surface
    around = (np.isin(tent.faces, tent.faces[400])).sum(axis=1) == 2
    assert around.sum() == 3
    island = Mesh(tent.vertices, tent.faces[~around])  # the triangle hangs on by its corners
    assert _body_faces(island)[1] == 0


def spiky(mesh: Mesh, height: float, vertices: list[int]) -> Mesh:
    """With some vertices moved outward, by ``height`` times the mean length of edges."""
    edges = mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)]
    moved = mesh.vertices.copy()
    length = np.linalg.norm(edges, axis=2).mean()
    moved[vertices] += height * length * moved[vertices] / np.linalg.norm(moved[vertices], axis=1, keepdims=True)
    return Mesh(moved, mesh.faces)


def test_spikes_are_flattened() -> None:
    mesh = blob(900)
    flat, count = flatten_spikes(spiky(mesh, 6.0, [3, 450]))
    assert count == 2
    beside = np.setdiff1d(mesh.faces[(mesh.faces == 450).any(axis=1)], 450)
    np.testing.assert_allclose(flat.vertices[450], mesh.vertices[beside].mean(axis=0))
    others = np.setdiff1d(np.arange(900), [3, 450])
    np.testing.assert_array_equal(flat.vertices[others], mesh.vertices[others])
    assert flatten_spikes(mesh) == (mesh, 0)
    low = spiky(mesh, 3.0, [450])
    assert flatten_spikes(low)[0] is low
    corners = np.concatenate([np.eye(3), -np.eye(3)])
    octahedron = Mesh(corners, ConvexHull(corners).simplices.astype(np.int64))
    coarse = joined(mesh, placed(octahedron, 1.0))  # neighbours are as far away as the vertices are high
    assert flatten_spikes(coarse)[1] == 0


def test_slivers_at_a_boundary_are_no_spikes() -> None:
    mesh = spiky(blob(900), 6.0, [450])
    beside = np.flatnonzero((mesh.faces == 450).any(axis=1))
    assert flatten_spikes(Mesh(mesh.vertices, np.delete(mesh.faces, beside[0], axis=0)))[1] == 0


def test_a_body_with_spikes_is_matched_as_the_body(plain) -> None:
    source, target = (spiky(mesh, 8.0, [33, 77, 222]) for mesh in (plain.source, plain.target))
    with pytest.warns(KfmapsWarning, match="for the match 3 spikes are flattened; the numbering is kept"):
        found = match(source, target, SMALL, landmarks=MARKS)
    errors = geodesic_errors(plain.source, found.target_to_source, plain.target_to_source)
    assert np.delete(errors, [33, 77, 222]).mean() < 0.03


def test_edges_of_no_length_connect_nothing() -> None:
    vertices = np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 0], [0, 1, 0]])
    needles = Mesh(vertices, np.array([[0, 1, 2], [3, 4, 5]]))
    np.testing.assert_array_equal(weld_vertices(needles), [0, 0, 2, 3, 3, 5])


def test_a_prepared_shape_keeps_every_vertex() -> None:
    mesh = littered(blob(300))
    shape, clean = quietly(prepare, mesh, SMALL), prepare(blob(300), SMALL)
    assert clean.cleaned[0] is clean
    assert len(shape.mesh.vertices) == len(shape.basis.functions) == len(mesh.vertices)
    within, part = shape.cleaned
    for name in ("eigenvalues", "functions", "mass"):
        np.testing.assert_array_equal(getattr(within.basis, name), getattr(clean.basis, name))
    np.testing.assert_array_equal(within.mesh.vertices, clean.mesh.vertices)
    np.testing.assert_array_equal(within.mesh.faces, clean.mesh.faces)
    np.testing.assert_array_equal(part.to_original, np.arange(300))
    # Cleaned again it is what its preparation has left.
    again, numbers = replace(shape).cleaned
    np.testing.assert_allclose(again.mesh.vertices, within.mesh.vertices, atol=1e-12)
    np.testing.assert_array_equal(again.mesh.faces, within.mesh.faces)
    for name in ("to_original", "to_clean", "unreferenced", "faces_to_original"):
        np.testing.assert_array_equal(getattr(numbers, name), getattr(part, name))
    for name in ("functions", "mass"):
        np.testing.assert_array_equal(getattr(again.basis, name), getattr(within.basis, name))
    # Moved and scaled as one.
    factor = 1 / np.sqrt(surface_area(blob(300)))
    moved = shape.mesh.vertices - shape.mesh.vertices[0]
    np.testing.assert_allclose(moved, factor * (mesh.vertices - mesh.vertices[0]), atol=1e-9)


def test_faces_that_name_a_vertex_twice_change_nothing() -> None:
    """They come first, so that they shift the numbers of all other faces."""
    clean = blob(300)
    dirty = Mesh(clean.vertices, np.vstack([[[5, 5, 5], [7, 7, 8], [10, 11, 11]], clean.faces]))
    config = replace(SMALL, registration=NonRigid(n_levels=2, steps=2))
    landmark_vertices = np.stack([np.arange(0, 300, 60)] * 2, axis=1)
    plain = match(clean, clean, config, landmarks=landmark_vertices)
    for source, target in ((dirty, clean), (clean, dirty)):
        found = quietly(match, source, target, config, landmarks=landmark_vertices)
        assert np.array_equal(found.target_to_source, plain.target_to_source)
        assert np.array_equal(source.faces[found.precise().faces], clean.faces[plain.precise().faces])


def test_noise_is_smoothed_and_a_clean_mesh_stays(rng: np.random.Generator) -> None:
    clean = unit_area(blob(2000))
    noisy = Mesh(clean.vertices + 0.008 * rng.normal(size=clean.vertices.shape), clean.faces)
    with pytest.warns(KfmapsWarning, match="the noise of its vertices is smoothed"):
        found = prepare(noisy, SMALL)
    np.testing.assert_array_equal(found.mesh.faces, clean.faces)
    before, after = (np.linalg.norm(m.vertices - clean.vertices, axis=1).mean() for m in (unit_area(noisy), found.mesh))
    assert after < 0.6 * before
    assert found.extent == pytest.approx(1.0, abs=0.05)
    assert (found.extent or 0) < 0.97 * np.sqrt(surface_area(noisy))
    assert smooth_noise(clean) is None
    assert smooth_noise(Mesh(noisy.vertices, NO_FACES)) is None
    with warnings.catch_warnings(action="error"):
        prepare(clean, SMALL)
        prepare(unit_area(Mesh(blob(900).vertices + 0.05 * rng.normal(size=(900, 3)), blob(900).faces)), SMALL)


@pytest.mark.parametrize(("count", "left"), [(2000, 0.55), (8000, 0.37)])
def test_smoothing_keeps_what_is_longer_than_noise(count, left, rng: np.random.Generator) -> None:
    """More is left of the noise of coarse meshes, whose features are as short."""
    ball, spacing = fibonacci_sphere(count), np.sqrt(4 * np.pi / count)
    noise = 0.4 * spacing * rng.normal(size=ball.vertices.shape)
    smooth = smooth_noise(Mesh(ball.vertices + noise, ball.faces))
    assert smooth is not None
    radii = np.linalg.norm(smooth.vertices, axis=1)
    assert radii.mean() == pytest.approx(1, abs=0.02)
    assert radii.std() < left * 0.4 * spacing
    wave = np.cos(6 * np.arccos(ball.vertices[:, 2]))
    waved = smooth_noise(Mesh(ball.vertices * (1 + 0.1 * wave[:, None]) + noise, ball.faces))
    assert waved is not None
    height = np.linalg.norm(waved.vertices, axis=1) - 1
    assert height @ wave / (wave @ wave) == pytest.approx(0.1, rel=0.15)
